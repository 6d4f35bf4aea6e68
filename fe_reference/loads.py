"""Loads, and drives of a motion: what leads which coordinates of a body, when and how fast.

Loads are forces and moments on bodies and at free ends, with their histories. A dead force F at an offset o
from the point that its body is reduced about has the potential -F.(d + (R - 1) o), and so a moment and a
stiffness that depend on the turn. A follower R F has no potential: its tangent is the product -R' F (x) 1 of
its rate in the turn and the turn's unit vector, which is not symmetric.

Histories are linear between their instants, so that a motion falls into spans on which every led coordinate
goes at a constant rate. Held like that they need no multiplier: the body is reduced about the point that is
led (`mass.about_mass_centre`), the led rows have no equation of motion, and what resists them is what the
drive exerts. At the beginning of a span velocities change at once, by impulses of the drives alone.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Annotated

import numpy as np

from .arrays import Array, Flags, rotation_matrix
from .errors import Checked, History, InvalidParameter, finite, read_history
from .loading import ALWAYS_FULL, AppliedForce, BodyLoad, TipForce, factor_of
from .mass import RigidBodies
from .matrix import Symmetric, Unsymmetric
from .mesh import swept, turned
from .model import Model
from .places import prescribed, twice
from .structure import Evaluation, Structure


@dataclass(frozen=True, kw_only=True, eq=False)
class Pull:
    """A load on one body or node.

    Attributes:
        target: index of the body, or the node i as -1 - i.
        row (5,): force x, y [N], moment [N m], and the offset of the point from the body's point [m].
        history: instants [s] and factors. follows: whether the force turns with its target.
    """

    target: int
    row: Array
    history: History
    follows: bool


def applied(structure: Structure) -> list[Pull]:
    """Return the named loads of a scene: at free ends, and on bodies."""
    pulls, model = [], structure.model
    for tip in model.effects.every(TipForce):
        node = (model.strip_index(tip.strip) + 1) * structure.stations - 1
        row = np.array([*tip.force, tip.moment, 0.0, 0.0])
        pulls.append(Pull(target=-1 - node, row=row, history=tip.history, follows=tip.follower))
    for load in model.effects.every(BodyLoad):
        k = model.body_index(load.body)
        force, moment = getattr(load, "force", (0.0, 0.0)), getattr(load, "moment", 0.0)
        place, follows = getattr(load, "at", None), getattr(load, "follower", False)
        place = model.bodies[k].centre if place is None else np.array(place)
        row = np.array([*force, moment, *(place - structure.points[k])])
        pulls.append(Pull(target=k, row=row, history=load.history, follows=follows))
    return pulls


@dataclass(frozen=True, kw_only=True, eq=False)
class Load:
    """All loads together as a function of the coordinates.

    Attributes:
        constant (size,): the part that does not depend on the coordinates [N, N m].
        turning: of each force that does, first coordinate of its body or node, `Pull.row`, and whether it
            follows.
    """

    constant: Array
    turning: tuple[tuple[int, Array, bool], ...]

    @property
    def follows(self) -> bool:
        """Whether it has no potential."""
        return any(follows for _, _, follows in self.turning)

    def force(self, y: Array, followers: bool = True) -> Array:
        """Return the generalised force at coordinates (size,), with those that follow or without."""
        if not self.turning:
            return self.constant
        force = self.constant.copy()
        for at, row, follows in self.turning:
            if follows and not followers:
                continue
            pull, arm = _turned(y[at + 2], row, follows)
            force[at : at + 2] += np.multiply(follows, pull)
            force[at + 2] += arm[0] * pull[1] - arm[1] * pull[0]
        return force

    def work(self, y: Array) -> float:
        """Return the work from rest of the loads that have a potential [J]."""
        work = float(self.constant @ y)
        for at, row, follows in self.turning:
            if not follows:
                work += float(row[:2] @ swept(y[at + 2], row[3], row[4]))
        return work

    def stiffen(self, tangent: Symmetric, y: Array, share: float) -> Symmetric:
        """Return a tangent with what a share of the load adds; what of it is symmetric is added in place."""
        left, right = [], []
        for at, row, follows in self.turning:
            (x, z), arm = _turned(y[at + 2], row, follows)
            if follows:
                left.append(np.zeros(len(y)))
                right.append(np.eye(1, len(y), at + 2)[0])
                left[-1][at : at + 2] = share * z, -share * x
            else:
                tangent.data[tangent.pattern.diagonal[at + 2]] += share * (arm[0] * x + arm[1] * z)
        if not left:
            return tangent
        return Unsymmetric(tangent.pattern, tangent.data, np.array(left), np.array(right))

    def stiffened(self, at: Evaluation, structure: Structure, y: Array, share: float) -> Evaluation:
        """Return an evaluation at y with the stiffness that a share of the load adds."""
        if not self.turning:
            return at
        places = at.tangent.pattern.diagonal[structure.turns]
        before = at.tangent.data[places]
        tangent = self.stiffen(at.tangent, y, share)
        at.curvature[:, 1] += tangent.data[places] - before
        return replace(at, tangent=tangent)


def _turned(turn: float, row: Array, follows: bool) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return force [N] and arm [m] of a load on what is turned."""
    force = turned(turn, row[0], row[1]) if follows else (row[0], row[1])
    return force, turned(turn, row[3], row[4])


