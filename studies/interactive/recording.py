"""Session files: the events of a session as JSON lines, each with the mark of the state it led to; written,
and replayed at once or at their own times."""

import asyncio
import contextlib
import hashlib
import json
import time
from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping
from typing import Any

from studies.errors import BadInput
from studies.interactive.input import NUMBER, checked
from studies.interactive.session import Session

#: Characters of the hash that marks a state.
MARK = 16


def mark(state: Mapping[str, Any]) -> str:
    """Return a hash of a state: equal for states that are equal digit by digit."""
    text = json.dumps(state, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:MARK]


def _events(lines: Iterable[str]) -> Iterator[dict[str, Any]]:
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
    """Feed a session file to a session; yield each state, and whether it equals the recorded one."""
    session = session or Session()
    for event in _events(lines):
        known = event.pop("mark", None)
        state = session.feed(event)
        yield state, known == mark(state)


def _setup(session: Session) -> dict[str, Any]:
    """Return the event that makes a new session of this one's settings."""
    piece, placing = session.mechanics.piece, session.mechanics.placing
    return {
        **{name: getattr(session, name) for name in ("drive", "solver", "sweeps")},
        **{"do": "setup", "t": session.time, "lock_step": session.clock.lock_step},
        **{"preset": piece.name, "values": dict(piece.values), "case": dict(piece.document)},
        "rest": placing.rest.tolist(),
    }


class Recorder:
    """Gives a session's events as lines to `keep`, or keeps them up to a number of characters; begins with a
    new session."""

    MOST = 20_000_000

    def __init__(self, session: Session, keep: Callable[[str], object] | None = None) -> None:
        self.lines: list[str] = []
        self._keep, self._size = keep, 0
        start = _setup(session)
        self.write(start, session.feed(start))

    @property
    def full(self) -> bool:
        """Whether nothing more is kept."""
        return self._size >= self.MOST

    def write(self, event: Mapping[str, Any], state: Mapping[str, Any]) -> None:
        """Keep one event and the mark of the state after it."""
        text = json.dumps({**event, "mark": mark(state)}, allow_nan=False) + "\n"
        if self._keep is not None:
            self._keep(text)
        elif not self.full:
            self.lines.append(text)
            self._size += len(text)


Say = Callable[[dict[str, Any]], Awaitable[None]]


class Player:
    """Plays one session after the other; while it does, nothing else moves."""

    def __init__(self) -> None:
        self._task: asyncio.Task[None] | None = None

    @property
    def on(self) -> bool:
        """Whether a session is being replayed."""
        return self._task is not None and not self._task.done()

    async def over(self) -> None:
        """Wait until no session is being replayed."""
        while self.on and self._task is not None:
            await asyncio.wait([self._task])

    def end(self) -> None:
        """End the session that is being replayed."""
        if self._task is not None:
            self._task.cancel()

    def play(self, lines: list[str], say: Say, show: Callable[[Session], Awaitable[None]]) -> None:
        """Begin to replay a session file; BadInput for one that is none."""
        times = [float(checked(event, {"t": NUMBER})["t"]) for event in _events(lines)]
        self.end()
        self._task = asyncio.create_task(_play(lines, times, say, show))


async def _play(
    lines: list[str], times: list[float], say: Say, show: Callable[[Session], Awaitable[None]]
) -> None:
    """Send every state at its time, and in the end how many of them are those that were recorded."""
    session = Session()
    states, same = replay(lines, session), 0
    begin = time.monotonic() - (times[1] if len(times) > 1 else 0.0)
    ended = "The replay was ended"
    try:
        for k, due in enumerate(times):
            await asyncio.sleep(max(0.0, begin + due - time.monotonic()))
            at = time.perf_counter()
            state, good = await asyncio.to_thread(next, states)
            same += good
            took = 1e3 * (time.perf_counter() - at)
            await say(
                {"kind": "state", **state, "seq": None, "solve_ms": took, "replay": [k + 1, len(lines)]}
            )
            await show(session)
        ended = "The session file has ended"
    except BadInput as error:
        ended = f"The session file has ended early ({error})"
    finally:
        with contextlib.suppress(RuntimeError):  # the page may be gone
            await say(
                {"kind": "replayed", "text": f"{ended}: {same} of {len(lines)} states are those recorded."}
            )
