"""What the server lets in: hosts, pages, tokens, sizes, rates."""

import contextlib
import logging
import math
import secrets
import socket as sockets
import time

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from studies.commands import interactive
from studies.errors import BadInput
from studies.interactive.web import protocol
from studies.interactive.web.server import MOST_SOCKETS, Server, Settings
from tests.interactive.sockets import answer, closing, emptied, get, opened, say, told


def test_page_is_served_with_its_headers(server):
    """Requirement: page and modules come with their kinds and strict headers: the page may load and reach
    nothing but this server, and run no script from a string."""
    response, body = get(server, "/")
    assert (response.status, b"<!doctype html>" in body) == (200, True)
    for name, value in protocol.headers([f"127.0.0.1:{server.port}", f"localhost:{server.port}"]).items():
        assert response.getheader(name) == value
    policy = response.getheader("Content-Security-Policy")
    assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy and "*" not in policy
    assert get(server, "/page/app.js")[0].getheader("Content-Type").startswith("text/javascript")
    assert server.address.startswith(f"http://127.0.0.1:{server.port}/#token=")


@pytest.mark.parametrize(
    "path",
    ["/page/../server.py", "/page/..%2f..%2fserver.py", "/page/__init__.py", "/etc/passwd", "/page/none.js"],
)
def test_nothing_else_is_served(server, path):
    """Requirement: no path leaves the page's folder."""
    assert get(server, path)[0].status == 404


def shaken(server, *, host=None, origin=None, end=b"\r\n"):
    """Status that answers the request for a socket, None of one that breaks off before its `end`."""
    own = f"127.0.0.1:{server.port}"
    lines = [
        *("GET /ws HTTP/1.1", f"Host: {host or own}", f"Origin: {origin or f'http://{own}'}"),
        *("Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13"),
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
    ]
    with sockets.create_connection(("127.0.0.1", server.port), timeout=5.0) as plain:
        plain.sendall("".join(f"{line}\r\n" for line in lines).encode() + end)
        return int(plain.recv(12).split()[1]) if end else None


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{}", "127.0.0.1", "127.0.0.1:81", "127.0.0.1.evil.example:{}"]
)
def test_foreign_hosts_are_refused(server, host):
    """Requirement: a request for another host (DNS rebinding) gets 400, and 403 for a socket."""
    host = host.format(server.port)
    assert get(server, "/", host=f"localhost:{server.port}")[0].status == 200
    assert get(server, "/", host=host)[0].status == 400
    assert shaken(server, host=host) == 403
    assert shaken(server) == 101


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", None, "http://127.0.0.1:81", "https://127.0.0.1:{}"]
)
def test_foreign_pages_are_refused(server, origin):
    """Requirement: a socket opened by another page, or none, gets 403."""
    own = origin and origin.format(server.port)
    with pytest.raises(InvalidStatus) as caught, opened(server, origin=own):
        pass
    assert caught.value.response.status_code == 403


def test_refused_sockets_leave_no_line_in_the_log(server):
    """Requirement: sockets of foreign pages and hosts, that break off, that never say hello, with a wrong
    token and that close in the middle of an answer are no errors of the server: its log stays empty."""
    lines, keeper = [], logging.Handler()
    keeper.emit = lambda record: lines.append(record.getMessage())
    log = logging.getLogger("uvicorn.error")
    log.addHandler(keeper)
    try:
        assert shaken(server, origin="http://evil.example") == 403
        assert shaken(server, host="evil.example") == 403
        shaken(server, end=b"")
        with opened(server, hello=False):
            pass
        with opened(server, hello=False) as socket:
            say(socket, do="hello", version=1, token="x" * 32)
            assert closing(socket)[0] == 4403
        with opened(server) as socket:
            say(socket, do="pose", pose=[0, 0, 0.1])
            socket.socket.close()
        assert emptied(server)
        assert lines == []
        log.error("any line")
        assert lines == ["any line"]
    finally:
        log.removeHandler(keeper)


