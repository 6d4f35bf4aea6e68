"""Following an equilibrium path: predictor, Newton, a check of every state, halved increments on failure.

An increment at which the number of negative eigenvalues changes is halved like one that fails, until the
change goes away (it was another branch, or a sharp bend of this one) or until it is within so small a part of
the path that the two states beside it are one: a critical point.

The predictor is the tangent of the path, with the curvature of the path seen over the increment before:

    y(p + h) = y + h y' + h^2/2 (y' - y'_before) / (p - p_before)

On fine meshes the second term matters: nodes moved along straight lines stretch every element by h^2/2.
"""

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .control import Control, Response, respond
from .critical import critical_point, extremes
from .errors import InvalidParameter
from .newton import Outcome, equilibrate
from .solution import CriticalPoint

Array = NDArray[np.float64]

#: An increment is halved at least so often before it is given up, and until it is this part of the path.
HALVINGS, SMALLEST = 6, 2.0**-20
#: Largest distance of two states that are taken for one, in strip lengths and rad. Another branch is farther
#: away; closer, the round-off of residuals over a stiffness that vanishes at a critical point would be seen.
APART = 1e-4
#: Distance of a state from where the mean of the rates at both ends of the increment leads, over what the
#: increment moved, above which it has jumped. Increments of 45 deg of a pivot stay below 0.04, most jumps are
#: at 1.
OFF_THE_PATH = 0.1
#: Change of the rates over an increment, over its chord, above which it is too long to tell. Increments of
#: 45 deg of a pivot stay below 0.6; a parabola that begins without a slope has 2.
SHARPEST = 1.0
#: Relative mismatch between the total potential gained in an increment and the integral of its rate above
#: which the increment has jumped to another branch; on one branch the two-point Hermite rule below errs by
#: less than 1 % in any sane increment. Energies are told apart down to the round-off of EI/L and of the
#: energy of natural strains, which may cancel along the whole path.
WORK_MISMATCH = 0.01
ROUND_OFF = 1e-10
#: Largest turn of an element's end from its chord [rad]: beyond a quarter turn the element is folded, not
#: bent.
DISTORTION = 0.5 * np.pi


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """A state in equilibrium.

    Attributes:
        parameter: p. y: reduced coordinates (size,).
        response: its derivatives along the path, torque and stiffness.
        bend: second derivative of y in p (size,), by the difference of the first over the increment before
            (zero at the first state).
        potential: total potential [J].
        work: of loads and drives since the first state [J].
        norms: residual norms of the iteration that led here.
    """

    parameter: float
    y: Array
    response: Response
    bend: Array
    potential: float
    work: float
    norms: tuple[float, ...]


