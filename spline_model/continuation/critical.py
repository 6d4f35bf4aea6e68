"""Limit and bifurcation points between two states of a path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.point import NOT_TRACKED, directed, hermite, reached
from spline_model.newton import correct
from spline_model.solution import CriticalPoint

Array = NDArray[np.float64]

LIMIT, TURN, BIFURCATION = "limit point", "turning point", "bifurcation"
FINE = 1e-7
"""A critical point is known to this part of the step between the two states, or of the value
there: closer to it the tangent is singular to no purpose."""
JUMP = 1e-5
"""Part of the value at the ends of a step that is no zero: a sign that changes in a jump, from one
path to another one."""
NO_PART = 1e-6
"""Part of a mode's largest entry below which bodies have none in it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Crossing:
    """A critical point, its place z (N,) [m, rad, N] on the system, and the mode (Q,) of its coordinates."""

    told: CriticalPoint
    z: Array
    mode: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Bracket:
    """The piece of a path between two states, as a function of t in [0, 1]."""

    work: Followed
    before: Point
    after: Point
    step: float

    def plane(self) -> tuple[Array, float]:
        """Return normal (N,) and load-factor part [1] of the planes across the path.

        They are normal to the chord, or to the load factor.
        """
        if self.before.slope == self.after.slope == 1.0:
            return np.zeros_like(self.before.z), 1.0
        normal = (self.after.z - self.before.z) / self.work.unit
        normal[self.work.count :] = 0.0
        return normal, self.after.load_factor - self.before.load_factor

    def at(self, t: float) -> Point | None:
        """Return the state of the path at t in 0 to 1 [1], or None if Newton does not find it."""
        a, b, step = self.before, self.after, self.step
        z = hermite(a.z, b.z, step * a.rate, step * b.rate, t)
        factor = hermite(a.load_factor, b.load_factor, step * a.slope, step * b.slope, t)
        return corrected(self.work, z, float(factor), *self.plane())


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
    bracket = Bracket(work=work, before=before, after=after, step=step)
    found = []
    for number in range(*sorted((before.inertia, after.inertia))):
        found.append(_of_tangent(bracket, number))
    if before.stiffness * after.stiffness < 0.0 and before.slope * after.slope > 0.0:
        limit = _of_torque(bracket)
        if limit is not None or before.inertia == after.inertia:
            found.append(limit)  # where the inertia changes, the stiffness may go through infinity
    if None in found:
        return None
    return tuple(sorted((c for c in found if c), key=lambda c: abs(c.told.load_factor - before.load_factor)))


def _of_tangent(bracket: Bracket, number: int) -> Crossing | None:
    """The state at which one eigenvalue of the reduced tangent vanishes."""
    work, modes = bracket.work, {}

    def value(t: float) -> float:
        point = bracket.at(t)
        if point is None:
            return np.nan
        tangent = ReducedTangent.of(work)
        eigenvalue, modes[t] = tangent.eigenpair(number)
        return eigenvalue if abs(eigenvalue) > tangent.grain else 0.0

    t = _zero(value)
    point = None if t is None else bracket.at(t)
    if t is None or point is None:
        return None
    if bracket.before.slope * bracket.after.slope > 0.0:
        kind = BIFURCATION
    else:
        turned = work.system.scene.turned
        kind = TURN if turned and turned.angle != 0.0 else LIMIT
    return _crossing(work, kind, point, modes[t], bracket.after.inertia)


def _of_torque(bracket: Bracket) -> Crossing | None:
    """The state at which the stiffness of the driven rotation vanishes, at fixed loads."""

    def value(t: float) -> float:
        point = bracket.at(t)
        return np.nan if point is None else point.stiffness

    t = _zero(value)
    point = None if t is None else bracket.at(t)
    if point is None or point.turn is None:
        return None
    work = bracket.work
    mode = (point.turn / work.unit)[: work.count]
    return _crossing(work, LIMIT, point, mode, bracket.after.inertia)


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


def _zero(value: Callable[[float], float]) -> float | None:
    """Where a function on [0, 1] goes through zero: inverse quadratic interpolation, or bisection where the
    last three values are not those of a smooth monotonic function, as at a kink of the softest eigenvalue
    (Chandrupatla, Advances in Engineering Software 28 (1997) 145-149).

    None where it is not found, or where the sign changes in a jump: then there is no zero.
    """
    a, b, fa, fb = 1.0, 0.0, value(1.0), value(0.0)
    if not fa * fb < 0.0:
        return None
    small, nothing = (part * min(abs(fa), abs(fb)) for part in (FINE, JUMP))
    share, failed = 0.5, False
    while abs(b - a) >= FINE and min(abs(fa), abs(fb)) > small:
        t = a + share * (b - a)
        ft = value(t)
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
    return t if least <= nothing else None


@dataclass(frozen=True, kw_only=True, eq=False)
class ReducedTangent:
    """Stiffness (F, F) on the free directions (Q, F), which are orthonormal, all dimensionless (EI/L) [1].

    It is symmetric except with followers.
    """

    stiffness: Array
    free: Array
    symmetric: bool

    @classmethod
    def of(cls, work: Followed) -> ReducedTangent:
        """The reduced tangent at the state that ``work`` was last evaluated at.

        Forces with a compliance are condensed; those of clamps, drives and inextensible strips are
        constraints.
        """
        hessian = work.hessian * (work.unit[:, None] * work.unit / work.energy)
        from scipy.linalg import null_space  # as in ``point``, where there is something critical alone

        count = work.count
        rows, between = hessian[count:, :count], hessian[count:, count:]
        soft = np.diag(between) != 0.0
        stiffness = hessian[:count, :count] + rows[soft].T @ np.linalg.solve(
            -between[np.ix_(soft, soft)], rows[soft]
        )
        constraints = rows[~soft]
        norms = np.linalg.norm(constraints, axis=1, keepdims=True)
        free = null_space(constraints / norms) if len(constraints) else np.eye(count)
        symmetric = work.system.has_potential
        return cls(stiffness=free.T @ stiffness @ free, free=free, symmetric=symmetric)

    @property
    def grain(self) -> float:
        """Round-off of an eigenvalue [1]: with many segments above a thousandth of the softest mode's."""
        return float(np.finfo(float).eps * np.abs(self.stiffness).sum(axis=0).max())

    def eigenpair(self, number: int) -> tuple[float, Array]:
        """The eigenvalue of that number from the lowest, 0 on, and its direction (Q,); with followers the
        smallest singular value, with the determinant's sign."""
        from scipy.linalg import eigh

        if not self.symmetric:
            _, values, vectors = np.linalg.svd(self.stiffness)
            sign = float(np.linalg.slogdet(self.stiffness)[0])
            return sign * float(values[-1]), np.asarray(self.free @ vectors[-1])
        values, vectors = eigh(self.stiffness, subset_by_index=(number, number))
        return float(values[0]), np.asarray(self.free @ vectors[:, 0])
