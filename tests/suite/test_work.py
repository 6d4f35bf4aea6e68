"""The formulas of counted work are those of the code that is counted."""

from types import SimpleNamespace

import numpy as np
import pytest

from fe_reference import cross_axis_pivot as element_pivot
from fe_reference import law
from fe_reference.structure import structure_of
from spline_model import cross_axis_pivot, swinging_slide_stiffness
from spline_model.compile import compile_scene
from spline_model.continuation.followed import Followed
from spline_model.motion import forces
from spline_model.motion.arrays import Flexures
from spline_model.motion.mechanism import Moving
from spline_model.motion.start import set_in_motion
from spline_model.path import follow
from spline_model.pattern import LEAST_SIZE
from spline_model.reduced import beside
from spline_model.reduced.model import reduced
from spline_model.strip import condense as strip_condense
from spline_model.strip import laws, points
from spline_model.strip.element import POINTS
from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from studies.work_precision import work
from studies.work_precision.work import work_of_motion
from tests.suite.counted import Counted
from tests.table_one import TABLE_ONE

counting = np.vectorize(Counted, otypes=[object])


def operations(call, *arguments):
    """Operations that a call does with counted numbers."""
    Counted.operations = 0
    call(*arguments)
    return Counted.operations


@pytest.mark.parametrize("n", [4, 5, 6, 9])
def test_operations_of_the_condensed_spline(monkeypatch, n):
    """Assembly, condensation and recovery of a strip do as many operations as the formulas say."""
    model = reduced(compile_scene(cross_axis_pivot(**TABLE_ONE, control_points=n).driven(1.0)))
    strips, shape, local = model.strips, model.shape, model.local()
    for module in (points, laws):
        for name, called in list(vars(module).items()):
            if hasattr(called, "py_func"):
                monkeypatch.setattr(module, name, called.py_func)
    monkeypatch.setattr(points, "math", SimpleNamespace(sqrt=lambda value: value.sqrt()))
    for name in ("add_slopes", "curve_at", "four"):
        monkeypatch.setattr(beside, name, getattr(points, name))
    monkeypatch.setattr(beside, "_product_at", beside._product_at.py_func)
    monkeypatch.setattr(strip_condense, "eliminate", strip_condense.eliminate.py_func)
    modes, own = strips.compliance.shape[1], 2 * n - 6
    curve = np.column_stack((np.linspace(0.0, 1.0, n), 0.01 * np.sin(np.arange(n))))
    counted = {name: counting(getattr(strips, name)) for name in ("along", "compliance", "numbers")}
    tables = {name: counting(getattr(shape, name)) for name in ("tables", "rule", "curve", "products")}
    room = {name: counting(getattr(local, name)) for name in ("nodal", "gap", "lanes", "pairs")}
    shape, local = shape._replace(**tables), local._replace(**room)
    local.nodal[0, POINTS] = counting(curve.ravel())
    ones, out = counting(np.ones(modes)), counting(np.zeros(5))
    evaluate = points.evaluate_points
    done = operations(evaluate, 0, ones, n - 1, shape, strips._replace(**counted), local, out)
    assert done == work._assembly_flops(shape.rule.shape[1], n - 1, modes)

    size = own + 3
    gain, gap = counting(np.ones(modes)), counting(np.ones(modes))
    g, h = counting(np.ones(size)), counting(10.0 * np.eye(size) + 1.0)
    b = counting(np.ones((modes, size)))
    condense = (strip_condense.condense.py_func, own, size, gain, g, h, b, gap)
    assert operations(*condense) == work._condensation_flops(own, modes)
    count = len(shape.rule[0]), n, modes
    strip = 0, ones, n, shape, strips._replace(**counted), local
    along, covector = counting(np.ones(2 * n)), counting(np.zeros(2 * n))
    product = beside._add_product.py_func, 0, ones, along, *strip[3:], covector
    confirmed = operations(points.evaluate_residual, *strip, out) + operations(*product)
    assert confirmed == work._confirmation_flops(*count)
    forward = beside._forward.py_func, own, own, size, 0, 0, gain, h, b, gap, g
    assert operations(*forward) == work._forward_flops(own, modes)
    change = (counting(np.zeros(k)) for k in (3, own, modes))
    recover = (strip_condense.recover.py_func, own, size, Counted(1.0), 0, 0, gain, g, h, b, gap, *change)
    assert operations(*recover) == work._recovery_flops(own, modes)


