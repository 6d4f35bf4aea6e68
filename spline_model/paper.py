"""The paper's printed system: gradient and Hessian of L(z) = V - lambda psi - f q (Eqs 4 to 20).

Unknowns z are control points and bodies' poses q, axial forces a and multipliers lambda. Strips are curves
C(u) = sum N_i(u) P_i of their control points (Eqs 2 and 3), ' = d/du:

    phi = (x' y'' - y' x'') / |C'|^2,    v = |C'|                               (Eqs 8 and 9)
    V = sum of w (bending energy of phi and v + stretching energy of v)         (Eqs 10 and 13)
    psi = (P_end - X - R(theta) b, angle of C' - theta - the one at rest)       (Eqs 5 and 6)

and driven coordinates (Eq 7). Equilibrium is a vanishing gradient (Eq 19). The point laws are those of
``spline_model.strip``, which the elements share; from there on this is another way to the same equilibria.
Forces as printed (Eqs 12 and 15, without d|C'|/dq) are a measure of their own: they have no energy.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import GROUND, MEASURES, Bending, Clamp, MixedStretching, Stretching, StripDamping
from spline_model.effects.base import Constraint
from spline_model.frames import carry, fold, fold_tangent
from spline_model.scene import Scene
from spline_model.strip.compiled import kernel, lane, part
from spline_model.strip.laws import SPATIAL, TERMS, bending_law, curl_factors, curl_law, stretching_law

Array = NDArray[np.float64]
Places = NDArray[np.int64]

PRINTED = 2
"""Code of the published forces, which ``spline_model.strip.laws`` does not have."""
SPEED, REST, CURVATURE, RIGIDITY, DROP = range(5)
"""Places in ``Strips.along``."""
STRAIN, STRETCHING, CURL, RELAXATION = range(4)
"""Places in ``Strips.own``."""
SIGN, ACROSS, ALONG, DIRECTION = range(4)
"""Places in ``Clamps.numbers``."""
WORK = 9
"""Rows of the working array of ``assemble``."""


class Strips(NamedTuple):
    """S strips of n control points and K axial forces at P Gauss points; what does not act is zero.

    first, axial (S,): places in z of the first x and of the first axial force. curve (P, 2, n): first and
    second derivatives of the basis; weight (P,) of Gauss; modes (P, K) of the axial forces. along (S, P, 11):
    J0 [m], curvature at rest and stress-free [1/m], EI [N m^2], the coefficients of ``curl_law`` [1]. own (S,
    4): natural strain, EA of stretching by quadrature [N], the flattening of ``curl_law`` [m], relaxation
    time [s]. compliance (S, K, K): of the axial forces [m/N]; measure: its code.
    """

    first: Places
    axial: Places
    curve: Array
    weight: Array
    modes: Array
    along: Array
    own: Array
    compliance: Array
    measure: int

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The strips of a scene, which have one basis and quadrature."""
        bends, layout = scene.of(Bending), scene.layout
        basis = scene.strips[0].basis
        u, weight = basis.gauss_rule(bends[0].gauss_points)
        curve = np.stack([basis.evaluate(u, order) for order in (1, 2)], axis=1)
        mixed = [[e for e in scene.of(MixedStretching) if e.strip == bend.strip] for bend in bends]
        values = [e.modes.evaluate(u) for e in mixed[0]]
        modes = np.ascontiguousarray(np.concatenate(values or [np.zeros((len(u), 0))], axis=1))
        along, own = np.zeros((len(bends), len(u), DROP + TERMS)), np.zeros((len(bends), 4))
        compliance = np.zeros((len(bends), modes.shape[1], modes.shape[1]))
        stretched = {e.strip: e for e in scene.of(Stretching)}
        own[:, RELAXATION] = sum(damping.relaxation_time for damping in scene.of(StripDamping))
        for s, (bend, parts) in enumerate(zip(bends, mixed, strict=True)):
            (x1, x2), (y1, y2) = (curve @ scene.strip(bend.strip).control_points).T
            speed, at = np.hypot(x1, y1), along[s].T
            at[SPEED], at[REST] = speed, (x1 * y2 - y1 * x2) / speed**3
            at[CURVATURE] = at[REST] + bend.natural_curvature
            at[RIGIDITY] = bend.rigidity_at(basis.degree, u)
            if bend.curl is not None:
                at[DROP:], own[s, CURL] = bend.curl.drop(basis.degree, u).T, bend.curl.flattening
            if bend.strip in stretched:
                own[s, STRETCHING] = stretched[bend.strip].axial_rigidity
                own[s, STRAIN] = stretched[bend.strip].natural_strain
            done = 0
            for each, value in zip(parts, values, strict=True):
                own[s, STRAIN], block = each.natural_strain, slice(done, done + each.modes.count)
                soft = weight * speed * each.compliance_at(u)
                compliance[s, block, block], done = value.T @ (soft[:, None] * value), block.stop
        return cls(
            first=np.array([layout.strips[bend.strip][0] for bend in bends], dtype=np.int64),
            axial=layout.coordinate_count + modes.shape[1] * np.arange(len(bends)),
            curve=curve,
            weight=weight,
            modes=modes,
            along=along,
            own=own,
            compliance=compliance,
            measure=MEASURES.index(bends[0].measure),
        )

    def with_share(self, share: float) -> Strips:
        """The same with a share of the pre-strain."""
        if share == 1.0:
            return self
        along, own = self.along.copy(), self.own.copy()
        along[..., CURVATURE] = (1.0 - share) * along[..., REST] + share * along[..., CURVATURE]
        own[:, STRAIN] *= share
        return self._replace(along=along, own=own)

    def derivatives(self, z: Array) -> Array:
        """Return x', y', x'', y'' by u at the unknowns z (..., N), shape (4, ..., S, P) [m]."""
        places = self.first[:, None] + np.arange(2 * self.curve.shape[2])
        found = self.curve @ z[..., places].reshape(*z.shape[:-1], len(places), 1, -1, 2)
        return np.stack([found[..., order, axis] for order in range(2) for axis in range(2)])

    def strains(self, z: Array) -> Array:
        """Return what the axial forces see at the unknowns z (..., N), in their order: (..., S K) [m]."""
        x, y, _, _ = self.derivatives(z)
        gaps = np.hypot(x, y) - (1.0 + self.own[:, STRAIN, None]) * self.along[..., SPEED]
        return np.asarray((self.weight * gaps @ self.modes).reshape(*z.shape[:-1], -1))

    def moments(self, z: Array) -> Array:
        """Return bending moments (S, P) at the unknowns z (N,) [N m]."""
        x1, y1, x2, y2 = self.derivatives(z)
        square, along, curl = x1**2 + y1**2, np.moveaxis(self.along, 2, 0), self.own[:, CURL, None]
        speed = along[SPEED] if MEASURES[self.measure] == "material" else np.sqrt(square)
        strain = (x1 * y2 - y1 * x2) / square / speed - along[CURVATURE]
        factor = curl_factors(strain, self.along[..., DROP:], curl)[1] if curl.any() else 1.0
        return np.asarray(along[RIGIDITY] * strain * factor)


