"""From a request (what is driven, what is loaded) to the states of a path.

Where a path ends for want of an equilibrium, the limit point beyond its last state is looked for.
"""

from collections.abc import Callable, Sequence
from itertools import islice

import numpy as np

from .arc_length import Stride, Walk
from .control import Control, taken
from .critical import bodies_stand, point
from .matrix import Singular
from .path import Path
from .solution import CriticalPoint

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


#: First and longest step of the search, in strip lengths and rad, and how many there may be.
FIRST, LONGEST, MOST = 1e-3, 0.05, 60
#: A limit point is what stopped the path if it lies within this part of it.
NEAR = 1e-2


def limit_point(path: Path, toward: float) -> CriticalPoint | None:
    """Return the limit point that a path ran into on its way to a parameter, or None if there is none.

    The path is followed in its arc length from the last good state until the parameter turns back.
    """
    last = path.last
    walk = Walk(control=path.control, counters=path.counters)
    along = (np.zeros_like(last.y), toward - last.parameter)
    try:
        here = walk.place(taken(path.control, last.y, last.parameter), along)
    except Singular:
        return None
    for stride in islice(walk.onward(here, FIRST, LONGEST), MOST):
        if stride.turned:
            return _turned(walk, stride)
        if abs(stride.end.found.parameter - last.parameter) > NEAR:
            return None
    return None


def _turned(walk: Walk, stride: Stride) -> CriticalPoint:
    """Return the limit point within a step; the path goes on there along its tangent, at the same load."""
    control = walk.control
    at = walk.before(stride, lambda place: place.slope * stride.begin.slope > 0.0)
    driven = control.watched is not None and control.watched in control.held
    kind = "turning point" if driven else "limit point"
    strips = bodies_stand(control, at.rate)
    what = "the strips buckle" if strips else "the strips give way with the body"
    return point(control, kind, at.found.y, at.found.parameter, at.response.inertia + 1, f"{kind}: {what}")
