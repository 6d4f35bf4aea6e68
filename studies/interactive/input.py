"""What comes into a session: events and their fields, the clock that counts the steps they stand for, and the
hand."""

import math
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np

from studies.cases.rules import TRUTH, Rule, choice, number, text, whole
from studies.errors import BadInput
from studies.interactive.presets import STEP, STEPS_A_FRAME
from studies.kinds import Array

#: Grips of the hand: the rotation, and the centre by a spring; the centre alone, by a spring; the rotation
#: alone; the whole pose.
DRIVES = ("grip", "pull", "rotation", "pose")
#: Longest that simulated time is caught up, or waits, in one frame, in steps; frames whose pace is told.
MOST_STEPS, FRAMES = 20, 25

Fields = Mapping[str, Rule]
Events = Mapping[str, Fields]
NUMBER, _NAME, ANYTHING = number("a finite number"), text("a name"), Rule(expected="anything")
_MAP = Rule(expected="values by name", admits=lambda value: isinstance(value, Mapping), read=dict)
_WORDS = Rule(
    expected="a list of texts",
    admits=lambda value: isinstance(value, list) and all(isinstance(word, str) for word in value),
)
_THREE = Rule(
    expected="three finite numbers",
    admits=lambda value: (
        isinstance(value, list | tuple) and len(value) == 3 and all(map(NUMBER.admits, value))
    ),
    read=lambda value: np.array(value, dtype=float),
)
_DRIVE = choice(*DRIVES)
#: Actions of events, each a method of the session, with their fields; fields with a question mark are
#: optional.
EVENTS: Events = {
    "setup": {
        **{"preset": _NAME, "values": _MAP, "case?": _MAP, "drive": _DRIVE},
        **{"lock_step": TRUTH, "rest": _THREE},
    },
    "pose": {"pose": _THREE},
    "seen": {
        **{
            "marker": _THREE,
            "sd?": _THREE,
            "rms?": NUMBER,
            "state?": _NAME,
            "plane?": ANYTHING,
            "quads?": ANYTHING,
        },
        "faults?": _WORDS,
    },
    "unseen": {"code?": _NAME, "text?": ANYTHING},
    "parameter": {"name": _NAME, "value": ANYTHING},
    "preset": {"name": _NAME, "values?": _MAP, "case?": _MAP},
    "drive": {"by": _DRIVE},
    "grasp": {"body": _NAME},
    "critical": {"force": ANYTHING},
    **{do: {} for do in ("tick", "release", "catch", "pause", "resume", "reset", "rest")},
}
#: What every event may have.
_ALWAYS: Fields = {"t": NUMBER, "room?": whole(1, MOST_STEPS)}


def fields(event: Mapping[str, Any], every: Events = EVENTS, always: Fields = _ALWAYS) -> Fields:
    """Return the rules of an event's fields; BadInput in one line for an unknown event or field."""
    do = event.get("do")
    if not isinstance(do, str) or do not in every:
        raise BadInput(f"do: got {str(do)[:40]!r}, expected one of {', '.join(every)}")
    rules = {**every[do], **always}
    if odd := set(event) - {name.rstrip("?") for name in rules} - {"do"}:
        expected = sorted(name.rstrip("?") for name in every[do])
        raise BadInput(f"{min(odd)[:40]!r}: got an unknown field of {do}, expected {expected}")
    return rules


def checked(event: Mapping[str, Any], rules: Fields | None = None) -> dict[str, Any]:
    """Return an event with its fields as they are worked with; BadInput in one line for one that does not
    fit."""
    found = {"do": event.get("do")}
    for name, rule in (fields(event) if rules is None else rules).items():
        key = name.rstrip("?")
        if key in event or key == name:
            try:
                found[key] = rule.parse(event.get(key))
            except BadInput as error:
                raise BadInput(f"{key}: {error}") from None
    return found


class Clock:
    """Steps and simulated time since the release.

    Args:
        lock_step: every frame is four steps (films, replays), not as many as its time asks for (cameras).

    Attributes:
        steps, simulated: taken since the release, and their time [s], each at the length it had.
    """

    def __init__(self, *, lock_step: bool) -> None:
        self.lock_step = lock_step
        self.begin(None)

    def begin(self, time: float | None) -> None:
        """Start again at `time` [s], or at the next frame."""
        self.steps, self.simulated, self._last = 0, 0.0, time
        self._owed, self._asked = 0.0, 0.0
        self._paces: deque[tuple[float, float]] = deque(maxlen=FRAMES)

    @property
    def pace(self) -> float:
        """Simulated time of the last frames over what they asked for [1], 1 before there are any."""
        asked, done = (sum(each) for each in zip(*self._paces, strict=True)) if self._paces else (0.0, 0.0)
        return done / asked if asked > 0.0 else 1.0

    def wait(self, time: float) -> None:
        """Nothing moves up to `time` [s]."""
        self._last = time

    def due(self, time: float, room: int = MOST_STEPS) -> int:
        """Return the steps of the frame at `time` [s], for as many as there is `room`.

        What rounding leaves, of either sign, is owed to the next frame, so that no time is gained or lost;
        what there is no room for is not: time goes slower.
        """
        before, self._last = self._last, time
        if self.lock_step or before is None:
            self._asked = STEPS_A_FRAME * STEP
            return STEPS_A_FRAME
        self._asked = time - before
        due = self._owed + self._asked / STEP
        steps = max(0, min(MOST_STEPS, room, round(due)))
        most = 0.5 if steps == room < MOST_STEPS else MOST_STEPS
        self._owed = min(max(due - steps, -MOST_STEPS), most)
        return steps

    def count(self, steps: int, done: float, scale: float) -> None:
        """Add steps that were taken, which did `done` seconds of a time of that scale."""
        self.steps += steps
        self.simulated += done
        self._paces.append((self._asked, done / scale))
        self._asked = 0.0


#: A camera's pose that lies farther from the last one, for each frame's time since, waits for a second one
#: that agrees [m, rad, s].
JUMP_SHIFT, JUMP_TURN, FRAME = 0.025, math.radians(15), 0.04


class Hand:
    """The last pose (3,) [m, m, rad] of the hand with its time [s], None before there is one."""

    def __init__(self) -> None:
        self.last: tuple[float, Array] | None = None
        self._odd: Array | None = None

    def believes(self, time: float, pose: Array) -> bool:
        """Return whether a pose (3,) [m, m, rad] at an instant [s] may be taken.

        It may if it is as near the last one as a hand moves in that time, or seen twice.
        """
        known, self._odd = self._odd, None
        if self.last is None or (known is not None and _close(pose, known, 1.0)):
            return True
        last, before = self.last
        if _close(pose, before, max(1.0, (time - last) / FRAME)):
            return True
        self._odd = pose
        return False


def _close(pose: Array, other: Array, frames: float) -> bool:
    shift, turn = math.hypot(*(pose[:2] - other[:2])), abs(pose[2] - other[2])
    return shift <= frames * JUMP_SHIFT and turn <= frames * JUMP_TURN
