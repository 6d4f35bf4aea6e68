"""The server on a real port, without a browser."""

import math
import time
from itertools import pairwise

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")


from studies.errors import BadInput
from studies.interactive.film.painter import counter
from studies.interactive.session.recording import replay
from studies.interactive.session.session import Session
from studies.interactive.tracking.detector import encoded
from studies.interactive.web import protocol
from studies.interactive.web.server import Hosted, Server, Settings
from studies.interactive.web.sources import FilmSource, VideoSource
from tests.interactive.films import film, truth
from tests.interactive.sockets import answer, closing, frame, opened, say


def test_bad_numbers_are_answered_and_change_nothing(server):
    """Requirement: an event with a number out of range is answered by an error; the socket lives on."""
    with opened(server) as socket:
        say(socket, do="parameter", name="length", value=7.0)
        assert "length: got 7000, expected 40 to 120 mm" in answer(socket, "error")["text"]
        say(socket, do="pose", pose=[0, 0, 0.2])
        assert answer(socket)["pose"][2] == pytest.approx(0.2)


def test_failing_solver_keeps_the_last_state(server, monkeypatch):
    """Requirement: an arithmetic fault of the solver, or a number that is not finite, is answered by a
    sentence; the next event is answered as ever."""
    with opened(server) as socket:
        say(socket, do="pose", pose=[0, 0, 0.2])
        answer(socket)
        for fault in (lambda *_: 1 / 0, lambda *_: {"pose": [math.nan]}):
            with monkeypatch.context() as patch:
                patch.setattr(Session, "feed", fault)
                say(socket, do="pose", pose=[0, 0, 0.3])
                text = answer(socket, "error")["text"]
                assert text.startswith("The solver failed, the last good state is kept")
        say(socket, do="tick")
        assert answer(socket)["pose"][2] == pytest.approx(0.2)


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
        say(socket, do="step")
        first = answer(socket)["steps"]
        say(socket, do="step")
        assert answer(socket)["steps"] == first + 1


def test_recording_is_sent_and_replays(server):
    """Requirement: what the page records replays to the same states."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        say(socket, do="record", on=True)
        for k in range(8):
            say(socket, do="pose", pose=[0, 0, 0.05 * k])
        say(socket, do="release")
        say(socket, do="pause")
        for _ in range(3):
            say(socket, do="step")
        while answer(socket)["steps"] < 3:
            pass
        say(socket, do="record", on=False)
        lines = answer(socket, "recording")
        if lines["on"]:
            lines = answer(socket, "recording")
    same = [good for _, good in replay(lines["lines"])]
    assert len(same) >= 14
    assert all(same)


def test_film_is_tracked_and_sent():
    """Requirement: a film's pictures come with the state that belongs to them; released, each is four
    steps."""
    made = FilmSource(film(frames=12, samples=3))
    with Hosted(Settings(camera="film", source=lambda: made)) as hosted, opened(hosted.server) as socket:
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
        assert {b - a for a, b in pairwise(counts[2:])} == {4}


def test_pictures_of_the_page_are_tracked(server):
    """Requirement: JPEG and grey pictures from the page give the same pose to a hundredth of a degree,
    numbered."""
    picture = film(frames=4).picture(3)
    angles = []
    for coding, body in ((0, picture.tobytes()), (1, encoded(picture))):
        with opened(server) as socket:
            socket.send(protocol.HEADER.pack(1, 1, coding, 0, 42, 640, 480, 1000.0) + body)
            state = answer(socket)
            assert (state["seq"], state["sight"]["state"]) == (42, "found")
            angles.append(state["pose"][2])
    assert angles[0] == pytest.approx(truth(3)[2], abs=2e-3)
    assert angles[0] == pytest.approx(angles[1], abs=1e-3)


def test_wrong_size_is_refused_and_right_one_scales(server):
    """Requirement: the printed side is taken within bounds, and scales the shift."""
    with opened(server) as socket:
        say(socket, do="size", side_mm=1000)
        assert closing(socket)[0] == 4400
    with opened(server) as socket:
        say(socket, do="size", side_mm=58.2)
        socket.send(protocol.HEADER.pack(1, 1, 0, 0, 1, 640, 480, 0.0) + film(frames=1).picture(0).tobytes())
        state = answer(socket)
        assert [w["code"] for w in state["warnings"]] == ["off-path"]


def test_record_file_replays():
    """Requirement: what `--record` stores of the first page replays to the same states."""
    lines = []
    with Hosted(Settings(camera="none", keep=lines.append)) as hosted, opened(hosted.server) as socket:
        with opened(hosted.server) as second:
            say(second, do="pose", pose=[0, 0, 0.3])
            answer(second)
        for k in range(5):
            say(socket, do="pose", pose=[0, 0, 0.1 * k])
            answer(socket)
    same = [good for _, good in replay(lines)]
    assert len(same) == 7
    assert all(same)


def test_film_file_is_played(tmp_path):
    """Requirement: a film file gives its pictures in order, and begins anew at its end."""
    import cv2

    path = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 25.0, (640, 480), False)
    for picture in film(frames=3):
        writer.write(picture)
    writer.release()
    shots = [shot for shot, _ in zip(VideoSource(path).shots(), range(5), strict=False)]
    assert [shot.number for shot in shots] == [0, 1, 2, 3, 4]
    assert [counter(shot.picture) for shot in shots] == [0, 1, 2, 0, 1]
    assert shots[4].time == pytest.approx(4 / 25)


def test_taken_port_is_one_line(server):
    """Requirement: a port that is taken is refused in one line."""
    with pytest.raises(BadInput, match=rf"--port: got {server.port}, expected a free one"):
        Server(Settings(port=server.port)).bind()


@pytest.mark.slow
def test_poses_of_a_fast_screen_keep_their_session(server):
    """Requirement: poses that come faster than the rate are dropped, the newest is answered, a key that is
    pressed meanwhile is taken; the socket stays open."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        rate, count = 2.0 * protocol.RATE, round(3 * protocol.BURST)
        begin = time.monotonic()
        for k in range(count):
            say(socket, do="pose", pose=[0, 0, 0.5 * k / count], seq=k)
            time.sleep(max(0.0, begin + k / rate - time.monotonic()))
        say(socket, do="pose", pose=[0, 0, 0.5], seq=count)
        say(socket, do="undo")
        while (state := answer(socket))["seq"] != count:
            pass
        assert state["pose"][2] == pytest.approx(0.5)
        assert [w["code"] for w in answer(socket)["warnings"]] == ["empty"]


def test_flood_of_poses_is_thinned(server):
    """Requirement: of poses at once only as many as the rate allows are solved, and the last of them is."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        for k in range(400):
            say(socket, do="pose", pose=[0, 0, 1e-3 * k], seq=k)
        solved = 0
        while (state := answer(socket))["seq"] != 399:
            solved += 1
        assert state["pose"][2] == pytest.approx(0.399)
        assert solved < 250
