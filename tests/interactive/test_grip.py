"""The hand that grips elastically: balance, true spreads; loads that a design does not bear; every case."""

import json
import math
import tomllib

import numpy as np
import pytest

from spline_model import cross_axis_pivot, solve_statics
from studies.answers.critical import critical_load
from studies.answers.settings import SplineSettings
from studies.cases.document import parsed
from studies.cases.problem import FOLDER
from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.presets import OWN, PENALTY_STIFFNESS, PRESETS, opened
from studies.interactive.session import Session
from tests import gates
from tests.interactive.events import FRAME, codes, seen, session, turned
from tests.table_one import TABLE_ONE

SD = np.array([3e-5, 3e-5, 3e-4])


def held(preset, degrees):
    """A session whose camera sees an unloaded pivot at a rotation, the true state, and the true marker."""
    made, true = Session(preset), session(preset)
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        state = turned(true, part * degrees)
        event = seen(true, np.array(state["displacement"][:2]), state["displacement"][2])
        made.feed({**event, "sd": SD.tolist(), "t": 0.0})
    return made, state, np.array(event["marker"])


@pytest.mark.parametrize("degrees", [0, 11, 45])
@pytest.mark.parametrize("preset", PRESETS)
def test_a_camera_s_noise_is_no_force(preset, degrees):
    """Requirement: in the hand of a camera an unloaded pivot shows pose, forces, moment and stiffness within
    three stated spreads of the truth in 99 % of the frames, the spreads being neither too small nor twice too
    large, and below 10 % of the moment at 45 degrees."""
    made, true, marker = held(preset, degrees)
    rng, gaps = np.random.default_rng(1), []
    for k in range(60):
        noisy = (marker + rng.normal(size=3) * SD).tolist()
        state = made.feed({"do": "seen", "marker": noisy, "sd": SD.tolist(), "t": 1.0 + k * FRAME})
        pairs = [(name, f"{name}_sd" if name == "force" else "sd") for name in ("force", "pose")]
        gap = np.concatenate([np.subtract(state[n], true[n]) / state[sd][:3] for n, sd in pairs])
        gaps.append([*gap, (state["stiffness"] - true["stiffness"]) / state["force_sd"][3]])
    gaps = np.array(gaps)
    assert np.mean(np.abs(gaps) > 3.0) < 0.01
    spread = np.sqrt(np.mean(gaps**2, axis=0))
    assert (spread < 1.3).all()
    assert (spread > 0.5).all()
    if degrees == 45:

        def spread(by="grip"):
            """Stated spread of the moment over it, as a drive has it."""
            made.feed({"do": "drive", "by": by, "t": 9.0})
            shown = made.feed({"do": "seen", "marker": noisy, "sd": SD.tolist(), "t": 9.1})
            return shown["force_sd"][2] / true["force"][2]

        gates.hold("grip_moment_spread", spread)


@pytest.mark.parametrize("preset", PRESETS)
def test_strips_and_grip_are_in_balance(preset):
    """Requirement: the force on the body is that of the grip's spring, wherever the hand pulls, and the same
    whatever way it came."""
    made, rng = session(preset, drive="grip"), np.random.default_rng(2)
    for k in range(40):
        wanted = [*rng.uniform(-0.01, 0.01, 2), rng.uniform(-0.8, 0.8)]
        state = made.feed({"do": "pose", "pose": wanted, "t": k * FRAME})
        assert codes(state) == []
        spring = state["grip"] * np.subtract(wanted[:2], state["displacement"][:2])
        scale = np.hypot(*spring) + state["scale"]["force"]
        assert np.abs(state["force"][:2] - spring).max() < 1e-6 * scale
    fresh = session(preset, drive="grip").feed({"do": "pose", "pose": wanted, "t": 0.0})
    assert fresh["pose"] == pytest.approx(state["pose"], abs=1e-8)


