"""A strip by its width and thickness, and clamps over the whole width: what they need, and what they give."""

import pytest

from spline_model import (
    DEFAULT_EFFECTS,
    cross_axis_pivot,
    plate_factors,
    solve_many,
    solve_statics,
)
from tests import gates
from tests.table_one import TABLE_ONE

SIDES = {"width": 0.01, "thickness": 0.005}
BARE = {name: value for name, value in TABLE_ONE.items() if name not in ("area", "second_moment_of_area")}
CLAMPED = (*DEFAULT_EFFECTS, "clamped_width")


def thin_pivot(width, **changed):
    """A pivot of strips so thin that stretch is out of sight, whose clamps hold the whole width."""
    return cross_axis_pivot(
        **BARE | {"width": width, "thickness": 1e-4, "effects": CLAMPED, "control_points": 8} | changed
    )


def test_width_and_thickness_stand_for_area_and_second_moment():
    """Sides give A = b t and I = b t^3 / 12; printed ones beside them count, and may be rounded."""
    strip = cross_axis_pivot(**BARE, **SIDES).design.strips[0]
    assert strip.area == 0.01 * 0.005
    assert strip.second_moment_of_area == pytest.approx(0.01 * 0.005**3 / 12.0, rel=1e-15)
    both = cross_axis_pivot(**TABLE_ONE, **SIDES).design.strips[0]
    assert both.second_moment_of_area == TABLE_ONE["second_moment_of_area"]


@pytest.mark.parametrize("crossing_ratio", [0.5, 0.3, 0.873])
def test_clamped_width_gives_a_pivot_the_stiffness_of_its_plates(crossing_ratio):
    """K(0) = sum EI/L [f_b + 12 (lambda - 1/2)^2 f_s] for all widths, with five control points or more."""

    def error(control_points=6):
        worst = 0.0
        for ratio in (0.05, 0.5, 2.0):
            pivot = thin_pivot(
                ratio * BARE["length"], control_points=control_points, crossing_ratio=crossing_ratio
            )
            found = solve_statics(pivot, rotation=1e-4, increments=1).stiffness[0]
            bend, shift = plate_factors(ratio, BARE["poisson_ratio"])
            known = bend + 12.0 * (crossing_ratio - 0.5) ** 2 * shift
            known *= 2.0 * pivot.flexural_rigidity / BARE["length"]
            worst = max(worst, abs(found / known - 1.0))
        return worst

    gates.hold("spline_clamped_width", error)


def test_a_batch_keeps_the_profile():
    """A batch of other thickness and modulus has the plate's profile, as b/L stays."""
    pivot = thin_pivot(0.01)
    alone = solve_statics(
        thin_pivot(0.01, thickness=2e-4, youngs_modulus=1e11, control_points=8), rotation=0.5, increments=4
    )
    found = solve_many(pivot, {"thickness": [2e-4], "youngs_modulus": [1e11]}, rotation=0.5, increments=4)
    assert found.torque[0] == pytest.approx(alone.torque, rel=1e-9)