def test_token_is_needed(server):
    """Requirement: without the whole token nothing is answered."""
    assert len(server.token) >= 32
    for token in ("x" * 32, server.token[:-1], f"{server.token}x", "", None, 5):
        with opened(server, hello=False) as socket:
            say(socket, do="hello", version=1, token=token)
            assert closing(socket)[0] == 4403
    with opened(server, hello=False) as socket:
        say(socket, do="pose", pose=[0, 0, 0])
        code, reason = closing(socket)
        assert (code, "expected one first" in reason) == (4400, True)


def picture(width=64, height=64, body=None, kind=1, version=1, time=40.0):
    """A binary message."""
    body = bytes(width * height) if body is None else body
    return protocol.HEADER.pack(kind, version, 7, width, height, time) + body


#: What is no message, and what its own socket is told.
MALFORMED = [
    (b"short", "got 5 bytes"),
    (picture(kind=9), "got kind 9"),
    (picture(version=2), "version 2"),
    (picture(width=63), "for 63 x 64"),
    (picture(width=9999, body=b"x"), "for 9999 x 64"),
    (picture(body=bytes(4095)), "got 4095 grey levels"),
    (picture(body=bytes(4097)), "got 4097 grey levels for 64 x 64"),
    (picture(time=math.nan), "time nan"),
    (picture(time=-1.0), "time -1.0"),
    ("", "got no JSON"),
    ("{", "got no JSON"),
    ("[1]", "got list"),
    ('{"do": "pose", "pose": [0, 0, NaN]}', "got no JSON"),
    ('{"do": "format_disk"}', "do: got 'format_disk'"),
    ('{"do": "tick", "path": "x"}', "'path': got an unknown field of tick"),
    ('{"do": "tick", "t": 5}', "'t': got an unknown field of tick"),
    ('{"do": "tick"' + " " * 5000 + "}", "got 5014 characters"),
    ("[" * 4000, "got no JSON"),
]


def test_malformed_messages_close_their_socket_only(server):
    """Requirement: what is no message closes its own socket with 4400 and one line; others go on."""
    with opened(server) as other:
        for message, text in MALFORMED:
            with opened(server) as socket:
                socket.send(message)
                code, reason = closing(socket)
                assert (code, text in reason, "\n" in reason) == (4400, True, False), (text, reason)
            assert told(other, do="pose", pose=[0, 0, 0.1])["pose"][2] == pytest.approx(0.1)


def test_too_large_messages_are_refused(server):
    """Requirement: a message above the limit closes the socket before any of it is read: its length is
    enough. Unread bytes could hide the reason for closing."""
    binary, masked, of_eight_bytes = 0x82, 0x80, 127  # RFC 6455, section 5.2
    length, mask = (protocol.LARGEST_PICTURE + 10).to_bytes(8, "big"), bytes(4)
    with opened(server) as socket:
        socket.socket.sendall(bytes([binary, masked | of_eight_bytes]) + length + mask)
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
    assert emptied(server)  # of pages of the tests before
    with contextlib.ExitStack() as stack:
        for _ in range(MOST_SOCKETS):
            stack.enter_context(opened(server))
        with opened(server, hello=False) as socket:
            say(socket, do="hello", version=1, token=server.token)
            assert closing(socket)[0] == 4429
    assert emptied(server)
    with opened(server):
        pass
    assert emptied(server)


def test_sockets_without_the_token_take_no_place(server):
    """Requirement: sockets that have not shown the token keep nobody out."""
    with contextlib.ExitStack() as stack:
        for _ in range(2 * MOST_SOCKETS):
            stack.enter_context(opened(server, hello=False))
        with opened(server) as socket:
            assert told(socket, do="pose", pose=[0, 0, 0.1])["pose"][2] == pytest.approx(0.1)


#: An address of this machine that is not its usual one, for a network of one's own.
NETWORK = "127.0.0.2"


