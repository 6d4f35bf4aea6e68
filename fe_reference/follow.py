"""From a request (what is driven, what is loaded) to the states of a path."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .control import Control
from .effects.loads import DeadLoad, applied, together
from .errors import ConvergenceError
from .limit import limit_point
from .path import Path
from .solution import Status
from .structure import Structure

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
COUNTERS = (
    "increments",
    "halvings",
    "newton_iterations",
    "residual_evaluations",
    "tangent_evaluations",
    "factorisations",
)


def spans(
    structure: Structure,
    *,
    body: int | None = None,
    rotations: Sequence[float] | None = None,
    displacement: Sequence[float] | None = None,
    load: DeadLoad | None = None,
    watched: int | None = None,
) -> list[Control]:
    """Return the spans of a path on which a body is led through `rotations` [rad], one leg each.

    The displacement [m] of the body's centre and the load grow with the load factor over all legs.
    """
    ends = [0.0, *rotations] if rotations is not None else [0.0, 0.0]
    at = structure.body_slice(0 if body is None else body).start
    held = [] if displacement is None else [at, at + 1]
    held += [at + 2] if rotations is not None else []
    legs = len(ends) - 1

    def values(leg: int) -> list[float]:
        place = [] if displacement is None else [leg / legs * part for part in displacement]
        return place + ([ends[leg]] if rotations is not None else [])

    return [
        Control(
            structure=structure,
            held=np.array(held, dtype=np.int64),
            values=np.array([values(leg), values(leg + 1)]),
            span=(leg / legs, (leg + 1) / legs),
            load=load,
            watched=watched,
        )
        for leg in range(legs)
    ]


def follow(controls: Sequence[Control], increments: int, progress: Progress | None = None) -> Path:
    """Settle under gravity and natural strains, then walk through the spans as far as they can be reached."""
    path = _settled(controls[0], increments)
    total = increments * len(controls)
    for leg, control in enumerate(controls):
        if path.message:
            break
        if leg:
            path.turn_to(control)
        for k in range(1, increments + 1):
            if not advanced(path, (leg * increments + k) / total):
                break
            if progress is not None:
                progress(leg * increments + k, total)
    return path


def advanced(path: Path, target: float) -> bool:
    """Go on to a target; if it is not reached, keep the limit point that is in the way."""
    if path.advance(target):
        return True
    limit = limit_point(path, target)
    path.critical += [] if limit is None else [limit]
    return False


def _settled(control: Control, increments: int) -> Path:
    """Return a path at its first state: rest, or the equilibrium under gravity and natural strains.

    If that cannot be reached, the path holds the shape at rest and says why.
    """
    path = Path(control=control)
    if not control.structure.constant_effects:
        path.begin()
        return path
    values = np.stack([control.values[0]] * 2)
    settling = Control(structure=control.structure, held=control.held, values=values, settling=True)
    before = Path(control=settling)
    before.begin()
    reached = all(advanced(before, k / increments) for k in range(1, increments + 1))
    path.counters = before.counters
    path.counters["settling_increments"] = path.counters.pop("increments", 0)
    path.begin(before.states[-1].y if reached else None)
    path.message, path.failures, path.critical = before.message, before.failures, before.critical
    return path


def full_load(structure: Structure) -> DeadLoad | None:
    """Return all named loads at load factor 1 as one."""
    return together([load for load, _ in applied(structure)])


def load_factors(path: Path, total: int) -> Array:
    """Return the load factor of the states (S,)."""
    return np.arange(len(path.states)) / total


def checked(solution: Any, path: Path, raise_on_failure: bool) -> Any:
    """Return the solution, or raise if its path ended early."""
    if solution.status is not Status.CONVERGED and raise_on_failure:
        raise ConvergenceError(
            f"{solution.message}; {solution.status.text}",
            solution=solution,
            load_factor=float(solution.load_factor[-1]),
            history=tuple(path.failures),
        )
    return solution