def full_load(structure: Structure, *, time: float | None = None) -> Load | None:
    """Return the named loads in full, or as they are at an instant [s]; None if there are none."""
    pulls = applied(structure)
    if not pulls:
        return None
    constant, turning = np.zeros(structure.size), []
    for pull in pulls:
        at = structure.first_body + 3 * pull.target
        if pull.target < 0:
            at = structure.nodal.tolist().index(3 * (-1 - pull.target))
        row = pull.row.copy()
        row[:3] *= 1.0 if time is None else factor_of(pull.history, time)
        constant[at + 2] += row[2]
        if not pull.follows:
            constant[at : at + 2] += row[:2]
        if row[:2].any() and (pull.follows or row[3:].any()):
            turning.append((at, row, pull.follows))
    return Load(constant=constant, turning=tuple(turning))


def steepest(structure: Structure, inertia: Array) -> float:
    """Return what no stiffness of turns by forces off the centres exceeds, over the inertia (B,) [1/s^2]."""
    total, model = 0.0, structure.model
    for load in model.effects.every(AppliedForce):
        if load.at is not None:
            k = model.body_index(load.body)
            arm = math.hypot(*(np.array(load.at) - model.bodies[k].centre))
            total += max(abs(f) for _, f in load.history) * math.hypot(*load.force) * arm / inertia[k]
    return total


#: Instants nearer than this part of the motion are the same.
SAME = 1e-12
ALWAYS = (0.0, math.inf)


@dataclass(frozen=True, kw_only=True)
class DrivenRotation(Checked):
    """The rotation of a body prescribed as an angle times the change of a history, from the current rotation.

    A body that is re-clamped loses the velocity that the drive does not have.

    Parameters
    ----------
    body : str, default None
        None: the only one.
    angle : float, rad
    history : pairs of s and 1, default ((0, 1),)
        Times and factors of the angle.
    held : (2,) s, default (0, inf)
        Begin and end of the drive.

    Raises
    ------
    InvalidParameter
        A value outside its domain.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7.

    Examples
    --------
    >>> DrivenRotation(angle=0.1, history=((0.0, 1.0), (0.01, 0.0)), held=(0.0, 0.02)).angle
    0.1
    """

    body: str | None = None
    angle: Annotated[float, finite, "rad"]
    history: Annotated[History, read_history] = ALWAYS_FULL
    held: tuple[float, float] = ALWAYS

    def __post_init__(self) -> None:
        super().__post_init__()
        begin, end = self.held
        if not begin < end:
            raise InvalidParameter("held", self.held, "two instants, the first before the second [s]")


