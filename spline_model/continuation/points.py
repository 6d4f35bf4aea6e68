"""States of equilibrium on a path, and the limit and bifurcation points between two of them.

How a state changes along the path, how stable it is, and whether another one lies on the same path, by the
energy gained between them against the work done.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Followed, Point
from spline_model.newton import Newton, correct
from spline_model.solution import CriticalPoint

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

LIMIT, TURN, BIFURCATION = "limit point", "turning point", "bifurcation"
FINE = 1e-7
"""A critical point is known to this part of the step between the two states, or of the value
there: closer to it the tangent is singular to no purpose."""
JUMP = 1e-6
"""Part of the value at the ends of a step that is no zero: a sign that changes in a jump, from one
path to another one."""
NO_PART = 1e-6
"""Part of a mode's largest entry below which bodies have none in it."""

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


def booked(before: Point, after: Point, step: float, unit: float) -> tuple[float, str]:
    """Return int P_lambda d(lambda) between two states [J], and why they are not on one path; empty if they
    may be.

    step: length of the step in the path's parameter; unit: EI/L [J]. The integral is of both factors as cubic
    Hermite polynomials of the parameter, from the end values and slopes: exact to the fourth power of the
    step.
    """
    a, b, t = before, after, NODES
    ends = ((0.0, a.conjugate, step * a.conjugate_rate), (1.0, b.conjugate, step * b.conjugate_rate))
    slope = 6 * t * (1 - t) * (b.load_factor - a.load_factor)
    slope += step * (a.slope * (1 - t) * (1 - 3 * t) - b.slope * t * (2 - 3 * t))
    parts = hermite(ends, t) * slope
    done, gained = float(WEIGHTS @ parts), after.potential - before.potential
    scale = max(abs(gained), float(WEIGHTS @ np.abs(parts)))
    floor = ROUND_OFF * (unit + sum(map(abs, after.energies)))
    if abs(gained - done) > WORK_MISMATCH * scale + floor:  # never where there is no potential, nan
        return done, "the state lies on another branch (energy gained and work done differ)"
    return done, ""


def hermite(known: Sequence[tuple[float, Any, Any]], at: Any) -> Any:
    """Return Hermite's polynomial through (place, value, slope) triples at a place or places, in their units.

    It is of degree 2 k - 1 for k triples. Values are taken from the last one: what does not change then has
    no round-off.
    """
    total = last = known[-1][1]
    for i, (place, value, slope) in enumerate(known):
        share, lean = 1.0, 0.0
        for other in (each[0] for j, each in enumerate(known) if j != i):
            share = share * ((at - other) / (place - other)) ** 2
            lean += 2.0 / (place - other)
        total = total + share * ((1.0 - (at - place) * lean) * (value - last) + (at - place) * slope)
    return total


@dataclass(frozen=True, kw_only=True, eq=False)
class Crossing:
    """A critical point, its place z (N,) [m, rad, N] on the system, and the mode (Q,) of its coordinates."""

    told: CriticalPoint
    z: Array
    mode: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class _Bracket:
    """The piece of a path between two states, as a function of t in [0, 1]."""

    work: Followed
    before: Point
    after: Point
    step: float

    def at(self, t: float) -> Point | None:
        """Return the state of the path at t in 0 to 1 [1], or None if Newton does not find it.

        It is sought on a plane across the path: normal to the chord, or to the load factor.
        """
        a, b, step = self.before, self.after, self.step
        z = hermite(((0.0, a.z, step * a.rate), (1.0, b.z, step * b.rate)), t)
        factor = hermite(((0.0, a.load_factor, step * a.slope), (1.0, b.load_factor, step * b.slope)), t)
        normal, along = np.zeros_like(z), 1.0
        if not a.slope == b.slope == 1.0:
            normal, along = (b.z - a.z) / self.work.unit, b.load_factor - a.load_factor
            normal[self.work.count :] = 0.0
        return corrected(self.work, z, float(factor), normal, along)


def corrected(work: Followed, z: Array, load_factor: float, normal: Array, along: float) -> Point | None:
    """Return the point of the path on a plane through (z (N,), load factor); None if Newton does not find it.

    normal (N,), along: normal of the plane in dimensionless unknowns and the load factor.
    """
    found = correct(work, z, load_factor, normal, along)
    point, _ = reached(work, found)
    return None if point is None else directed(work, point, normal, along)


def between(work: Followed, before: Point, after: Point, step: float) -> tuple[Crossing, ...] | None:
    """Return all critical points between two neighbouring states; step: their distance in the path's
    parameter.

    Eigenvalues are continuous along the path when they are numbered by size: the one whose number is the
    smaller of the two inertias changes its sign, and so on. A torque has its limit where the stiffness at
    fixed loads vanishes, wherever the torque turns as loads grow beside it. None where an eigenvalue changes
    its sign without going through zero: the states are not on one path, or too far apart to tell.
    """
    if NOT_TRACKED in (before.inertia, after.inertia):
        return ()
    bracket = _Bracket(work=work, before=before, after=after, step=step)
    numbers = range(*sorted((before.inertia, after.inertia)))
    found = [_of_tangent(bracket, number) for number in numbers]
    if before.stiffness * after.stiffness < 0.0 and before.slope * after.slope > 0.0:
        limit = _of_torque(bracket)
        if limit is not None or not numbers:
            found.append(limit)  # where the inertia changes, the stiffness may go through infinity
    if None in found:
        return None
    return tuple(sorted((c for c in found if c), key=lambda c: abs(c.told.load_factor - before.load_factor)))


