"""A session: events in, states out. No input or output, no clock: the same events give the same states.

An event is a mapping with "do" and "t" [s], as the page sends it and a session file stores it. A state is
what
`view.shown` makes of the session: plain numbers in SI units and sentences.
"""

import math
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.design import wrapped
from studies.interactive.mechanics import Mechanics
from studies.interactive.motion import MOTIONS
from studies.interactive.placing import Placing
from studies.interactive.presets import STEP, STEPS_A_FRAME
from studies.interactive.view import Warnings, shown

Array = NDArray[np.float64]

#: Farthest a pose may lie from rest: shift over the strips' length, and turn [rad].
FARTHEST_SHIFT, FARTHEST_TURN = 2.0, 3.5
#: A camera's pose that lies farther from the last one waits for a second one that agrees [m, rad].
JUMP_SHIFT, JUMP_TURN = 0.025, math.radians(15)
#: Longest that simulated time is caught up in one frame, in steps.
MOST_STEPS = 20
#: Poses that the hand's velocity is taken from.
HAND_POSES = 5
#: Mean axial strain that no hand gives a strip: the markers' size or rest place is wrong.
ODD_STRAIN = 0.015
UNDO = 100
#: What the hand holds: the whole pose, or the rotation alone.
DRIVES = ("pose", "rotation")


