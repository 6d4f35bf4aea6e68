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

from spline_model.basis import all_modes
from spline_model.effects import Bending, MixedStretching
from spline_model.reduced.model import Reduced
from spline_model.reduced.numbers import in_order
from spline_model.sensitivity.parameters import Varied
from spline_model.sensitivity.planar import Curve, across, cross, dot, times, times_each, turned
from spline_model.strip import laws
from spline_model.strip.element import WHERE

Array = NDArray[Any]

uncompiled: list[Any] = [laws.bending_law, laws.stretching_law, laws.mixed_law]
bending_law, stretching_law, mixed_law = (getattr(law, "py_func", law) for law in uncompiled)


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements:
    """All strips at states y (P, S, Y), under what they know of the design."""

    model: Reduced
    varied: Varied
    y: Array

    def _own(self, y: Array) -> tuple[Array, Array, Array, Array]:
        """Free control points (n - 4, 2, ...), first the turns of the roots where they yield and the offset
        of the tip where it shears, shares of the ends' reach (2, 1, ...), axial forces (K, ...) and poses
        (2, 3, ...) of what carries root and tip; the ground's is zero."""
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
        free, share, _, pose = self._state
        frames, angle = self.varied.frames, pose[:, 2]
        arm = turned(angle, frames[:, 0], frames[:, 1])
        return arm, turned(angle + self._turns(free) + frames[:, 2], self.varied.reach, 0.0), share

    def _turns(self, free: Array) -> Array | float:
        """Of the free control points those that are the turns of the roots, (2, ...)."""
        return free[0] if self.model.yields else 0.0

    def _apart(self, free: Array) -> Array | float:
        """Of the free control points the tip's offset by shear, zero at the root, (2, 2, ...)."""
        if not self.model.shears:
            return 0.0
        apart = free[int(self.model.yields)]
        return np.stack((0.0 * apart, apart))

    @cached_property
    def points(self) -> Array:
        """Control points (n, 2, ...) in the order of elimination."""
        arm, stick, share = self._ends
        free, _, _, pose = self._state
        clamped = pose[:, :2] + arm + self._apart(free)
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
        """Axial energy, its derivatives in v, v v, N and N v."""
        strips, varied, v = self.model.strips, self.varied, self.curve.speed
        strain = strips.strain[:, None, None]
        found = [np.zeros(())] * 5
        if len(self.axial):
            parts = self._forces(self.axial)
            loss = varied.compliance[0] * parts[0] ** 2 + varied.compliance[1] * parts[1] ** 2
            found = [*mixed_law(v, varied.speed, strain, sum(parts), loss, strips.measure)]
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
        """Bending and axial energy (P, S) of all strips [EI/L], not that of shear: see ``effects.Shear``."""
        weight = self.model.shape.weight
        bending, axial = (np.tensordot(weight, law[0], 1) for law in (self._bending, self._stretching))
        if self.model.shears:
            strips = self.model.strips
            length = (strips.speed @ self.model.shape.weight)[:, None, None]
            axial = axial + 0.5 * (self.axial[: strips.split] ** 2).sum(axis=0) / (self.varied.shear * length)
        return bending.sum(axis=0) + self._of_roots(self._state[0]), axial.sum(axis=0)

    def _of_roots(self, free: Array) -> Array:
        """1/2 k psi^2 (P, S) of the roots' turns psi, the first of ``free``."""
        return np.asarray(0.5 * (self.varied.springs * self._turns(free) ** 2).sum(axis=(0, 1)))

    def _of_shear(self, free: Array) -> Array:
        """1/2 k |e|^2 (P, S) of the tips' offsets e by shear, which stand among ``free``."""
        return np.asarray(0.5 * (self.varied.shear * self._apart(free) ** 2).sum(axis=(0, 1, 2)))

    def residual(self) -> tuple[Array, Array]:
        """Derivative of the strips' energy by y (P, S, Y); force and moment of the clamps at root and tip on
        the strips (2, 3, ...)."""
        shape, n, curve = self.model.shape, len(self.points), self.curve
        arm, stick, share = self._ends
        m = (shape.weight[:, None, None, None] * self._bending[1] / curve.square)[:, None]
        f = self._bending[4] + self._stretching[1]
        f = (shape.weight[:, None, None, None] * f / curve.speed)[:, None]
        first = (f - 2.0 * m * curve.turning[:, None]) * curve.first - m * across(curve.second)
        g = times(shape.d1.T, first) + times(shape.d2.T, m * across(curve.first)) - self.varied.dead
        inner, clamped = g[n - 4 : n - 2], g[: n - 3 : -1]
        force, moment = inner + clamped, share[:, 0] * cross(stick, inner)
        if self.model.yields:
            g[0] = self.varied.springs * self._turns(self._state[0]) + moment
        if self.model.shears:
            g[int(self.model.yields)] = (self.varied.shear * self._apart(self._state[0]) + force)[1]
        w, a, poses = self._places
        out = np.zeros((self.model.size + 3, *g.shape[3:]), dtype=complex)
        out[w[:-2]] = g[: n - 4].reshape(len(w) - 2, *g.shape[2:])
        out[w[-2:]] = dot(stick, inner)
        out[a] = self._gap() if len(a) else 0.0
        push = np.concatenate((force, (cross(arm, force) + moment)[:, None]), axis=1)
        for at in np.ndindex(poses.shape):
            out[poses[at]] += push[at]
        return np.moveaxis(out[:-3], 0, -1), np.concatenate((force, moment[:, None]), axis=1)

    def _gap(self) -> Array:
        """What the axial forces do not agree with the stretch by, (K, ...)."""
        strips, by_n = self.model.strips, self._stretching[3]
        length = self.curve.speed if strips.measure else self.varied.speed
        parts = []
        for k, force in enumerate(self._forces(self.axial)):
            modes = strips.modes[..., (slice(strips.split), slice(strips.split, None))[k]]
            left = by_n - self.varied.compliance[k] * force * length
            parts.append(times_each((self.model.shape.weight[:, None] * modes).swapaxes(1, 2), left))
        return np.concatenate(parts)

    def second_along(self, rate: Array) -> Array:
        """rate^T (d2V/dy2) rate (P, S) of the strips' energy, for rates (1, S, Y)."""
        shape, varied, curve = self.model.shape, self.varied, self.curve
        (arm, stick, share), (free, push, pull, pose) = self._ends, self._own(rate)
        spin = pose[:, 2:]
        swing = spin + (free[0][:, None] if self.model.yields else 0.0)
        clamped = pose[:, :2] + spin * across(arm) + self._apart(free)
        turn = swing * across(stick)
        back = -(spin**2) * arm
        bent = back + 2.0 * push * turn - share * swing**2 * stick
        twice = _ordered(0.0 * free, bent, back)
        by = Curve.of(shape.d1, shape.d2, _ordered(free, clamped + push * stick + share * turn, clamped))
        by2 = Curve.of(shape.d1, shape.d2, twice)
        phi, v, square1 = curve.turning, curve.speed, 2.0 * dot(curve.first, by.first)
        square2 = 2.0 * (dot(by.first, by.first) + dot(curve.first, by2.first))
        cross1 = cross(curve.first, by.second) + cross(by.first, curve.second)
        cross2 = cross(curve.first, by2.second) + cross(by2.first, curve.second)
        phi1, v1 = (cross1 - phi * square1) / curve.square, 0.5 * square1 / v
        cross2 = cross2 + 2.0 * cross(by.first, by.second) - 2.0 * phi1 * square1
        phi2, v2 = (cross2 - phi * square2) / curve.square, (0.5 * square2 - v1**2) / v
        (_, m, m_phi, m_v, f, f_v), (_, g, g_v, _, by_nv) = self._bending, self._stretching
        density = m * phi2 + m_phi * phi1**2 + 2.0 * m_v * phi1 * v1 + (f + g) * v2 + (f_v + g_v) * v1**2
        if len(pull):
            length, longer = (v, v1) if self.model.strips.measure else (varied.speed, 0.0)
            parts = zip(varied.compliance, self._forces(self.axial), self._forces(pull), strict=True)
            for c, force, by_force in parts:
                density = density + by_force * (2.0 * by_nv * v1 - c * by_force * length)
                density = density - 2.0 * c * by_force * force * longer
        total = np.tensordot(shape.weight, density, 1) - (varied.dead * twice).sum(axis=(0, 1))
        return np.asarray(total.sum(axis=0) + 2.0 * (self._of_roots(free) + self._of_shear(free)))

    def fibre_stress(self, stations: Array) -> Array:
        """Stress [Pa] at both extreme fibres of G strips at Q stations, (P, S, G, Q, 2).

        N / A -+ M h / (2 I) with h = sqrt(12 I / A) of the rectangular section, left fibre first: signed,
        so that both are smooth in state and design. Plane sections, without the clamps' notches.
        """
        model, varied, strips = self.model, self.varied, self.model.strips
        scene, basis = model.system.scene, model.system.scene.strips[0].basis
        d1, d2 = (in_order(basis.evaluate(stations, k)[..., None], model.shape)[..., 0] for k in (1, 2))
        still = np.stack([in_order(s.control_points, model.shape) for s in scene.strips], axis=-1)
        at_rest = still[..., None, None] / model.length
        rest, curve = Curve.of(d1, d2, at_rest), Curve.of(d1, d2, self.points)
        natural = {e.strip: model.length * e.natural_curvature for e in scene.of(Bending)}
        curvature = np.array([natural[s.name] for s in scene.strips])[:, None, None]
        curvature, speed = curvature + rest.turning / rest.speed, rest.speed * varied.longer
        bend = curve.turning / (curve.speed if strips.measure else speed) - curvature
        rigidity, drop = varied.along(model, stations)
        curled = laws.curl_factors(bend, drop, varied.curl)[1] if varied.curl.any() else 1.0
        moment = rigidity * bend * curled
        side = moment * model.energy * np.sqrt(3.0 / (varied.area * varied.second_moment))
        force: Any = 0.0
        if strips.stretching.any():
            force = varied.stretching * (curve.speed / speed - 1.0 - strips.strain[:, None, None])
        if len(self.axial):
            parts = [e.modes for e in scene.of(MixedStretching) if e.strip == scene.strips[0].name]
            shown = np.column_stack([all_modes(modes, stations) for modes in parts]) @ model.to_modes
            force = force + times_each(shown, self.axial)
        mean = force * (model.energy / model.length / varied.area)
        return np.stack((mean - side, mean + side)).transpose(3, 4, 2, 1, 0)


def _ordered(free: Array, inner: Array, clamped: Array) -> Array:
    """Control points in the order of elimination: P_2 ... P_(n-3), P_1, P_(n-2), P_(n-1), P_0."""
    many = np.broadcast_shapes(free.shape[1:], inner.shape[1:])
    return np.concatenate([np.broadcast_to(p, (len(p), *many)) for p in (free, inner, clamped[::-1])])
