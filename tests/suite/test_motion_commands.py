"""`release` and `modes`: JSON, tables, exit codes; energies that are booked, what is not resolved is told."""

import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest

import fe_reference
import spline_model
from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from tests.suite.refused import FINDS
from tests.table_one import TABLE_ONE


@pytest.mark.parametrize("length", [1e-3, 0.08485281374238571, 1.0])
def test_a_release_keeps_the_pace_of_its_design(length, case, command):
    """Without duration and step four swings of the design are followed, in steps that resolve them."""
    path = case(("length_m = 0.08485281374238571", f"length_m = {length}"))
    answer = json.loads(command("release", path, "--rotation-deg", 5, "--json", "-").out)
    assert answer["time_s"][-1] * answer["frequency_Hz"] == pytest.approx(4.0, rel=0.05)
    assert (answer["status"], answer["resolution"]) == ("converged", "")


@pytest.mark.parametrize("model", ["spline", pytest.param("fe", marks=pytest.mark.slow)])
def test_an_unstable_design_is_seen_to_fall(model, command):
    """Without --duration a pivot that its weight tips over is followed until it has fallen to its side."""
    words = ["release", FINDS / "heavy_pivot.toml", "--model", model, "--no-check", "--json", "-"]
    answer = json.loads(command(*words).out)
    assert math.degrees(answer["rotation_rad"][-1]) == pytest.approx(102.0, abs=0.2)


def test_release_table_is_short_and_says_what_is_not_resolved(case, command):
    """Without --json a few instants are printed, and a step too long for the swing is said to be so."""
    outcome = command("release", case(), "--model", "spline", "--step", 1e-3, "--duration", 0.05)
    lines = outcome.out.splitlines()
    assert outcome.code == 0
    assert "clamp gap" in lines[2]
    assert "of the period of mode" in lines[-2]
    assert "of the swing's" in lines[-2]


def test_what_stands_still_has_no_balance_of_energy(case, command):
    """Where nothing moves, energies are round-off, and no line says how well they balance."""
    out = command("release", case(), "--rotation-deg", 0, "--duration", 1e-3, "--step", 1e-4).out
    assert "nothing moves" in out and "balanced" not in out


def test_an_unstable_rest_is_told(case, command):
    """Under a load beyond that at which it tips over a pivot at rest stays there, but `release` and `modes`
    say in which time a disturbance grows, as the frequency has it."""
    scene = '[scene]\neffects = ["+applied_force"]\n[effects.applied_force]\nforce_N = [0, -100e3]\n[drive]'
    words = [case(("[drive]", scene)), "--rotation-deg", 0]
    frequency = json.loads(command("modes", *words, "--count", 1, "--json", "-").out)["frequency_Hz"][0]
    told = f"a disturbance grows e-fold in {-1.0 / (2.0 * math.pi * frequency):.3g} s"
    assert frequency < 0.0 and told in command("modes", *words).out
    let_go = command("release", *words, "--duration", 1e-3, "--step", 1e-4).out
    assert f"the start is an unstable equilibrium, where {told}" in let_go


def test_modes_beyond_those_that_there_are_told(case, command):
    """Asked for more modes than the discretisation has, the table says how many there are."""
    out = command("modes", case(), "--count", 500, "--control-points", 6).out
    assert "13 of 500 modes" in out


@pytest.mark.parametrize("verb", ["release", "modes"])
@pytest.mark.parametrize(
    "model", [["fe", "--elements", 1], ["spline", "--stretch", "inextensible", "--control-points", 6]]
)
def test_state_that_statics_cannot_reach(verb, model, case, command):
    """A start that statics does not reach is exit code 3, without a record, and says where it stopped."""
    path = case(("length_m = 0.08", "length_m = 8.08"))
    outcome = command(verb, path, "--model", *model, "--rotation-deg", 300, "--json", "-")
    answer = json.loads(outcome.out)
    assert outcome.code == 3
    assert answer["status"] == "not_converged"
    assert answer["message"].startswith("statics does not reach the ")
    where = "at 300 deg: " if verb == "modes" else ""
    assert outcome.err == f"studies: not converged: {where}{answer['message']}\n"
    arrays = ("frequency_Hz",) if verb == "modes" else ("time_s", "rotation_rad", "strain_J", "com_x_m")
    assert all(answer[name] == [] for name in arrays)


