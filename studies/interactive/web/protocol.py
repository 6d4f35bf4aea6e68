"""What a server serves, and the messages of its web sockets: text events up, pictures up, states down;
everything that comes in is checked here."""

import json
import struct
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from studies.cases.rules import number
from studies.errors import BadInput
from studies.interactive.input import ANYTHING, EVENTS, Events, Fields, fields

if TYPE_CHECKING:  # a replay needs no pictures
    from studies.interactive.tracking.films import Source
    from studies.interactive.tracking.planar import Camera

#: Longest text and picture that are taken [bytes], and the largest picture [px].
LONGEST_TEXT = 4096
LARGEST_PICTURE = 3_000_000
MOST_WIDTH, MOST_HEIGHT = 1920, 1080
LEAST_SIDE = 64
#: Picture: kind, version, seq, width, height, time of capture [ms]; its grey levels follow, row after row.
HEADER = struct.Struct("<BB2xIHHd")
#: First byte of a binary message that is a picture; the second byte, the version of all messages. Both bytes
#: of one that is the text of a case file, which follows.
PICTURE, VERSION = 1, 1
DESIGN = bytes((3, VERSION))

#: Messages a second that a connection may send, and how many at once; so many of them are kept from poses,
#: of which only the newest counts: they never use up what a key or a button needs.
RATE, BURST, KEPT = 120.0, 120.0, 20.0

#: What every event of the page may have, and those of its own.
_ALWAYS: Fields = {"seq?": ANYTHING}
PAGE_EVENTS: Events = {
    "hello": {"version": ANYTHING, "token": ANYTHING},
    **EVENTS,
    "size": {"side_mm": number("a printed side from 10 to 300 mm", 10.0, 300.0, closed="low and high")},
    **{do: {} for do in ("shown", "save")},
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
    fields(content, PAGE_EVENTS, _ALWAYS)
    return content


def _refuse(constant: str) -> float:
    raise ValueError(constant)


def sent_picture(data: bytes) -> tuple[int, float, NDArray[np.uint8]]:
    """Return number, time of capture [s] and grey levels (H, W) of the picture in a binary message.

    Raises:
        BadInput: a header or size that does not fit; one line.
    """
    if not HEADER.size < len(data) <= LARGEST_PICTURE:
        raise BadInput(f"picture: got {len(data)} bytes, expected {HEADER.size} to {LARGEST_PICTURE}")
    kind, version, seq, width, height, time = HEADER.unpack_from(data)
    if (kind, version) != (PICTURE, VERSION) or not 0.0 <= time < 1e15:
        got = f"kind {kind}, version {version}, time {time}"
        raise BadInput(f"picture: got {got}, expected {PICTURE}, {VERSION}, milliseconds")
    sent, fits = len(data) - HEADER.size, LEAST_SIDE <= width <= MOST_WIDTH
    if sent != width * height or not fits or not LEAST_SIDE <= height <= MOST_HEIGHT:
        got = f"{sent} grey levels for {width} x {height}"
        raise BadInput(f"picture: got {got}, expected one for each, at most {MOST_WIDTH} x {MOST_HEIGHT}")
    levels = np.frombuffer(data, dtype=np.uint8, offset=HEADER.size)
    return seq, time / 1e3, levels.reshape(height, width)


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


def headers(hosts: Sequence[str]) -> dict[str, str]:
    """Return the headers of every answer of a server that is reached by these hosts with their port: nothing
    from elsewhere is loaded, framed, sniffed or kept."""
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self'; "
        "img-src 'self' blob: data:; media-src blob:; "
        f"connect-src 'self' {' '.join(f'ws://{host}' for host in hosts)}; "
        "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
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


@dataclass(frozen=True, kw_only=True)
class Settings:
    """What one server serves.

    Attributes:
        port: 0 for any; share: the address of this machine by which its network reaches the page too.
        camera: "browser", "none", "film" or "server", which the page is told.
        source: of every page's pictures, None where the page's camera or nothing sends them; keep: takes the
            lines of a recording, of the first page that is open.
    """

    port: int = 0
    share: str | None = None
    camera: str = "browser"
    source: "Source | None" = None
    calibration: "Camera | None" = None
    preset: str = "polymer"
    keep: Callable[[str], object] | None = None