@pytest.mark.parametrize("preset", PRESETS)
def test_a_pulled_body_turns_until_no_moment_is_left(preset):
    """Requirement: a body that a spring pulls by its centre turns to where the strips' force is the spring's
    and their moment nought; pulled aside it turns to that side, and it is at rest when released."""
    made = session(preset, drive="pull")
    for k, x in enumerate((-4e-3, -8e-3, -12e-3, 6e-3)):
        state = made.feed({"do": "pose", "pose": [x, 0.0, 0.0], "t": k * FRAME})
        assert codes(state) == []
        spring = state["grip"] * np.subtract([x, 0.0], state["displacement"][:2])
        scale = np.hypot(*spring) + state["scale"]["force"]
        assert np.abs(state["force"][:2] - spring).max() < 1e-6 * scale
        assert abs(state["force"][2]) < 1e-6 * scale * made.mechanics.length
        assert state["pose"][2] * x < 0.0
    assert abs(made.feed({"do": "pose", "pose": [0.0, 0.0, 0.0], "t": 1.0})["pose"][2]) < 1e-6


def loaded(load, preset="polymer"):
    """A session whose hand holds the rotation of a body under a load [N]."""
    made = session(preset)
    made.feed({"do": "parameter", "name": "load", "value": load, "t": 0.0})
    return made


@pytest.mark.parametrize("degrees", [1, 30])
def test_load_is_that_of_the_model(degrees):
    """Requirement: a body under a dead load, its rotation held, stands where the path of the model with that
    load ends, and needs its moment; no force holds its centre."""
    load = 2e3
    state = turned(loaded(load, "table-1"), degrees)
    force = {"applied_force": {"force": (0.0, -load)}}
    given = {"effects": ("bending", "stretching", "applied_force"), "parameters": force}
    given["control_points"] = state["control_points"]
    pivot = cross_axis_pivot(**TABLE_ONE, **given, penalty_stiffness=PENALTY_STIFFNESS)
    path = solve_statics(pivot, rotation=math.radians(degrees))
    assert np.abs(np.array(state["pose"][:2]) - path.centre[-1]).max() < 1e-9
    assert state["force"][2] == pytest.approx(path.torque[-1], rel=1e-9)
    assert np.abs(state["force"][:2]).max() < 1e-6 * load


def test_released_load_swings_and_gains_nothing():
    """Requirement: under a load the energy of strips, body and load never rises; released where it balances,
    the body stays there."""
    made = loaded(0.05)
    rest = turned(made, 0)
    made.feed({"do": "release", "t": 0.0})
    for k in range(10):
        state = made.feed({"do": "tick", "t": 0.04 * k})
    assert np.abs(np.subtract(state["pose"], rest["pose"])).max() < 1e-6
    made.feed({"do": "catch", "t": 1.0})
    held = turned(made, 20, 40)
    before = held["energy"]["strain"] + held["energy"]["potential"]
    assert held["energy"]["potential"] < 0.0
    made.feed({"do": "release", "t": 1.0})
    for k in range(50):
        energy = made.feed({"do": "tick", "t": 1.0 + 0.04 * k})["energy"]
        now = energy["strain"] + energy["potential"] + energy["kinetic"]
        assert now <= before + 1e-6 * held["energy"]["strain"]
        assert made.mechanics.begun - now == pytest.approx(energy["dissipated"], abs=1e-9)
        before = now


def test_load_is_in_the_case_file_and_curve():
    """Requirement: a design's load is written into its case file and read from it; its curve is that of the
    loaded body."""
    made = loaded(0.05)
    assert opened(OWN, tomllib.loads(made.mechanics.piece.as_case()), {}).values["load"] == 0.05
    curve, without = made.mechanics.curve, session().mechanics.curve
    state = turned(made, math.degrees(curve.rotation[7]))
    assert state["force"][2] == pytest.approx(curve.moment[7], rel=1e-9)
    assert abs(curve.moment[7] / without.moment[7] - 1) > 0.05


DESIGNS = ["polymer", "table-1", "titanium_pivot", "spring_steel_pivot"]


def burdened(preset, load):
    """A session under a load [N], whose hand holds the rotation alone, and its state."""
    made = session(preset)
    made.feed({"do": "parameter", "name": "load", "value": load, "t": 0.0})
    made.feed({"do": "critical", "force": presets.preset(preset).critical_load(), "t": 0.0})
    return made, turned(made, 0)