def test_accuracy_of_a_motion_is_reported(case, command):
    """With --accuracy the answer has its steps, what was refined and the estimate, in JSON and table."""
    words = ["release", case(), "--accuracy", 3e-2, "--duration", 0.004]
    answer = json.loads(command(*words, "--json", "-").out)
    estimate = answer["estimate"]
    assert 0.0 < estimate["rotation_rad"] <= estimate["accuracy_rad"] == 3e-2
    assert answer["settings"]["step_s"] > 0.0
    assert "estimated error of the rotation " in command(*words).out
    assert answer["settings"]["control_points"] == estimate["control_points"]
    refused = command(*words, "--model", "fe")
    assert refused.code == 2
    assert "accuracy: got 0.03, expected none for a motion of the finite elements" in refused.err


def test_a_companion_that_fails_is_told(command):
    """Where a companion cannot follow the motion its errors are not estimated, and the reason is printed."""
    words = ("release", "cross_axis_pivot", "--control-points", 4, "--duration", 0.05, "--step", 0.005)
    told = command(*words).out.splitlines()
    assert "errors of rotations and displacements: not estimated" in told
    reason = "error not estimated: a companion with 4 .* reaches the end: stopped at .* strip_1 folds"
    assert re.search(reason, "\n".join(told))


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_the_stability_under_a_load_that_follows_is_not_judged(model, command):
    """A load that follows its body has no modes: a release that starts in balance under it has a remark."""
    words = ["release", FINDS / "followed.toml", "--model", model, "--duration", 1e-3, "--no-check"]
    answer = json.loads(command(*words, "--json", "-").out)
    assert answer["status"] == "converged"
    assert answer["message"].startswith("the start is in equilibrium, whose stability is not judged")


@pytest.mark.parametrize("settings", [SplineSettings(control_points=6), FeSettings(elements=4)])
def test_the_smallest_turn_is_a_motion(settings):
    """A turn of 1e-7 rad is no equilibrium, none is one."""
    motions = [
        answer_release(named_case("cross_axis_pivot"), settings, start=turn, duration=1e-4)
        for turn in (1e-7, 0.0)
    ]
    assert [motion.starts_still for motion in motions] == [False, True]
    assert motions[1].message.startswith("nothing moves")


@pytest.mark.parametrize(
    "settings, how",
    [
        (SplineSettings(), {"duration": 5.2e4, "step": 400.0}),
        (FeSettings(elements=4), {"duration": 5.2e4, "step": 200.0, "integrator": "generalised-alpha"}),
    ],
    ids=["spline", "fe"],
)
def test_a_pivot_of_extreme_slenderness_moves(settings, how):
    """Strips of 60 m and 20 um: the forces of the release are below the round-off of the axial forces, but
    over half a swing both models follow it. `nothing moves` was told of it."""
    design = replace(named_case("silicon_pivot"), length=60.0)
    motion = answer_release(design, settings, **how)
    assert motion.rotation[-1] < -0.9 * motion.rotation[0]
    assert "nothing moves" not in motion.message
    still = answer_release(design, settings, start=0.0, **how)
    assert still.message.startswith("nothing moves")


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
    motion = fe_reference.solve_motion(fe_reference.cross_axis_pivot(**TABLE_ONE | LIGHT, elements=10), **at)
    assert (motion.energy_error > 1e-3) == ("the energy drifts by" in motion.resolution)
    assert "the energy drifts by" in motion.resolution
    few = fe_reference.cross_axis_pivot(**TABLE_ONE, elements=4)
    small = fe_reference.solve_motion(few, **(at | {"start": 0.5}))
    assert small.energy_error < 1e-3 and small.resolution == ""


@pytest.mark.parametrize("degrees", [150, 178])
def test_a_motion_that_stops_is_tried_with_more_control_points(degrees):
    """Six control points fold at 178 deg; left open they are raised until the motion goes on."""
    at = {"start": math.radians(degrees), "duration": 0.01, "check": False}
    left = spline_model.solve_motion(spline_model.cross_axis_pivot(**TABLE_ONE), **at)
    fixed = spline_model.solve_motion(spline_model.cross_axis_pivot(**TABLE_ONE, control_points=6), **at)
    assert left.status.value == "converged"
    assert (left.control_points > 6) == (fixed.status.value != "converged")


@pytest.mark.parametrize(
    ("given", "how", "said", "error"),
    [
        (LIGHT, {"start": math.radians(92.0), "duration": 0.02}, "the motion is not resolved", 0.2),
        (
            {"control_points": 4},
            {"start": math.pi / 2.0},
            "rotations are uncertain by up to",
            0.05 * math.pi / 2.0,
        ),
    ],
)
def test_coarse_motion_says_so_by_default(given, how, said, error):
    """A body of 0.4 times the mass of its strips from 92 deg, and four control points, are not resolved."""
    motion = spline_model.solve_motion(spline_model.cross_axis_pivot(**TABLE_ONE | given), **how)
    assert said in motion.resolution
    assert motion.rotation_error > error