def test_page_is_shared_at_one_more_address():
    """Requirement: shared, the page is there for this machine and at one address of its network, for those
    with the token and pages of its own alone; other hosts and origins are refused; the page shows this."""
    with Server(Settings(camera="none", share=NETWORK)) as hosted:
        server = hosted
        own, theirs = f"127.0.0.1:{server.port}", f"{NETWORK}:{server.port}"
        assert server.address_at(NETWORK).startswith(f"http://{theirs}/#token=")
        response, _ = get(server, "/", host=theirs)
        assert f"ws://{theirs}" in response.getheader("Content-Security-Policy")
        assert get(server, "/", host="evil.example")[0].status == 400
        for place in (own, theirs):
            with connect(f"ws://{place}/ws", origin=f"http://{place}") as socket:
                say(socket, do="hello", version=1, token=server.token)
                assert answer(socket, "welcome")["shared"]
        with connect(f"ws://{theirs}/ws", origin=f"http://{theirs}") as socket:
            say(socket, do="hello", version=1, token="x" * 32)
            assert closing(socket)[0] == 4403
        with pytest.raises(InvalidStatus), connect(f"ws://{theirs}/ws", origin="http://evil.example"):
            pass


def test_one_place_is_for_this_machine():
    """Requirement: guests take all places but one; this machine takes the last one."""
    with Server(Settings(camera="none", share=NETWORK)) as server, contextlib.ExitStack() as every:
        theirs = f"{NETWORK}:{server.port}"
        for k in range(MOST_SOCKETS):
            place = connect(f"ws://{theirs}/ws", origin=f"http://{theirs}", source_address=(NETWORK, 0))
            guest = every.enter_context(place)
            say(guest, do="hello", version=1, token=server.token)
            if k < MOST_SOCKETS - 1:
                answer(guest, "welcome")
            else:
                assert closing(guest)[0] == 4429
        with opened(server) as own:
            assert told(own, do="tick")["mode"] == "held"


def test_page_is_not_shared_unless_asked(server):
    """Requirement: without being asked the server listens to this machine alone, and knows no other name."""
    with pytest.raises(OSError), connect(f"ws://{NETWORK}:{server.port}/ws"):
        pass
    assert get(server, "/", host=f"{NETWORK}:{server.port}")[0].status == 400
    with opened(server, hello=False) as socket:
        say(socket, do="hello", version=1, token=server.token)
        assert not answer(socket, "welcome")["shared"]


@pytest.mark.parametrize("address", ["0.0.0.0", "8.8.8.8", "example.org", "10.254.253.252"])
def test_page_is_shared_with_a_network_of_ones_own_only(address):
    """Requirement: all addresses at once, those of the internet and names are refused in one line."""
    with pytest.raises(BadInput, match=rf"--share: got {address}, expected this machine's address in"):
        Server(Settings(share=address)).bind()


def test_shared_link_is_said_plainly_and_as_a_code(capsys):
    """Requirement: the link is printed with what it opens, and as a code that a phone's camera reads."""
    link = f"http://{NETWORK}:41234/#token={secrets.token_urlsafe(24)}"
    interactive._say_shared(link, "server")
    said = capsys.readouterr().err
    for words in (link, "SEES WHAT THIS MACHINE'S CAMERA SEES", "nothing is encrypted"):
        assert words in said
    rows = [line for line in said.splitlines() if set(line) <= set(" ▄▀█")]
    cells = [[(" ▄▀█".index(mark) >> bit & 1) for mark in row] for row in rows for bit in (1, 0)]
    code = np.kron(np.array(cells, dtype=np.uint8) * 255, np.ones((8, 8), dtype=np.uint8))
    import cv2

    assert cv2.QRCodeDetectorAruco().detectAndDecode(code)[0] == link


def test_answers_leave_at_once(server):
    """Requirement: no answer waits for the acknowledgement of the one before (40 ms): asyncio lets them leave
    at once on sockets of a listener that says it speaks TCP."""
    assert {each.proto for each in server._listeners} == {sockets.IPPROTO_TCP}


def test_flood_of_poses_is_thinned(server):
    """Requirement: of poses at once only as many as the rate allows are solved, and the last of them is."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        begin = time.monotonic()
        for k in range(400):
            say(socket, do="pose", pose=[0, 0, 1e-3 * k], seq=k)
        solved = 0
        while (state := answer(socket))["seq"] != 399:
            solved += 1
        assert state["pose"][2] == pytest.approx(0.399)
        assert solved <= protocol.BURST + protocol.RATE * (time.monotonic() - begin)