@dataclass(frozen=True, kw_only=True)
class Piece:
    """Equal steps [s] of a motion from an instant on [s]; `kept`: a sample is at their end."""

    time: float
    step: float
    steps: int
    kept: bool


@dataclass(frozen=True, kw_only=True)
class Span:
    """A part of a motion, `begin` to `end` [s], on which all drives go at constant rates.

    Attributes:
        rates: of coordinate k of body b, under 3 b + k [m/s, rad/s].
        begins: whether a drive takes hold at its beginning.
    """

    begin: float
    end: float
    rates: Mapping[int, float]
    begins: bool

    @property
    def led(self) -> tuple[int, ...]:
        """The bodies whose centres are led."""
        return tuple(sorted({at // 3 for at in self.rates if at % 3 < 2}))

    def held(self, structure: Structure) -> Flags:
        """Return which coordinates of a structure are led (size,)."""
        return structure.flags([structure.first_body + at for at in self.rates])

    def caught(self, structure: Structure, bodies: RigidBodies, y: Array, v: Array) -> Array:
        """Return velocities (size,) with the rates of the drives, all others as impulses of these leave them.

        The mass of a body is off the point that is led: an impulse there turns it.
        """
        after = v.copy()
        for at, rate in self.rates.items():
            after[structure.first_body + at] = rate
        for body in self.led:
            place, inertia = structure.body_slice(body), bodies.moment_of_inertia[body]
            if 3 * body + 2 not in self.rates and inertia > 0.0:
                arm = rotation_matrix(y[place][2]) @ (bodies.centre[body] - structure.points[body])
                change = (after - v)[place]
                lever = arm[0] * change[1] - arm[1] * change[0]
                after[place.stop - 1] -= bodies.mass[body] * lever / inertia
        return after

    def pieces(self, step: float, chunks: Sequence[int]) -> Iterator[Piece]:
        """Yield the pieces of a motion whose samples are `chunks` of steps [s] apart.

        Chunks within which a span begins or ends are cut there, in whole steps of their own.
        """
        close, done = SAME * step * sum(chunks), 0
        for many in chunks:
            low, high = step * done, step * (done + many)
            done += many
            begin, end = max(low, self.begin), min(high, self.end)
            if end - begin >= high - low - close:
                yield Piece(time=low, step=step, steps=many, kept=True)
            elif end - begin > close:
                steps = max(1, math.ceil((end - begin) / step * (1.0 - SAME)))
                kept = end >= high - close
                yield Piece(time=begin, step=(end - begin) / steps, steps=steps, kept=kept)


def drive_spans(model: Model, drive: DrivenRotation | None, duration: float) -> list[Span]:
    """Return the spans of a motion, in order: one where nothing is led."""
    drives: list[tuple[int, float, History, tuple[float, float]]] = []
    if drive is not None:
        turn = 3 * model.body_index(drive.body) + 2
        drives.append((turn, drive.angle, drive.history, drive.held))
    for at, (end, history) in prescribed(model, None).items():
        if history is not None:
            if drives and at == drives[0][0]:
                raise twice(model, at)
            drives.append((at, end, history, ALWAYS))
    times = {duration}
    for _, _, history, held in drives:
        times |= {*held, *(time for time, _ in history)}
    instants = [0.0]
    for time in sorted(times):
        if instants[-1] + SAME * duration < time <= duration:
            instants.append(time)
    spans: list[Span] = []
    for begin, end in pairwise([*instants[:-1], duration]):
        rates = {
            at: (factor_of(history, end) - factor_of(history, begin)) / (end - begin) * target
            for at, target, history, held in drives
            if held[0] < 0.5 * (begin + end) < held[1]
        }
        before = spans[-1].rates if spans else {}
        spans.append(Span(begin=begin, end=end, rates=rates, begins=bool(rates.keys() - before.keys())))
    return spans
