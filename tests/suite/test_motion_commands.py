"""`python -m studies release` and `modes`: JSON, tables, exit codes and refusals are an interface."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case


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
    "model",
    [
        ["fe", "--elements", 1],
        ["spline", "--stretch", "inextensible", "--control-points", 6, "--axial-modes", 1],
    ],
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


def test_motion_that_blows_up_is_not_an_answer(case, command):
    """Explicit elements above their critical step are exit code 3, and say when the energy grew."""
    words = ["--model", "fe", "--elements", 10, "--step", 2e-6, "--duration", 1e-3]
    outcome = command("release", case(), *words, "--json", "-")
    answer = json.loads(outcome.out)
    assert outcome.code == 3
    assert answer["status"] == "unstable"
    assert "the energy grew from" in outcome.err


@pytest.mark.slow
def test_accuracy_of_a_motion_is_reported(case, command):
    """With --accuracy the answer has its steps, what was refined and the estimate, in JSON and table."""
    words = ["--model", "fe", "--elements", 3, "--duration", 5e-4]
    words = ["release", case(), "--accuracy", 3e-2, *words]
    answer = json.loads(command(*words, "--json", "-").out)
    estimate = answer["estimate"]
    assert 0.0 < estimate["rotation_rad"] <= estimate["accuracy_rad"] == 3e-2
    assert answer["settings"]["step_s"] > 0.0
    out = command(*words).out
    assert "estimated error of the rotation " in out
    assert f": elements tried: {', '.join(map(str, estimate['meshes']))}" in out


FINDS = Path(__file__).with_name("finds")


def test_a_companion_that_fails_is_told(command):
    """Where a companion cannot follow the motion its errors are not estimated, and the reason is printed."""
    words = ("release", "cross_axis_pivot", "--control-points", 4, "--duration", 0.05, "--step", 0.005)
    told = command(*words).out.splitlines()
    assert "errors of rotations and displacements: not estimated" in told
    reason = "error not estimated: a companion with 4 .* reaches the end: stopped at .* strip_1 folds"
    assert re.search(reason, "\n".join(told))


#: A strip whose tip is pressed along itself, and a little aside.
FOLLOWED = """
[[strips]]
name = "strip"
start_m = [0, 0]
end_m = [0.1, 0]
tip = "body"

[[bodies]]
name = "body"
centre_m = [0.1, 0]
mass_kg = 0.05
moment_of_inertia_kg_m2 = 1e-5

[section]
width_m = 0.01
thickness_m = 0.0005

[material]
name = "spring_steel"

[drive]
body = "body"
increments = 10

[scene]
effects = ["+applied_force"]

[effects.applied_force]
force_N = [-10.0, 0.5]
follower = true
"""


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_the_stability_under_a_load_that_follows_is_not_judged(model, tmp_path, command):
    """A load that follows its body has no modes: a release that starts in balance under it has a remark."""
    case = tmp_path / "followed.toml"
    case.write_text(FOLLOWED)
    words = ["release", case, "--model", model, "--duration", 1e-3, "--no-check"]
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
