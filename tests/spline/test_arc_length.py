"""Paths through limit points of the load: frames with published limit loads."""

import numpy as np
import pytest

from spline_model import ConvergenceError, cross_axis_pivot, solve_loads, solve_mechanism, solve_statics
from tests import gates
from tests.spline.frames import column, lees_frame, toggle
from tests.table_one import SIX


def test_a_load_that_turns_round_keeps_its_sign():
    """Requirement: with default settings Lee's frame is followed through loads below zero, told with sign."""
    path = solve_mechanism(lees_frame(control_points=None), control="arc-length")
    assert path.estimate.accuracy == 1e-4 and path.resolution == ""
    assert [point.kind for point in path.critical_points] == ["limit point", "limit point"]
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


def resumed(**settings):
    """Largest relative difference in torque of a path in two parts and in one."""
    pivot = cross_axis_pivot(**(SIX | settings))
    first = solve_statics(pivot, rotation=0.8, increments=8)
    second = solve_statics(pivot, rotation=1.6, increments=8, start=first)
    whole = solve_statics(cross_axis_pivot(**SIX), rotation=1.6, increments=16)
    assert second.rotation[0] == first.rotation[-1]
    return np.abs(second.torque - whole.torque[8:]).max() / whole.torque.max()


def test_a_path_goes_on_from_a_stored_solution():
    """Requirement: a path that is continued from a solution is the path in one go."""
    gates.check("spline_resumed_path", resumed())


def test_resumed_gate_has_teeth():
    """Requirement: the check notices another discretisation."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_resumed_path", resumed(**gates.teeth("spline_resumed_path")))


def test_arc_length_goes_on_from_beyond_a_limit_point():
    """Requirement: a path through limit points can be taken up on its unstable part."""
    scene = toggle(control_points=8).scene
    whole = solve_loads(scene, control="arc-length")[1]
    unstable = int(np.flatnonzero(whole.inertia == 1)[0])
    part = type(whole)(**{**vars(whole), **whole.rows(slice(unstable + 1))})
    onward = solve_loads(scene, control="arc-length", start=part, end=0.55)[1]
    assert onward.status.value == "converged", onward.message
    assert onward.inertia[0] == 1


def test_states_of_a_mechanism_go_on():
    """Requirement: a mechanism under loads goes on from its solution, beyond load factor 1 too."""
    made = column(load=1.0, side=0.1, control_points=6)
    half = solve_mechanism(made, end=0.5, increments=5)
    onward = solve_mechanism(made, start=half, end=2.0, increments=15)
    whole = solve_mechanism(made, end=2.0)
    assert onward.load_factor[0] == 0.5
    assert np.abs(onward.states[-1] - whole.states[-1]).max() < 1e-9