class Clamps(NamedTuple):
    """C clamped ends.

    place (C, 7): of x and y of the end's control point, of its neighbour, and of x, y and angle of the body
    among z, -1 of the ground. row (C,): of the first of three multipliers. numbers (C, 4): sign, +1 at the
    start of a strip and -1 at its end, so that sign * (inner - end) points along C'; clamped point from the
    body's centre [m]; angle of C' at rest [rad].
    """

    place: Places
    row: Places
    numbers: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """The clamped strip ends of a scene."""
        place, row, numbers = [], [], []
        for clamp, (first, _) in zip(scene.of(Constraint), scene.layout.multipliers, strict=True):
            if not isinstance(clamp, Clamp):
                continue
            strip, (start, count) = scene.strip(clamp.strip), scene.layout.strips[clamp.strip]
            sign, end, inner = (1, 0, 1) if clamp.end == "start" else (-1, count - 1, count - 2)
            x, y = sign * (strip.control_points[inner] - strip.control_points[end])
            centre, body = np.zeros(2), [-1, -1, -1]
            if clamp.to != GROUND:
                at = scene.layout.bodies[clamp.to]
                centre, body = scene.body(clamp.to).centre, [at, at + 1, at + 2]
            place.append([start + 2 * at + k for at in (end, inner) for k in range(2)] + body)
            row.append(first)
            numbers.append((sign, *(strip.control_points[end] - centre), math.atan2(y, x)))
        return cls(
            np.array(place, dtype=np.int64).reshape(-1, 7),
            np.array(row, dtype=np.int64),
            np.array(numbers, dtype=float).reshape(-1, 4),
        )

    @property
    def grounded(self) -> bool:
        """Whether any of them is on the ground."""
        return bool((self.place[:, 4:] < 0).any())

    def gaps(self, z: Array) -> tuple[Array, Array]:
        """Return gaps of the points (2, ..., C), and chords to their neighbours along and across the clamps
        (2, ..., C) at unknowns z (..., N) [m]."""
        end, inner, pose = np.split(np.where(self.place < 0, 0.0, z[..., self.place]), (2, 4), axis=-1)
        sign, x, y, direction = self.numbers.T
        cos, sin = np.cos(pose[..., 2]), np.sin(pose[..., 2])
        arm = np.stack((cos * x - sin * y, sin * x + cos * y))
        chord, turn = np.moveaxis(inner - end, -1, 0) * sign, direction + pose[..., 2]
        cos, sin = np.cos(turn), np.sin(turn)
        along, across = cos * chord[0] + sin * chord[1], cos * chord[1] - sin * chord[0]
        return np.moveaxis(end - pose[..., :2], -1, 0) - arm, np.stack((along, across))


