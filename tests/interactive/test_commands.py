"""The commands `interactive` and `markers`, what happens without the extra, and sessions that replay."""

import io
import math
import os
import re
import signal
import subprocess
import sys
from urllib.request import urlopen

import numpy as np
import pytest
from PIL import Image

from spline_model import natural_frequencies
from studies.cases.problem import FOLDER, named_case
from studies.commands import interactive
from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.session import Recorder, Session, replay
from studies.record.source import ROOT
from studies.registry import study_of


@pytest.mark.parametrize("command", ["interactive", "markers"])
def test_without_the_extra_it_is_one_line(command, monkeypatch, refused):
    """Requirement: a missing package is named in one line with what to do, exit code 2, and the figure of the
    environment is not computed."""
    monkeypatch.setitem(sys.modules, "cv2", None)
    # where the extra is not installed at all, its other packages are named as well
    said = refused(command, says=f"studies: {command}: got no opencv-python-headless")
    remedy = "run `make interactive`, or pip install 'cross-axis-pivot-validation[interactive]'"
    assert said.endswith(f", expected the extra: {remedy}\n")
    assert study_of("paper/fig07_interactive").missing().startswith("it needs cv2")


@pytest.mark.slow
def test_interrupt_ends_the_server():
    """Requirement: the address with its token is printed, and Ctrl-C ends the server with exit code 0."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    words = [sys.executable, "-m", "studies", "interactive", "--camera", "none", "--no-browser"]
    with subprocess.Popen(words, cwd=ROOT, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr
        said = process.stderr.readline()
        found = re.match(r"studies: open (http://127\.0\.0\.1:\d+/)#token=[\w-]{32,} ", said)
        assert found
        with urlopen(found[1], timeout=10.0) as page:  # it is at work
            assert page.status == 200
        process.send_signal(signal.SIGINT)
        assert process.wait(10.0) == 0


#: Words, and what the one line must say.
WORDS = {
    "--film none.mp4": "--film: got none.mp4, expected demo, or a film file that OpenCV reads",
    "--film pyproject.toml": "--film: got pyproject.toml, expected demo, or a film file that OpenCV reads",
    "--film demo --camera 0": "--camera: got 0 beside --film, expected one of them",
    "--preset rubber": "preset: got 'rubber', expected one of polymer, table-1",
    "polymer_pivot --preset polymer": "--preset: got polymer beside a case, expected one of them",
    "--port 99999": "--port: got 99999, expected a free one (bind(): port must be 0-65535.)",
    "--camera 77": "--camera: got 77, expected the number of a camera that is connected",
    "--replay none.jsonl": "--replay: got none.jsonl, expected a session file",
    "--record no/such/folder/x": "--record: no/such/folder/x: cannot be written (No such file or dir",
    "--calibration none.json": "none.json: got no camera",
}


@pytest.mark.parametrize("words", WORDS)
def test_bad_arguments_are_one_line(words, capfd):
    """Requirement: bad arguments are refused in one line with exit code 2."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    from studies.__main__ import main

    assert main(["interactive", *words.split()]) == 2
    lines = [line for line in capfd.readouterr().err.splitlines() if line.startswith("studies:")]
    assert len(lines) == 1
    assert WORDS[words] in lines[0]


def test_packages_of_the_extra_are_those_of_pyproject():
    """Requirement: the command needs the packages that the extra installs."""
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    asked = {need.partition(">")[0] for need in project["project"]["optional-dependencies"]["interactive"]}
    assert asked == set(interactive.EXTRA.values())


def test_sheet_is_a_page(tmp_path, capfd):
    """Requirement: the sheet is a PDF of A4, the same bytes each time."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    from studies.__main__ import main
    from studies.interactive.tracking.sheet import sheet

    target = tmp_path / "markers.pdf"
    assert main(["markers", "--out", str(target)]) == 0
    assert capfd.readouterr().err == ""
    assert target.read_bytes()[:5] == b"%PDF-"
    assert target.read_bytes() == sheet()
    box = re.search(rb"/MediaBox \[ ?0 0 ([\d.]+) ([\d.]+) ?\]", target.read_bytes())
    assert box
    assert [round(float(side) / 72 * 25.4, 1) for side in box.groups()] == [210.0, 297.0]


def test_sheet_is_read_in_size():
    """Requirement: both markers are read from the sheet as it is printed, 60 mm wide, upright and as far
    apart as the session takes them to be."""
    pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
    from studies.interactive.session import Session
    from studies.interactive.tracking.sheet import page
    from studies.interactive.tracking.tracker import Tracker

    stream = io.BytesIO()
    page().savefig(stream, format="png", dpi=127.0)  # five pixels a millimetre
    with Image.open(stream) as image:
        grey = np.asarray(image.convert("L"))
    tracker = Tracker()
    tracker.see(grey, 0.0)  # it learns that these values are light itself, as no camera's are
    event = tracker.see(grey, 0.04)
    assert event["marker"] == pytest.approx(Session().mechanics.placing.rest.tolist(), abs=1e-4)
    for quad in np.array(event["quads"]):
        sides = np.linalg.norm(quad - np.roll(quad, 1, axis=0), axis=1) / 5.0
        assert sides == pytest.approx([60.0] * 4, abs=0.1)


def test_scripts_have_short_lines():
    """Requirement: no line of the page's scripts has 120 characters or more."""
    scripts = sorted((ROOT / "studies" / "interactive" / "web" / "page").glob("*.js"))
    assert len(scripts) > 5
    for path in scripts:
        assert max(map(len, path.read_text(encoding="utf-8").splitlines())) < 120, path.name


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
