"""Limit and bifurcation points between two states of a path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.corrector import correct
from spline_model.continuation.point import NOT_TRACKED, Point, directed, stand
from spline_model.continuation.reduced import reduced_tangent
from spline_model.effects import DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.newton import Workspace
from spline_model.solution import CriticalPoint

Array = NDArray[np.float64]

LIMIT, TURN, BIFURCATION = "limit point", "turning point", "bifurcation"
FINE = 1e-6
"""A critical point is known to this part of the step between the two states, or of the value
there: closer to it the tangent is singular to no purpose."""
MOST_TRIALS = 60


@dataclass(frozen=True, kw_only=True, eq=False)
class Bracket:
    """The piece of a path between two states, as a function of t in [0, 1]."""

    work: Workspace
    before: Point
    after: Point
    step: float

    def plane(self) -> tuple[Array, float]:
        """Normal (N,) and load-factor part of the planes across the path: the chord, or the load factor."""
        if self.before.slope == self.after.slope == 1.0:
            return np.zeros_like(self.before.z), 1.0
        normal = (self.after.z - self.before.z) / self.work.system.scales.unit
        normal[self.work.system.layout.coordinate_count :] = 0.0
        return normal, self.after.load_factor - self.before.load_factor

    def at(self, t: float) -> Point | None:
        """The state of the path at t, or None if Newton does not find it."""
        a, b, step = self.before, self.after, self.step
        z = _hermite(a.z, b.z, step * a.rate, step * b.rate, t)
        factor = _hermite(a.load_factor, b.load_factor, step * a.slope, step * b.slope, t)
        return corrected(self.work, z, float(factor), *self.plane())


def corrected(work: Workspace, z: Array, load_factor: float, normal: Array, along: float) -> Point | None:
    """The point of the path on a plane through (z, load factor); None if Newton does not find it."""
    found = correct(work, z, load_factor, normal, along)
    if found.reason:
        return None
    try:
        point = stand(work, found.z, found.load_factor, found.energies)
    except np.linalg.LinAlgError:
        return None
    return directed(work.system, point, normal, along)


def between(work: Workspace, before: Point, after: Point, step: float) -> tuple[CriticalPoint, ...]:
    """All critical points between two neighbouring states; step: their distance in the path's parameter.

    Eigenvalues are continuous along the path when they are numbered by size: the one whose
    number is the smaller of the two inertias changes its sign, and so on.
    """
    if NOT_TRACKED in (before.inertia, after.inertia):
        return ()
    bracket = Bracket(work=work, before=before, after=after, step=step)
    found = []
    for number in range(*sorted((before.inertia, after.inertia))):
        found.append(_of_tangent(bracket, number))
    row = torque_row(work.system)
    if row is not None and before.rate[row] * after.rate[row] < 0.0 and before.slope * after.slope > 0.0:
        found.append(_of_torque(bracket, row))
    return tuple(sorted((c for c in found if c), key=lambda c: abs(c.load_factor - before.load_factor)))


def torque_row(system: System) -> int | None:
    """Index in z of the driven rotation's torque, if there is one that moves."""
    for i, drive in enumerate(system.scene.of(Constraint)):
        if isinstance(drive, DrivenRotation) and drive.angle != 0.0:
            return int(system.layout.rows(i).start)
    return None


def _of_tangent(bracket: Bracket, number: int) -> CriticalPoint | None:
    """The state at which one eigenvalue of the reduced tangent vanishes."""
    work, modes = bracket.work, {}

    def value(t: float) -> float:
        point = bracket.at(t)
        if point is None:
            return np.nan
        tangent = reduced_tangent(work)
        eigenvalue, modes[t] = tangent.eigenpair(number)
        return eigenvalue

    t = _zero(value)
    point = None if t is None else bracket.at(t)
    if t is None or point is None:
        return None
    if bracket.before.slope * bracket.after.slope > 0.0:
        kind = BIFURCATION
    else:
        kind = LIMIT if torque_row(work.system) is None else TURN
    return _point(work.system, kind, point, modes[t], bracket.after.inertia)


def _of_torque(bracket: Bracket, row: int) -> CriticalPoint | None:
    """The state at which the torque of the driven rotation is stationary."""

    def value(t: float) -> float:
        point = bracket.at(t)
        return np.nan if point is None else float(point.rate[row])

    t = _zero(value)
    point = None if t is None else bracket.at(t)
    if point is None:
        return None
    system = bracket.work.system
    count = system.layout.coordinate_count
    mode = point.rate[:count] / system.scales.unit[:count]
    return _point(system, LIMIT, point, mode, bracket.after.inertia)


def _point(system: System, kind: str, at: Point, mode: Array, inertia: int) -> CriticalPoint:
    """Complete a critical point; ``mode`` in dimensionless coordinates."""
    size = np.abs(mode)
    mode = mode / mode[np.flatnonzero(size >= (1.0 - 1e-6) * size.max())[0]]  # ties in a symmetric mode
    drives = [d for d in system.scene.of(Constraint) if isinstance(d, DrivenRotation)]
    return CriticalPoint(
        kind=kind,
        load_factor=at.load_factor,
        rotation=at.load_factor * drives[0].angle if drives else np.nan,
        z=at.z,
        mode=mode * system.scales.unit[: len(mode)],
        inertia=inertia,
    )


def _zero(value: Callable[[float], float]) -> float | None:
    """Where a function on [0, 1] changes sign, by bisection and Illinois' rule; None if it is not found."""
    a, b, fa, fb = 0.0, 1.0, value(0.0), value(1.0)
    if not fa * fb < 0.0:
        return None
    small = FINE * min(abs(fa), abs(fb))
    kept = 0
    for trial in range(MOST_TRIALS):
        t = 0.5 * (a + b) if trial % 3 == 2 else (a * fb - b * fa) / (fb - fa)
        ft = value(t)
        if not np.isfinite(ft):  # close to the point Newton may fail: elsewhere, or the nearer end
            t = 0.5 * (a + b)
            ft = value(t)
        if not np.isfinite(ft):
            return a if abs(fa) < abs(fb) else b
        if abs(ft) <= small or b - a < FINE:
            return t
        if ft * fa > 0.0:
            a, fa = t, ft
            fb, kept = (0.5 * fb if kept == 1 else fb), 1
        else:
            b, fb = t, ft
            fa, kept = (0.5 * fa if kept == 2 else fa), 2
    return None


def _hermite(
    a: Array | float, b: Array | float, slope_a: Array | float, slope_b: Array | float, t: float
) -> Array:
    """Hermite's cubic between two values with slopes on the unit interval."""
    value = a * ((1 + 2 * t) * (1 - t) ** 2) + b * (t**2 * (3 - 2 * t))
    return np.asarray(value + slope_a * (t * (1 - t) ** 2) - slope_b * (t**2 * (1 - t)))