def strips_of(system: System) -> Strips:
    """Return the strips of a system, made once."""
    made: Strips = system.once("strips", lambda own: Strips.of(own.scene))
    return made


def clamps_of(system: System) -> Clamps:
    """Return the clamps of a system, made once."""
    made: Clamps = system.once("clamps", lambda own: Clamps.of(own.scene))
    return made


def evaluate(
    system: System, z: Array, load_factor: float, gradient: Array, hessian: Array, share: float = 1.0
) -> tuple[float, float]:
    """Fill gradient (N,) and hessian (N, N) at z (N,); returns bending and axial energy [J].

    Equilibrium is gradient = 0: its rows are force balance, axial compatibility and, with a minus sign, the
    constraints. Frames are put into z where their bodies carry them. share [1]: of weight and pre-strain.
    """
    frames, arms, drives, loads = system.frames, np.empty_like(z), system.drives, system.loads
    if frames.place.size:
        carry(z, frames, arms)
    strips = strips_of(system).with_share(share)
    bending, axial, _ = assemble(z, strips, clamps_of(system), gradient, hessian, room(strips))
    gradient[drives.row] -= z[drives.coordinate] - drives.origin - load_factor * drives.target  # Eq 7
    gradient[drives.coordinate] -= z[drives.row]
    hessian[drives.row, drives.coordinate] = hessian[drives.coordinate, drives.row] = -1.0
    np.subtract.at(gradient, loads.coordinate, load_factor * loads.value)
    gradient[: system.weight.size] -= share * system.weight
    system.followers.subtract(z, load_factor, gradient, hessian)
    if system.springs.size:
        at = system.layout.poses
        gradient[at] += system.springs @ (z[at] - system.rest[at])
        hessian[at, at] += system.springs
    if frames.place.size:
        fold(gradient, frames, arms)
        fold_tangent(hessian, system.scales.energy / system.scales.length**2, frames, arms, arms)
    return bending, axial


def room(strips: Strips) -> Array:
    """Return a working array of ``assemble``."""
    return np.empty((WORK, 2 * strips.curve.shape[2]))


@kernel()
def assemble(z, strips, clamps, gradient, hessian, work):
    """Fill gradient (N,) and hessian (N, N) of what strips and clamps do; work as of ``room``.

    Returns bending and axial energy [J] and the least v / J0.
    """
    bending, axial, slowest = 0.0, 0.0, np.inf
    for i in range(z.size):
        gradient[i] = 0.0
        for j in range(z.size):
            hessian[i, j] = 0.0
    for s in range(strips.first.size):
        for p in range(strips.weight.size):
            bent, stretched, v = _add_point(s, p, z, strips, gradient, hessian, work)
            bending += bent
            axial += stretched
            slowest = min(slowest, v / strips.along[s, p, SPEED])
        axial -= _add_compliance(s, z, strips, gradient, hessian)
    for c in range(clamps.row.size):
        _subtract_clamp(z, clamps.place[c], clamps.row[c], clamps.numbers[c], gradient, hessian, work)
    return bending, axial, slowest


@part()
def derivatives(curve, z, first):
    """Return x', y', x'', y'' of a curve (2, n) whose control points begin at z[first]."""
    x1 = y1 = x2 = y2 = 0.0
    for a in range(curve.shape[1]):
        x, y = z[first + 2 * a], z[first + 2 * a + 1]
        x1 += curve[0, a] * x
        y1 += curve[0, a] * y
        x2 += curve[1, a] * x
        y2 += curve[1, a] * y
    return x1, y1, x2, y2


