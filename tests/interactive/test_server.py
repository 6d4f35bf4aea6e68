"""The server on a real port, without a browser: events, films, pictures of the page, ten minutes of them."""

import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.cases.problem import named_case
from studies.errors import BadInput
from studies.interactive.session import Session, replay
from studies.interactive.tracking.films import Video
from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings
from tests.interactive.films import counter, film, truth
from tests.interactive.painter import Optics
from tests.interactive.sockets import answer, closing, emptied, frame, opened, say, told


def test_bad_numbers_are_answered_and_change_nothing(server):
    """Requirement: an event with a number out of range is answered by an error; the socket lives on."""
    with opened(server) as socket:
        say(socket, do="parameter", name="length", value=70.0)
        assert "length: got 70000, expected 0.01 to 10000 mm" in answer(socket, "error")["text"]
        assert told(socket, do="pose", pose=[0, 0, 0.2])["pose"][2] == pytest.approx(0.2)


def test_failing_solver_keeps_the_last_state(server, monkeypatch):
    """Requirement: an arithmetic fault of the solver, or a number that is not finite, is answered by a
    sentence; the next event is answered as ever."""
    with opened(server) as socket:
        told(socket, do="pose", pose=[0, 0, 0.2])
        for fault in (lambda *_: 1 / 0, lambda *_: {"pose": [math.nan]}):
            with monkeypatch.context() as patch:
                patch.setattr(Session, "feed", fault)
                say(socket, do="pose", pose=[0, 0, 0.3])
                text = answer(socket, "error")["text"]
                assert text.startswith("The solver failed, the last good state is kept")
        assert told(socket, do="tick")["pose"][2] == pytest.approx(0.2)


def test_released_body_runs_by_itself(server):
    """Requirement: without pictures the server drives a released body on at 25 Hz until it is paused."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        say(socket, do="pose", pose=[0, 0, 0.6])
        say(socket, do="release")
        steps = [answer(socket)["steps"] for _ in range(12)]
        assert steps[-1] > 15
        say(socket, do="pause")
        while not answer(socket)["paused"]:
            pass


def test_design_is_saved_and_opened(server, tmp_path):
    """Requirement: the design is a case file that the commands read; opened, it is the same design; a text
    that is no case is named in one line."""
    with opened(server) as socket:
        values = told(socket, do="parameter", name="thickness", value=7e-4)["values"]
        say(socket, do="save")
        text = answer(socket, "case")["text"]
        (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
        problem = named_case(tmp_path / "mine.toml")
        assert (problem.width, problem.thickness) == pytest.approx((0.01, 7e-4))
        assert problem.effects.parameters()["strip_damping"] == {"relaxation_time": 2e-3}
        told(socket, do="preset", name="table-1")
        socket.send(protocol.DESIGN + text.encode())
        state = answer(socket)
        same = {**state["values"], "time_scale": values["time_scale"]}
        assert same == pytest.approx(values | {"yield_strength": 30e6})
        assert state["preset"] == "own"
        for wrong in (text.replace("length_m", "lenght_m"), "no = case = file"):
            socket.send(protocol.DESIGN + wrong.encode())
            assert "design.toml: " in answer(socket, "error")["text"]


def test_curve_of_every_design_is_sent(server):
    """Requirement: with each design comes its moment over rotation and where it yields, as held states do."""
    with opened(server) as socket:
        say(socket, do="parameter", name="thickness", value=2e-3)
        assert answer(socket, "curve")["text"].startswith("does not yield up to ")
        curve = answer(socket, "curve")
        told(socket, do="drive", by="rotation")
        at, moment = curve["yields"]
        turns = curve["rotation"][6], 0.99 * at, 1.01 * at
        states = [told(socket, do="pose", pose=[0, 0, angle]) for angle in turns]
        assert states[0]["force"][2] == pytest.approx(curve["moment"][6], rel=1e-9)
        assert states[1]["force"][2] < moment < states[2]["force"][2]
        assert states[1]["stress"]["of_yield"] < 1.0 < states[2]["stress"]["of_yield"]
        assert curve["text"].startswith(f"yields at ±{math.degrees(at):.1f}° by ")


def test_record_file_replays():
    """Requirement: what `--record` stores of the first page replays to the same states."""
    lines = []
    with Server(Settings(camera="none", keep=lines.append)) as hosted, opened(hosted) as socket:
        with opened(hosted) as second:
            told(second, do="pose", pose=[0, 0, 0.3])
        for k in range(5):
            told(socket, do="pose", pose=[0, 0, 0.1 * k])
    same = [good for _, good in replay(lines)]
    assert len(same) == 7
    assert all(same)


def test_taken_port_is_one_line(server):
    """Requirement: a port that is taken is refused in one line."""
    with pytest.raises(BadInput, match=rf"--port: got {server.port}, expected a free one"):
        Server(Settings(port=server.port)).bind()


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
    """Requirement: pictures of the page give the pose that they show, numbered as they are, and how long
    tracking and solving took."""
    with opened(server) as socket:
        picture = film(frames=4).picture(3)
        socket.send(protocol.HEADER.pack(1, 1, 42, 640, 480, 1000.0) + picture.tobytes())
        state = answer(socket)
    assert (state["seq"], state["sight"]["state"]) == (42, "found")
    assert state["track_ms"] > 0.0 and state["solve_ms"] > 0.0
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
