"""Whether two states lie on one path: the energy gained between them against the work done."""

from __future__ import annotations

import numpy as np

from spline_model.continuation.point import NOT_TRACKED, Point

WORK_MISMATCH = 0.02
"""Largest difference between the potential gained in a step and the integral of its rate, over
the larger of both. On one branch the rule below errs with the fifth power of the step: 0.1 %
for a quarter turn at once; between branches they differ by their own size."""
ROUND_OFF = 1e-10
"""Energy differences below this are round-off, in EI/L and in the stored energy."""

NODES, WEIGHTS = (np.polynomial.legendre.leggauss(4)[i] / 2 for i in range(2))
NODES = NODES + 0.5


def jumped(before: Point, after: Point, step: float, unit: float) -> str:
    """Why ``after`` is not reached from ``before`` along a path; empty if it may be.

    step: length of the step in the path's parameter; unit: EI/L [J]. int P_lambda d(lambda) is
    integrated with both factors as cubic Hermite polynomials of the parameter, from the end
    values and slopes: exact to the fourth power of the step.
    """
    if after.inertia == NOT_TRACKED:
        return ""
    parts = _parts(before, after, step)
    done = float(WEIGHTS @ parts)
    gained = after.potential - before.potential
    scale = max(abs(gained), float(WEIGHTS @ np.abs(parts)))
    floor = ROUND_OFF * (unit + sum(map(abs, after.energies)))
    if abs(gained - done) > WORK_MISMATCH * scale + floor:
        return "the state lies on another branch (energy gained and work done differ)"
    return ""


def done_by_load_factor(before: Point, after: Point, step: float) -> float:
    """int P_lambda d(lambda) between two states of one path [J]."""
    return float(WEIGHTS @ _parts(before, after, step))


def _parts(before: Point, after: Point, step: float) -> np.ndarray:
    """The integrand at the nodes of the unit interval."""
    a, b = before, after
    conjugate = _cubic(a.conjugate, b.conjugate, step * a.conjugate_rate, step * b.conjugate_rate)
    return np.asarray(conjugate * _cubic_slope(a.load_factor, b.load_factor, step * a.slope, step * b.slope))


def _cubic(a: float, b: float, slope_a: float, slope_b: float) -> np.ndarray:
    """Hermite's cubic on the unit interval at the nodes."""
    t = NODES
    value = a * (1 + 2 * t) * (1 - t) ** 2 + b * t**2 * (3 - 2 * t)
    return np.asarray(value + slope_a * t * (1 - t) ** 2 - slope_b * t**2 * (1 - t))


def _cubic_slope(a: float, b: float, slope_a: float, slope_b: float) -> np.ndarray:
    """Its derivative at the nodes."""
    t = NODES
    value = 6 * t * (1 - t) * (b - a)
    return np.asarray(value + slope_a * (1 - t) * (1 - 3 * t) - slope_b * t * (2 - 3 * t))