@dataclass(kw_only=True, eq=False)
class Path:
    """The states of one path, and how hard they were to reach.

    last: the last good state of a path that stopped. critical: the critical points that were passed.
    """

    control: Control
    states: list[State] = field(default_factory=list)
    counters: Counter[str] = field(default_factory=Counter)
    failures: list[tuple[float, ...]] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    message: str = ""
    last: State = field(init=False)

    def begin(self, y: Array | None = None) -> None:
        """Put down the first state: rest, or coordinates in equilibrium (size,)."""
        y = np.zeros(self.control.structure.size) if y is None else y
        try:
            self.states.append(self._state(y, self.control.span[0], (0.0,), None))
        except RuntimeError as error:
            raise InvalidParameter(
                "strips", "a model that can move freely", "clamps that hold it [1]"
            ) from error

    def turn_to(self, control: Control) -> None:
        """Go on from the last state in the next span."""
        last = self.states[-1]
        self.control = control
        there = self._state(last.y, last.parameter, last.norms, None)
        self.states[-1] = replace(there, work=last.work)

    def advance(self, target: float) -> bool:
        """Go from the last state to `target` in one increment or in halved ones, and keep its end."""
        reached = self._reach(self.states[-1], target, 0)
        if reached is None:
            return False
        self.states.append(reached)
        self.counters["increments"] += 1
        return True

    def remark(self) -> str:
        """Return what is to be said of the path: its critical points, why it ended early; else ""."""
        told = [point.text for point in self.critical if point.text]
        told += [self.message] if self.message else []
        if self.states[-1].response.inertia:
            told.append("the last state is unstable")
        return "; ".join(told)

    def _reach(self, state: State, target: float, depth: int) -> State | None:
        step = target - state.parameter
        guess = state.y + step * state.response.rate + 0.5 * step**2 * state.bend
        outcome = equilibrate(self.control, guess, target, self.counters)
        failure = outcome.failure
        if not failure:
            try:
                reached = self._state(outcome.y, target, outcome.norms, state)
            except RuntimeError:
                failure = "the tangent is singular"
            else:
                failure = self._doubt(state, reached) or self._judged(state, reached)
                if not failure:
                    self.critical += extremes(self.control, state, reached)
                    return reached
        self.failures.append(outcome.norms)
        if depth >= HALVINGS and abs(step) <= SMALLEST:
            self.last = state
            self.message = self._stopped(failure, state.parameter, target, depth, outcome)
            return None
        self.counters["halvings"] += 1
        middle = self._reach(state, 0.5 * (state.parameter + target), depth + 1)
        return None if middle is None else self._reach(middle, target, depth + 1)

    def _judged(self, before: State, after: State) -> str:
        """Return why a state is not on the branch of the one before, or ""; keep a critical point of them.

        States that are taken for one are on one branch, whatever the rates at the point between them are.
        """
        step, moved = after.parameter - before.parameter, after.y - before.y
        crossed = before.response.inertia != after.response.inertia
        if crossed and abs(step) > SMALLEST:
            return "the stability changes"
        first, last = step * before.response.rate, step * after.response.rate
        size = self._size(moved)
        off = self._size(moved - 0.5 * (first + last)) > OFF_THE_PATH * size
        one = abs(step) <= SMALLEST and size <= APART
        if not one and (off or self._size(last - first) > SHARPEST * size):
            return "the state lies on another branch (it is not where the path leads)"
        if crossed:
            self.critical.append(critical_point(self.control, before, after))
        return ""

    def _size(self, change: Array) -> float:
        """Return the largest component of a change of the coordinates, in strip lengths and rad."""
        return float(np.abs(self.control.structure.measure * change).max(initial=0.0))

    def _stopped(self, failure: str, begin: float, target: float, depth: int, outcome: Outcome) -> str:
        return (
            f"{failure} between {self.control.describe(begin)} and {self.control.describe(target)}"
            f" after {depth} halvings of the increment; last residual {outcome.norms[-1]:.3g}"
        )

    def _state(self, y: Array, parameter: float, norms: tuple[float, ...], before: State | None) -> State:
        """Complete a converged state by its response, curvature of the path, potential and work."""
        response = respond(self.control, y, parameter, self.counters)
        step = 0.0 if before is None else parameter - before.parameter
        bend, work = np.zeros_like(y), 0.0
        if before is not None and step != 0.0:
            bend = (response.rate - before.response.rate) / step
            # loads p F.q: their work is [p F.q] less the integral of F.q, which is part of the conjugate
            gain = parameter * self.control.load_work(y) - before.parameter * self.control.load_work(before.y)
            work = before.work + gain + _integral(step, before.response, response)
        return State(
            parameter=parameter,
            y=y,
            response=response,
            bend=bend,
            potential=self.control.potential(y, parameter),
            work=work,
            norms=norms,
        )

    def _doubt(self, before: State, after: State) -> str:
        """Return why a converged state is not believed, or ""."""
        structure = self.control.structure
        if structure.law.distortion(structure.element_displacement(after.y)) > DISTORTION:
            return "an element is folded"
        step, gained = after.parameter - before.parameter, after.potential - before.potential
        integral = _integral(step, before.response, after.response)
        largest = abs(before.response.conjugate) + abs(after.response.conjugate)
        unit = structure.moment_unit + abs(self.control.potential_rate(after.y, after.parameter)[1])
        scale = max(abs(gained), 0.5 * abs(step) * largest)
        if abs(gained - integral) > WORK_MISMATCH * scale + ROUND_OFF * unit:
            return "the state lies on another branch (energy gained and work done differ)"
        return ""


def _integral(step: float, before: Response, after: Response) -> float:
    """Return the integral of the conjugate over a step [J] by Hermite's two-point rule, of fourth order."""
    mean = 0.5 * step * (before.conjugate + after.conjugate)
    return mean + step**2 / 12.0 * (before.slope - after.slope)
