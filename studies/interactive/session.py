"""A session: events in, states out; and its file: the events, each with the mark of the state it led to.

No input or output, no clock: the same events give the same states.

An event is a mapping with "do" and "t" [s], as the page sends it and a session file stores it. A state is
what `view.shown` makes of the session: plain numbers in SI units and sentences.
"""

import hashlib
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from studies.errors import BadInput
from studies.interactive import presets
from studies.interactive.design import PRINTED
from studies.interactive.input import DRIVES, MOST_STEPS, Clock, Hand, checked
from studies.interactive.mechanics import Mechanics
from studies.interactive.motion import softness, ways
from studies.interactive.presets import STEP, Piece
from studies.interactive.view import SENTENCES, shown, unstable
from studies.kinds import Array

#: Grips that hold the body by a spring.
SPRUNG = ("grip", "pull")
#: Farthest a pose may lie from rest: shift over the strips' length, and turn [rad].
FARTHEST_SHIFT, FARTHEST_TURN = 2.0, 3.5
#: Distance of the body from where the pivot turns by itself, over the strips' length, that is named: few
#: hands pull so hard, but 1.5 % of a wrong printed size do it.
OFF_PATH = 0.02
#: Pace of a motion below which it is said to be slowed down.
SLOWED = 0.9


class Session:
    """The state machine behind the page; a design that cannot be built leaves the former one.

    Args:
        preset: name of the design to start with.
        lock_step: every frame is four steps (films, replays), not as many as its time asks for (cameras).

    Attributes:
        mechanics: the design at work. warnings: sentences of what is wrong by their codes.
        critical: load at which the design loses its stability [N], None where it is not known.
        sd (3,): standard deviation of the pose [m, m, rad]; force_sd (4,): of force, moment and stiffness, to
            first order; None where no camera holds the body.
    """

    def __init__(self, preset: str = "polymer", *, lock_step: bool = True) -> None:
        self._begin(presets.preset(preset), lock_step)
        self._settle()

    def _begin(self, piece: Piece, lock_step: bool, rest: Any = PRINTED) -> None:
        """Everything as at the start, with this design and marker 1 at `rest`."""
        self._at_rest, self.mechanics = rest, Mechanics(piece, rest)
        self.critical: float | None = None
        self.clock, self.hand = Clock(lock_step=lock_step), Hand()
        self.warnings: dict[str, str] = {}
        self.drive, self.paused, self.time = DRIVES[0], False, 0.0
        self.sight: dict[str, Any] = {"state": "none"}
        self.spread: Array | None = None
        self.sd: Array | None = None
        self.force_sd: Array | None = None
        self.marker: Array | None = None
        self.wanted = np.zeros(3)

    def feed(self, event: Mapping[str, Any]) -> dict[str, Any]:
        """Take one event and return the state after it.

        Raises:
            BadInput: an event that is none; the session is as it was.
        """
        fields = checked(event)
        self.warnings = {}
        getattr(self, f"_{fields['do']}")(fields)
        mechanics, self.time = self.mechanics, fields["t"]
        spread, tangent = self.spread, mechanics.snapshot.tangent
        self.sd = self.force_sd = None
        if spread is not None and tangent is not None:
            pose = ways(tangent, self.drive, self.grip) @ spread
            self.sd, force = np.linalg.norm(pose, axis=1), np.linalg.norm(tangent @ pose, axis=1)
            self.force_sd = np.append(force, mechanics.stiffness_spread(pose))
        if mechanics.doubt:
            self._warn("coarse", mechanics.doubt)
        if not mechanics.resolved:
            self._warn("under-resolved", f"{mechanics.longest_step / STEP:.1g} resolves it")
        if mechanics.moving and not self.paused and self.clock.pace < SLOWED:
            real = "real time" if mechanics.step == STEP else "the time scale"
            self._warn("slowed", f"runs at {self.clock.pace:.1g} of {real}")
        if mechanics.piece.values["load"] and not mechanics.snapshot.stable(mechanics.length):
            self._warn("unstable", unstable(self))
        return shown(self)

    def _warn(self, code: str, detail: str = "") -> None:
        """Add a fault, once; `detail` stands behind its sentence in brackets."""
        sentence = SENTENCES.get(code, SENTENCES["lost"])
        self.warnings[code] = f"{sentence[:-1]} ({detail})." if detail else sentence

    @property
    def grip(self) -> float:
        """Stiffness of the hand's spring [N/m]."""
        return softness(self.spread, self.mechanics.scale["force"])

    def _setup(self, event: dict[str, Any]) -> None:
        """Start again with these settings; the first event of a session file."""
        self._begin(self._chosen(event["preset"], event), event["lock_step"], event["rest"])
        self.drive = event["drive"]
        self._settle()

    def _pose(self, event: dict[str, Any]) -> None:
        """A pose from mouse, touch, keys or sliders: displacement from rest and turn."""
        self.sight, self.spread = {"state": "none"}, None
        self._to(event["pose"], event["t"])

    def _seen(self, event: dict[str, Any]) -> None:
        """Marker 1 in marker 0's frame, as the camera sees it."""
        marker, placing = event["marker"], self.mechanics.placing
        self.sight = {key: event[key] for key in ("state", "rms", "plane", "quads") if key in event}
        self.sight.setdefault("state", "found")
        self.marker = marker
        for code in event.get("faults", []):
            self._warn(code)
        if self._tick(event) or self.paused:
            return
        body = placing.body(marker, near=self.wanted[2])
        pose = np.array([*(body[:2] - placing.centre), body[2]])
        if not self.hand.believes(event["t"], pose):
            self._warn("jump")
        else:
            self.spread = placing.spread(event["sd"], body[2]) if "sd" in event else None
            self._to(pose, event["t"])

    def _unseen(self, event: dict[str, Any]) -> None:
        """A frame without a pose: the last one is held, and why is said."""
        self.sight = {"state": "lost"}
        self._warn(event.get("code", "lost"), str(event.get("text", "")))
        self._tick(event)

    def _tick(self, event: dict[str, Any]) -> bool:
        """Advance the released body by a frame, by no more steps than there is room for; False while it is
        held."""
        if not self.mechanics.moving or self.paused:
            self.clock.wait(event["t"])
        else:
            self._advance(self.clock.due(event["t"], event.get("room", MOST_STEPS)))
        return self.mechanics.moving

    def _to(self, pose: Array, time: float) -> None:
        """Drive the body to `pose` (3,), displacement from rest and turn."""
        if self.mechanics.moving:
            return
        far = math.hypot(pose[0], pose[1]) / self.mechanics.length
        if far <= FARTHEST_SHIFT and abs(pose[2]) <= FARTHEST_TURN:
            self.wanted = pose
            self._hold()
            self.hand.last = (time, self.wanted)
        else:
            self._warn("absurd", f"shift {far:.2g} strip lengths, turn {math.degrees(pose[2]):.0f}°")

    def _hold(self) -> None:
        """Static solve at the wanted pose; on failure the last good state stays."""
        mechanics = self.mechanics
        target = np.array([*(self.wanted[:2] + mechanics.placing.centre), self.wanted[2]])
        if self.drive in SPRUNG:
            reached = mechanics.grip(target, self.grip, turns=self.drive == "pull")
        else:
            reached = mechanics.hold(target) if self.drive == "pose" else mechanics.turn(float(target[2]))
        if reached < 1.0:
            self._warn("no-equilibrium", f"{100 * reached:.0f} % of the way")
            if mechanics.piece.values["load"] and self.drive != "pose":
                self._warn("unstable", unstable(self))
        elif self.drive == "rotation":
            self._hand_is_here(turn=self.wanted[2])
        elif self.sight["state"] != "none":
            gap = mechanics.curve.gap(self.wanted)
            if gap > OFF_PATH * mechanics.length:
                self._warn("off-path", f"{1e3 * gap:.1f} mm")

    def _settle(self) -> None:
        """A load moves the body from where the strips are at rest."""
        if self.mechanics.piece.values["load"]:
            self._hold()

    def _hand_is_here(self, turn: float) -> None:
        """Without a camera the hand is where the body is: a shift that it does not hold is not wanted."""
        if self.sight["state"] == "none":
            mechanics = self.mechanics
            self.wanted = np.array([*(mechanics.snapshot.pose[:2] - mechanics.placing.centre), turn])

    def _release(self, event: dict[str, Any]) -> None:
        if not self.mechanics.moving:
            self._let_go(np.zeros(3), event["t"])

    def _let_go(self, velocity: Array, time: float) -> None:
        """Release the held body with a `velocity` (3,)."""
        self.mechanics.release(velocity)
        self.clock.begin(time)

    def _catch(self, event: dict[str, Any]) -> None:
        if not self.mechanics.moving:
            return
        if not self.mechanics.catch():
            return self._warn("no-catch")
        self.hand = Hand()  # whose next pose is no jump
        turn = float(self.mechanics.snapshot.pose[2])
        self._hand_is_here(turn)
        self.wanted[2] = turn + math.remainder(self.wanted[2] - turn, math.tau)
        self._hold()

    def _advance(self, steps: int) -> None:
        """Take steps; time stands still where they fail, and before the body falls through the ground."""
        before = self.mechanics.snapshot
        done = self.mechanics.advance(steps) if steps else 0.0
        if steps and not done:
            self._warn("stopped")
        else:
            self.clock.count(steps, done, self.mechanics.step / STEP)
        if self.mechanics.grounded(self.mechanics.snapshot.pose):
            self.mechanics.snapshot = before
            self._warn("grounded")
        self.paused |= bool({"stopped", "grounded"} & set(self.warnings))

    def _pause(self, event: dict[str, Any]) -> None:
        self.paused = event["do"] == "pause"
        self.clock.wait(event["t"])

    _resume = _pause

    def _reset(self, event: dict[str, Any]) -> None:
        self.mechanics.reset()
        self.wanted, self.paused = np.zeros(3), False
        self.clock.begin(None)
        self.hand = Hand()
        self._settle()

    def _parameter(self, event: dict[str, Any]) -> None:
        self._change(self.mechanics.piece.changed({event["name"]: event["value"]}), event["t"])

    def _grasp(self, event: dict[str, Any]) -> None:
        """Hold another body of the mechanism, from rest on."""
        self.mechanics.reset()
        self._change(self.mechanics.piece.grasped(event["body"]), event["t"])

    def _preset(self, event: dict[str, Any]) -> None:
        self._change(self._chosen(event["name"], event), event["t"])

    def _chosen(self, name: str, event: dict[str, Any]) -> Piece:
        return presets.chosen(name, self.mechanics.piece, event.get("case"), event.get("values", {}))

    def _change(self, piece: Piece, time: float) -> None:
        """Another design goes on where the former one is, held or swinging; its time begins."""
        before = self.mechanics
        if before.piece.like(piece):
            return before.pace(piece)
        self.mechanics = Mechanics(piece, self._at_rest)
        loads = [each.values["load"] or 0.0 for each in (before.piece, piece)]
        if not before.piece.like(piece, "load", "relaxation_time") or loads[0] * loads[1] < 0.0:
            self.critical = None
        if piece.body.name != before.piece.body.name:
            self.wanted = np.zeros(3)
        elif piece.name != before.piece.name:
            self.wanted[:2] *= self.mechanics.length / before.length
        if piece.design.rotation is None and self.drive == "rotation":
            self.drive = "pull"  # its case turns no body
        if before.moving and self.mechanics.hold(before.snapshot.pose) == 1.0:
            return self._let_go(before.snapshot.velocity, time)
        if before.moving:
            self._warn("swing-ended")
        self.clock.begin(None)
        self._hold()

    def _critical(self, event: dict[str, Any]) -> None:
        """What is known of the design's critical load [N]; None: of none."""
        self.critical = event["force"]

    def _drive(self, event: dict[str, Any]) -> None:
        self.drive = event["by"]
        if not self.mechanics.moving:
            self._hand_is_here(float(self.mechanics.snapshot.pose[2]))
            self._hold()

    def _rest(self, event: dict[str, Any]) -> None:
        """The markers, as they are seen now, are those of the pivot at rest."""
        if self.marker is None or self.sight["state"] == "lost":
            self._warn("no-rest")
        else:
            self._at_rest = self.marker
            self.mechanics.placed(self.marker)
            self._reset(event)


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