class Session:
    """The state machine behind the page.

    Args:
        preset: name of the design to start with.
        lock_step: whether every frame is four steps whatever its time (films, replays), or as many as its
            time
            asks for (cameras).
    """

    def __init__(self, preset: str = "polymer", *, lock_step: bool = True) -> None:
        self._begin(preset, presets.preset(preset).values(), lock_step)

    def _begin(self, preset: str, values: Mapping[str, object], lock_step: bool) -> None:
        """Everything as at the start, with these settings."""
        self._design(values)
        self.preset, self.lock_step = preset, lock_step
        self.warnings = Warnings()
        self.drive, self.solver = DRIVES[0], next(iter(MOTIONS))
        self.paused = False
        self.steps, self.lag, self.time = 0, 0.0, 0.0
        self.sight: dict[str, Any] = {"state": "none"}
        self.spread: Array | None = None
        self.start_energy = 0.0
        self.wanted = np.zeros(3)
        self._past: list[tuple[str, dict[str, float]]] = []
        self._future: list[tuple[str, dict[str, float]]] = []
        self._hand: deque[tuple[float, Array]] = deque(maxlen=HAND_POSES)
        self._odd: Array | None = None
        self._last_frame: float | None = None

    seen_marker: Array | None
    placing: Placing
    mechanics: Mechanics

    def feed(self, event: Mapping[str, Any]) -> dict[str, Any]:
        """Take one event and return the state after it.

        Raises:
            BadInput: an event that is none; the session is as it was.
        """
        name = event.get("do")
        action = ACTIONS.get(name) if isinstance(name, str) else None
        if action is None:
            raise BadInput(f"do: got {name!r}, expected one of {', '.join(ACTIONS)}")
        time = _number(event, "t")
        self.warnings.begin()
        action(self, event, time)
        self.time = time
        return shown(self)

    def setup(self) -> dict[str, Any]:
        """Return the event that makes a new session of this one's settings."""
        return {
            "do": "setup",
            "t": self.time,
            "preset": self.preset,
            "values": dict(self.mechanics.values),
            "drive": self.drive,
            "solver": self.solver,
            "lock_step": self.lock_step,
            "rest": self.placing.rest.tolist(),
        }

    def _setup(self, event: Mapping[str, Any], time: float) -> None:
        """Begin anew with these settings; the first event of a session file."""
        presets.preset(event.get("preset"))
        drive, solver = _choice(event, "drive", DRIVES), _choice(event, "solver", tuple(MOTIONS))
        rest, values = _three(event, "rest"), presets.checked(event.get("values", {}))
        self._begin(str(event["preset"]), values, event.get("lock_step") is not False)
        self.drive, self.solver = drive, solver
        self.placing = self.placing.with_rest(rest)

    # -- poses ---------------------------------------------------------------------------------------------

    def _pose(self, event: Mapping[str, Any], time: float) -> None:
        """A pose from mouse, touch, keys or sliders: displacement from rest and turn."""
        self.sight, self.spread = {"state": "none"}, None
        pose = _three(event, "pose")
        self._to(pose, time)

    def _seen(self, event: Mapping[str, Any], time: float) -> None:
        """Marker 1 in marker 0's frame, as the camera sees it."""
        marker = _three(event, "marker")
        self.sight = {key: event[key] for key in ("state", "rms", "plane", "quads") if key in event}
        self.sight.setdefault("state", "found")
        self.seen_marker = marker
        for code in event.get("faults", ()):
            self.warnings.say(code, str(event.get("text", "")))
        if not self._frame(time) and not self.paused and self._plausible(marker):
            self.spread = self.placing.spread(_three(event, "sd")) if "sd" in event else None
            body = self.placing.body(marker, near=self.wanted[2])
            self._to(np.array([*(body[:2] - self.placing.centre), body[2]]), time)

    def _unseen(self, event: Mapping[str, Any], time: float) -> None:
        """A frame without a pose: the last one is held, and why is said."""
        self.sight = {"state": "lost", **{key: event[key] for key in ("plane", "quads") if key in event}}
        self.warnings.say(str(event.get("code", "lost")), str(event.get("text", "")))
        self._frame(time)

    def _tick(self, event: Mapping[str, Any], time: float) -> None:
        """A frame's time has passed without a camera."""
        self._frame(time)

    def _frame(self, time: float) -> bool:
        """Advance the released body by a frame; False while it is held."""
        if not self.mechanics.moving:
            self._last_frame = time
            return False
        before, self._last_frame = self._last_frame, time
        if self.paused:
            return True
        steps = STEPS_A_FRAME
        if not self.lock_step and before is not None:
            due = self.lag + (time - before) / STEP
            steps = max(0, min(MOST_STEPS, round(due)))
            self.lag = max(0.0, due - steps)
        self._advance(steps)
        return True

    def _plausible(self, marker: Array) -> bool:
        """Whether a camera's pose may be taken: not swapped, and no jump that was seen but once."""
        if self.placing.looks_swapped(marker):
            self.warnings.say("swapped")
            return False
        body = self.placing.body(marker, near=self.wanted[2])
        pose = np.array([*(body[:2] - self.placing.centre), body[2]])
        if not self._hand or _close(pose, self._hand[-1][1]):
            self._odd = None
            return True
        known, self._odd = self._odd, pose
        if known is not None and _close(pose, known):
            self._odd = None
            return True
        self.warnings.say("jump")
        return False

    def _to(self, pose: Array, time: float) -> None:
        """Drive the body to `pose` (3,), displacement from rest and turn."""
        if self.mechanics.moving:
            return
        far = math.hypot(pose[0], pose[1]) / self.mechanics.values["length"]
        if not (far <= FARTHEST_SHIFT and abs(pose[2]) <= FARTHEST_TURN):
            self.warnings.say("absurd", f"shift {far:.2g} strip lengths, turn {math.degrees(pose[2]):.0f}°")
            return
        self._hand.append((time, pose))
        self.wanted = pose
        self._hold()

    def _hold(self) -> None:
        """Static solve at the wanted pose; on failure the last good state stays."""
        target = np.array([*(self.wanted[:2] + self.placing.centre), self.wanted[2]])
        by_pose = self.drive == "pose"
        reached = self.mechanics.hold(target) if by_pose else self.mechanics.turn(float(target[2]))
        if reached < 1.0:
            self.warnings.say("no-equilibrium", f"{100 * reached:.0f} % of the way")
        elif by_pose and self.sight["state"] != "none":
            strain = float(np.abs(self.mechanics.snapshot.reading.strain).max())
            if strain > ODD_STRAIN:
                self.warnings.say("strained", f"{100 * strain:.1f} %")

    # -- release and catch ---------------------------------------------------------------------------------

    def _release(self, event: Mapping[str, Any], time: float) -> None:
        if self.mechanics.moving:
            return
        velocity = np.zeros(3)
        if event.get("speed", "zero") == "hand" and len(self._hand) > 1:
            times = np.array([at for at, _ in self._hand])
            poses = np.array([pose for _, pose in self._hand])
            if np.ptp(times) > 0:
                velocity = np.polyfit(times - times.mean(), poses, 1)[0] / self.mechanics.values["time_scale"]
        self.mechanics.release(velocity, self.solver)
        now = self.mechanics.snapshot
        self.steps, self.lag, self.start_energy = 0, 0.0, now.strain + now.kinetic
        self._last_frame = time

    def _catch(self, event: Mapping[str, Any], time: float) -> None:
        if not self.mechanics.moving:
            return
        if not self.mechanics.catch():
            self.warnings.say("no-catch")
            return
        self._hand.clear()
        if self.sight["state"] == "none":  # without a camera the hand is where the body is
            pose = self.mechanics.snapshot.pose
            self.wanted = np.array([*(pose[:2] - self.placing.centre), pose[2]])
        self.wanted[2] = self.mechanics.snapshot.pose[2] + wrapped(
            self.wanted[2] - self.mechanics.snapshot.pose[2]
        )
        self._hold()

    def _advance(self, steps: int) -> None:
        if steps and not self.mechanics.advance(steps):
            self.warnings.say("stopped")
            self.paused = True
            return
        self.steps += steps

    def _pause(self, event: Mapping[str, Any], time: float) -> None:
        self.paused = True

    def _resume(self, event: Mapping[str, Any], time: float) -> None:
        self.paused, self._last_frame = False, time

    def _step(self, event: Mapping[str, Any], time: float) -> None:
        """One step of a released body that is paused."""
        self.paused = True
        if self.mechanics.moving:
            self._advance(1)

    def _reset(self, event: Mapping[str, Any], time: float) -> None:
        self.mechanics.reset()
        self.wanted, self.paused, self.steps, self.lag = np.zeros(3), False, 0, 0.0
        self._hand.clear()

    # -- settings ------------------------------------------------------------------------------------------

    def _design(self, values: Mapping[str, object]) -> None:
        """Build a design and hold it at rest; what cannot be built leaves the former one."""
        self.mechanics = Mechanics(presets.checked(values))
        self.placing = Placing.of(self.mechanics.pivot)
        self.seen_marker = None

    def _change(self, name: str, values: Mapping[str, object]) -> None:
        """Another design, held at the same displacement."""
        known = (self.preset, dict(self.mechanics.values))
        rest = self.placing.rest
        changed_rest = not np.array_equal(rest, Placing.of(self.mechanics.pivot).rest)
        self._design(values)
        if changed_rest:
            self.placing = self.placing.with_rest(rest)
        self.preset = name
        self._past = [*self._past[-UNDO:], known]
        self._hold()

    def _parameter(self, event: Mapping[str, Any], time: float) -> None:
        name = event.get("name")
        self._change(self.preset, {**self.mechanics.values, str(name): event.get("value")})
        self._future.clear()

    def _preset(self, event: Mapping[str, Any], time: float) -> None:
        name = event.get("name")
        values = dict(presets.preset(name).values())
        given = event.get("values", {})
        if not isinstance(given, Mapping):
            raise BadInput(f"values: got {given!r}, expected parameters by name")
        self._change(str(name), {**values, **given})
        self._future.clear()

    def _undo(self, event: Mapping[str, Any], time: float) -> None:
        self._swap_design(self._past, self._future, "nothing to undo")

    def _redo(self, event: Mapping[str, Any], time: float) -> None:
        self._swap_design(self._future, self._past, "nothing to redo")

    def _swap_design(self, source: list[Any], target: list[Any], empty: str) -> None:
        if not source:
            self.warnings.say("empty", empty)
            return
        name, values = source.pop()
        target.append((self.preset, dict(self.mechanics.values)))
        kept = list(self._past)
        self._change(name, values)
        self._past = kept

    def _set_drive(self, event: Mapping[str, Any], time: float) -> None:
        self.drive = _choice(event, "by", DRIVES)
        if not self.mechanics.moving:
            self._hold()

    def _set_solver(self, event: Mapping[str, Any], time: float) -> None:
        self.solver = _choice(event, "name", tuple(MOTIONS))

    def _rest(self, event: Mapping[str, Any], time: float) -> None:
        """The markers, as they are seen now, are those of the pivot at rest."""
        if self.seen_marker is None or self.sight["state"] == "lost":
            self.warnings.say("no-rest")
            return
        self.placing = self.placing.with_rest(self.seen_marker)
        self._reset(event, time)


