"""Newton's method to the equilibrium at one parameter of a path, with the consistent tangent."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .control import Balance, Control
from .matrix import Factors, Singular

Array = NDArray[np.float64]

#: Newton's iterations of one increment; from a tangent predictor a sound increment takes one to four.
ITERATIONS = 25
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) taken as equilibrium where round-off allows
#: it.
TOLERANCE = 1e-10
#: The factors at the end give one more correction, unless it is longer than this [strip lengths, rad]: then
#: it is the round-off of the residual over a stiffness that vanishes.
LAST = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What Newton's method left.

    Attributes:
        y, parameter: coordinates and where. norms: of the residuals. failure: "" or the reason.
        balance, factors: at the last iterate; no factors after a failure.
    """

    y: Array
    parameter: float
    norms: tuple[float, ...]
    failure: str
    balance: Balance
    factors: Factors | None = None


#: Changes of coordinates and parameter that correct a state, from these, the balance there and its factors.
Correct = Callable[[Array, float, Balance, Factors], tuple[Array, float]]


def at_the_parameter(y: Array, parameter: float, balance: Balance, factors: Factors) -> tuple[Array, float]:
    """Return Newton's correction with the parameter as it is."""
    return -factors.solve(balance.residual), 0.0


def equilibrate(
    control: Control,
    start: Array,
    parameter: float,
    counters: Counter[str],
    correct: Correct = at_the_parameter,
) -> Outcome:
    """Iterate from `start` to equilibrium at `parameter`, with the consistent tangent at every iteration.

    One compiled call gives residual and tangent; the factors at the equilibrium serve what is asked there.
    """
    tolerance = max(TOLERANCE, control.structure.round_off)
    y, norms = start.copy(), []
    while True:
        y[control.held] = control.prescribed(parameter)
        for counted in ("residual_evaluations", "tangent_evaluations"):
            counters[counted] += 1
        balance, factors = control.balance(y, parameter), None
        norms.append(control.unbalanced(balance.residual))
        failure = "" if np.isfinite(norms[-1]) else "the residual is not finite"
        if len(norms) > ITERATIONS and norms[-1] > tolerance:
            failure = f"no equilibrium in {ITERATIONS} iterations"
        if not failure:
            counters["factorisations"] += 1
            try:
                factors = control.factors(balance)
            except Singular as error:
                failure = str(error)
        if factors is not None and norms[-1] <= tolerance:
            last = factors.solve(balance.residual)
            y = y - last if np.abs(control.structure.measure * last).max(initial=0.0) <= LAST else y
        if factors is None or norms[-1] <= tolerance:
            return Outcome(
                y=y,
                parameter=parameter,
                norms=tuple(norms),
                failure=failure,
                balance=balance,
                factors=factors,
            )
        counters["newton_iterations"] += 1
        move, change = correct(y, parameter, balance, factors)
        y, parameter = y + move, parameter + change


def taken(control: Control, y: Array, parameter: float) -> Outcome:
    """Return coordinates that are in equilibrium as such; raises Singular."""
    balance = control.balance(y, parameter)
    factors = control.factors(balance)
    return Outcome(y=y, parameter=parameter, norms=(0.0,), failure="", balance=balance, factors=factors)
