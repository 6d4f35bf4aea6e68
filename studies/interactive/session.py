"""A session: events in, states out. No input or output, no clock: the same events give the same states.

An event is a mapping with "do" and "t" [s], as the page sends it and a session file stores it. A state is
what `view.shown` makes of the session: plain numbers in SI units and sentences.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from studies.interactive import presets
from studies.interactive.bench import DRIVES, SPRUNG, Bench
from studies.interactive.input import EVENTS, MOST_STEPS, Event
from studies.interactive.mechanics import Mechanics
from studies.interactive.motion import SOLVERS
from studies.interactive.presets import STEP
from studies.interactive.view import SENTENCES, shown
from studies.kinds import Array

#: Farthest a pose may lie from rest: shift over the strips' length, and turn [rad].
FARTHEST_SHIFT, FARTHEST_TURN = 2.0, 3.5
#: Distance of the body from where the pivot turns by itself, over the strips' length, that is named: few
#: hands pull so hard, but 1.5 % of a wrong printed size do it.
OFF_PATH = 0.02
#: Pace of a motion below which it is said to be slowed down, and most sweeps of a solver.
SLOWED, MOST_SWEEPS = 0.9, 1000


class Session(Bench):
    """The state machine behind the page.

    Args:
        preset: name of the design to start with.
        lock_step: every frame is four steps (films, replays), not as many as its time asks for (cameras).
    """

    def __init__(self, preset: str = "polymer", *, lock_step: bool = True) -> None:
        self.begin(preset, presets.preset(preset).values(), lock_step)
        self._settle()

    def feed(self, event: Mapping[str, Any]) -> dict[str, Any]:
        """Take one event and return the state after it.

        Raises:
            BadInput: an event that is none; the session is as it was.
        """
        event = Event(event)
        action, time = getattr(self, f"_{event.choice('do', EVENTS)}"), event.number("t")
        self.warnings = {}
        action(event, time)
        self.time = time
        self.readings.take(self.mechanics, None if self.spread is None else self.ways @ self.spread)
        if self.mechanics.doubt:
            self._warn("coarse", self.mechanics.doubt)
        if not self.mechanics.resolved:
            self._warn("under-resolved", f"{self.mechanics.longest_step / STEP:.1g} resolves it")
        if self.mechanics.moving and not self.paused and self.clock.pace < SLOWED:
            real = "real time" if self.mechanics.step == STEP else "the time scale"
            self._warn("slowed", f"runs at {self.clock.pace:.1g} of {real}")
        return shown(self)

    def _warn(self, code: str, detail: str = "") -> None:
        """Add a fault, once; `detail` stands behind its sentence in brackets."""
        sentence = SENTENCES.get(code, SENTENCES["lost"])
        self.warnings[code] = f"{sentence[:-1]} ({detail})." if detail else sentence

    def setup(self) -> dict[str, Any]:
        """Return the event that makes a new session of this one's settings."""
        return {
            "do": "setup",
            "t": self.time,
            "preset": self.preset,
            "values": dict(self.mechanics.values),
            "drive": self.drive,
            "solver": self.solver,
            "sweeps": self.sweeps,
            "lock_step": self.clock.lock_step,
            "rest": self.placing.rest.tolist(),
        }

    def _setup(self, event: Event, time: float) -> None:
        """Begin anew with these settings; the first event of a session file."""
        drive, solver = event.choice("drive", DRIVES), event.choice("solver", SOLVERS)
        sweeps = event.whole("sweeps", MOST_SWEEPS)
        rest, values = event.three("rest"), presets.checked(event.mapping("values"))
        preset = event.choice("preset", (*presets.PRESETS, presets.OWN))
        self.begin(preset, values, event.get("lock_step") is not False)
        self.drive, self.solver, self.sweeps = drive, solver, sweeps
        if not np.array_equal(rest, self.placing.rest):
            self.set_rest(rest)
        self._settle()

    # -- poses ---------------------------------------------------------------------------------------------

    def _pose(self, event: Event, time: float) -> None:
        """A pose from mouse, touch, keys or sliders: displacement from rest and turn."""
        self.sight, self.spread = {"state": "none"}, None
        pose = event.three("pose")
        self._to(pose, time)

    def _seen(self, event: Event, time: float) -> None:
        """Marker 1 in marker 0's frame, as the camera sees it."""
        marker = event.three("marker")
        self.sight = {key: event[key] for key in ("state", "rms", "plane", "quads") if key in event}
        self.sight.setdefault("state", "found")
        self.marker = marker
        for code in event.words("faults"):
            self._warn(code)
        if self._tick(event, time) or self.paused:
            return
        body = self.placing.body(marker, near=self.wanted[2])
        pose = np.array([*(body[:2] - self.placing.centre), body[2]])
        if self.placing.looks_swapped(marker):
            self._warn("swapped")
        elif not self.hand.believes(time, pose):
            self._warn("jump")
        else:
            self.spread = self.placing.spread(event.three("sd"), body[2]) if "sd" in event else None
            self._to(pose, time)

    def _unseen(self, event: Event, time: float) -> None:
        """A frame without a pose: the last one is held, and why is said."""
        self.sight = {"state": "lost", **{key: event[key] for key in ("plane", "quads") if key in event}}
        self._warn(str(event.get("code", "lost")), str(event.get("text", "")))
        self._tick(event, time)

    def _tick(self, event: Event, time: float) -> bool:
        """Advance the released body by a frame, by no more steps than there is room for; False while it is
        held."""
        room = event.whole("room", MOST_STEPS) if "room" in event else MOST_STEPS
        if not self.mechanics.moving or self.paused:
            self.clock.wait(time)
        else:
            self._advance(self.clock.due(time, room))
        return self.mechanics.moving

    def _to(self, pose: Array, time: float) -> None:
        """Drive the body to `pose` (3,), displacement from rest and turn."""
        if self.mechanics.moving:
            return
        far = math.hypot(pose[0], pose[1]) / self.mechanics.values["length"]
        if not (far <= FARTHEST_SHIFT and abs(pose[2]) <= FARTHEST_TURN):
            self._warn("absurd", f"shift {far:.2g} strip lengths, turn {math.degrees(pose[2]):.0f}°")
            return
        self.wanted = pose
        self._hold()
        self.hand.add(time, self.wanted)

    def _hold(self) -> None:
        """Static solve at the wanted pose; on failure the last good state stays."""
        mechanics = self.mechanics
        target = np.array([*(self.wanted[:2] + self.placing.centre), self.wanted[2]])
        if self.drive in SPRUNG:
            reached = mechanics.grip(target, self.grip, turns=self.drive == "pull")
        else:
            reached = mechanics.hold(target) if self.drive == "pose" else mechanics.turn(float(target[2]))
        if reached < 1.0:
            self._warn("no-equilibrium", f"{100 * reached:.0f} % of the way")
        elif self.drive == "rotation":
            self._hand_is_here(turn=self.wanted[2])
        elif self.sight["state"] != "none":
            gap = mechanics.curve.gap(self.wanted)
            if gap > OFF_PATH * mechanics.values["length"]:
                self._warn("off-path", f"{1e3 * gap:.1f} mm")

    def _settle(self) -> None:
        """A load moves the body from where the strips are at rest."""
        if self.mechanics.values["load"]:
            self._hold()

    def _hand_is_here(self, turn: float) -> None:
        """Without a camera the hand is where the body is: a shift that it does not hold is not wanted."""
        if self.sight["state"] == "none":
            self.wanted = np.array([*(self.mechanics.snapshot.pose[:2] - self.placing.centre), turn])

    # -- release and catch ---------------------------------------------------------------------------------

    def _release(self, event: Event, time: float) -> None:
        if self.mechanics.moving:
            return
        velocity = self.hand.velocity if event.get("speed") == "hand" else np.zeros(3)
        self._let_go(velocity / self.mechanics.values["time_scale"], time)

    def _let_go(self, velocity: Array, time: float) -> None:
        """Release the held body with a `velocity` (3,)."""
        self.mechanics.release(velocity, self.solver, self.sweeps)
        self.clock.begin(time)

    def _catch(self, event: Event, time: float) -> None:
        if not self.mechanics.moving:
            return
        if not self.mechanics.catch():
            self._warn("no-catch")
            return
        self.hand.forget()
        turn = float(self.mechanics.snapshot.pose[2])
        self._hand_is_here(turn)
        self.wanted[2] = turn + math.remainder(self.wanted[2] - turn, math.tau)
        self._hold()

    def _advance(self, steps: int) -> None:
        done = self.mechanics.advance(steps) if steps else 0.0
        if steps and not done:
            self._warn("stopped")
            self.paused = True
            return
        self.clock.count(steps, done, self.mechanics.values["time_scale"])

    def _pause(self, event: Event, time: float) -> None:
        self.paused = True

    def _resume(self, event: Event, time: float) -> None:
        self.paused = False
        self.clock.wait(time)

    def _step(self, event: Event, time: float) -> None:
        """One step of a released body that is paused."""
        self.paused = True
        if self.mechanics.moving:
            self._advance(1)

    def _reset(self, event: Event, time: float) -> None:
        self.mechanics.reset()
        self.wanted, self.paused = np.zeros(3), False
        self.clock.begin(None)
        self.hand.forget()
        self._settle()

    # -- settings ------------------------------------------------------------------------------------------

    def _parameter(self, event: Event, time: float) -> None:
        (preset, values), before = self.design, self.mechanics
        changed = {**values, str(event.get("name")): event.get("value")}
        self.change(preset, changed, part=event.get("part") is True)
        self._rebuilt(before, time)

    def _preset(self, event: Event, time: float) -> None:
        before, given, name = self.mechanics, dict(event.mapping("values")), event.get("name")
        known = {} if name == presets.OWN and given else presets.preset(name).values()
        self.change(str(name), known | given, part=event.get("part") is True)
        self._rebuilt(before, time)

    def _undo(self, event: Event, time: float) -> None:
        before, name = self.mechanics, event["do"]
        self._rebuilt(before, time) if self.swap(back=name == "undo") else self._warn("empty", f"to {name}")

    _redo = _undo

    def _rebuilt(self, before: Mechanics, time: float) -> None:
        """Another design goes on where the former one is, held or swinging; its time begins."""
        if self.mechanics is before:  # at another pace
            return
        if before.moving and self.mechanics.hold(before.snapshot.pose) == 1.0:
            self._let_go(before.snapshot.velocity, time)
            return
        if before.moving:
            self._warn("swing-ended")
        self.clock.begin(None)
        self._hold()

    def _drive(self, event: Event, time: float) -> None:
        self.drive = event.choice("by", DRIVES)
        if not self.mechanics.moving:
            self._hand_is_here(float(self.mechanics.snapshot.pose[2]))
            self._hold()

    def _solver(self, event: Event, time: float) -> None:
        solver = event.choice("name", SOLVERS)
        self.sweeps = event.whole("sweeps", MOST_SWEEPS) if "sweeps" in event else self.sweeps
        self.solver = solver
        self.mechanics.change_solver(self.solver, self.sweeps)
        self.clock.forget()

    def _rest(self, event: Event, time: float) -> None:
        """The markers, as they are seen now, are those of the pivot at rest."""
        if self.marker is None or self.sight["state"] == "lost":
            self._warn("no-rest")
            return
        self.set_rest(self.marker)
        self._reset(event, time)
