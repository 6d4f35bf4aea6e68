"""Pictures through the server: films, those of the page, how long they take, and ten minutes of them."""

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.interactive.tracking.films import Video
from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings
from tests.interactive.films import counter, film, truth
from tests.interactive.latency import measured
from tests.interactive.painter import Optics
from tests.interactive.sockets import answer, closing, emptied, frame, opened, say


def test_film_is_tracked_and_sent():
    """Requirement: a film's pictures come with the state that belongs to them; released, each is four
    steps."""
    made = film(frames=12, samples=3)
    with Server(Settings(camera="film", source=made)) as hosted, opened(hosted) as socket:
        for k in range(12):
            state, jpeg = frame(socket)
            say(socket, do="shown")
            assert state["seq"] == k
            assert jpeg[:2] == b"\xff\xd8"
            assert state["sight"]["state"] == "found"
            assert abs(state["placing"]["marker"][2] - truth(k)[2]) < 0.01 or state["warnings"]
        say(socket, do="release")
        counts = []
        for _ in range(8):
            state, _ = frame(socket)
            say(socket, do="shown")
            counts.append(state["steps"])
        taken = np.diff(counts[2:])  # a picture that is late by 0.2 s leaves its four to the clock
        assert (taken >= 4).all() and not (taken % 4).any()


def test_pictures_of_the_page_are_tracked(server):
    """Requirement: pictures of the page give the pose that they show, numbered as they are."""
    with opened(server) as socket:
        picture = film(frames=4).picture(3)
        socket.send(protocol.HEADER.pack(1, 1, 42, 640, 480, 1000.0) + picture.tobytes())
        state = answer(socket)
    assert (state["seq"], state["sight"]["state"]) == (42, "found")
    assert state["pose"][2] == pytest.approx(truth(3)[2], abs=2e-3)


def test_wrong_size_is_refused_and_right_one_scales(server):
    """Requirement: the printed side is taken within bounds, and scales the shift."""
    with opened(server) as socket:
        say(socket, do="size", side_mm=1000)
        assert closing(socket)[0] == 4400
    with opened(server) as socket:
        say(socket, do="size", side_mm=58.2)
        socket.send(protocol.HEADER.pack(1, 1, 1, 640, 480, 0.0) + film(frames=1).picture(0).tobytes())
        state = answer(socket)
        assert [w["code"] for w in state["warnings"]] == ["off-path"]


def test_film_file_is_played(tmp_path):
    """Requirement: a film file gives its pictures in order, and starts again at its end."""
    import cv2

    path = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (640, 480), False)
    for picture in film(frames=3):
        writer.write(picture)
    writer.release()
    shots = [shot for shot, _ in zip(Video(path).shots(), range(5), strict=False)]
    assert [counter(picture) for picture, _ in shots] == [0, 1, 2, 0, 1]
    assert Video(path).rate == 25.0


@pytest.mark.slow
def test_way_of_a_picture_is_told_in_parts():
    """Requirement: the state of a picture says how long tracking, solving and sending took; the first two are
    together no longer than its whole way, most of which is tracking. Sending ends beside its receipt."""
    rows = measured(20)
    parts, whole = rows[:, :3], rows[:, -1]
    assert (parts >= 0.0).all()
    assert (parts[:, :2].sum(axis=1) <= whole).all()
    track, solve, send = np.median(parts, axis=0)
    assert track > max(solve, send)


STATM = Path("/proc/self/statm")
#: Frames of ten minutes, and those after which everything has been allocated once.
FRAMES, WARM = 10 * 60 * 25, 500
#: Growth that is allowed [bytes].
GROWTH = 20e6


def resident():
    """Memory of this process [bytes]."""
    return int(STATM.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.slow
@pytest.mark.skipif(not STATM.is_file(), reason="needs /proc")
def test_ten_minutes_of_film_do_not_grow(monkeypatch):
    """Requirement: ten minutes of film with a release and a catch every four seconds grow by less than 20 MB
    and leave no socket open."""
    monkeypatch.setattr(protocol, "RATE", 1e9)
    monkeypatch.setattr(protocol, "BURST", 1e9)
    source = replace(film(Optics(width=480, height=360, focal=450.0), frames=40, samples=3), rate=1e6)
    with Server(Settings(camera="film", source=source)) as hosted:
        with opened(hosted) as socket:
            for shown in range(1, FRAMES + 1):
                assert frame(socket)[0]["sight"]["state"] == "found"
                say(socket, do="shown")
                if shown % 100 in (50, 90):
                    say(socket, do="release" if shown % 100 == 50 else "catch")
                if shown == WARM:
                    start = resident()
            assert resident() - start < GROWTH
        assert emptied(hosted)
