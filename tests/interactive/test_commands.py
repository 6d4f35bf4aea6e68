"""The commands `interactive` and `markers`, and what happens without the extra."""

import io
import re
import signal
import subprocess
import sys
from urllib.request import urlopen

import numpy as np
import pytest
from PIL import Image

from studies.commands import interactive
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
