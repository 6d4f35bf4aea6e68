"""The checks of an accepted state on the fast path, and its inertia."""

from __future__ import annotations

import math

from spline_model.continuation.balance import ROUND_OFF, WORK_MISMATCH
from spline_model.continuation.resolution import SMALLEST_MOMENT
from spline_model.strip.compiled import part


@part()
def inertia(body, out):
    """Negative eigenvalues of the reduced tangent, the rotation held.

    Those of the strips' pivots, out[3], and of what their condensation leaves of the body's
    place: inertias of a block and of its Schur complement add up (Haynsworth 1968).
    """
    determinant = body[0, 0] * body[1, 1] - body[0, 1] ** 2
    negative = int(out[3])
    if determinant < 0.0:
        return negative + 1
    return negative + 2 if body[0, 0] + body[1, 1] < 0.0 else negative


@part()
def jumped(step, torque0, torque1, stiffness0, stiffness1, gained, stored, frame):
    """Whether energy gained and work done differ over a step: ``continuation.balance.jumped``."""
    done = 0.5 * step * (torque0 + torque1) + step * step / 12.0 * (stiffness0 - stiffness1)
    scale = max(abs(gained), 0.5 * abs(step) * (abs(torque0) + abs(torque1)))
    unit = frame.rigidity[0] / frame.length[0]
    return abs(gained - done) > WORK_MISMATCH * scale + ROUND_OFF * (unit + abs(stored))


@part()
def defect(wrong, bending, frame):
    """The moment defect (``continuation.resolution``) from the energies of defect and bending."""
    unit = 0.0
    for s in range(frame.length.size):
        unit = max(unit, frame.rigidity[s] / frame.length[s])
    return math.sqrt(wrong / (2.0 * bending + SMALLEST_MOMENT**2 * unit))


@part()
def strip_defect(local, basis, weight):
    """int (M - M_b)^2 du of a strip that was just condensed, in EI/L.

    The balance starts from the force and moment at the tip, which are the tip's rows of g.
    """
    points, lever, turning, g = local.points, local.lever, local.turning, local.g
    last, own = points.shape[0] - 1, g.size - 3
    for i in range(last + 1):  # about the control points: linear in the place, as the curve is in them
        lever[i] = (points[last, 0] - points[i, 0]) * g[own + 1]
        lever[i] += g[own + 2] - (points[last, 1] - points[i, 1]) * g[own]
    wrong = 0.0
    for p in range(weight.size):
        left = turning[p]
        for i in range(last + 1):
            left -= basis[p, i] * lever[i]
        wrong += weight[p] * left * left
    return wrong
