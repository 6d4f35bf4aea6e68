"""Paths through limit points of the load: frames with published limit loads."""

from spline_model import solve_mechanism
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.published.case import published
from tests import gates


def lees_frame(control_points):
    """Lee's frame of the published problems, its load of 3 t at load factor 1."""
    design = published("lees_frame").frame().design
    return put(design, SplineSettings(control_points=control_points)).modelled


def test_a_load_that_turns_round_keeps_its_sign():
    """Requirement: with default settings Lee's frame is followed through loads below zero, told with sign."""
    path = solve_mechanism(lees_frame(control_points=None), control="arc-length")
    assert path.estimate.accuracy == 1e-4 and path.resolution == ""
    assert [point.kind for point in path.critical_points] == ["limit point", "limit point"]
    assert path.load_factor.min() < -0.3
    assert "load factor -0.3138" in path.message


def work_balance(late=0):
    """Work of the load on Lee's frame, some states late, against the energy stored at the end of its path."""
    path = solve_mechanism(lees_frame(control_points=10), control="arc-length")
    return abs(path.work[-1 - late] / path.energies[-1].sum() - 1)


def test_work_is_booked_through_limit_points():
    """Requirement: along a path whose load goes up, down and up again the work is the energy stored."""
    gates.hold("spline_arc_length_work", work_balance)