def _of_tangent(bracket: _Bracket, number: int) -> Crossing | None:
    """The state at which one eigenvalue of the reduced tangent vanishes."""
    work = bracket.work
    point = _where_zero(bracket, lambda _: _eigenpair(work, number)[0])
    if point is None:
        return None
    if bracket.before.slope * bracket.after.slope > 0.0:
        kind = BIFURCATION
    else:
        turned = work.system.scene.turned
        kind = TURN if turned and turned.angle != 0.0 else LIMIT
    return _crossing(work, kind, point, _eigenpair(work, number)[1], bracket.after.inertia)


def _of_torque(bracket: _Bracket) -> Crossing | None:
    """The state at which the stiffness of the driven rotation vanishes, at fixed loads."""
    point, work = _where_zero(bracket, lambda point: point.stiffness), bracket.work
    if point is None or point.turn is None:
        return None
    return _crossing(work, LIMIT, point, (point.turn / work.unit)[: work.count], bracket.after.inertia)


def _crossing(work: Followed, kind: str, at: Point, mode: Array, inertia: int) -> Crossing:
    """Complete a critical point; ``mode`` in dimensionless coordinates of the system."""
    system, moved = work.system, work.moved(at.z, mode)
    scale = _sense(system, moved) / np.abs(moved).max()
    turned, z = system.scene.turned, work.unknowns(at.z)
    told = CriticalPoint(
        kind=kind,
        load_factor=at.load_factor,
        rotation=at.load_factor * turned.angle if turned else np.nan,
        z=z,
        mode=scale * moved * system.scales.unit[: len(moved)],
        inertia=inertia,
        turns=z[system.layout.poses][2::3],
    )
    return Crossing(told=told, z=at.z, mode=scale * mode)


def _sense(system: System, moved: Array) -> float:
    """The sign that a mode is given: with any number of control points the bodies move to the same side."""
    bodies = moved[system.layout.poses]
    if np.abs(bodies).max(initial=0.0) < NO_PART * np.abs(moved).max():
        bodies = moved
    size = np.abs(bodies)
    return float(np.sign(bodies[np.flatnonzero(size >= 0.5 * size.max())[0]]))


def _where_zero(bracket: _Bracket, value: Callable[[Point], float]) -> Point | None:
    """The state where a value goes through zero: inverse quadratic interpolation, or bisection where the last
    three values are not those of a smooth monotonic function, as at a kink of the softest eigenvalue
    (Chandrupatla, Advances in Engineering Software 28 (1997) 145-149).

    None where it is not found, or where the sign changes in a jump: then there is no zero.
    """

    def at(t: float) -> float:
        point = bracket.at(t)
        return np.nan if point is None else value(point)

    a, b, fa, fb = 1.0, 0.0, at(1.0), at(0.0)
    if not fa * fb < 0.0:
        return None
    small, nothing = (part * min(abs(fa), abs(fb)) for part in (FINE, JUMP))
    share, failed = 0.5, False
    while abs(b - a) >= FINE and min(abs(fa), abs(fb)) > small:
        t = a + share * (b - a)
        ft = at(t)
        if not np.isfinite(ft):  # close to the point Newton may fail: elsewhere, or the nearer end
            if failed or share == 0.5:
                break
            share, failed = 0.5, True
            continue
        failed = False
        c, fc = a, fa
        if ft * fa < 0.0:
            c, fc, b, fb = b, fb, a, fa
        a, fa = t, ft
        place, height = (a - b) / (c - b), (fa - fb) / (fc - fb)
        share = 0.5
        if height**2 < place and (1.0 - height) ** 2 < 1.0 - place:
            share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            share = min(max(share, FINE), 1.0 - FINE)
    t, least = (a, abs(fa)) if abs(fa) < abs(fb) else (b, abs(fb))
    return bracket.at(t) if least <= nothing else None


def _eigenpair(work: Followed, number: int) -> tuple[float, Array]:
    """An eigenvalue of the reduced tangent, by its number from the lowest, 0 on, and its direction (Q,).

    Of the state that ``work`` was last evaluated at, dimensionless (EI/L); zero where it is round-off, which
    with many segments is above a thousandth of the softest mode's. With followers the tangent is not
    symmetric: the smallest singular value, with the determinant's sign. Forces with a compliance are
    condensed; those of clamps, drives and inextensible strips are constraints.
    """
    from scipy.linalg import eigh, null_space  # where there is something critical alone

    hessian = work.hessian * (work.unit[:, None] * work.unit / work.energy)
    count = work.count
    rows, between = hessian[count:, :count], hessian[count:, count:]
    soft = np.diag(between) != 0.0
    stiffness = hessian[:count, :count] + rows[soft].T @ np.linalg.solve(
        -between[np.ix_(soft, soft)], rows[soft]
    )
    constraints = rows[~soft]
    norms = np.linalg.norm(constraints, axis=1, keepdims=True)
    free = null_space(constraints / norms) if len(constraints) else np.eye(count)
    stiffness = free.T @ stiffness @ free
    if work.system.has_potential:
        values, vectors = eigh(stiffness, subset_by_index=(number, number))
        value, vector = float(values[0]), vectors[:, 0]
    else:
        _, values, vectors = np.linalg.svd(stiffness)
        value, vector = float(np.linalg.slogdet(stiffness)[0] * values[-1]), vectors[-1]
    grain = float(np.finfo(float).eps * np.abs(stiffness).sum(axis=0).max())
    return value if abs(value) > grain else 0.0, np.asarray(free @ vector)
