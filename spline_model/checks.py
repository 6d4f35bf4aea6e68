"""What a converged state must also satisfy before it is accepted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.paper import SPEED, clamps_of, strips_of

Array = NDArray[np.float64]

SLOWEST_SPEED = 0.1
"""Least |C'| / |C0'|: the spatial curvature has a pole at zero, and a curve that nearly stops
there is a folded parametrisation, not a strip."""
LARGEST_CORRECTION = 0.5
"""Largest distance from the predicted to the corrected state, over the length of the step: a
corrector that goes further has probably left the branch."""

SMALLEST_CORRECTION = 1e-7
"""Corrections below this, in lengths and rad, are round-off: a straight strip under its load stays put, and
the points of a Bezier strip of more than twenty are known no better. Another branch is farther away."""


def refuse(system: System, z: Array) -> str:
    """Return why a converged state z (N,) [m, rad, N] is no strip; an empty string if it is one."""
    backwards = np.flatnonzero(~(clamps_of(system).gaps(z)[1][0] > 0.0))
    if backwards.size:
        return f"the end tangent at clamp {backwards[0] + 1} points backwards"
    x, y, _, _ = strips_of(system).derivatives(z)
    slowest = float((np.hypot(x, y) / strips_of(system).along[..., SPEED]).min(initial=np.inf))
    if not slowest > SLOWEST_SPEED:
        return f"the centreline is folded: |C'| falls to {slowest:.2g} of its value at rest"
    return ""


def left_the_branch(unit: Array, previous: Array, predicted: Array, corrected: Array) -> str:
    """Return why a corrected state (N,) does not continue the previous one; an empty string if it does.

    unit (Q,): units of the coordinates [m, rad], which the states begin with.
    """
    q = slice(0, len(unit))
    step = float(np.linalg.norm((predicted[q] - previous[q]) / unit))
    correction = float(np.linalg.norm((corrected[q] - predicted[q]) / unit))
    if correction > max(LARGEST_CORRECTION * step, SMALLEST_CORRECTION):
        apart = f"{correction / step:.2g} steps" if step > 0.0 else "away"
        return f"the solution lies {apart} from the predicted one"
    return ""
