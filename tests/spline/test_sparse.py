"""Long B-splines are factorised by their pattern."""

import numpy as np
import pytest

from spline_model import newton
from spline_model.compile import compile_scene
from spline_model.continuation.followed import Followed
from spline_model.newton import filled_entries
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_statics
from tests import gates
from tests.spline.frames import opposed
from tests.table_one import TABLE_ONE

FIELDS = ("centre", "torque", "axial_force", "bending_moment", "clamp_reactions")


def pivot(**settings):
    """Table 1 with B-splines."""
    return cross_axis_pivot(**TABLE_ONE, **({"basis": "bspline", "control_points": 40} | settings))


def both(monkeypatch, dense=None, **settings):
    """The path by the sparse and by the dense factorisation, the latter of changed settings if given."""
    sparse = solve_statics(pivot(**settings), rotation=1.5, increments=6)
    with monkeypatch.context() as patch:
        patch.setattr(newton.Pattern, "of", lambda system: None)
        return sparse, solve_statics(pivot(**(settings | (dense or {}))), rotation=1.5, increments=6)


def difference(one, other, *names):
    """Largest difference of the named answers over their largest value."""
    return max(
        np.abs(getattr(one, name) - getattr(other, name)).max() / np.abs(getattr(other, name)).max()
        for name in names
    )


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"stretch": "inextensible"},
        {"control_points": 64},
    ],
    ids=str,
)
def test_both_factorisations_give_the_same_answer(monkeypatch, settings):
    """Requirement: sparse and dense factorisation agree to 1e-10, the stiffness to its round-off."""
    assert Followed.of(compile_scene(pivot(**settings).driven(1.0))).pattern is not None
    sparse, dense = both(monkeypatch, **settings)
    gates.check("spline_sparse_path", difference(sparse, dense, *FIELDS))
    gates.check("spline_sparse_stiffness", difference(sparse, dense, "stiffness"))


@pytest.mark.parametrize(
    ("gate", "names"), [("spline_sparse_path", FIELDS), ("spline_sparse_stiffness", ("stiffness",))]
)
def test_the_gates_of_the_sparse_path_have_teeth(monkeypatch, gate, names):
    """Requirement: the check notices one control point more."""
    sparse, dense = both(monkeypatch, dense=gates.teeth(gate))
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(gate, difference(sparse, dense, *names))


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"stretch": "consistent"},
        {"stretch": "inextensible"},
        {"slide_stiffness": 5.0},
        {"slide_stiffness": 0.0, "axial_modes": 39},
        {"basis": "bezier", "control_points": 9},
    ],
    ids=str,
)
def test_the_pattern_holds_every_entry(settings):
    """Requirement: no entry of the tangent at a crooked state lies outside of the pattern."""
    system = compile_scene(pivot(**settings).driven(1.0))
    work = Followed.of(system)
    generator = np.random.default_rng(5)
    work.evaluate(system.rest + system.scales.unit * 0.01 * generator.normal(size=system.layout.size), 0.5)
    filled = filled_entries(system)
    assert not work.hessian[~filled].any()
    assert (work.hessian[filled] != 0.0).mean() > 0.5


def test_both_factorisations_count_the_same_inertia(monkeypatch):
    """Requirement: a long B-spline's states have the same inertia by either factorisation."""
    made = opposed(offset=0.03, basis="bspline", control_points=40)
    sparse = solve_statics(made, rotation=-0.3, increments=8)
    with monkeypatch.context() as patch:
        patch.setattr(newton.Pattern, "of", lambda system: None)
        dense = solve_statics(made, rotation=-0.3, increments=8)
    assert set(sparse.inertia) == {0, 1}
    assert np.array_equal(sparse.inertia, dense.inertia)
    points = [[c.rotation for c in answer.critical_points] for answer in (sparse, dense)]
    assert np.allclose(*points, atol=1e-6)


def test_short_splines_and_bezier_curves_stay_dense():
    """Requirement: where a dense factorisation is the faster one it is taken."""
    for settings in ({"control_points": 12}, {"basis": "bezier", "control_points": 30}):
        assert Followed.of(compile_scene(pivot(**settings).driven(1.0))).pattern is None


def test_entries_that_are_not_finite_or_singular_are_refused():
    """Requirement: the sparse factorisation refuses what the dense one refuses, in the same words."""
    work = Followed.of(compile_scene(pivot().driven(1.0)))
    work.hessian[:] = np.nan
    with pytest.raises(np.linalg.LinAlgError, match="not finite"):
        work.solve(work.gradient)
    work.hessian[:] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="singular"):
        work.solve(np.ones_like(work.gradient))
