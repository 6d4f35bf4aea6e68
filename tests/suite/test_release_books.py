"""Releases: energies are booked by what takes and gives them, and what is not resolved is told."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import fe_reference
import spline_model
from tests.table_one import TABLE_ONE

FINDS = Path(__file__).with_name("finds")
#: A body that is light beside its strips.
LIGHT = {"body_mass": 0.0265, "body_moment_of_inertia": 2.65e-5}

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
    at = {"start": math.radians(170.0), "duration": 0.01, "raise_on_failure": False, "check": False}
    motion = fe_reference.solve_release(fe_reference.cross_axis_pivot(**TABLE_ONE | LIGHT, elements=10), **at)
    assert (motion.energy_error > 1e-3) == ("the energy drifts by" in motion.resolution)
    assert "the energy drifts by" in motion.resolution
    few = fe_reference.cross_axis_pivot(**TABLE_ONE, elements=4)
    small = fe_reference.solve_release(few, **(at | {"start": 0.5}))
    assert small.energy_error < 1e-3 and small.resolution == ""


@pytest.mark.parametrize("degrees", [150, 178])
def test_a_motion_that_stops_is_tried_with_more_control_points(degrees):
    """Six control points fold at 178 deg; left open they are raised until the motion goes on."""
    at = {"start": math.radians(degrees), "duration": 0.01, "check": False}
    left = spline_model.solve_release(spline_model.cross_axis_pivot(**TABLE_ONE), **at)
    fixed = spline_model.solve_release(spline_model.cross_axis_pivot(**TABLE_ONE, control_points=6), **at)
    assert left.status.value == "converged"
    assert (left.control_points > 6) == (fixed.status.value != "converged")


@pytest.mark.parametrize(
    ("given", "how", "said", "error"),
    [
        (LIGHT, {"start": math.radians(92.0), "duration": 0.02}, "the motion is not resolved", 0.2),
        ({"control_points": 4}, {}, "rotations are uncertain by up to", 0.05 * math.pi / 2.0),
    ],
)
def test_coarse_motion_says_so_by_default(given, how, said, error):
    """A body of 0.4 times the mass of its strips from 92 deg, and four control points, are not resolved."""
    motion = spline_model.solve_release(spline_model.cross_axis_pivot(**TABLE_ONE | given), **how)
    assert said in motion.resolution
    assert motion.rotation_error > error


def test_resolved_motion_has_an_error_and_no_remark():
    """Six control points are enough for Table 1; the estimate is what eight make of it by the leapfrog."""
    pivots = (spline_model.cross_axis_pivot(**TABLE_ONE | given) for given in ({}, {"control_points": 8}))
    fine = {"integrator": "leapfrog", "step": 1e-6, "records": 400, "check": False}
    motion, finer = (
        spline_model.solve_release(pivot, duration=0.02, **how)
        for pivot, how in zip(pivots, ({}, fine), strict=True)
    )
    assert motion.resolution == "" and math.isnan(finer.rotation_error)  # nobody asked for it
    exact = np.abs(motion.rotation - finer.rotation).max()
    assert motion.rotation_error == pytest.approx(exact, rel=0.05)


def test_explicit_run_of_too_many_steps_is_refused_before_it_starts():
    """A stiffly damped release that needs 5e9 explicit steps names the scheme that needs twenty thousand."""
    damped = {
        "effects": ("bending", "stretching", "strip_inertia", "body_inertia", "strip_damping"),
        "parameters": {"strip_damping": {"relaxation_time": 2e-3}},
    }
    pivot = fe_reference.cross_axis_pivot(**TABLE_ONE, **damped)
    with pytest.raises(fe_reference.InvalidParameter) as refused:
        fe_reference.solve_release(pivot, start=0.1, duration=0.05, increments=2)
    assert "at most 2e+07 steps" in str(refused.value)
    assert "--integrator generalised-alpha takes about 2.3e+04" in str(refused.value)
    brief = {"start": 0.1, "duration": 1e-8, "increments": 2, "samples": 2}
    run = fe_reference.solve_release(pivot, **brief, most_steps=1000)
    assert 100 < run.counters["steps"] <= 1000
    with pytest.raises(fe_reference.InvalidParameter, match="at most 100 steps"):
        fe_reference.solve_release(pivot, **brief, most_steps=100)
