"""`python -m studies release` and `modes`: JSON, tables, exit codes and refusals are an interface."""

import json
import math

import numpy as np
import pytest

from studies.answers import adapters

MODELS = ("spline", "fe", "fe-shear")
ARRAYS = {"time_s", "rotation_rad", "com_x_m", "com_y_m", "kinetic_J", "strain_J", "constraint_residual"}
KEYS = ARRAYS | {"status", "message", "resolution", "model", "settings", "effects", "frequency_Hz"}
KEYS |= {"frequency_reason", "modes", "rotation_error_rad", "displacement_error_m", "counters", "wall_s"}
MODE_KEYS = {"status", "message", "model", "settings", "effects", "rotation_rad", "held", "wall_s"}
MODE_KEYS |= {"frequency_Hz", "body_shapes", "slide_frequency_Hz"}

#: A coarse discretisation of each model, so that a motion takes a moment.
COARSE = {
    "spline": ["--control-points", 4, "--step", 1e-4],
    "fe": ["--elements", 4],
    "fe-shear": ["--elements", 4],
}


@pytest.mark.parametrize(
    "model", [pytest.param(model, marks=[pytest.mark.slow] * (model == "fe-shear")) for model in MODELS]
)
def test_release_of_every_model(model, case, command):
    """The JSON holds exactly the named keys; the motion begins at rest at the start and swings through."""
    words = ["release", case(), "--model", model, *COARSE[model], "--rotation-deg", 30, "--duration", 0.02]
    outcome = command(*words, "--json", "-")
    assert (outcome.code, outcome.err) == (0, "")
    answer = json.loads(outcome.out)
    assert set(answer) == KEYS
    assert len({len(answer[name]) for name in ARRAYS}) == 1
    assert (answer["status"], answer["message"], answer["resolution"]) == ("converged", "", "")
    assert answer["model"] == model
    assert answer["time_s"][0] == 0.0
    assert answer["time_s"][-1] == pytest.approx(0.02, rel=1e-12)
    assert answer["rotation_rad"][0] == pytest.approx(math.radians(30.0), rel=1e-9)
    assert answer["kinetic_J"][0] == 0.0
    assert min(answer["rotation_rad"]) < -0.4
    assert 70.0 < answer["frequency_Hz"] < 90.0
    assert max(answer["constraint_residual"]) < 1e-10
    assert answer["settings"]["step_s"] > 0.0
    assert answer["wall_s"] >= 0.0  # so short a motion may drown in the scatter of the static path taken off
    assert all(isinstance(count, int) for count in answer["counters"].values())


@pytest.mark.parametrize("length", [1e-3, 0.08485281374238571, 1.0])
def test_a_release_keeps_the_pace_of_its_design(length, case, command):
    """Without duration and step four swings of the design are followed, in steps that resolve them."""
    path = case(("length_m = 0.08485281374238571", f"length_m = {length}"))
    answer = json.loads(command("release", path, "--rotation-deg", 5, "--json", "-").out)
    assert answer["time_s"][-1] * answer["frequency_Hz"] == pytest.approx(4.0, rel=0.05)
    assert (answer["status"], answer["resolution"]) == ("converged", "")


def test_both_models_swing_alike(case, command):
    """Six control points and ten elements are together to half a percent of the amplitude after 10 ms."""
    words = ["--rotation-deg", 45, "--duration", 0.01, "--json", "-"]
    ends = [
        json.loads(command("release", case(), "--model", *model, *words).out)["rotation_rad"][-1]
        for model in (["spline"], ["fe", "--elements", 10])
    ]
    assert ends[0] == pytest.approx(ends[1], abs=0.005 * math.radians(45.0))


def test_options_of_the_motion_reach_the_model(case, command):
    """Integrator, step and slide stiffness stand in the answer's settings; accuracy replaces the step."""
    words = ["release", case(), "--model", "spline", "--control-points", 4, "--duration", 1e-3, "--json", "-"]
    fixed = ["--integrator", "leapfrog", "--step", 1e-6, "--slide-stiffness", 3]
    settings = json.loads(command(*words, *fixed).out)["settings"]
    assert settings["integrator"] == "leapfrog"
    assert settings["step_s"] == pytest.approx(1e-6, rel=1e-12)
    assert settings["slide_stiffness"] == 3.0
    assert json.loads(command(*words, "--accuracy", 1e-3).out)["settings"]["accuracy_rad"] == 1e-3


def test_start_is_that_of_the_case_unless_said(case, command):
    """Without --rotation-deg a release is from the end of the path; without crossings it has no frequency."""
    words = ["--model", "spline", *COARSE["spline"], "--duration", 1e-3, "--json", "-"]
    answer = json.loads(command("release", case(), *words).out)
    assert answer["rotation_rad"][0] == pytest.approx(math.pi / 2.0, rel=1e-12)
    assert answer["frequency_Hz"] is None


