"""The server on a real port, without a browser."""

import contextlib
import http.client
import json
import time
from itertools import pairwise

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from studies.errors import BadInput
from studies.interactive.film.painter import counter
from studies.interactive.session.recording import replay
from studies.interactive.tracking.detector import encoded
from studies.interactive.web import protocol, security
from studies.interactive.web.hosting import Hosted
from studies.interactive.web.server import Server, Settings
from studies.interactive.web.sources import FilmSource, VideoSource
from tests.interactive.films import film, truth


@pytest.fixture(scope="module")
def server():
    """A server without pictures."""
    with Hosted(Settings(camera="none")) as hosted:
        yield hosted.server


@contextlib.contextmanager
def opened(server, *, token=None, hello=True, **options):
    """A socket that has said hello and taken the welcome."""
    origin = options.pop("origin", f"http://127.0.0.1:{server.port}")
    address = f"ws://127.0.0.1:{server.port}/ws"
    with connect(address, origin=origin, max_size=None, compression=None, **options) as socket:
        if hello:
            say(socket, do="hello", version=1, token=token or server.token)
            assert json.loads(socket.recv(5))["kind"] == "welcome"
            assert json.loads(socket.recv(5))["kind"] == "state"
        yield socket


def say(socket, **event):
    """Send an event."""
    socket.send(json.dumps(event))


def answer(socket, kind="state"):
    """The next message of that kind."""
    while True:
        message = json.loads(socket.recv(5))
        if message["kind"] == kind:
            return message


def closing(socket):
    """Code and reason that the server closes with."""
    with pytest.raises(ConnectionClosed) as caught:
        while True:
            socket.recv(5)
    return caught.value.rcvd.code, caught.value.rcvd.reason


def get(server, path, host=None):
    """Answer to a request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=5)
    connection.request("GET", path, headers={"Host": host or f"127.0.0.1:{server.port}"})
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def test_page_is_served_with_its_headers(server):
    """Requirement: page and modules come with their kinds and the strict headers."""
    response, body = get(server, "/")
    assert (response.status, b"<!doctype html>" in body) == (200, True)
    for name, value in security.headers(server.port).items():
        assert response.getheader(name) == value
    assert get(server, "/page/app.js")[0].getheader("Content-Type").startswith("text/javascript")
    assert server.address.startswith(f"http://127.0.0.1:{server.port}/#token=")


@pytest.mark.parametrize(
    "path",
    ["/page/../server.py", "/page/..%2f..%2fserver.py", "/page/__init__.py", "/etc/passwd", "/page/none.js"],
)
def test_nothing_else_is_served(server, path):
    """Requirement: no path leaves the page's folder."""
    assert get(server, path)[0].status == 404


def test_foreign_hosts_are_refused(server):
    """Requirement: a request for another host (DNS rebinding) gets 400, for page and socket."""
    assert get(server, "/", host="evil.example")[0].status == 400
    with pytest.raises(InvalidStatus) as caught, opened(server, additional_headers={"Host": "evil.example"}):
        pass
    assert caught.value.response.status_code == 400


@pytest.mark.parametrize("origin", ["http://evil.example", "null", None])
def test_foreign_pages_are_refused(server, origin):
    """Requirement: a socket opened by another page, or none, gets 403."""
    with pytest.raises(InvalidStatus) as caught, opened(server, origin=origin):
        pass
    assert caught.value.response.status_code == 403


def test_token_is_needed(server):
    """Requirement: without the token nothing is answered."""
    with opened(server, hello=False) as socket:
        say(socket, do="hello", version=1, token="x" * 32)
        assert closing(socket)[0] == 4403
    with opened(server, hello=False) as socket:
        say(socket, do="pose", pose=[0, 0, 0])
        code, reason = closing(socket)
        assert (code, "expected one first" in reason) == (4400, True)


@pytest.mark.parametrize(
    "message",
    [
        "rubbish",
        '{"do": "tick", "odd": 1}',
        b"short",
        protocol.HEADER.pack(1, 1, 1, 0, 1, 640, 480, 0.0) + b"no jpeg at all",
        protocol.HEADER.pack(1, 1, 0, 0, 1, 641, 480, 0.0) + bytes(9),
    ],
    ids=["text", "field", "short", "jpeg", "grey"],
)
def test_malformed_messages_close_their_socket_only(server, message):
    """Requirement: what is no message closes its own socket with 4400 and one line; others go on."""
    with opened(server) as other:
        with opened(server) as socket:
            socket.send(message)
            code, reason = closing(socket)
            assert code == 4400
            assert "got" in reason
            assert "\n" not in reason
        say(other, do="pose", pose=[0, 0, 0.1])
        assert answer(other)["pose"][2] == pytest.approx(0.1)


def test_jpeg_whose_inside_is_rubbish_closes_its_socket_only(server):
    """Requirement: a JPEG with a good header and a bad body is no picture, and the server lives."""
    head = b"\xff\xd8\xff\xc0\x00\x0b\x08\x01\xe0\x02\x80\x01\x01\x11\x00"
    with opened(server) as socket:
        socket.send(protocol.HEADER.pack(1, 1, 1, 0, 1, 640, 480, 0.0) + head + b"\x00" * 4000)
        assert closing(socket)[0] == 4400
    assert get(server, "/")[0].status == 200


def test_too_large_messages_are_refused(server):
    """Requirement: a message above the limit closes the socket before it is read as a whole."""
    with opened(server) as socket:
        with contextlib.suppress(ConnectionClosed):
            socket.send(bytes(protocol.LARGEST_PICTURE + 10))
        assert closing(socket)[0] == 1009


def test_floods_are_cut_off(server):
    """Requirement: more messages than the rate close the socket."""
    with opened(server) as socket:
        with contextlib.suppress(ConnectionClosed):
            for _ in range(400):
                socket.send('{"do": "shown"}')
        code, reason = closing(socket)
        assert (code, "too many" in reason) == (4400, True)


def test_sockets_are_few(server):
    """Requirement: no more than four pages at a time; a closed one makes room."""
    with contextlib.ExitStack() as stack:
        for _ in range(security.MOST_SOCKETS):
            stack.enter_context(opened(server))
        with opened(server, hello=False) as socket:
            assert closing(socket)[0] == 4429
    time.sleep(0.3)
    with opened(server):
        pass
    time.sleep(0.2)
    assert server.open == 0


def test_bad_numbers_are_answered_and_change_nothing(server):
    """Requirement: an event with a number out of range is answered by an error; the socket lives on."""
    with opened(server) as socket:
        say(socket, do="parameter", name="length", value=7.0)
        assert "length: got 7000, expected 40 to 120 mm" in answer(socket, "error")["text"]
        say(socket, do="pose", pose=[0, 0, 0.2])
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


def frame(socket):
    """State and JPEG of the next picture of a film."""
    while True:
        message = socket.recv(10)
        if isinstance(message, bytes):
            size = int.from_bytes(message[:4], "little")
            return json.loads(message[4 : 4 + size]), message[4 + size :]


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
