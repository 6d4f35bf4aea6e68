"""From a request (what is driven, what is loaded) to the states of a path."""

from collections.abc import Callable, Sequence

import numpy as np

from .control import Control
from .limit import limit_point
from .path import Path

Progress = Callable[[int, int], None]
COUNTERS = (
    "increments",
    "halvings",
    "newton_iterations",
    "residual_evaluations",
    "tangent_evaluations",
    "factorisations",
)


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
