"""Cameras: of unknown and known constants, and what they make of light."""

import math
import re
from dataclasses import asdict
from itertools import product

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")

from studies.__main__ import main
from studies.errors import BadInput
from studies.interactive.design import PRINTED
from studies.interactive.session import Session
from studies.interactive.tracking import tracker as tracking
from studies.interactive.tracking.planar import Camera
from studies.interactive.tracking.tracker import Tracker
from tests import gates
from tests.interactive.events import session, turned
from tests.interactive.films import detected_corners, error, errors, film, names, rms, truth, watch
from tests.interactive.painter import Marker, Optics


@pytest.mark.parametrize(
    "optics",
    [
        pytest.param(Optics(gamma=2.2, blur=1.6, noise=3.0), marks=pytest.mark.slow),
        pytest.param(Optics(gamma=1.8, blur=1.2), marks=pytest.mark.slow),
        pytest.param(Optics(gamma=2.4, blur=1.2), marks=pytest.mark.slow),
        pytest.param(Optics(gamma=1.0, blur=1.2), marks=pytest.mark.slow),
        pytest.param(Optics(exposure=2.0), marks=pytest.mark.slow),
        Optics(exposure=3.0, gamma=1.0),
    ],
    ids=str,
)
def test_camera_that_encodes_or_clips_light(optics):
    """Requirement: whatever power a camera encodes light with, and over-exposed, the shift is as good."""
    events = watch(film(optics, frames=12))
    _, shifts, found = errors(events)
    assert found == 12
    gates.check("tracking_encoded_shift", rms(shifts))
    assert all(("over-exposed" in names(event)) == (optics.exposure > 1.0) for event in events)


def test_encoded_gate_has_teeth(monkeypatch):
    """Requirement: without the common offset of the edges an over-exposed film fails."""
    assert gates.teeth("tracking_encoded_shift") == {"offset": False}
    monkeypatch.setattr(tracking.Shrinkage, "taken_out", lambda self, picture, corners, cells: corners)
    _, shifts, _ = errors(watch(film(Optics(exposure=3.0), frames=6)))
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("tracking_encoded_shift", rms(shifts))


#: Cameras that encode light by the powers 1/1.8 and 1/2.4, blur it, and expose it too little or too much.
CAMERAS = [
    Optics(gamma=gamma, blur=blur, exposure=exposure, noise=2.0)
    for gamma, blur, exposure in product((1.8, 2.4), (0.5, 1.0, 1.6), (0.5, 1.3))
]


@pytest.mark.slow
def test_unloaded_pivot_before_any_camera():
    """Requirement: before cameras of any power, blur and exposure, which nobody told, the poses of an
    unloaded pivot are within 0.05 degrees and 0.1 mm rms in each film, and pose, forces, moment and stiffness
    that are shown are farther than three stated spreads from the truth in at most 1 % of the frames."""
    path, angles, shifts, gaps = session(), [], [], []
    for optics in CAMERAS:
        made, follower, shown = film(optics, frames=16, samples=3), Tracker(), Session()
        turns, places = [], []
        for k, picture in enumerate(made):
            event = follower.see(picture, k / 25)
            state = shown.feed({**event, "t": k / 25})
            turn, place = error(event, k)
            turns.append(turn)
            places.append(place)
            true = turned(path, math.degrees(truth(k)[2]))
            pose, force = (np.subtract(state[name], true[name]) for name in ("pose", "force"))
            gap = [*pose, *force, state["stiffness"] - true["stiffness"]]
            gaps.append(np.array(gap) / [*state["sd"], *state["force_sd"]])
        angles.append(rms(turns))
        shifts.append(rms(places))
    with detected_corners():
        coarse = errors(watch(film(CAMERAS[-1], frames=6, samples=3)))
    gates.hold("camera_angle", lambda refined=True: max(angles) if refined else rms(coarse[0]))
    gates.hold("camera_shift", lambda refined=True: max(shifts) if refined else rms(coarse[1]))
    assert (np.mean(np.abs(gaps) > 3.0, axis=0) <= 0.01).all()


#: Tilts and rolls [deg] of a sheet that a hand shows to the camera.
SHOWN = [(tilt, roll) for tilt in (-40, -25, 0, 25, 40) for roll in (-60, 0, 60)]


def sheet_film(folder, shown):
    """A film of the uncut sheet before a camera with a lens."""
    import cv2

    flat = [Marker(number=0, pose=(0.0, 0.0, 0.0)), Marker(number=1, pose=PRINTED)]
    path, kind = str(folder / "sheet.avi"), cv2.VideoWriter.fourcc(*"MJPG")
    writer = cv2.VideoWriter(path, kind, 25.0, (640, 480), False)
    for tilt, roll in shown:
        optics = Optics(tilt=math.radians(tilt), roll=math.radians(roll), k1=-0.1)
        writer.write(film(optics, frames=1, markers=lambda k: flat, samples=2).picture(0))
    writer.release()
    return path


@pytest.mark.slow
def test_camera_is_calibrated_from_a_film(tmp_path, capsys):
    """Requirement: the command finds a camera's constants from a film of the sheet within three of the
    spreads that it says, the focal length to 1 %, and writes the file that `--calibration` reads."""
    out = tmp_path / "camera.json"
    assert main(["calibrate", sheet_film(tmp_path, SHOWN), "--out", str(out)]) == 0
    found, said = Camera.read(out), capsys.readouterr().out
    spread = dict(re.findall(r"(\w+) = \S+ ± (\S+)", said))
    for name, true in asdict(Optics(k1=-0.1).camera).items():
        assert abs(getattr(found, name) - true) <= 3.0 * float(spread[name]), (name, said)
    assert max(abs(found.fx / 600 - 1), abs(found.fy / 600 - 1)) < 0.01
    assert re.search(r"camera.json: \d+ views of 640 x 480 px, corners within 0\.\d+ px\n", said)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shown", "message"),
    [
        ([(20, 0)] * 3, "views: got 1, expected at least 3"),
        ([(0, 0), (14, 0), (-14, 0)], "tilt the sheet more"),
    ],
)
def test_views_that_do_not_suffice_are_named(tmp_path, capsys, shown, message):
    """Requirement: views that are alike, or too few, are refused in one line with what to do."""
    assert main(["calibrate", sheet_film(tmp_path, shown), "--out", str(tmp_path / "camera.json")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "camera.json").exists()


def test_camera_file(tmp_path):
    """Requirement: a camera is stored and read; what is none is one line."""
    camera = Camera(fx=600.0, fy=601.0, cx=320.0, cy=240.0, k1=-0.1)
    camera.write(tmp_path / "camera.json")
    assert Camera.read(tmp_path / "camera.json") == camera
    for bad in ('{"fx": "wide"}', '{"fx": 0, "fy": 600, "cx": 320, "cy": 240}'):
        (tmp_path / "bad.json").write_text(bad, encoding="utf-8")
        with pytest.raises(BadInput, match=r"bad.json: got no camera, expected JSON with fx, fy, cx, cy"):
            Camera.read(tmp_path / "bad.json")
