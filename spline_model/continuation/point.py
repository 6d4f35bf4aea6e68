"""A state of equilibrium on a path: how it changes along the path, how stable it is, and whether another one
lies on the same path, by the energy gained between them against the work done."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.continuation.followed import Followed, Point
from spline_model.newton import Newton

Array = NDArray[np.float64]


BLOCK = 64
"""Columns that LAPACK's symmetric factorisation takes at once."""
FASTEST = 1e13
"""Rate of an unknown, dimensionless, from which on a tangent is singular: strips of a slenderness of 1e5 have
forces of 1e11, round-off in the place of a pivot gives 1e15."""
NO_STIFFNESS = 1e-14
"""Stiffness of a driven rotation that is none, over the sum of the terms that cancel in it."""
NOT_TRACKED = -1
"""Inertia of a state of published forces, which have no potential: its tangent is not symmetric."""

WORK_MISMATCH = 0.02
"""Largest difference between the potential gained in a step and the integral of its rate, over
the larger of both. On one branch the rule below errs with the fifth power of the step: 0.1 %
for a quarter turn at once; between branches they differ by their own size."""
ROUND_OFF = 1e-10
"""Energy differences below this are round-off, in EI/L and in the stored energy."""

NODES, WEIGHTS = (np.polynomial.legendre.leggauss(4)[i] / 2 for i in range(2))
NODES = NODES + 0.5


def stand(work: Followed, z: Array, load_factor: float, energies: tuple[float, float]) -> Point:
    """Return the point of a state z (N,) that ``work`` was just evaluated at, with the load factor as
    parameter.

    energies: bending and axial [J]. One symmetric factorisation gives the rate, the turn and, by Sylvester's
    law, the inertia: of the negative eigenvalues of the bordered matrix one belongs to each axial force and
    to each constraint, the rest to the reduced tangent. With followers it is the sign of the determinant.

    Raises
    ------
    LinAlgError
        The matrix is singular.
    """
    row, push = work.driven, work.push(z, load_factor)
    right = np.zeros((len(z), 1 if row is None else 2))
    right[:, 0] = push
    if row is not None:
        right[row, 1] = -1.0  # the drive's row is -(theta - angle)
    smooth = work.system.has_potential
    found, inertia = _symmetric(work, right) if smooth else (work.solve(right), _sign(work))
    rate = work.along(z, found[:, 0].copy())
    conjugate, curvature = work.conjugate(z, load_factor)
    return Point(
        load_factor=load_factor,
        z=z,
        rate=rate,
        slope=1.0,
        turn=None if row is None else work.along(z, found[:, 1].copy()),
        stiffness=np.nan if row is None else _of_drive(work, row, found[:, 1]),
        inertia=inertia,
        energies=energies,
        potential=work.potential(z, load_factor, energies) if smooth else np.nan,
        conjugate=conjugate,
        conjugate_rate=curvature - float(push @ rate),
    )


def _of_drive(work: Followed, row: int, turn: Array) -> float:
    """The stiffness of the driven rotation at fixed loads; 0 where it is the round-off of its terms, as that
    of a pendulum that nothing pulls down: the sign of what is no stiffness tells of no critical point."""
    turned = int(np.abs(work.hessian[row]).argmax())
    terms = float(np.abs(np.delete(work.hessian[turned] * turn, row)).sum())
    return float(turn[row]) if abs(turn[row]) > NO_STIFFNESS * terms else 0.0


def reached(work: Followed, found: Newton) -> tuple[Point | None, str]:
    """Return the point where Newton ended; or None and the reason, if it failed or the tangent is
    singular."""
    if found.reason:
        return None, found.reason
    try:
        return stand(work, found.z, found.load_factor, found.energies), ""
    except np.linalg.LinAlgError as error:
        return None, str(error)


