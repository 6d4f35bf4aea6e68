"""Messages of the web socket: text events up, pictures up, states down; everything that comes in is checked
here."""

import hmac
import json
import secrets
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from studies.errors import BadInput
from studies.interactive.input import EVENTS

VERSION = 1
#: Longest text and picture that are taken [bytes], and the largest picture [px].
LONGEST_TEXT = 4096
LARGEST_PICTURE = 3_000_000
MOST_WIDTH, MOST_HEIGHT = 1920, 1080
LEAST_SIDE = 64
#: Picture: kind, version, seq, width, height, time of capture [ms]; its grey levels follow, row after row.
HEADER = struct.Struct("<BB2xIHHd")
PICTURE = 1
#: Part of a file, kind, version and whether it is the last; of a session to be replayed, or of a design.
PART = struct.Struct("<BBB")
REPLAY, DESIGN = 2, 3

#: Messages a second that a connection may send, and how many at once; so many of them are kept from poses,
#: of which only the newest counts: they never use up what a key or a button needs.
RATE, BURST, KEPT = 120.0, 120.0, 20.0

#: Event -> the fields it may have besides "do" and "seq": those of the session, and the page's own.
FIELDS: dict[str, tuple[str, ...]] = {
    "hello": ("version", "token"),
    **EVENTS,
    "record": ("on",),
    "size": ("side_mm",),
    "shown": (),
    "save": (),
    "live": (),
}


def event(text: str) -> dict[str, Any]:
    """Return the event in a text message.

    Raises:
        BadInput: too long, no JSON, not finite, an unknown event or field; one line.
    """
    if len(text.encode()) > LONGEST_TEXT:
        raise BadInput(f"message: got {len(text)} characters, expected at most {LONGEST_TEXT}")
    try:
        content = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError):
        raise BadInput("message: got no JSON, expected an object") from None
    if not isinstance(content, dict):
        raise BadInput(f"message: got {type(content).__name__}, expected an object")
    fields = FIELDS.get(str(content.get("do")))
    if fields is None:
        raise BadInput(f"do: got {str(content.get('do'))[:40]!r}, expected one of {', '.join(FIELDS)}")
    odd = set(content) - {*fields, "do", "seq"}
    if odd:
        raise BadInput(
            f"{min(odd)[:40]!r}: got an unknown field of {content['do']}, expected {sorted(fields)}"
        )
    return content


def sent_part(data: bytes) -> tuple[int, bool, bytes] | None:
    """Return kind, whether it is the last, and bytes of a file's part in a binary message, None of others."""
    if len(data) < PART.size or data[0] not in (REPLAY, DESIGN):
        return None
    kind, version, last = PART.unpack_from(data)
    if version != VERSION or last > 1:
        raise BadInput(f"file: got version {version}, last {last}, expected {VERSION}, 0 or 1")
    return kind, bool(last), data[PART.size :]


def _refuse(constant: str) -> float:
    raise ValueError(constant)


def sent_picture(data: bytes) -> tuple[int, float, NDArray[np.uint8]]:
    """Return number, time of capture [s] and grey levels of the picture in a binary message.

    Raises:
        BadInput: a header or size that does not fit; one line.
    """
    if not HEADER.size < len(data) <= LARGEST_PICTURE:
        raise BadInput(f"picture: got {len(data)} bytes, expected {HEADER.size} to {LARGEST_PICTURE}")
    kind, version, seq, width, height, time = HEADER.unpack_from(data)
    if (kind, version) != (PICTURE, VERSION):
        raise BadInput(f"picture: got kind {kind}, version {version}, expected {PICTURE}, {VERSION}")
    if not (LEAST_SIDE <= width <= MOST_WIDTH and LEAST_SIDE <= height <= MOST_HEIGHT):
        raise BadInput(f"picture: got {width} x {height}, expected at most {MOST_WIDTH} x {MOST_HEIGHT}")
    levels = np.frombuffer(data, dtype=np.uint8, offset=HEADER.size)
    if levels.size != width * height:
        raise BadInput(f"picture: got {levels.size} grey levels, expected {width} x {height}")
    if not 0.0 <= time < 1e15:
        raise BadInput(f"picture: got time {time}, expected milliseconds")
    # a copy, for the tracker's kernels are compiled for arrays that may be written to
    return seq, time / 1e3, levels.reshape(height, width).copy()


def text(content: Mapping[str, Any]) -> str:
    """Return a message down; ValueError for a number that is not finite."""
    return json.dumps(content, allow_nan=False, separators=(",", ":"))


def with_picture(content: Mapping[str, Any], picture: bytes) -> bytes:
    """Return a binary message down: length of the text, text, JPEG."""
    head = text(content).encode()
    return struct.pack("<I", len(head)) + head + picture


class Meter:
    """Refuses what comes faster than RATE a second; time is given, so that it can be tested."""

    def __init__(self) -> None:
        self._left, self._last = BURST, 0.0

    def passes(self, now: float, kept: float = 0.0) -> bool:
        """Return whether one more message at time `now` [s] is within the rate, `kept` being left of it."""
        self._left = min(BURST, self._left + (now - self._last) * RATE)
        self._last = now
        if self._left < 1.0 + kept:
            return False
        self._left -= 1.0
        return True


#: Bytes of the token that stands in the address behind the #.
TOKEN_BYTES = 24
#: Sockets at a time.
MOST_SOCKETS = 4
#: Names of this machine; who shares the page adds the one by which its network knows it.
HOSTS = ("127.0.0.1", "localhost")


class Token(str):
    """What a page must know to be answered; one that cannot be guessed."""

    def __new__(cls) -> Self:
        """Make another one."""
        return super().__new__(cls, secrets.token_urlsafe(TOKEN_BYTES))

    def fits(self, given: object) -> bool:
        """Return whether `given` is the token, in a time that does not depend on where they differ."""
        return isinstance(given, str) and hmac.compare_digest(self.encode(), given.encode())


@dataclass(frozen=True)
class Door:
    """Where a server is entered: its port, and the names of its machine that no foreign page can take."""

    port: int
    names: Sequence[str] = HOSTS

    def good_host(self, host: str | None) -> bool:
        """Return whether a request's Host is this machine."""
        return host in {f"{name}:{self.port}" for name in self.names}

    def good_origin(self, origin: str | None) -> bool:
        """Return whether a socket was opened by a page of this server."""
        return origin in {f"http://{name}:{self.port}" for name in self.names}

    def headers(self) -> dict[str, str]:
        """Return the headers of every answer: nothing from elsewhere is loaded, framed, sniffed or kept."""
        sockets = " ".join(f"ws://{name}:{self.port}" for name in self.names)
        policy = (
            "default-src 'none'; script-src 'self'; style-src 'self'; "
            "img-src 'self' blob: data:; media-src blob:; "
            f"connect-src 'self' {sockets}; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
        )
        return {
            "Content-Security-Policy": policy,
            "X-Content-Type-Options": "nosniff",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Permissions-Policy": "camera=(self), microphone=(), geolocation=()",
            "Referrer-Policy": "no-referrer",
            "Cache-Control": "no-store",
        }
