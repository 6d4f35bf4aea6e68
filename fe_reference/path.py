"""Following an equilibrium path: predictor, Newton, a check of every state, halved increments on failure.

The predictor is the tangent of the path, with the curvature of the path seen over the increment before:

    y(p + h) = y + h y' + h^2/2 (y' - y'_before) / (p - p_before)

On fine meshes the second term matters: nodes moved along straight lines stretch every element by h^2/2.
"""

from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidParameter
from .newton import Control, Outcome, equilibrate

Array = NDArray[np.float64]

#: An increment is halved at most so often: 20 increments of 90 deg go down to 0.07 deg.
HALVINGS = 6
#: Relative mismatch between the energy gained in an increment and the work done on it above which the
#: increment has jumped to another branch; on one branch the two-point Hermite rule below errs by less than 1
#: % in any sane increment.
WORK_MISMATCH = 0.05
#: Largest turn of an element's end from its chord [rad]: beyond a quarter turn the element is folded, not
#: bent.
DISTORTION = 0.5 * np.pi


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """A state in equilibrium.

    Attributes:
        parameter: p. y: reduced coordinates (size,).
        rate, bend: first and second derivative of y in p (size,), the second by the difference over the
            increment before (zero at the first state).
        energy: strain energy [J].
        conjugate: what does work with p: the driving torque [N m], or the work of the unit load F.y [J].
        slope: d conjugate / d p from the tangent.
        torque, stiffness: generalised force on the rotation [N m] and its derivative [N m/rad], all else
            free.
        norms: residual norms of the iteration that led here.
    """

    parameter: float
    y: Array
    rate: Array
    bend: Array
    energy: float
    conjugate: float
    slope: float
    torque: float
    stiffness: float
    norms: tuple[float, ...]


@dataclass(kw_only=True, eq=False)
class Path:
    """The states of one path, and how hard they were to reach."""

    control: Control
    states: list[State] = field(default_factory=list)
    counters: Counter[str] = field(default_factory=Counter)
    failures: list[tuple[float, ...]] = field(default_factory=list)
    message: str = ""

    def begin(self) -> None:
        """Put down the unloaded state."""
        rest = np.zeros(self.control.structure.size)
        try:
            self.states.append(self._state(rest, 0.0, (0.0,), None))
        except RuntimeError as error:
            raise InvalidParameter(
                "strips", "a model that can move freely", "clamps that hold it [1]"
            ) from error

    def advance(self, target: float) -> bool:
        """Go from the last state to `target` in one increment or in halved ones, and keep its end."""
        reached = self._reach(self.states[-1], target, 0)
        if reached is None:
            return False
        self.states.append(reached)
        self.counters["increments"] += 1
        return True

    def _reach(self, state: State, target: float, depth: int) -> State | None:
        step = target - state.parameter
        guess = state.y + step * state.rate + 0.5 * step**2 * state.bend
        outcome = equilibrate(self.control, guess, target, self.counters)
        failure = outcome.failure
        if not failure:
            try:
                reached = self._state(outcome.y, target, outcome.norms, state)
            except RuntimeError:
                failure = "the tangent is singular"
            else:
                failure = self._doubt(state, reached)
                if not failure:
                    return reached
        self.failures.append(outcome.norms)
        if depth == HALVINGS:
            self.message = self._stopped(failure, state.parameter, target, outcome)
            return None
        self.counters["halvings"] += 1
        middle = self._reach(state, 0.5 * (state.parameter + target), depth + 1)
        return None if middle is None else self._reach(middle, target, depth + 1)

    def _stopped(self, failure: str, begin: float, target: float, outcome: Outcome) -> str:
        what = "rotation [rad]" if self.control.driven else "load factor"
        return (
            f"{failure} between {what} {begin:.6g} and {target:.6g}"
            f" after {HALVINGS} halvings of the increment; last residual {outcome.norms[-1]:.3g}"
        )

    def _state(self, y: Array, parameter: float, norms: tuple[float, ...], before: State | None) -> State:
        """Complete a converged state by its tangent: path rate, torque and stiffness."""
        structure, control, counters = self.control.structure, self.control, self.counters
        force, tangent = structure.internal_force(y), structure.tangent_stiffness(y)
        counters["residual_evaluations"] += 1
        counters["tangent_evaluations"] += 1
        rate = control.rate(tangent, counters)
        if control.driven:
            # What is left of the residual is carried to the torque by the same solve: to first order the
            # torque is that of exact equilibrium, free of the round-off in the last elements' forces.
            torque = float(force[-1] + force[:-1] @ rate[:-1])
            stiffness = float(rate @ (tangent @ rate))  # errors of the solve enter squared
            conjugate, slope = torque, stiffness
        else:
            torque, stiffness = float(force[-1]), 1.0 / control.turn_rate(tangent, counters)
            conjugate, slope = float(control.load @ y), float(control.load @ rate)
        step = 0.0 if before is None else parameter - before.parameter
        bend = np.zeros_like(y) if before is None or step == 0.0 else (rate - before.rate) / step
        return State(
            parameter=parameter,
            y=y,
            rate=rate,
            bend=bend,
            energy=sum(structure.energies(y)),
            conjugate=conjugate,
            slope=slope,
            torque=torque,
            stiffness=stiffness,
            norms=norms,
        )

    def _doubt(self, before: State, after: State) -> str:
        """Return why a converged state is not believed, or ""."""
        structure = self.control.structure
        if structure.law.distortion(structure.element_displacement(after.y)) > DISTORTION:
            return "an element is folded"
        step, gained = after.parameter - before.parameter, after.energy - before.energy
        mean = 0.5 * step * (before.conjugate + after.conjugate)
        work = mean + step**2 / 12.0 * (before.slope - after.slope)
        if not self.control.driven:  # integral of p dq = [p q] - integral of q dp
            work = after.parameter * after.conjugate - before.parameter * before.conjugate - work
        scale = max(abs(gained), 0.5 * abs(step) * (abs(before.conjugate) + abs(after.conjugate)))
        if abs(gained - work) > WORK_MISMATCH * scale:
            return "the state lies on another branch (energy gained and work done differ)"
        return ""