def test_operations_of_an_element(monkeypatch):
    """Forces and tangent of an element do as many operations as the constants say."""
    plain = SimpleNamespace(
        pi=np.pi, sqrt=Counted.sqrt, atan2=Counted.arctan2, floor=lambda value: np.floor(float(value))
    )
    monkeypatch.setattr(law, "math", plain)
    monkeypatch.setattr(law, "_spread", law._spread.py_func)
    structure = structure_of(element_pivot(**TABLE_ONE, elements=1))
    shear, table, first, curl = structure.given
    given, u = (
        (shear, counting(table[:1]), first[:1], curl),
        1e-3 * np.random.default_rng(3).normal(size=(2, 3)),
    )
    done = []
    for asked in (law.FORCES, law.TANGENT):
        ends, matrices, h = (np.empty(shape, dtype=object) for shape in ((1, 5), (1, 6, 6), (4, 4)))
        turns = law._turns.py_func, given, u, ends
        moments = law._moments.py_func, given, 1.0, asked, ends, matrices
        forces = law._forces.py_func, given, 1.0, asked, u, (None, ends, matrices, h)
        done.append(sum(operations(*each) for each in (turns, moments, forces)))
    assert done == [work.ELEMENT_FORCES, work.ELEMENT_FORCES + work.ELEMENT_TANGENT]


@pytest.mark.parametrize(
    "settings",
    [
        SplineSettings(control_points=7),
        SplineSettings(control_points=7, basis="bspline"),
        FeSettings(elements=6),
    ],
    ids=str,
)
def test_sizes_are_those_of_the_models(settings):
    """Unknowns and points are those of the systems that the models solve."""
    found = work.work_of(settings, answer_static(named_case("cross_axis_pivot"), settings).counters)
    if isinstance(settings, FeSettings):
        structure = structure_of(element_pivot(**TABLE_ONE, **settings.keywords()))
        assert (found["unknowns"], found["points"]) == (structure.size - 1, 2 * settings.elements)
        return
    pivot = cross_axis_pivot(**TABLE_ONE, **settings.keywords())
    if settings.basis == "bezier":
        own, modes = 2 * 7 - 6, reduced(compile_scene(pivot.driven(1.0))).strips.compliance.shape[1]
        assert found["unknowns"] == 2 + 2 * (own + modes)
    else:
        system = compile_scene(pivot.driven(1.0))
        assert found["unknowns"] == system.layout.size
        assert found["points"] == np.count_nonzero(system.points.rigidity)


@pytest.mark.parametrize("n", [24, 64])
def test_operations_of_the_sparse_factorisation(n):
    """The factors of a long B-spline hold what the constants say, within 3 %."""
    system = compile_scene(cross_axis_pivot(**TABLE_ONE, control_points=n, basis="bspline").driven(1.0))
    workspace, size = Followed.of(system), system.layout.size
    workspace.evaluate(follow(system, [0.2]).states[-1], 0.2)
    factors = workspace.pattern.factorise(workspace.hessian)
    below, right = (np.diff(part.indptr) - 1 for part in (factors.L.tocsc(), factors.U.tocsr()))
    assert (below + 2 * below * right).sum() / size == pytest.approx(work.SPARSE_FLOPS, rel=0.03)
    assert (factors.L.nnz + factors.U.nnz) / size == pytest.approx(work.SPARSE_ENTRIES, rel=0.03)
    assert size >= work.SPARSE_FROM == LEAST_SIZE


@pytest.mark.parametrize("n", [4, 7])
def test_operations_of_a_strip_in_motion(monkeypatch, n):
    """The forces of a strip without tangent take as many operations as the formula says."""
    slide = swinging_slide_stiffness(n)
    pivot = cross_axis_pivot(**TABLE_ONE, control_points=n, slide_stiffness=slide)
    system = compile_scene(pivot.released())
    strips = Moving.of(set_in_motion(system)).strips
    for name in ("bending_law", "stretching_law"):
        monkeypatch.setattr(forces, name, getattr(forces, name).py_func)
    monkeypatch.setattr(forces, "math", SimpleNamespace(sqrt=lambda value: value.sqrt()))

    def counted(table, kind):
        floats = {k: counting(v) for k, v in table._asdict().items() if np.asarray(v).dtype.kind == "f"}
        return kind(**(table._asdict() | floats))

    points = counting(np.array([np.linspace(0.0, 1.0, n), np.full(n, 0.01)]))
    room = counting(np.zeros((10, n + 2))), counting(np.zeros(n - 1)), counting(np.zeros((2, n)))
    given = counted(strips, Flexures), counted(forces.Grid.of(strips), forces.Grid)
    done = operations(forces.add_forces.py_func, 0, 0, *given, points, *room)
    assert done == work._strip_force_flops(n)


@pytest.mark.parametrize(
    ("settings", "options", "unknowns"),
    [
        (SplineSettings(control_points=5), {"integrator": "leapfrog"}, 11),
        (SplineSettings(control_points=5), {"step": 1e-4}, 43),
        (FeSettings(elements=4), {}, 21),
    ],
    ids=["leapfrog", "implicit", "elements"],
)
def test_work_of_a_motion(settings, options, unknowns):
    """Unknowns are those of the integrators, and the operations grow with the steps."""
    problem = named_case("cross_axis_pivot")
    short, long = (
        work_of_motion(settings, answer_release(problem, settings, duration=d, **options).counters)
        for d in (1e-3, 2e-3)
    )
    assert short["unknowns"] == unknowns
    assert long["steps"] == pytest.approx(2 * short["steps"], abs=2)
    assert long["flops"] == pytest.approx(2.0 * short["flops"], rel=0.2)
