"""Messages of the web socket: what fits is read, everything else is one line."""

import math
import struct

import numpy as np
import pytest

from studies.errors import BadInput
from studies.interactive.web import protocol


def picture(width=64, height=64, body=None, kind=1, version=1, time=40.0):
    """A binary message."""
    body = bytes(width * height) if body is None else body
    return protocol.HEADER.pack(kind, version, 7, width, height, time) + body


def test_pictures_are_read():
    """Requirement: grey levels come through row after row, with number and time."""
    levels = np.arange(64 * 80, dtype=np.uint8).reshape(64, 80)
    seq, time, seen = protocol.sent_picture(picture(width=80, body=levels.tobytes()))
    assert (seq, time) == (7, 0.04)
    assert np.array_equal(seen, levels)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (b"", "got 0 bytes"),
        (b"short", "got 5 bytes"),
        (bytes(protocol.LARGEST_PICTURE + 1), "got 3000001 bytes"),
        (picture(kind=9), "got kind 9"),
        (picture(version=2), "version 2"),
        (picture(width=63), "got 63 x 64"),
        (picture(width=9999, body=b"x"), "got 9999 x 64"),
        (picture(body=bytes(4095)), "got 4095 grey levels"),
        (picture(body=bytes(4097)), "got 4097 grey levels, expected 64 x 64"),
        (picture(time=math.nan), "got time nan"),
        (picture(time=-1.0), "got time -1.0"),
    ],
)
def test_bad_pictures_are_refused(message, text):
    """Requirement: header and size are checked before the picture is looked at."""
    with pytest.raises(BadInput, match=text):
        protocol.sent_picture(message)


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ("", "got no JSON"),
        ("{", "got no JSON"),
        ("[1]", "got list"),
        ('{"do": "pose", "pose": [0, 0, NaN]}', "got no JSON"),
        ('{"do": "format_disk"}', "do: got 'format_disk'"),
        ('{"do": "tick", "path": "x"}', "'path': got an unknown field of tick"),
        ('{"do": "tick", "t": 5}', "'t': got an unknown field of tick"),
        ('{"do": "tick"' + " " * 5000 + "}", "got 5014 characters"),
        ("[" * 4000, "got no JSON"),
    ],
    ids=["empty", "half", "list", "nan", "name", "field", "time", "long", "deep"],
)
def test_bad_events_are_refused(message, text):
    """Requirement: a text that is no known event with known fields is refused in one line."""
    with pytest.raises(BadInput, match=text):
        protocol.event(message)


def test_states_down_are_finite():
    """Requirement: NaN is never sent, and a picture's text is found by its length."""
    with pytest.raises(ValueError, match="not JSON compliant"):
        protocol.text({"x": math.nan})
    message = protocol.with_picture({"a": 1}, b"jpeg")
    assert struct.unpack("<I", message[:4])[0] == len(b'{"a":1}')
    assert message[4:] == b'{"a":1}jpeg'


def test_rate_is_limited():
    """Requirement: a burst passes, a flood does not, and time lets more through."""
    meter = protocol.Meter()
    passed = sum(meter.passes(0.0) for _ in range(500))
    assert passed == protocol.BURST
    meter = protocol.Meter()
    assert all(meter.passes(k / 60.0) for k in range(1000))


def test_only_this_machine_and_this_page():
    """Requirement: hosts and origins are this machine's with this port, the token is compared whole."""
    assert protocol.Door(80).good_host("127.0.0.1:80")
    assert protocol.Door(80).good_host("localhost:80")
    for host in (
        "evil.example",
        "evil.example:80",
        "127.0.0.1",
        "127.0.0.1:81",
        "127.0.0.1.evil.example:80",
        None,
        "",
    ):
        assert not protocol.Door(80).good_host(host)
    assert protocol.Door(80).good_origin("http://127.0.0.1:80")
    for origin in ("null", None, "http://127.0.0.1:81", "https://127.0.0.1:80", "http://evil.example"):
        assert not protocol.Door(80).good_origin(origin)
    token = protocol.Token()
    assert len(token) >= 32
    assert token != protocol.Token()
    assert token.fits(str(token))
    for other in (token[:-1], token + "x", "", None, 5):
        assert not token.fits(other)


def test_policy_is_strict():
    """Requirement: the page may load and reach nothing but this server, and run no script from a string."""
    policy = protocol.Door(80).headers()["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "unsafe" not in policy
    assert "*" not in policy


def test_poses_leave_room_for_keys():
    """Requirement: poses as fast as they may come never use up what a key or a button needs."""
    meter = protocol.Meter()
    for k in range(2000):
        meter.passes(k / 240.0, protocol.KEPT)
    assert all(meter.passes(2000 / 240.0) for _ in range(int(protocol.KEPT)))
