"""Loads that a design does not bear, and cases that come with the suite."""

import json
import math
import tomllib

import numpy as np
import pytest

from spline_model import solve_mechanism
from studies.answers.critical import critical_load
from studies.answers.settings import SplineSettings
from studies.cases.document import parsed
from studies.cases.problem import FOLDER
from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.session import Session
from tests import gates
from tests.interactive.events import FRAME, codes, session, turned

DESIGNS = ["polymer", "table-1", "titanium_pivot", "spring_steel_pivot"]


def loaded(preset, load):
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
    _, state = loaded(preset, 0.99 * force)
    assert "unstable" not in codes(state)
    assert state["stiffness"] > 0.0
    _, state = loaded(preset, 1.01 * force)
    (text,) = [each["text"] for each in state["warnings"] if each["code"] == "unstable"]
    assert state["stiffness"] < 0.0
    assert f"critical load {state['texts']['critical']}, stiffness -" in text
    assert text.startswith("Unstable under this load: ") and "Contact with the ground is not modelled" in text


def test_no_body_falls_through_the_ground():
    """Requirement: under five times its critical load a released body stops where its centre meets the
    ground, in a sentence, and time is paused."""
    made, _ = loaded("polymer", 1.4)
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
        path = solve_mechanism(model, body="crank", rotation=0.2, increments=4)
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