def directed(work: Followed, point: Point, direction: Array, along: float) -> Point:
    """Return the point with the arc length as parameter, growing along (direction (N,), along).

    Arc length is measured in dimensionless coordinates (lengths of a strip, rad) and load factors together;
    multipliers and axial forces have no part in it. Without a direction (zero, and along = 1) the load factor
    stays the parameter.
    """
    if not direction.any():
        return point
    count, rate = work.count, point.rate / work.unit
    speed = np.hypot(np.linalg.norm(rate[:count]), point.slope)
    scale = float(np.copysign(1.0 / speed, direction[:count] @ rate[:count] + along * point.slope))
    return replace(
        point,
        rate=scale * point.rate,
        slope=scale * point.slope,
        conjugate_rate=scale * point.conjugate_rate,
    )


def _symmetric(work: Followed, right: Array) -> tuple[Array, int]:
    """Solve hessian x = right (N, K), and count the negative eigenvalues of the reduced tangent."""
    from scipy.linalg import get_lapack_funcs  # whose import takes longer than a path without critical points

    sytrf, sytrs = get_lapack_funcs(("sytrf", "sytrs"))
    unit, energy, not_free = work.unit[:, None], work.energy, len(right) - work.count
    work.counters.factorisations += 1
    matrix = work.hessian * (unit * unit.T / energy)
    # the transpose is as LAPACK stores it; without room for blocks many unknowns take three times as long
    factors, pivots, failed = sytrf(matrix.T, lower=1, lwork=BLOCK * len(matrix), overwrite_a=1)
    if failed or not np.isfinite(factors).all():
        raise np.linalg.LinAlgError("the tangent is singular")
    single = pivots > 0
    # a block of two is indefinite: one negative eigenvalue each (Bunch and Kaufman 1977)
    negative = int((np.diag(factors)[single] < 0.0).sum() + (~single).sum() // 2)
    found = np.asarray(sytrs(factors, pivots, right * unit / energy, lower=1)[0])
    if not np.abs(found).max() < FASTEST:
        raise np.linalg.LinAlgError("the tangent is singular")
    return unit * found, negative - not_free


def _sign(work: Followed) -> int:
    """1 where the determinant of the reduced tangent is below zero, else 0; NOT_TRACKED of published forces.

    That of the whole one has another sign for each axial force and each constraint.
    """
    if not work.followers.place.size:
        return NOT_TRACKED
    matrix = work.hessian * (work.unit[:, None] * work.unit / work.energy)
    negative = float(np.linalg.slogdet(matrix)[0]) < 0.0
    return int(negative) ^ (len(matrix) - work.count) % 2


def jumped(before: Point, after: Point, step: float, unit: float) -> str:
    """Return why ``after`` is not reached from ``before`` along a path; an empty string if it may be.

    step: length of the step in the path's parameter; unit: EI/L [J]. int P_lambda d(lambda) is integrated
    with both factors as cubic Hermite polynomials of the parameter, from the end values and slopes: exact to
    the fourth power of the step.
    """
    if np.isnan(after.potential):
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
    """Return int P_lambda d(lambda) between two states of one path [J]."""
    return float(WEIGHTS @ _parts(before, after, step))


def _parts(before: Point, after: Point, step: float) -> Array:
    """The integrand at the nodes of the unit interval."""
    a, b, t = before, after, NODES
    conjugate = hermite(a.conjugate, b.conjugate, step * a.conjugate_rate, step * b.conjugate_rate, t)
    slope = 6 * t * (1 - t) * (b.load_factor - a.load_factor)
    slope += step * (a.slope * (1 - t) * (1 - 3 * t) - b.slope * t * (2 - 3 * t))
    return np.asarray(conjugate * slope)


def hermite(
    a: Array | float, b: Array | float, slope_a: Array | float, slope_b: Array | float, t: Array | float
) -> Array:
    """Return Hermite's cubic (...) between two values (...) with slopes on the unit interval, in their
    unit."""
    value = a * ((1 + 2 * t) * (1 - t) ** 2) + b * (t**2 * (3 - 2 * t))
    return np.asarray(value + slope_a * (t * (1 - t) ** 2) - slope_b * (t**2 * (1 - t)))