def test_release_table_is_short_and_says_what_is_not_resolved(case, command):
    """Without --json a few instants are printed, and a step too long for the swing is said to be so."""
    outcome = command("release", case(), "--model", "spline", "--step", 1e-3, "--duration", 0.05)
    lines = outcome.out.splitlines()
    assert outcome.code == 0
    assert "clamp gap" in lines[2]
    assert 20 <= len(lines) <= 30
    assert [float(cell) for cell in lines[4].split()[:2]] == [0.0, 90.0]
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


def test_release_is_timed_without_its_static_path(case, command, monkeypatch):
    """R releases are timed after a warm-up, and R that end at the first record are taken off."""
    asked = []
    genuine = adapters.measure

    def counted(work, *, repeat, warm_up, **part):
        timing = genuine(work, repeat=repeat, warm_up=warm_up, **part)
        asked.append((repeat, warm_up, round(timing.median, 9), float(timing.result.time[-1])))
        return timing

    monkeypatch.setattr(adapters, "measure", counted)
    words = ["release", case(), "--model", "spline", *COARSE["spline"], "--duration", 0.01, "--json", "-"]
    answer = json.loads(command(*words, "--repeat", 3).out)
    (whole, brief) = asked
    assert whole[:2] == (3, 1)
    assert brief[:2] == (3, 0)
    assert whole[3] == pytest.approx(0.01, rel=1e-12)
    assert brief[3] == pytest.approx(1e-4, rel=1e-6)
    assert answer["wall_s"] == pytest.approx(max(whole[2] - brief[2], 0.0), abs=1e-8)


@pytest.mark.parametrize("model", MODELS)
def test_modes_of_every_model(model, case, command):
    """The JSON holds exactly the named keys; at rest the first mode is the swing of the body at 76 Hz."""
    outcome = command("modes", case(), "--model", model, "--count", 3, "--json", "-")
    assert (outcome.code, outcome.err) == (0, "")
    answer = json.loads(outcome.out)
    assert set(answer) == MODE_KEYS | ({"estimate"} if model == "spline" else set())
    assert (answer["status"], answer["held"], answer["rotation_rad"]) == ("converged", False, 0.0)
    assert answer["frequency_Hz"] == sorted(answer["frequency_Hz"])
    assert answer["frequency_Hz"][0] == pytest.approx(76.22, abs=0.01)
    assert np.shape(answer["body_shapes"]) == (3, 3)


def test_held_modes_and_their_table(case, command):
    """Held at a rotation, the body does not turn and the swing is gone from the modes."""
    words = ["modes", case(), "--model", "fe", "--rotation-deg", 30, "--held", "--count", 2]
    answer = json.loads(command(*words, "--json", "-").out)
    assert answer["held"] is True
    assert answer["frequency_Hz"][0] > 500.0
    assert [turn for _, _, turn in answer["body_shapes"]] == pytest.approx([0.0, 0.0], abs=1e-12)
    lines = command(*words).out.splitlines()
    assert len(lines) == 5 + 2 + 1
    assert lines[5].split()[0] == "1"


