"""Sessions that are replayed in the page: by the server, from a session of their own, at their own times."""

import asyncio
import contextlib
import time
from collections.abc import Awaitable, Callable
from typing import Any

from studies.errors import BadInput
from studies.interactive.pivot.input import number
from studies.interactive.pivot.recording import Recorder, events, replay
from studies.interactive.pivot.session import Session

Say = Callable[[dict[str, Any]], Awaitable[None]]


class Player:
    """Takes files in parts, and plays one session after the other; while it does, nothing else moves."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
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

    def whole(self, kind: int, last: bool, data: bytes) -> str | None:
        """Take a part of a file and return the whole text with its last one.

        Raises:
            BadInput: more than a recording may hold, or no text.
        """
        self._parts.append(data)
        if sum(map(len, self._parts)) > Recorder.MOST:
            raise BadInput(f"file: got more than {Recorder.MOST} bytes, expected no more")
        if not last:
            return None
        content, self._parts = b"".join(self._parts), []
        return content.decode("utf-8", errors="replace")

    def play(self, lines: list[str], say: Say, show: Callable[[Session], Awaitable[None]]) -> None:
        """Begin to replay a session file; BadInput for one that is none."""
        times = [number(event, "t") for event in events(lines)]
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
