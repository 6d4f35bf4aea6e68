"""Simulated time: as long as the time that passed, added up step by step, and set to zero with a new
design."""

import re

import numpy as np
import pytest

from studies.interactive.mechanics import Mechanics
from tests.interactive.events import FRAME, codes, session, turned


@pytest.mark.parametrize("jitter", [0.0, 4e-3])
@pytest.mark.parametrize("rate", [15.0, 24.0, 25.0, 30.0, 50.0, 60.0, 1 / 0.0415, 1 / 0.043])
def test_simulated_time_is_the_time_that_passed(rate, jitter, monkeypatch):
    """Requirement: at any camera's rate, with jitter, simulated over elapsed time is 1 within 0.1 %."""
    monkeypatch.setattr(Mechanics, "advance", lambda self, n: n * self.step)  # the clock alone
    made, rng = session(lock_step=False), np.random.default_rng(1)
    turned(made, 10)
    made.feed({"do": "release", "t": 1.0})
    times = 1.0 + np.arange(1, round(10 * rate) + 1) / rate
    for time in times + rng.uniform(-jitter, jitter, len(times)):
        state = made.feed({"do": "tick", "t": float(time)})
    assert abs(state["simulated"] / (state["t"] - 1.0) - 1.0) < 1e-3


def test_simulated_time_is_added_up_and_starts_again_with_a_design():
    """Requirement: a changed time scale does not rewrite what was simulated: it goes on at another pace, and
    another design begins at nought."""
    made = session()
    turned(made, 20)
    made.feed({"do": "release", "t": 1.0})
    for k in range(10):
        state = made.feed({"do": "tick", "t": 1.0 + (k + 1) * FRAME})
    assert (state["simulated"], state["steps"]) == (pytest.approx(0.4), 40)
    before = state["velocity"]
    state = made.feed({"do": "parameter", "name": "time_scale", "value": 0.01, "t": 1.4})
    assert (state["mode"], state["velocity"]) == ("released", before)
    state = made.feed({"do": "tick", "t": 1.4 + FRAME})
    assert (state["simulated"], state["steps"]) == (pytest.approx(0.4 + 4e-4), 44)
    state = made.feed({"do": "parameter", "name": "width", "value": 0.012, "t": 2.0})
    assert (state["simulated"], state["steps"]) == (0.0, 0)


@pytest.mark.parametrize(
    "change",
    [
        {"do": "parameter", "name": "width", "value": 0.012},
        {"do": "parameter", "name": "length", "value": 0.09},
        {"do": "parameter", "name": "relaxation_time", "value": 0.0},
        {"do": "parameter", "name": "body_mass", "value": 0.1},
    ],
    ids=lambda change: change["name"],
)
def test_a_swing_goes_on_through_a_change(change):
    """Requirement: another design swings on from the pose and with the velocity that the former one had;
    energies are counted from zero."""
    made = session()
    turned(made, 20)
    made.feed({"do": "release", "t": 1.0})
    for k in range(6):
        before = made.feed({"do": "tick", "t": 1.0 + (k + 1) * FRAME})
    after = made.feed({**change, "t": 1.25})
    assert (after["mode"], codes(after)) == ("released", [])
    assert after["values"].get(change["name"]) == change.get("value")
    moved = np.subtract(after["pose"][:2], made.mechanics.placing.centre) - before["displacement"][:2]
    assert np.abs(moved).max() < (1e-12 if change["name"] != "length" else 0.01)
    assert after["pose"][2] == pytest.approx(before["pose"][2], abs=1e-12)
    assert after["velocity"] == pytest.approx(before["velocity"], rel=1e-6)
    assert after["energy"]["dissipated"] == pytest.approx(0.0, abs=1e-12)
    assert made.feed({"do": "tick", "t": 1.25 + FRAME})["pose"] != after["pose"]


def test_step_that_does_not_resolve_a_swing_is_named():
    """Requirement: Table 1 in real time is named as under-resolved, and what its steps take is shown."""
    made = session("table-1")
    made.feed({"do": "parameter", "name": "time_scale", "value": 1.0, "t": 0.0})
    turned(made, 20, 40)
    assert codes(made.feed({"do": "release", "t": 1.0})) == ["under-resolved"]
    state = made.feed({"do": "tick", "t": 1.0 + FRAME})
    energy = state["energy"]
    assert codes(state) == ["under-resolved"]
    assert "time scale (0.07 resolves it)" in state["warnings"][0]["text"]
    assert energy["dissipated"] > 0.5 * made.mechanics.begun


def test_time_goes_slower_where_there_is_no_room_for_its_steps():
    """Requirement: a solver that has room for one step a frame slows time to a quarter, which is said;
    nothing is owed: with room again time goes on at its own pace."""
    made = session(lock_step=False)
    turned(made, 20)
    made.feed({"do": "release", "t": 1.0})
    for k in range(1, 51):
        state = made.feed({"do": "tick", "t": 1.0 + k * FRAME, "room": 1})
    assert (state["simulated"], codes(state)) == (pytest.approx(0.5), ["slowed"])
    assert re.search(r"runs at 0\.[23] of real time", state["warnings"][0]["text"])
    for k in range(51, 101):
        state = made.feed({"do": "tick", "t": 1.0 + k * FRAME})
    assert (state["simulated"], codes(state)) == (pytest.approx(2.5, abs=0.011), [])