@part()
def turning(x1, y1, x2, y2):
    """Return phi, v and their derivatives in (x', y', x'', y'')."""
    square = x1 * x1 + y1 * y1
    v, phi = math.sqrt(square), (x1 * y2 - y1 * x2) / square
    by_phi = (y2 - 2.0 * phi * x1) / square, (-x2 - 2.0 * phi * y1) / square, -y1 / square, x1 / square
    return phi, v, by_phi, (x1 / v, y1 / v, 0.0, 0.0)


@part()
def _add_point(s, p, z, strips, gradient, hessian, work):
    """Add a Gauss point of a strip; returns its bending energy, its axial energy and v [m].

    E(phi, v) + N v, with the axial force N, has derivatives in (x', y', x'', y''), and these in z.
    """
    first, axial, curve, modes = strips.first[s], strips.axial[s], strips.curve[p], strips.modes[p]
    along, own, weight, force = strips.along[s, p], strips.own[s], strips.weight[p], 0.0
    x1, y1, x2, y2 = derivatives(curve, z, first)
    phi, v, phi_i, v_i = turning(x1, y1, x2, y2)
    for k in range(modes.size):
        force += modes[k] * z[axial + k]
    bent, m, m_phi, m_v, f, f_phi, f_v = bend(phi, v, along, own[CURL], strips.measure)
    stretched, by_v, by_vv = stretch(v, along[SPEED], own, strips.measure)
    f, f_v, over = f + by_v + force, f_v + by_vv, 1.0 / v
    for i in range(4):
        work[4, i] = weight * (m * phi_i[i] + f * v_i[i])
        s_i = 2.0 * v * v_i[i]
        for j in range(4):
            same = 1.0 if i == j and i < 2 else 0.0
            c_ij = 0.0
            if i + j == 3:  # (x', y'') and (y', x'')
                c_ij = 1.0 if i == 0 or i == 3 else -1.0
            s_j = 2.0 * v * v_i[j]
            phi_ij = (c_ij - phi_i[i] * s_j - phi_i[j] * s_i - 2.0 * phi * same) * over * over
            v_ij = (same - v_i[i] * v_i[j]) * over
            bends = phi_i[i] * (m_phi * phi_i[j] + m_v * v_i[j]) + m * phi_ij
            work[5 + i, j] = weight * (bends + v_i[i] * (f_phi * phi_i[j] + f_v * v_i[j]) + f * v_ij)
    _add_to_points(first, curve, gradient, hessian, work)
    gap = weight * (v - (1.0 + own[STRAIN]) * along[SPEED])
    for k in range(modes.size):
        row, share = hessian[axial + k], weight * modes[k]
        gradient[axial + k] += modes[k] * gap
        for a in range(curve.shape[1]):
            row[first + 2 * a] += share * v_i[0] * curve[0, a]
            row[first + 2 * a + 1] += share * v_i[1] * curve[0, a]
    return weight * bent, weight * stretched + force * gap, v


@lane()
def _add_to_points(first, curve, gradient, hessian, work):
    """Add gradient work[4] and Hessian work[5:9] in (x', y', x'', y'') to those of the control points."""
    for i in range(4):
        h0, h1, h2, h3 = work[5 + i, 0], work[5 + i, 1], work[5 + i, 2], work[5 + i, 3]
        for b in range(curve.shape[1]):
            work[i, 2 * b] = h0 * curve[0, b] + h2 * curve[1, b]
            work[i, 2 * b + 1] = h1 * curve[0, b] + h3 * curve[1, b]
    for a in range(curve.shape[1]):
        d1, d2 = curve[0, a], curve[1, a]
        for i in range(2):
            row = hessian[first + 2 * a + i]
            gradient[first + 2 * a + i] += d1 * work[4, i] + d2 * work[4, 2 + i]
            for b in range(2 * curve.shape[1]):
                row[first + b] += d1 * work[i, b] + d2 * work[2 + i, b]


