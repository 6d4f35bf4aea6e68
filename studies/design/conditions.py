"""The Karush-Kuhn-Tucker conditions at a design: what holds it back, and what each constraint costs."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from studies.design.programme import Programme
from studies.design.task import CENTRE_SHIFT, VARIABLES
from studies.kinds import Array

#: Margin below which a row is active [1].
ACTIVE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Active:
    """A constraint that holds an optimum back.

    Args:
        name: of the quantity, or of the variable at its bound.
        multiplier: of its row in the programme [1].
        price: relative change of the objective over a relative change of the limit, to first order [1].
    """

    name: str
    multiplier: float
    price: float


def conditions(programme: Programme, y: Array) -> tuple[tuple[Active, ...], float]:
    """Return the active constraints of a point y (6,) and the residual of the conditions.

    The gradient of t, which is 1, as a combination of the active rows' gradients with multipliers of at
    least zero, but for the equality's: the residual is the length of what is left over.
    """
    names, jacobian = _active(programme, y)
    equal = programme.equality_jacobian(y)[0]
    found, residual = nnls(np.column_stack([*jacobian, equal, -equal]), np.eye(6)[5])
    multipliers = [*found[:-2], found[-2] - found[-1]]
    summed: dict[str, float] = {}
    for name, multiplier in zip([*names, "stiffness"], multipliers, strict=True):
        summed[name] = summed.get(name, 0.0) + float(multiplier)
    squared = 2.0 if programme.task.objective == CENTRE_SHIFT else 1.0
    active = tuple(
        Active(name=name, multiplier=m, price=m * _per_limit(programme, y, name) / (squared * y[5]))
        for name, m in summed.items()
        if name != programme.task.objective and m != 0.0
    )
    return active, float(residual)


def _active(programme: Programme, y: Array) -> tuple[list[str], list[Array]]:
    """Return names and gradients of the rows without margin, and of the bounds that are reached."""
    rows, jacobian = programme.inequalities(y), programme.inequality_jacobian(y)
    labels = programme.row_names()
    reached = np.flatnonzero(rows < ACTIVE)
    names, gradients = [labels[i] for i in reached], list(jacobian[reached])
    for i, name in enumerate(VARIABLES):
        for end, where in ((0.0, "at its least"), (1.0, "at its most")):
            if abs(y[i] - end) < ACTIVE:
                names.append(f"{name} {where}")
                gradients.append((1.0 - 2.0 * end) * np.eye(6)[i])
    return names, gradients


def _per_limit(programme: Programme, y: Array, name: str) -> float:
    """Return d(t) over a relative change of a limit for a multiplier of one: minus the change of its row."""
    task, values = programme.task, dict(zip(VARIABLES, programme.variables(y), strict=True))
    whole = task.bounds["length"][1]
    variable, _, end = name.partition(" at its ")
    if variable in VARIABLES:
        low, high = task.bounds[variable]
        return float((low if end == "least" else -high) / (high - low))
    if name in task.limits:
        bound = task.limits[name] / programme.scale[name]
        return -2.0 * bound**2 if name == CENTRE_SHIFT else -bound
    changes: dict[str, float] = {
        "stiffness": 1.0,
        "stress": -1.0,
        "slenderness": task.least_slenderness * values["thickness"] / whole,
        "aspect": -task.largest_aspect * values["length"] / whole,
    }
    return changes[name]
