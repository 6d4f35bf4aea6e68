"""Paths through limit points of the load: frames with published limit loads."""

import numpy as np
import pytest

from spline_model.errors import ConvergenceError
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import solve_loads, solve_mechanism
from tests import gates
from tests.spline.frames import lees_frame, toggle
from tests.table_one import SIX


def limits(scene, load, **options):
    """Limit loads of a scene, in units of ``load`` at load factor 1."""
    path = solve_loads(scene, control="arc-length", **options)[1]
    assert path.status.value == "converged", path.message
    assert [c.kind for c in path.critical_points] == ["limit point"] * len(path.critical_points)
    return load * np.array([c.load_factor for c in path.critical_points])


def against_print(name, found, published):
    """Hold limit loads against published ones."""
    gates.check(name, np.abs(found - published).max())


def test_toggle_snaps_through_both_limit_points():
    """Requirement: Williams' toggle passes its upper and its lower limit load, as published."""
    found = limits(toggle(control_points=8).scene, 60.0)
    against_print("spline_toggle_published", found, (33.9, 31.3))


def test_toggle_gate_has_teeth():
    """Requirement: the check notices a coarser curve."""
    coarse = limits(toggle(**gates.teeth("spline_toggle_published")).scene, 60.0)
    with pytest.raises(AssertionError, match="x the gate"):
        against_print("spline_toggle_published", coarse, (33.9, 31.3))


def test_a_flatter_toggle_has_no_limit_point():
    """Requirement: with a rise of 0.32 the load of the toggle only grows: no critical point is reported."""
    assert limits(toggle(rise=0.32, control_points=8).scene, 60.0).size == 0


def test_lees_frame_passes_both_limit_points():
    """Requirement: Lee's frame passes its limit load and the one below zero, as published."""
    against_print("spline_lee_published", limits(lees_frame(control_points=10).scene, 3.0), (1.85, -0.94))


def test_lees_frame_gate_has_teeth():
    """Requirement: the check notices a coarser curve."""
    coarse = limits(lees_frame(**gates.teeth("spline_lee_published")).scene, 3.0)
    with pytest.raises(AssertionError, match="x the gate"):
        against_print("spline_lee_published", coarse, (1.85, -0.94))


def test_a_load_that_turns_round_keeps_its_sign():
    """Requirement: with default settings Lee's frame is followed through loads below zero, told with sign."""
    path = solve_mechanism(lees_frame(control_points=None), control="arc-length")
    assert path.estimate.accuracy == 1e-4 and path.resolution == ""
    found = 3.0 * np.array([point.load_factor for point in path.critical_points])
    against_print("spline_lee_published", found, (1.85, -0.94))
    assert path.load_factor.min() < -0.3
    assert "load factor -0.3138" in path.message


def work_balance(late=0):
    """Work of the load on Lee's frame, some states late, against the energy stored at the end of its path."""
    path = solve_loads(lees_frame(control_points=10).scene, control="arc-length")[1]
    return abs(path.work[-1 - late] / path.energies[-1].sum() - 1)


def test_work_is_booked_through_limit_points():
    """Requirement: along a path whose load goes up, down and up again the work is the energy stored."""
    gates.check("spline_arc_length_work", work_balance())


def test_work_gate_has_teeth():
    """Requirement: the check notices a step that is left out."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_arc_length_work", work_balance(**gates.teeth("spline_arc_length_work")))


def test_inertia_goes_with_the_limit_points():
    """Requirement: between its two limit points the frame is unstable, before and after it is not."""
    path = solve_loads(lees_frame(control_points=8).scene, control="arc-length")[1]
    slope = np.gradient(path.load_factor)
    turns = np.flatnonzero(np.diff(np.sign(slope))).tolist()
    assert set(path.inertia[: turns[0] - 1]) == {0}
    assert set(path.inertia[turns[0] + 3 : turns[1] - 2]) == {1}
    assert set(path.inertia[turns[1] + 3 :]) == {0}


def test_load_control_stops_at_the_limit_point():
    """Requirement: prescribed loads cannot pass a limit point: the path ends below it and says so."""
    with pytest.raises(ConvergenceError, match="stopped between load factor") as caught:
        solve_mechanism(toggle(control_points=8))
    reached = 60.0 * caught.value.solution.load_factor[-1]
    assert 33.0 < reached < 33.91


def test_a_driven_path_may_use_arc_length():
    """Requirement: the pivot driven to a rotation ends in the same state in either control."""
    pivot = cross_axis_pivot(**SIX)
    mechanism = pivot
    by_arc = solve_mechanism(mechanism, rotation=1.5, control="arc-length")
    by_load = solve_mechanism(mechanism, rotation=1.5)
    assert by_arc.load_factor[-1] == 1.0
    scale = np.abs(by_load.states[-1]).max()
    assert np.abs(by_arc.states[-1] - by_load.states[-1]).max() < 1e-9 * scale