@part()
def bend(phi, v, along, curl, measure):
    """Return the bending energy density and m, m_phi, m_v, f, f_phi, f_v; as published (Eq 12) without
    d|C'|/dq."""
    curvature, rigidity = along[CURVATURE], along[RIGIDITY]
    if measure == PRINTED:
        density, m, m_phi, m_v, _, _ = bending_law(phi, v, 1.0, curvature, rigidity, SPATIAL)
        ratio = phi / v
        slope = rigidity * (2.0 * ratio - curvature) / v
        return density, m, m_phi, m_v, -m * ratio, -slope, slope * ratio
    density, m, m_phi, m_v, f, f_v = bending_law(phi, v, along[SPEED], curvature, rigidity, measure)
    if curl > 0.0:
        by_energy, by_moment, by_tangent = curl_law(phi / along[SPEED] - curvature, along[DROP:], curl)
        density, m, m_phi = density * by_energy, m * by_moment, m_phi * by_tangent
    return density, m, m_phi, m_v, f, m_v, f_v


@part()
def stretch(v, speed, own, measure):
    """Return the energy density of stretching by quadrature, and its derivatives in v and v v."""
    strain, rigidity = own[STRAIN], own[STRETCHING]
    if rigidity == 0.0:
        return 0.0, 0.0, 0.0
    energy, by_v, by_vv = stretching_law(v, speed, strain, rigidity, min(measure, SPATIAL))
    if measure == PRINTED:  # Eq 15 without d|C'|/dq
        eps = v / speed - 1.0 - strain
        by_v -= 0.5 * rigidity * eps * eps
        by_vv -= rigidity * eps / speed
    return energy, by_v, by_vv


@part()
def _add_compliance(s, z, strips, gradient, hessian):
    """Subtract a C a / 2 of the axial forces, and mirror how they are coupled; returns that energy [J]."""
    first, axial, compliance, energy = strips.first[s], strips.axial[s], strips.compliance[s], 0.0
    for k in range(compliance.shape[0]):
        stretched = 0.0
        for j in range(compliance.shape[0]):
            stretched += compliance[k, j] * z[axial + j]
            hessian[axial + k, axial + j] = -compliance[k, j]
        gradient[axial + k] -= stretched
        energy += 0.5 * z[axial + k] * stretched
        for a in range(2 * strips.curve.shape[2]):
            hessian[first + a, axial + k] = hessian[axial + k, first + a]
    return energy


@part()
def _subtract_clamp(z, place, row, numbers, gradient, hessian, jacobian):
    """Subtract lambda psi of a clamped end, its gradient and its Hessian (Eqs 5 and 6).

    jacobian (3 or more, 7): filled, of psi in its end's point, that point's neighbour and the body's pose.
    """
    count, sign, ax, ay = 4, numbers[SIGN], numbers[ACROSS], numbers[ALONG]
    x = y = angle = 0.0
    if place[4] >= 0:
        count, x, y, angle = 7, z[place[4]], z[place[5]], z[place[6]]
        cos, sin = math.cos(angle), math.sin(angle)
        ax, ay = cos * ax - sin * ay, sin * ax + cos * ay
        hessian[place[6], place[6]] -= z[row] * ax + z[row + 1] * ay
    dx, dy = sign * (z[place[2]] - z[place[0]]), sign * (z[place[3]] - z[place[1]])
    square = dx * dx + dy * dy
    mx, my = math.cos(numbers[DIRECTION] + angle), math.sin(numbers[DIRECTION] + angle)
    gradient[row] -= z[place[0]] - x - ax
    gradient[row + 1] -= z[place[1]] - y - ay
    gradient[row + 2] -= math.atan2(mx * dy - my * dx, mx * dx + my * dy)
    for i in range(7):
        jacobian[0, i] = jacobian[1, i] = jacobian[2, i] = 0.0
    jacobian[0, 0] = jacobian[1, 1] = 1.0
    jacobian[0, 4] = jacobian[1, 5] = jacobian[2, 6] = -1.0
    jacobian[0, 6], jacobian[1, 6] = ay, -ax
    jacobian[2, 2], jacobian[2, 3] = -dy / square * sign, dx / square * sign
    jacobian[2, 0], jacobian[2, 1] = dy / square * sign, -dx / square * sign
    for i in range(count):
        for r in range(3):
            gradient[place[i]] -= z[row + r] * jacobian[r, i]
            hessian[row + r, place[i]] = hessian[place[i], row + r] = -jacobian[r, i]
    hxx = z[row + 2] * 2.0 * dx * dy / (square * square)
    hxy = z[row + 2] * (dy * dy - dx * dx) / (square * square)
    for i in range(4):
        for j in range(4):
            value = hxy if (i - j) % 2 else hxx if i % 2 == 0 else -hxx
            hessian[place[i], place[j]] -= value if i // 2 == j // 2 else -value