def _close(pose: Array, other: Array) -> bool:
    return math.hypot(*(pose[:2] - other[:2])) <= JUMP_SHIFT and abs(pose[2] - other[2]) <= JUMP_TURN


def _number(event: Mapping[str, Any], key: str) -> float:
    value = event.get(key)
    if not isinstance(value, int | float) or isinstance(value, bool) or not math.isfinite(value):
        raise BadInput(f"{key}: got {value!r}, expected a finite number")
    return float(value)


def _three(event: Mapping[str, Any], key: str) -> Array:
    values = event.get(key)
    if not isinstance(values, list | tuple) or len(values) != 3:
        raise BadInput(f"{key}: got {values!r}, expected three finite numbers")
    return np.array([_number({key: value}, key) for value in values])


def _choice(event: Mapping[str, Any], key: str, choices: tuple[str, ...]) -> str:
    value = event.get(key)
    if value not in choices:
        raise BadInput(f"{key}: got {value!r}, expected one of {', '.join(choices)}")
    return str(value)


#: What an event may do.
ACTIONS = {
    "setup": Session._setup,
    "pose": Session._pose,
    "seen": Session._seen,
    "unseen": Session._unseen,
    "tick": Session._tick,
    "release": Session._release,
    "catch": Session._catch,
    "pause": Session._pause,
    "resume": Session._resume,
    "step": Session._step,
    "reset": Session._reset,
    "parameter": Session._parameter,
    "preset": Session._preset,
    "undo": Session._undo,
    "redo": Session._redo,
    "drive": Session._set_drive,
    "solver": Session._set_solver,
    "rest": Session._rest,
}
