"""Session files: the same events give the same states."""

import math
import os
import subprocess
import sys

import pytest

from spline_model import natural_frequencies
from studies.cases.problem import FOLDER, named_case
from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.session import Recorder, Session, replay
from studies.record.source import ROOT


def recorded(preset="polymer"):
    """Lines of a session with turns, a change, release, swing and catch."""
    session, lines = Session(preset), []
    recorder = Recorder(session, lines.append)
    events = [{"do": "drive", "by": "rotation"}]
    events += [{"do": "pose", "pose": [0.0, 0.0, math.radians(3 * k)]} for k in range(15)]
    events += [{"do": "parameter", "name": "width", "value": 0.012}, {"do": "release"}]
    events += [{"do": "tick"}] * 20
    events += [{"do": "catch"}, {"do": "drive", "by": "pose"}, {"do": "pose", "pose": [1e-3, -2e-3, 0.4]}]
    for k, event in enumerate(events):
        stamped = {**event, "t": 0.04 * k}
        recorder.write(stamped, session.feed(stamped))
    return lines


@pytest.mark.parametrize("preset", ["polymer", "table-1"])
def test_a_session_replays_to_the_same_states(preset):
    """Requirement: every state of a replay is the recorded one, digit by digit."""
    lines = recorded(preset)
    same = [good for _, good in replay(lines)]
    assert all(same)
    assert len(same) == len(lines)


def test_a_design_of_ones_own_is_one_more_preset(monkeypatch):
    """Requirement: a case file joins the presets, swings once a second, and its session replays alone."""
    monkeypatch.setattr(presets, "PRESETS", dict(presets.PRESETS))
    problem = named_case(FOLDER / "spring_steel_pivot.toml")
    presets.PRESETS[presets.OWN] = presets.own(FOLDER / "spring_steel_pivot.toml")
    values = presets.preset(presets.OWN).values
    assert (values["length"], values["thickness"]) == (problem.length, pytest.approx(1e-3))
    frequency = natural_frequencies(presets.preset(presets.OWN).modelled(), rotation=0.0, count=1).frequency[
        0
    ]
    assert values["time_scale"] * frequency == pytest.approx(1.0)
    lines = recorded(presets.OWN)
    monkeypatch.undo()
    assert all(good for _, good in replay(lines))
    with pytest.raises(BadInput, match="preset: got 'own', expected one of polymer, table-1"):
        presets.preset(presets.OWN)


def test_a_recording_begins_at_rest():
    """Requirement: a recorded session starts again, held at rest, whatever happened before."""
    session = Session()
    session.feed({"do": "pose", "pose": [0.0, 0.0, 0.3], "t": 0.0})
    session.feed({"do": "release", "t": 0.1})
    lines = []
    Recorder(session, lines.append)
    assert not session.mechanics.moving
    assert session.mechanics.snapshot.pose[2] == 0.0
    assert all(good for _, good in replay(lines))


def test_a_changed_event_is_noticed():
    """Requirement: the comparison has teeth: a pose that differs in the last digits gives other states."""
    lines = recorded()
    lines[10] = lines[10].replace("0.4188790204786391", "0.4188790204786395")
    assert lines[10] != recorded()[10]
    assert not all(good for _, good in replay(lines))


@pytest.mark.slow
def test_the_command_replays_in_another_process(tmp_path):
    """Requirement: `--replay` gives the recorded states in a new process without the extra's packages."""
    path = tmp_path / "session.jsonl"
    words = [sys.executable, "-c", f"from {__name__} import recorded; print(''.join(recorded()), end='')"]
    watched = os.environ | {"NUMBA_DEBUG_CACHE": "1"}
    for _ in range(2):  # a process that compiles a kernel itself may round otherwise than one that loads it
        made = subprocess.run(words, cwd=ROOT, env=watched, capture_output=True, text=True, check=True)
        if "data saved to" not in made.stdout:
            break
    lines = [text for text in made.stdout.splitlines(keepends=True) if text.startswith("{")]
    path.write_text("".join(lines), encoding="utf-8")
    words = [sys.executable, "-m", "studies", "interactive", "--replay", str(path)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "42 of 42 states are those recorded" in done.stdout


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["no json"], "line 1: got no JSON"),
        (['{"do": "tick", "t": 0}'], "line 1: got .*expected an event, the first a setup"),
        (["[1, 2]"], "line 1: got"),
    ],
)
def test_what_is_no_session_file_is_one_line(lines, message):
    """Requirement: a file that is no session is refused with the number of the line."""
    with pytest.raises(BadInput, match=message):
        list(replay(lines))
