"""Session files: the events of a session as JSON lines, each with the mark of the state it led to."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from studies.errors import BadInput
from studies.interactive.pivot.session import Session

#: Characters of the hash that marks a state.
MARK = 16


def mark(state: Mapping[str, Any]) -> str:
    """Return a hash of a state: equal for states that are equal digit by digit."""
    text = json.dumps(state, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:MARK]


def line(event: Mapping[str, Any], state: Mapping[str, Any]) -> str:
    """Return one line of a session file."""
    return json.dumps({**event, "mark": mark(state)}, allow_nan=False) + "\n"


def events(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
    """Yield the events of a session file.

    Raises:
        BadInput: a line that is no event, or a first one that is no setup; one line with its number.
    """
    for number, text in enumerate(lines, start=1):
        try:
            event = json.loads(text)
        except ValueError:
            raise BadInput(f"line {number}: got no JSON, expected an event") from None
        if not isinstance(event, dict) or (number == 1 and event.get("do") != "setup"):
            raise BadInput(f"line {number}: got {text.strip()[:40]!r}, expected an event, the first a setup")
        yield event


def replay(lines: Iterable[str], session: Session | None = None) -> Iterator[tuple[dict[str, Any], bool]]:
    """Feed a session file to a new session; yield each state, and whether it is the one that was recorded."""
    session = session or Session()
    for event in events(lines):
        known = event.pop("mark", None)
        state = session.feed(event)
        yield state, known == mark(state)


class Recorder:
    """Keeps a session's events as lines, up to a number of characters; begins with a session made anew."""

    MOST = 20_000_000

    def __init__(self, session: Session) -> None:
        self.lines: list[str] = []
        self._size = 0
        start = session.setup()
        self.write(start, session.feed(start))

    @property
    def full(self) -> bool:
        """Whether nothing more is kept."""
        return self._size >= self.MOST

    def write(self, event: Mapping[str, Any], state: Mapping[str, Any]) -> None:
        """Keep one event and the mark of the state after it."""
        if not self.full:
            text = line(event, state)
            self.lines.append(text)
            self._size += len(text)
