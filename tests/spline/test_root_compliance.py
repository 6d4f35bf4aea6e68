"""Roots that turn: a peak of compliance at each clamped end."""

import numpy as np
import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    cross_axis_pivot,
    solve_motion,
    solve_statics,
)
from tests import gates
from tests.table_one import SIDES, SIX

ROOTS = (*DEFAULT_EFFECTS, "root_compliance")


def rooted(root="monolithic", **changed):
    """Table 1 with roots of that length over the thickness."""
    given = {"effects": ROOTS, "parameters": {"root_compliance": {"root": root}}}
    return cross_axis_pivot(**SIX | SIDES | given | changed)


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


def test_both_schemes_turn_the_roots_alike():
    """The integrators agree within their steps."""
    given = {"start": 1.0, "duration": 5e-4, "step": 1e-6, "check": False}
    runs = [solve_motion(rooted(), integrator=name, **given) for name in ("energy", "leapfrog")]
    assert runs[0].rotation[-1] == pytest.approx(runs[1].rotation[-1], abs=2e-7)