#: Words after the command and its case, and what the one line must say.
REFUSED = {
    "no duration": (
        ["release", "spline", "--duration", 0],
        "--duration: got 0, expected a finite number above 0",
    ),
    "negative duration": (
        ["release", "fe", "--duration", -1],
        "--duration: got -1, expected a finite number above 0",
    ),
    "duration nan": (["release", "fe", "--duration", "nan"], "duration: got nan, expected a finite number"),
    "duration in words": (["release", "fe", "--duration", "long"], "--duration: got long, expected a finite"),
    "no step": (["release", "spline", "--step", 0], "--step: got 0, expected a finite number above 0"),
    "negative step": (["release", "fe", "--step", -1e-6], "--step"),
    "unknown integrator": (
        ["release", "spline", "--integrator", "generalised-alpha"],
        "integrator: got 'generalised-alpha', expected one of energy, leapfrog",
    ),
    "integrator of the other model": (
        ["release", "fe", "--integrator", "energy"],
        "integrator: got 'energy', expected one of central-difference, generalised-alpha",
    ),
    "too much to record": (
        ["release", "spline", "--duration", 1e6],
        "expected records within 2 GB; 19",
    ),
    "too many steps": (["release", "fe", "--duration", 1e6], "expected at most 2e+07 steps of"),
    "accuracy of implicit elements": (
        ["release", "fe-shear", "--accuracy", 1e-3, "--integrator", "generalised-alpha"],
        "accuracy: got 0.001, expected no step beside it, and the integrator central-difference",
    ),
    "accuracy and step": (["release", "spline", "--accuracy", 1e-3, "--step", 1e-4], "accuracy: got 0.001"),
    "start 720": (
        ["release", "spline", "--rotation-deg", 720],
        "--rotation-deg: got 720.0, expected a number from -360",
    ),
    "start nan": (
        ["release", "spline", "--rotation-deg", "nan"],
        "--rotation-deg: got nan, expected a finite number",
    ),
    "steps of the spline": (
        ["release", "spline", "--most-steps", 100],
        "--most-steps: got it with --model spline, expected only --step, --integrator, --accuracy",
    ),
    "no repeat": (["release", "fe", "--repeat", 0], "--repeat: got 0, expected a whole number of at least 1"),
    "negative slide": (["modes", "spline", "--slide-stiffness", "-1"], "--slide-stiffness: got -1, expected"),
    "slide of the elements": (
        ["modes", "fe", "--slide-stiffness", 1],
        "--slide-stiffness: got it with --model fe",
    ),
    "three control points": (["release", "spline", "--control-points", 3], "control_points: got 3, expected"),
    "no mode": (["modes", "spline", "--count", 0], "--count: got 0, expected a whole number of at least 1"),
    "too many modes": (
        ["modes", "fe", "--elements", 1, "--count", 9],
        "count: got 9, expected at most 3 modes",
    ),
    "rotation 720": (["modes", "fe", "--rotation-deg", 720], "--rotation-deg: got 720.0, expected a number"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_bad_motion_is_one_line(name, case, refused):
    """An option of a motion with a fault is refused with got and expected in one line."""
    (verb, model, *words), text = REFUSED[name]
    refused(verb, case(), "--model", model, *words, says=text)


@pytest.mark.parametrize(("verb", "option"), [("release", "--rotation-deg"), ("modes", "--rotation-deg")])
@pytest.mark.parametrize(
    "model",
    [
        ["fe", "--elements", 1],
        ["spline", "--stretch", "inextensible", "--control-points", 6, "--axial-modes", 1],
    ],
)
def test_state_that_statics_cannot_reach(verb, option, model, case, command):
    """A start that statics does not reach is exit code 3, without a record, and says where it stopped."""
    path = case(("length_m = 0.08", "length_m = 8.08"))
    outcome = command(verb, path, "--model", *model, option, 300, "--json", "-")
    answer = json.loads(outcome.out)
    assert outcome.code == 3
    assert answer["status"] == "not_converged"
    assert answer["message"].startswith("statics does not reach the ")
    where = "at 300 deg: " if verb == "modes" else ""
    assert outcome.err == f"studies: not converged: {where}{answer['message']}\n"
    if verb == "release":
        assert {name: answer[name] for name in ARRAYS} == {name: [] for name in ARRAYS}
    else:
        assert answer["frequency_Hz"] == []


def test_motion_that_blows_up_is_not_an_answer(case, command):
    """Explicit elements above their critical step are exit code 3, and say when the energy grew."""
    words = ["--model", "fe", "--elements", 10, "--step", 2e-6, "--duration", 1e-3]
    outcome = command("release", case(), *words, "--json", "-")
    answer = json.loads(outcome.out)
    assert outcome.code == 3
    assert answer["status"] == "unstable"
    assert "the energy grew from" in outcome.err


def test_accuracy_of_a_motion_is_reported(case, command):
    """With --accuracy the answer has its steps, its control points and the estimate, in JSON and table."""
    words = ["release", case(), "--model", "spline", "--accuracy", 3e-2, "--duration", 0.004]
    answer = json.loads(command(*words, "--json", "-").out)
    estimate = answer["estimate"]
    names = {"accuracy_rad", "rotation_rad", "time_rad", "space_rad", "control_points", "runs"}
    assert set(estimate) == names
    assert 0.0 < estimate["rotation_rad"] <= 3e-2
    assert answer["settings"]["control_points"] == estimate["control_points"]
    assert answer["settings"]["step_s"] > 0.0
    lines = command(*words).out.splitlines()
    assert any(line.startswith("estimated error of the rotation ") for line in lines)


@pytest.mark.slow
def test_accuracy_of_a_motion_of_elements_is_reported(case, command):
    """With --accuracy the elements are doubled, and JSON and table have meshes and errors."""
    words = ["release", case(), "--model", "fe", "--elements", 3, "--accuracy", 3e-2, "--duration", 5e-4]
    estimate = json.loads(command(*words, "--json", "-").out)["estimate"]
    assert set(estimate) == {"accuracy_rad", "rotation_rad", "shape", "meshes"}
    assert 0.0 < estimate["rotation_rad"] <= 3e-2
    tried = ", ".join(map(str, estimate["meshes"]))
    assert f" rad: elements tried: {tried}" in command(*words).out
