"""Following an equilibrium path in its arc length: through limit points, and where the critical ones are.

Unknowns are the free coordinates y and the parameter p; lengths count in the longest strip, turns in rad and
p as it is. A step is predicted along the tangent and brought back to equilibrium on the plane across it, by
two solves with the same factors: K a = -r, K b = -dr/dp.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from .arrays import Array
from .control import Balance, Control, Outcome, equilibrate
from .errors import ConvergenceError, InvalidParameter, count
from .matrix import Factors
from .response import State, respond

#: Longest step, shortest part of the first one, and how many there may be.
LONGEST, SHORTEST, MOST = 0.5, 2.0**-14, 2000
#: Least cosine between the tangents at both ends of a step, and longest correction over the step.
SHARPEST, FARTHEST = 0.5, 0.5
#: As in `path`; steps of the arc length are longer where the parameter hardly moves.
WORK_MISMATCH, ROUND_OFF = 0.05, 1e-10
#: Iterations up to which the next step is longer.
EASY = 4
#: Halvings of a step in which a critical point lies.
BISECTIONS = 22


@dataclass(frozen=True, kw_only=True, eq=False)
class _Stride:
    """A step of a path between two states: its length, and the bend (size,) of the path at its beginning."""

    begin: State
    end: State
    length: float
    bend: Array

    @property
    def turned(self) -> bool:
        """Whether the parameter goes the other way at the end."""
        return self.begin.pace * self.end.pace < 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class _Critical:
    """A critical point of a path.

    kind: "limit point" of p or of the watched torque, "turning point" of a drive, else "bifurcation".
    """

    kind: str
    parameter: float
    y: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class ArcPath:
    """States of a path and its critical points in order."""

    states: tuple[State, ...]
    critical: tuple[_Critical, ...] = ()

    @property
    def message(self) -> str:
        """What is to be said of the path: where it is critical, and whether it ends unstable; else ""."""
        told = [f"{point.kind} at load factor {point.parameter:.4g}" for point in self.critical]
        return "; ".join([*told, *(["the last state is unstable"] if self.states[-1].inertia else [])])


@dataclass(kw_only=True, eq=False)
class Walk:
    """A path while it is followed."""

    control: Control
    counters: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.weight = self.control.structure.measure

    def product(self, a: tuple[Array, float], b: tuple[Array, float]) -> float:
        """Return the inner product of two changes of (y, p)."""
        return float((self.weight * a[0]) @ (self.weight * b[0])) + a[1] * b[1]

    def push(self, parameter: float, y: Array, balance: Balance) -> Array:
        """Return dr/dp (size,), the held coordinates going with p."""
        rate = np.zeros(len(y))
        rate[self.control.held] = self.control.slope
        change, load = balance.at.tangent.times(rate), self.control.rates(y, parameter, 0.0)[0]
        return change if load is None else change + load

    def place(self, found: Outcome, along: tuple[Array, float]) -> State:
        """Complete a state in equilibrium; the tangent goes with `along`; raises Singular."""
        state = respond(self.control, found)
        size = np.sqrt(self.product((state.rate, 1.0), (state.rate, 1.0)))
        return replace(state, pace=float(np.copysign(1.0 / size, self.product((state.rate, 1.0), along))))

    def step(self, here: State, length: float, bend: Array) -> tuple[State | None, int]:
        """Return the state on the plane at `length` along the tangent, or None, and the iterations."""
        control, normal = self.control, _tangent(here)
        y = here.y + length * normal[0] + 0.5 * length**2 * bend
        parameter = here.parameter + length * here.pace
        start = (y.copy(), parameter)

        def correct(y: Array, parameter: float, balance: Balance, factors: Factors) -> tuple[Array, float]:
            a, b = factors.solve(-np.stack([balance.residual, self.push(parameter, y, balance)]))
            b[control.held] = control.slope
            off = self.product((y - start[0], parameter - start[1]), normal)
            change = -(off + self.product((a, 0.0), normal)) / self.product((b, 1.0), normal)
            return a + change * b, change

        found = equilibrate(control, y, parameter, self.counters, correct)
        iterations, away = len(found.norms) - 1, (found.y - start[0], found.parameter - start[1])
        if found.factors is None or np.sqrt(self.product(away, away)) > FARTHEST * abs(length):
            return None, iterations
        there = self.place(found, normal)
        sound = self.product(_tangent(there), normal) >= SHARPEST and self.balanced(here, there)
        return (there if sound else None), iterations

    def onward(self, here: State, length: float, longest: float = LONGEST) -> Iterator[_Stride]:
        """Yield the steps from a state on, the first of a length; it ends where they become too short."""
        shortest, bend = SHORTEST * length, np.zeros_like(here.rate)
        while length > shortest:
            there, iterations = self.step(here, length, bend)
            if there is None:
                length /= 2.0
                continue
            yield _Stride(begin=here, end=there, length=length, bend=bend)
            bend, here = (_tangent(there)[0] - _tangent(here)[0]) / length, there
            length = min(1.5 * length, longest) if iterations <= EASY else length

    def before(self, stride: _Stride, holds: Callable[[State], bool]) -> State:
        """Return the last state of a step for which something holds, by bisection."""
        low, high, best = 0.0, stride.length, stride.begin
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            state, _ = self.step(stride.begin, middle, stride.bend)
            if state is None:
                break
            if holds(state):
                low, best = middle, state
            else:
                high = middle
        return best

    def balanced(self, one: State, other: State) -> bool:
        """Return whether the potential gained is what its rate gives along a path between two states."""
        moved = (other.y - one.y, other.parameter - one.parameter)
        ends = (0.0, np.sqrt(self.product(moved, moved)))
        p, pace = [one.parameter, other.parameter], [one.pace, other.pace]
        conjugate, bend = [one.conjugate, other.conjugate], [at.pace * at.slope for at in (one, other)]
        nodes, weights = np.polynomial.legendre.leggauss(4)
        s = 0.5 * ends[1] * (nodes + 1.0)
        rate = CubicHermiteSpline(ends, p, pace)(s, 1) * CubicHermiteSpline(ends, conjugate, bend)(s)
        done, gained = 0.5 * ends[1] * float(weights @ rate), other.balance.potential - one.balance.potential
        scale = max(abs(gained), 0.5 * ends[1] * float(weights @ np.abs(rate)))
        unit = self.control.structure.moment_unit + abs(other.balance.potential)
        return bool(abs(gained - done) <= WORK_MISMATCH * scale + ROUND_OFF * unit)


def _tangent(at: State) -> tuple[Array, float]:
    """Return the tangent (dy/ds, dp/ds) of a path at a state."""
    return at.pace * at.rate, at.pace


def follow_arc(control: Control, *, increments: int = 20) -> ArcPath:
    """Return the path from rest to the end of the control's span in p, however p goes up and down on the way.

    Args:
        control: what is held, driven and loaded. increments: the first step takes that part of the span.

    Raises:
        ConvergenceError: the end was not reached; InvalidParameter: fewer than one increment.
    """
    walk, end = Walk(control=control), control.span[1]
    first = equilibrate(control, np.zeros(control.structure.size), control.span[0], walk.counters)
    if first.failure:
        raise InvalidParameter("control", first.failure, "a scene at rest at its beginning [1]")
    here = walk.place(first, (np.zeros_like(first.y), end - control.span[0]))
    length = abs(end - control.span[0]) / count("increments", increments) / abs(here.pace)
    states, critical, reached = [here], list[_Critical](), False
    for stride in islice(walk.onward(here, min(length, LONGEST)), MOST):
        critical += _critical(walk, stride)
        reached = (stride.end.parameter - end) * (stride.begin.parameter - end) <= 0.0
        states.append(_last(walk, stride) if reached else stride.end)
        if reached:
            break
    path = ArcPath(states=tuple(states), critical=tuple(critical))
    if reached:
        return path
    last = states[-1].parameter
    message = f"p = {end:g} is not reached from {last:.6g}"
    raise ConvergenceError(message, solution=path, load_factor=last, history=())


def _critical(walk: Walk, stride: _Stride) -> Iterator[_Critical]:
    """Yield the critical points of a step."""
    inertia, stiff = stride.begin.inertia, stride.begin.stiffness
    if inertia != stride.end.inertia:
        turn = "limit point" if walk.control.watched is None else "turning point"
        at = walk.before(stride, lambda state: state.inertia == inertia)
        yield _Critical(kind=turn if stride.turned else "bifurcation", parameter=at.parameter, y=at.y)
    if stiff * stride.end.stiffness < 0.0 and not stride.turned:
        at = walk.before(stride, lambda state: state.stiffness * stiff > 0.0)
        yield _Critical(kind="limit point", parameter=at.parameter, y=at.y)


def _last(walk: Walk, stride: _Stride) -> State:
    """Return the state at the end of the span, between those of a step."""
    end, one, other = walk.control.span[1], stride.begin, stride.end
    share = (end - one.parameter) / (other.parameter - one.parameter)
    outcome = equilibrate(walk.control, one.y + share * (other.y - one.y), end, walk.counters)
    if outcome.factors is None:
        return replace(other, parameter=end, y=np.full_like(other.y, np.nan))
    return walk.place(outcome, _tangent(other))
