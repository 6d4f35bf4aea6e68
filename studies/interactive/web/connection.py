"""One socket: its session, its tracker, its recording; all that is slow runs in a thread of its own."""

import asyncio
import logging
import time
import tomllib
from collections import deque
from itertools import count
from statistics import median
from typing import Any

from numpy.linalg import LinAlgError
from starlette.websockets import WebSocket

from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.input import DRIVES, MOST_STEPS, checked
from studies.interactive.mechanics import Mechanics
from studies.interactive.session import Recorder, Session
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.films import Shot, Source
from studies.interactive.tracking.tracker import Tracker
from studies.interactive.view import curved
from studies.interactive.web import protocol
from studies.interactive.web.protocol import Settings

LOG = logging.getLogger(__name__)

#: Time of a frame without pictures [s], how long pictures may stay away before it counts, and how many are
#: sent before the page has shown one.
TICK, STILL, IN_FLIGHT = 0.04, 0.2, 2
#: Part of a frame's time that the steps of a released body may take.
SHARE = 0.6


class Connection:
    """Serves one socket from the first message to the last; that of the `first` page is recorded."""

    def __init__(self, socket: WebSocket, settings: Settings, *, first: bool) -> None:
        self._socket, self._settings = socket, settings
        source = settings.source
        self.session = Session(settings.preset, lock_step=source is not None and source.lock_step)
        self._tracker = Tracker(camera=settings.calibration)
        self._recorder = Recorder(self.session, settings.keep) if first and settings.keep else None
        self._begin, self._lock = time.monotonic(), asyncio.Lock()
        self._pending: tuple[int, float, Picture] | None = None
        self._late: dict[str, Any] | None = None
        self._wake, self._room = asyncio.Event(), asyncio.Semaphore(IN_FLIGHT)
        self._last_picture = -1e9
        self._offset: float | None = None
        self._curved: Mechanics | None = None
        self._weighed: Mechanics | None = None
        self._costs = deque[float](maxlen=3)

    async def serve(self) -> None:
        """Answer until the socket closes; raises BadInput for a message that is none."""
        await self._say(
            {
                "kind": "welcome",
                "camera": self._settings.camera,
                "shared": self._settings.share is not None,
                "drives": list(DRIVES),
                "side": self._tracker.side,
                **presets.catalogue(),
            }
        )
        await self._feed({"do": "tick"}, None)
        await self._show_curve()
        workers = [asyncio.create_task(work()) for work in (self._ticks, self._news)]
        if self._settings.source is not None:
            workers.append(asyncio.create_task(self._play(self._settings.source)))
        receiver = asyncio.create_task(self._receive())
        try:
            done, _ = await asyncio.wait([receiver, *workers], return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in (receiver, *workers):
                task.cancel()
            await asyncio.gather(receiver, *workers, return_exceptions=True)

    async def _receive(self) -> None:
        """Take messages; a newer picture replaces one that waits."""
        meter = protocol.Meter()
        while True:
            message = await self._socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            data = message.get("bytes")
            event = protocol.event(message.get("text") or "") if data is None else {}
            if event.get("do") == "pose":  # read on: only the newest counts, however long one takes
                self._late = event
                if meter.passes(time.monotonic(), protocol.KEPT):
                    self._wake.set()
                continue
            if not meter.passes(time.monotonic()):
                raise BadInput(f"messages: got too many, expected at most {protocol.RATE:.0f} a second")
            if data is not None and data.startswith(protocol.DESIGN):
                await self._open(data[len(protocol.DESIGN) :].decode("utf-8", errors="replace"))
            elif data is not None:
                self._pending = protocol.sent_picture(data)
                self._wake.set()
            else:
                await self._catch_up()
                await self._text(event)

    async def _catch_up(self) -> None:
        """Take the newest pose, if it was not taken yet."""
        late, self._late = self._late, None
        if late is not None:
            await self._text(late)

    async def _text(self, event: dict[str, Any]) -> None:
        seq = event.pop("seq", None)
        name = event["do"]
        if name == "shown":
            self._room.release()
        elif name == "save":
            await self._say({"kind": "case", "text": self.session.mechanics.piece.as_case()})
        elif name == "size":
            side = checked(event, protocol.PAGE_EVENTS["size"])["side_mm"] / 1e3
            self._tracker = Tracker(side=side, camera=self._settings.calibration)
        else:
            await self._feed(event, seq)
            await self._show_curve()

    async def _say(self, content: dict[str, Any]) -> None:
        await self._socket.send_text(protocol.text(content))

    async def _open(self, text: str) -> None:
        """Open the text of a case file as a design."""
        try:
            document = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            await self._say({"kind": "error", "text": f"design.toml: {error}"})
        else:
            await self._text({"do": "preset", "name": presets.OWN, "case": document})

    async def _show_curve(self) -> None:
        """Send what a moment alone does to a design that is another one than the last."""
        if self._curved is not self.session.mechanics:
            self._curved = self.session.mechanics
            async with self._lock:
                curve = await asyncio.to_thread(curved, self.session)
            await self._say({"kind": "curve", **curve})

    async def _weigh(self) -> None:
        """Tell the session under which load its design loses its stability, once for each."""
        session, mechanics = self.session, self.session.mechanics
        known = session.critical is not None or self._weighed is mechanics
        if known or mechanics.moving or not mechanics.piece.values["load"]:
            return
        self._weighed = mechanics
        force = await asyncio.to_thread(mechanics.piece.critical_load)
        if session.mechanics is mechanics:
            await self._feed({"do": "critical", "force": force}, None)

    async def _feed(self, event: dict[str, Any], seq: object, **more: Any) -> None:
        """Give one event to the session and send its state."""
        await self._say({**await self._state_after(event), **more, "seq": seq})

    async def _state_after(self, event: dict[str, Any]) -> dict[str, Any]:
        async with self._lock:
            if "t" not in event:
                event = {**event, "t": time.monotonic() - self._begin}
            return await asyncio.to_thread(self._fed, event)

    def _fed(self, event: dict[str, Any]) -> dict[str, Any]:
        """Feed the session, in a thread; bad numbers come back as an error and change nothing."""
        begin, steps = time.perf_counter(), self.session.clock.steps
        cost = median(self._costs) if len(self._costs) > 2 else 0.0  # one hiccup is no rule
        if event["do"] in ("tick", "seen", "unseen") and cost * MOST_STEPS > SHARE * TICK:
            event = {**event, "room": max(1, int(SHARE * TICK / cost))}
        try:
            state = self.session.feed(event)
            protocol.text(state)  # a number that is not finite must not be sent
        except BadInput as error:
            return {"kind": "error", "text": str(error)}
        except (ArithmeticError, ValueError, LinAlgError) as error:
            LOG.exception("the session failed at %s", event)
            return {"kind": "error", "text": f"The solver failed, the last good state is kept ({error})."}
        took, steps = time.perf_counter() - begin, self.session.clock.steps - steps
        if steps > 0:
            self._costs.append(took / steps)
        elif not self.session.mechanics.moving:
            self._costs.clear()
        if self._recorder is not None:
            self._recorder.write(event, state)
        return {"kind": "state", **state, "solve_ms": 1e3 * took}

    async def _tracked(self, picture: Picture, captured: float) -> tuple[dict[str, Any], dict[str, Any]]:
        """The event of a picture on the session's clock, where the first one's time is when it came, and what
        is said beside its state."""
        begin = time.perf_counter()
        event = await asyncio.to_thread(self._tracker.see, picture, captured)
        if self._offset is None:
            self._offset = time.monotonic() - self._begin - captured
        event["t"] = captured + self._offset
        return event, {"track_ms": 1e3 * (time.perf_counter() - begin), "picture": picture.shape[::-1]}

    async def _ticks(self) -> None:
        """Drive a released body on where no pictures do."""
        due = time.monotonic()
        while True:
            due = max(due + TICK, time.monotonic())
            await asyncio.sleep(due - time.monotonic())
            await self._catch_up()
            await self._weigh()
            still = time.monotonic() - self._last_picture > STILL
            if still and self.session.mechanics.moving and not self.session.paused:
                await self._feed({"do": "tick"}, None)

    async def _news(self) -> None:
        """Solve the newest pose and track the newest picture of those that came meanwhile."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            await self._catch_up()
            sent, self._pending = self._pending, None
            if sent is None:
                continue
            seq, captured, picture = sent
            self._last_picture = time.monotonic()
            event, more = await self._tracked(picture, captured)
            await self._feed(event, seq, **more)

    async def _play(self, source: Source) -> None:
        """Track the pictures of a source and send each with its state, no faster than they are shown."""
        shots = source.shots()
        due = time.monotonic()
        for seq in count():
            shot: Shot | None = await asyncio.to_thread(next, shots, None)
            if shot is None:
                text = "camera: got no picture, expected one: is it unplugged?"
                await self._say({"kind": "error", "text": text})
                await asyncio.Event().wait()  # the page stays open until it is closed
            assert shot is not None
            await self._room.acquire()
            self._last_picture = time.monotonic()
            picture, jpeg = shot
            event, more = await self._tracked(picture, seq / source.rate)
            head = {**await self._state_after(event), **more, "seq": seq}
            await self._socket.send_bytes(protocol.with_picture(head, jpeg))
            due = max(due + 1.0 / source.rate, time.monotonic() - 0.5)
            await asyncio.sleep(max(0.0, due - time.monotonic()))
