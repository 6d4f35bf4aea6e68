"""The strips' elements as analytic functions of state and design, for a complex step in either.

Evaluated at x + i STEP dx, the imaginary part over STEP is the derivative along dx, without the
difference that loses digits (Squire and Trapp, SIAM Review 40 (1998) 110). The point laws are those of
``spline_model.strip``. Axes: points or control points, root and tip, x and y, then always strips G,
parameters P, states S.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.reduced.model import Reduced
from spline_model.sensitivity.parameters import Varied
from spline_model.strip import laws
from spline_model.strip.element import WHERE

Array = NDArray[Any]

uncompiled: list[Any] = [laws.bending_law, laws.stretching_law, laws.mixed_law]
bending_law, stretching_law, mixed_law = (getattr(law, "py_func", law) for law in uncompiled)


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """C' and C'' (Q, 2, G, P, S)."""

    first: Array
    second: Array

    @classmethod
    def of(cls, d1: Array, d2: Array, points: Array) -> Curve:
        """From tables (Q, n) and control points (n, 2, G, P, S)."""
        return cls(first=_times(d1, points), second=_times(d2, points))

    @cached_property
    def square(self) -> Array:
        """|C'|^2 (Q, G, P, S)."""
        return _dot(self.first, self.first)

    @cached_property
    def speed(self) -> Array:
        """v = |C'|."""
        return np.sqrt(self.square)

    @cached_property
    def turning(self) -> Array:
        """phi, turning of the tangent per du."""
        return _cross(self.first, self.second) / self.square


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements:
    """All strips at states y (P, S, Y), under what they know of the design."""

    model: Reduced
    varied: Varied
    y: Array

    def _own(self, y: Array) -> tuple[Array, Array, Array, Array]:
        """Free control points (n - 4, 2, ...), shares of the ends'
        reach (2, 1, ...), axial forces (K, ...) and poses (2, 3, ...) of what carries root and tip; the
        ground's is zero."""
        y = np.concatenate((np.moveaxis(y, -1, 0), np.zeros((3, *y.shape[:-1]))))
        w = y[self._places[0]]
        return (
            w[:-2].reshape(len(w) // 2 - 1, 2, *w.shape[1:]),
            w[-2:, None],
            y[self._places[1]],
            y[self._places[2]],
        )

    @cached_property
    def _places(self) -> tuple[Array, Array, Array]:
        """Where w (W, G), a (K, G) and the poses (2, 3, G) stand in y, the ground's three rows behind it."""
        strips, rows = self.model.strips, np.arange(self.model.size)
        w, a = (
            np.stack([rows[self.model.places(s)[k]] for s in range(len(strips.roots))], axis=-1)
            for k in range(2)
        )
        bodies = np.stack((strips.roots, strips.tips))[:, None]
        return w, a, np.where(bodies < 0, self.model.size, 3 * bodies) + np.arange(3)[:, None]

    @cached_property
    def _state(self) -> tuple[Array, Array, Array, Array]:
        return self._own(self.y)

    @cached_property
    def _ends(self) -> tuple[Array, Array, Array]:
        """Arms from the bodies' centres to the clamped points, and sticks from there to the inner control
        points at rest, (2, 2, ...); shares of these (2, 1, ...)."""
        _, share, _, pose = self._state
        frames, angle = self.varied.frames, pose[:, 2]
        arm = turned(angle, frames[:, 0], frames[:, 1])
        return arm, turned(angle + frames[:, 2], self.varied.reach, 0.0), share

    @cached_property
    def points(self) -> Array:
        """Control points (n, 2, ...) in the order of elimination."""
        arm, stick, share = self._ends
        free, _, _, pose = self._state
        clamped = pose[:, :2] + arm
        return _ordered(free, clamped + share * stick, clamped)

    @cached_property
    def curve(self) -> Curve:
        """At the Gauss points."""
        return Curve.of(self.model.shape.d1, self.model.shape.d2, self.points)

    @cached_property
    def axial(self) -> Array:
        """Axial forces a (K, ...)."""
        return self._state[2]

    @cached_property
    def _bending(self) -> tuple[Array, ...]:
        strips, curve = self.model.strips, self.curve
        rigidity, drop = self.varied.along(self.model, self.model.shape.rule[WHERE])
        given = (self.varied.speed, strips.curvature.T[..., None, None], rigidity)
        found = bending_law(curve.turning, curve.speed, *given, 0.0, 0.0, strips.measure)
        if self.varied.curl.any():  # which the material measure alone knows
            strain = curve.turning / self.varied.speed - given[1]
            by = laws.curl_factors(strain, drop, self.varied.curl)
            found = (*(value * factor for value, factor in zip(found, by, strict=False)), *found[3:])
        return tuple(found)

    @cached_property
    def _stretching(self) -> tuple[Array, ...]:
        """Axial energy, its derivatives in v, v v and N."""
        strips, varied, v = self.model.strips, self.varied, self.curve.speed
        strain = strips.strain[:, None, None]
        found: list[Any] = [np.zeros(())] * 4
        if len(self.axial):
            parts = self._forces(self.axial)
            force, by_n = sum(parts), mixed_law(v, varied.speed, strain)
            loss = varied.compliance[0] * parts[0] ** 2 + varied.compliance[1] * parts[1] ** 2
            found = [force * by_n - 0.5 * loss * varied.speed, force, np.zeros(()), by_n]
        if strips.stretching.any():
            law = stretching_law(v, varied.speed, strain, varied.stretching, strips.measure)
            found[:3] = [a + b for a, b in zip(found, law, strict=False)]
        return tuple(found)

    def _forces(self, a: Array) -> list[Array]:
        """Axial force at the Gauss points, its part of the stretching and of the sliding, (Q, ...)."""
        modes, split = self.model.strips.modes, self.model.strips.split
        return [times_each(modes[..., k], a[k]) for k in (slice(split), slice(split, None))]

    @cached_property
    def energies(self) -> tuple[Array, Array]:
        """Bending and axial energy (P, S) of all strips [EI/L]."""
        weight = self.model.shape.weight
        bending, axial = (np.tensordot(weight, law[0], 1) for law in (self._bending, self._stretching))
        return bending.sum(axis=0), axial.sum(axis=0)

    def residual(self) -> tuple[Array, Array]:
        """Derivative of the strips' energy by y (P, S, Y); force and moment of the clamps at root and tip on
        the strips (2, 3, ...)."""
        shape, n, curve = self.model.shape, len(self.points), self.curve
        arm, stick, share = self._ends
        m = (shape.weight[:, None, None, None] * self._bending[1] / curve.square)[:, None]
        f = self._bending[4] + self._stretching[1]
        f = (shape.weight[:, None, None, None] * f / curve.speed)[:, None]
        first = (f - 2.0 * m * curve.turning[:, None]) * curve.first - m * _across(curve.second)
        g = _times(shape.d1.T, first) + _times(shape.d2.T, m * _across(curve.first)) - self.varied.dead
        inner, clamped = g[n - 4 : n - 2], g[: n - 3 : -1]
        force, moment = inner + clamped, share[:, 0] * _cross(stick, inner)
        w, a, poses = self._places
        out = np.zeros((self.model.size + 3, *g.shape[3:]), dtype=complex)
        out[w[:-2]] = g[: n - 4].reshape(len(w) - 2, *g.shape[2:])
        out[w[-2:]] = _dot(stick, inner)
        out[a] = self._gap() if len(a) else 0.0
        push = np.concatenate((force, (_cross(arm, force) + moment)[:, None]), axis=1)
        for at in np.ndindex(poses.shape):
            out[poses[at]] += push[at]
        return np.moveaxis(out[:-3], 0, -1), np.concatenate((force, moment[:, None]), axis=1)

    def _gap(self) -> Array:
        """What the axial forces do not agree with the stretch by, (K, ...)."""
        strips, by_n = self.model.strips, self._stretching[3]
        parts = []
        for k, force in enumerate(self._forces(self.axial)):
            modes = strips.modes[..., (slice(strips.split), slice(strips.split, None))[k]]
            left = by_n - self.varied.compliance[k] * force * self.varied.speed
            parts.append(times_each((self.model.shape.weight[:, None] * modes).swapaxes(1, 2), left))
        return np.concatenate(parts)

    def second_along(self, rate: Array) -> Array:
        """rate^T (d2V/dy2) rate (P, S) of the strips' energy, for rates (1, S, Y)."""
        shape, varied, curve = self.model.shape, self.varied, self.curve
        (arm, stick, share), (free, push, pull, pose) = self._ends, self._own(rate)
        spin = pose[:, 2:]
        clamped = pose[:, :2] + spin * _across(arm)
        turn = spin * _across(stick)
        back = -(spin**2) * arm
        bent = back + 2.0 * push * turn - share * spin**2 * stick
        twice = _ordered(0.0 * free, bent, back)
        by = Curve.of(shape.d1, shape.d2, _ordered(free, clamped + push * stick + share * turn, clamped))
        by2 = Curve.of(shape.d1, shape.d2, twice)
        phi, v, square1 = curve.turning, curve.speed, 2.0 * _dot(curve.first, by.first)
        square2 = 2.0 * (_dot(by.first, by.first) + _dot(curve.first, by2.first))
        cross1 = _cross(curve.first, by.second) + _cross(by.first, curve.second)
        cross2 = _cross(curve.first, by2.second) + _cross(by2.first, curve.second)
        phi1, v1 = (cross1 - phi * square1) / curve.square, 0.5 * square1 / v
        cross2 = cross2 + 2.0 * _cross(by.first, by.second) - 2.0 * phi1 * square1
        phi2, v2 = (cross2 - phi * square2) / curve.square, (0.5 * square2 - v1**2) / v
        (_, m, m_phi, m_v, f, f_v), (_, g, g_v, _) = self._bending, self._stretching
        density = m * phi2 + m_phi * phi1**2 + 2.0 * m_v * phi1 * v1 + (f + g) * v2 + (f_v + g_v) * v1**2
        if len(pull):
            for c, by_force in zip(varied.compliance, self._forces(pull), strict=True):
                density = density + by_force * (2.0 * v1 - c * by_force * varied.speed)
        total = np.tensordot(shape.weight, density, 1) - (varied.dead * twice).sum(axis=(0, 1))
        return np.asarray(total.sum(axis=0))


def _ordered(free: Array, inner: Array, clamped: Array) -> Array:
    """Control points in the order of elimination: P_2 ... P_(n-3), P_1, P_(n-2), P_(n-1), P_0."""
    many = np.broadcast_shapes(free.shape[1:], inner.shape[1:])
    return np.concatenate([np.broadcast_to(p, (len(p), *many)) for p in (free, inner, clamped[::-1])])


def turned(angle: Array, x: Array, y: Array | float) -> Array:
    """The vector (x, y) turned by an angle, x and y along axis 1."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack((c * x - s * y, s * x + c * y), axis=1)


def _times(table: Array, values: Array) -> Array:
    """table @ values along the first axis, one product of real matrices."""
    flat = np.ascontiguousarray(values).reshape(len(values), -1)
    return (table @ flat.view(np.float64)).view(flat.dtype).reshape(len(table), *values.shape[1:])


def times_each(tables: Array, values: Array) -> Array:
    """The same with a table for each strip, (G, ...) of values (..., G, P, S)."""
    return np.stack([_times(table, values[:, s]) for s, table in enumerate(tables)], axis=1)


def _across(v: Array) -> Array:
    """The vectors turned by a right angle."""
    return np.stack((-v[:, 1], v[:, 0]), axis=1)


def _cross(a: Array, b: Array) -> Array:
    """a x b."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _dot(a: Array, b: Array) -> Array:
    """a . b."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])
