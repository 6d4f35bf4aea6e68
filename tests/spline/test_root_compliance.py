"""Roots that turn: a peak of compliance at each clamped end."""

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    BodyDesign,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    solve_mechanism,
    solve_motion,
    solve_statics,
)
from tests import gates
from tests.table_one import SIDES, SIX, TABLE_ONE

ROOTS = (*DEFAULT_EFFECTS, "root_compliance")


def rooted(root="monolithic", **changed):
    """Table 1 with roots of that length over the thickness."""
    given = {"effects": ROOTS, "parameters": {"root_compliance": {"root": root}}}
    return cross_axis_pivot(**SIX | SIDES | given | changed)


@pytest.mark.parametrize("grid", [{}, {"control_points": 10, "segments": 3}], ids=["whole", "segments"])
def test_a_strip_rolls_up_as_if_it_were_longer(grid):
    """In pure bending both roots turn by c t / EI times the moment, at any angle."""
    strip = StripDesign(
        name="strip", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", youngs_modulus=2e11, density=1.0,
        width=0.1, thickness=0.05,
    )  # fmt: skip
    tip, root = BodyDesign(name="tip", centre=(1.0, 0.0)), {"root_compliance": {"root": 0.416}}
    made = compliant_mechanism(strips=[strip], bodies=[tip], effects=ROOTS, parameters=root, **grid)
    path = solve_mechanism(made, rotation=2.0, increments=4)
    moment = strip.flexural_rigidity * 2.0 / (1.0 + 2.0 * 0.416 * 0.05)
    # 1.5e-8 with three segments of ten points, which follow the roots' peaks
    assert path.torque[-1] == pytest.approx(moment, rel=5e-8)
    assert path.bending_energy[-1] == pytest.approx(moment, rel=5e-8)  # half of moment times two radians


def test_work_is_the_energy_of_strips_and_roots():
    """Over a quarter turn the energy of strips and roots is the work of the drive, and roots soften."""

    def error(increments=20):
        path = solve_statics(rooted(), rotation=np.pi / 2, increments=increments)
        assert path.inertia.max() == 0
        return np.abs(path.bending_energy + path.axial_energy - path.work).max() / path.work[-1]

    gates.hold("spline_root_work", error)


def test_roots_of_no_length_are_none():
    """A root of no length is a clamp: the same scene, to the last digit."""
    none, plain = (
        solve_statics(pivot, rotation=1.0, increments=4)
        for pivot in (rooted(0.0), rooted(effects=DEFAULT_EFFECTS, parameters=None))
    )
    assert np.array_equal(none.torque, plain.torque)


def test_modes_know_the_roots():
    """The swing of a heavy body at rest goes with the root of its stiffness, and so with its roots."""
    swing = [
        natural_frequencies(rooted(root, body_moment_of_inertia=10.0)).frequency[0] for root in (0.0, 0.416)
    ]
    series = 1.0 + 2.0 * 0.416 * SIDES["thickness"] / TABLE_ONE["length"]
    assert (swing[0] / swing[1]) ** 2 == pytest.approx(series, rel=1e-6)


def test_both_schemes_turn_the_roots_alike():
    """The integrators agree within their steps."""
    given = {"start": 1.0, "duration": 5e-4, "step": 1e-6, "check": False}
    runs = [solve_motion(rooted(), integrator=name, **given) for name in ("energy", "leapfrog")]
    assert runs[0].rotation[-1] == pytest.approx(runs[1].rotation[-1], abs=2e-7)
