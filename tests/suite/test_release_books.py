"""Releases: energies are booked by what takes and gives them, and every motion can be drawn."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from fe_reference import cross_axis_pivot, solve_release
from spline_model import cross_axis_pivot as spline_pivot
from spline_model import solve_release as solve_spline
from tests.table_one import TABLE_ONE

FINDS = Path(__file__).with_name("finds")

#: How the drive of the case leads its body, and what that costs without a damper.
BEGINS_MOVING = ("held_s=[0.0,0.02]\nhistory=[[0,0],[0.01,1]]", "")
BEGINS_LATER = ("held_s=[0.002,0.02]\nhistory=[[0,0],[0.01,1]]", "")
STOPS_SHORT = ("held_s=[0.0,0.005]\nhistory=[[0,0],[0.005,1]]", "")


@pytest.mark.parametrize("model", ["spline", "fe"])
@pytest.mark.parametrize("drive", [BEGINS_MOVING, BEGINS_LATER, STOPS_SHORT], ids=["at once", "later", "end"])
def test_a_jolt_of_a_drive_is_work(model, drive, tmp_path, command):
    """Without dampers nothing negative is dissipated, and a body that is set in motion costs work alone."""
    text = (FINDS / "drive_that_begins_moving.toml").read_text(encoding="utf-8")
    led = tmp_path / "led.toml"
    led.write_text(text.replace(BEGINS_MOVING[0], drive[0]), encoding="utf-8")
    coarse = ["--control-points", 6] if model == "spline" else ["--elements", 4]
    words = ["release", led, "--model", model, *coarse, "--duration", 0.008, "--no-check", "--json", "-"]
    answer = json.loads(command(*words).out)
    assert min(answer["dissipated_J"]) >= 0.0
    assert np.all(np.diff(answer["dissipated_J"]) >= 0.0)
    if drive is BEGINS_MOVING:
        assert max(answer["dissipated_J"]) == 0.0
        assert answer["work_J"][0] == pytest.approx(answer["kinetic_J"][0], rel=1e-9)
        # kinetic energy of the body at the rate of the drive, as both models have it
        assert answer["work_J"][0] == pytest.approx(6.12e-4, rel=2e-2)
    balance = np.sum([answer[f"{name}_J"] for name in ("kinetic", "strain", "gravity", "dissipated")], axis=0)
    balance -= answer["work_J"]
    assert np.ptp(balance) < 2e-3 * max(np.abs(answer["work_J"]))


@pytest.mark.parametrize("words", [("release", "--duration", 0.01, "--no-check"), ("modes",)])
def test_what_lets_go_of_a_displacement_is_drawn(words, tmp_path, command):
    """A motion and modes have fewer unknowns than the path to their start, and are drawn all the same."""
    name, *more = words
    picture = tmp_path / "led.svg"
    assert command(name, FINDS / "led_guide.toml", *more, "--plot", picture).code == 0
    assert picture.stat().st_size > 0


def test_explicit_steps_that_lose_energy_are_told():
    """A light body from 170 deg: the default step is stable, but the energy is off, as a remark says."""
    light = TABLE_ONE | {"body_mass": 0.0265, "body_moment_of_inertia": 2.65e-5}
    at = {"start": math.radians(170.0), "duration": 0.01, "raise_on_failure": False, "check": False}
    motion = solve_release(cross_axis_pivot(**light, elements=10), **at)
    assert (motion.energy_error > 1e-3) == ("the energy drifts by" in motion.resolution)
    assert "the energy drifts by" in motion.resolution
    small = solve_release(cross_axis_pivot(**TABLE_ONE, elements=4), **(at | {"start": 0.5}))
    assert small.energy_error < 1e-3 and small.resolution == ""


@pytest.mark.parametrize("degrees", [150, 178])
def test_a_motion_that_stops_is_tried_with_more_control_points(degrees):
    """Six control points fold at 178 deg; left open they are raised until the motion goes on."""
    at = {"start": math.radians(degrees), "duration": 0.01, "check": False}
    left = solve_spline(spline_pivot(**TABLE_ONE), **at)
    fixed = solve_spline(spline_pivot(**TABLE_ONE, control_points=6), **at)
    assert left.status.value == "converged"
    assert (left.control_points > 6) == (fixed.status.value != "converged")