@pytest.mark.parametrize("preset", DESIGNS)
def test_a_load_beyond_the_critical_one_is_named(preset):
    """Requirement: 1 % below the load of `critical-load` the body stays, 1 % beyond it the page says that it
    is unstable, with that load, the negative stiffness, and that contact is not modelled."""
    design = presets.preset(preset).design
    force = critical_load(design, SplineSettings(), direction=-math.pi / 2).force
    _, state = burdened(preset, 0.99 * force)
    assert "unstable" not in codes(state)
    assert state["stiffness"] > 0.0
    _, state = burdened(preset, 1.01 * force)
    (text,) = [each["text"] for each in state["warnings"] if each["code"] == "unstable"]
    assert state["stiffness"] < 0.0
    assert f"critical load {state['texts']['critical']}, stiffness -" in text
    assert text.startswith("Unstable under this load: ") and "Contact with the ground is not modelled" in text


def test_no_body_falls_through_the_ground():
    """Requirement: under five times its critical load a released body stops where its centre meets the
    ground, in a sentence, and time is paused."""
    made, _ = burdened("polymer", 1.4)
    turned(made, 1)
    made.feed({"do": "release", "t": 0.0})
    for k in range(60):
        state = made.feed({"do": "tick", "t": (k + 1) * FRAME})
        if state["paused"]:
            break
    assert "grounded" in codes(state)
    assert state["pose"][1] > 0.0
    assert made.feed({"do": "reset", "t": 9.0})["mode"] == "held"


@pytest.mark.parametrize("case", presets.SHIPPED)
def test_every_case_opens(case):
    """Requirement: a case of the suite, a mechanism too, is held, turned, released and caught; its file has
    the same design; no number is infinite, and the strength is that of the case or unknown."""
    made = Session(case)
    made.feed({"do": "drive", "by": "pull" if case == "parallel_strip_guide" else "rotation", "t": 0.0})
    length = made.mechanics.length
    states = [made.feed({"do": "pose", "pose": [0.01 * length, 0.0, 0.05], "t": 0.1})]
    states.append(made.feed({"do": "release", "t": 0.2}))
    states += [made.feed({"do": "tick", "t": 0.2 + k * FRAME}) for k in range(1, 6)]
    states.append(made.feed({"do": "catch", "t": 1.0}))
    assert json.loads(json.dumps(states, allow_nan=False)) == states
    assert [codes(state) for state in states] == [[]] * len(states)
    assert (states[0]["stress"]["of_yield"] is None) == (
        presets.preset(case).values["yield_strength"] is None
    )
    saved = presets.opened(case, tomllib.loads(made.mechanics.piece.as_case()), {}).values
    assert saved == pytest.approx(presets.preset(case).values, nan_ok=True)


def test_body_of_a_four_bar_is_grasped():
    """Requirement: the bodies of a four-bar follow the held one, with the moment of `solve` on the crank.
    Another body that is grasped is held from rest on."""
    made = Session("four_bar_of_flexures")
    made.feed({"do": "drive", "by": "rotation", "t": 0.0})
    state = made.feed({"do": "pose", "pose": [0.0, 0.0, 0.2], "t": 0.1})

    def error(control_points=made.mechanics.control_points):
        model = made.mechanics.piece.modelled(control_points, loaded=False)
        path = solve_statics(model, body="crank", rotation=0.2, increments=4)
        return abs(state["force"][2] / path.torque[-1] - 1.0)

    gates.hold("held_four_bar_moment", error)
    assert np.array(state["poses"])[:, 2] == pytest.approx([0.2, 0.0, 0.192], abs=0.002)
    state = made.feed({"do": "grasp", "body": "coupler", "t": 0.2})
    assert (state["placing"]["body"], state["texts"]["rotation"]) == (1, "0.00 °")
    state = made.feed({"do": "pose", "pose": [0.01, 0.0, 0.0], "t": 0.3})
    crank, coupler, rocker = state["poses"]
    assert crank[2] < -0.05
    assert rocker[2] == pytest.approx(crank[2], rel=0.01)
    assert coupler[0] - 0.05 == pytest.approx(0.01, rel=0.5)
    with pytest.raises(BadInput, match="body: got 'wheel', expected one of crank, coupler, rocker"):
        made.feed({"do": "grasp", "body": "wheel", "t": 0.5})


def test_free_end_is_refused_in_one_line():
    """Requirement: a mechanism with a free strip end is refused with what is expected."""
    document = parsed(FOLDER / "cantilever_with_body.toml")
    document["strips"][0]["tip"] = "free"
    with pytest.raises(BadInput, match=r"strips: got .* with a free end, expected both ends on a body"):
        presets.opened("own", document, {})
