"""Session files: the events of a session as JSON lines, each with the mark of the state it led to; written
and replayed."""

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from studies.errors import BadInput
from studies.interactive.session import Session

#: Characters of the hash that marks a state.
MARK = 16


def mark(state: Mapping[str, Any]) -> str:
    """Return a hash of a state: equal for states that are equal digit by digit."""
    text = json.dumps(state, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:MARK]


def replay(lines: Iterable[str]) -> Iterator[tuple[dict[str, Any], bool]]:
    """Feed a session file to a session; yield each state, and whether it equals the recorded one.

    Raises:
        BadInput: a line that is no event, or a first one that is no setup; one line with its number.
    """
    session = Session()
    for number, text in enumerate(lines, start=1):
        try:
            event = json.loads(text)
        except ValueError:
            raise BadInput(f"line {number}: got no JSON, expected an event") from None
        if not isinstance(event, dict) or (number == 1 and event.get("do") != "setup"):
            raise BadInput(f"line {number}: got {text.strip()[:40]!r}, expected an event, the first a setup")
        known = event.pop("mark", None)
        state = session.feed(event)
        yield state, known == mark(state)


def _setup(session: Session) -> dict[str, Any]:
    """Return the event that makes a new session of this one's settings."""
    piece, placing = session.mechanics.piece, session.mechanics.placing
    return {
        **{"do": "setup", "t": session.time, "lock_step": session.clock.lock_step, "drive": session.drive},
        **{"preset": piece.name, "values": dict(piece.values), "case": dict(piece.document)},
        "rest": placing.rest.tolist(),
    }


class Recorder:
    """Gives a session's events as lines to `keep`; begins with a new session."""

    def __init__(self, session: Session, keep: Callable[[str], object]) -> None:
        self._keep = keep
        start = _setup(session)
        self.write(start, session.feed(start))

    def write(self, event: Mapping[str, Any], state: Mapping[str, Any]) -> None:
        """Give one event and the mark of the state after it."""
        self._keep(json.dumps({**event, "mark": mark(state)}, allow_nan=False) + "\n")
