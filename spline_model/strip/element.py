"""One strip between two end frames: energy, gradient and Hessian in its own coordinates and its ends' poses.

Clamps hold by construction. With a root (P0, phi_r) and a tip (P_(n-1), phi_t) that are fixed to
the ground or carried by bodies,

    P_1 = P_0 + s_A k_A (cos, sin)(phi_r),    P_(n-2) = P_(n-1) - s_B k_B (cos, sin)(phi_t),

k_A and k_B the distances at rest. Own coordinates w = (P_2 ... P_(n-3), s_A, s_B); axial forces a.
Control points stand in the order of elimination: P_2 ... P_(n-3), P_1, P_(n-2), P_(n-1), P_0. The
element's coordinates are (w, coupled axial forces, pose of the tip's body, pose of the root's, mean
axial force). Those of a grounded end do not exist; the last one only that of inextensible strips: no w
can give a straight strip another length, so its mean axial force cannot be condensed. All is
dimensionless (lengths over L, energy over EI/L) and in the ground's frame, so that dead loads are
constant.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.strip.compiled import aligned
from spline_model.strip.laws import TERMS

Array = NDArray[np.float64]
GROUNDED = -1

VALUE, FIRST, SECOND, BEYOND = range(4)
"""Places of ``Shape.tables``."""
WHERE, WEIGHT = range(2)
"""Places of ``Shape.rule``."""
SPEED, CURVATURE, RIGIDITY, CURL, DROP = range(5)
MODES = DROP + TERMS
"""Places along a strip, ``Strips.along``."""
STRETCHING, STRAIN, ROOT, TIP, REACH, PER_U, ON_POINTS = 0, 1, 2, 5, 8, 10, 16
"""Places of a strip's numbers."""
LEVER, GRADIENT, POINTS = -3, -2, -1
"""Last rows of ``Local.nodal``."""
HESSIAN_AT, TANGENT_AT, SPEED_AT, MOMENT_AT, PULL_AT, GIVEN, FORCE_AT, LANES = 8, 18, 20, 21, 22, 23, 29, 30
"""Rows of ``Local.lanes`` behind x', y', x'', y'' and the derivatives of the energy in them, and their count:
its second derivatives, the unit tangent, |C'|, the moment, the derivative in N, what is given there, and
N."""
LAST = -1
"""Row of g in ``Local.reduced``."""


class Shape(NamedTuple):
    """Basis at the G Gauss points, the same for all strips, points in the order of elimination.

    order (n,) control point at each place; tables (6, G, n) the basis, its first and second derivatives and
    the integrals from u to 1 of it, of u and of u^2 times it; rule (2, G) u and weights; curve (2, n, G) both
    derivatives once more; products (4, G, P) of derivatives 11, 12, 21 and 22 of pairs i <= j of points, j by
    j, P filled up to eights.
    """

    order: NDArray[np.int64]
    tables: Array
    rule: Array
    curve: Array
    products: Array

    @classmethod
    def of(cls, order: NDArray[np.int64], tables: Array, rule: Array) -> Shape:
        """With all that follows from the tables."""
        n, points = len(order), rule.shape[1]
        curve, products = aligned((2, n, points), (4, points, -(-n * (n + 1) // 16) * 8))
        curve[:] = tables[FIRST : SECOND + 1].transpose(0, 2, 1)
        j, i = np.tril_indices(n)
        for place, (of_i, of_j) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
            products[place, :, : len(i)] = (curve[of_i, i] * curve[of_j, j]).T
        return cls(order=order, tables=tables, rule=rule, curve=curve, products=products)


class Strips(NamedTuple):
    """What tells S strips from one another, in few arrays: each costs every kernel that they are passed to.

    along (S, G, 11 + K): J0, stress-free curvature, EI, the numbers of ``curl_law``, and the modes of the
    axial force at the Gauss points, orthonormal as compliances weigh them, of which ``split`` belong to the
    stretching, the others to the sliding of control points; compliance (S, K) of each; gain (S, K) the
    stiffness by which they are condensed; numbers (S, 16 + 2 n): EA of stretching by quadrature, 0 for the
    mixed form; natural strain; root and tip, three each, the clamped point in its body's frame, or on the
    ground, and direction at rest [rad]; reach, k_A and k_B; dead load per du, a parabola: two for each of 1,
    u and u^2, and on the control points; roots, tips (S,) bodies or GROUNDED; coupled: leading axial forces
    that stay beside w, where a compliance is too small to divide by; outer: 1 if the mean stays beside the
    bodies, or 0; measure: of all.
    """

    along: Array
    compliance: Array
    gain: Array
    numbers: Array
    roots: NDArray[np.int64]
    tips: NDArray[np.int64]
    split: int
    coupled: int
    outer: int
    measure: int

    @property
    def speed(self) -> Array:
        """J0 (S, G)."""
        return self.along[..., SPEED]

    @property
    def modes(self) -> Array:
        """Modes of the axial force (S, G, K)."""
        return self.along[..., MODES:]

    @property
    def root(self) -> Array:
        """Clamped point and direction at the root (S, 3)."""
        return self.numbers[:, ROOT:TIP]

    @property
    def tip(self) -> Array:
        """Clamped point and direction at the tip (S, 3)."""
        return self.numbers[:, TIP:REACH]

    @property
    def reach(self) -> Array:
        """k_A, k_B (S, 2)."""
        return self.numbers[:, REACH:PER_U]


class Local(NamedTuple):
    """What one evaluation of S strips fills, in few arrays as ``Strips``; E = W + coupled + 7 coordinates.

    nodal (S, 2 n + K + 3, 2 n), in the control points: the Hessian, the coupling of the axial forces, and
    in its last rows LEVER, GRADIENT and POINTS: moment of the tip's reaction about the points (n), gradient
    and the points themselves; reduced (S, E + K + 1, E), in the element's coordinates: h, then b, the
    coupling, and last g; gap (S, K) of the axial forces; lanes (S, LANES, G) at the Gauss points; pairs
    (4, P) of control points as in ``Shape``; map (S, 16) of the ends; scratch (17, 8).
    """

    nodal: Array
    reduced: Array
    gap: Array
    lanes: Array
    pairs: Array
    map: Array
    scratch: Array

    @classmethod
    def of(cls, strips: Strips, control_points: int) -> Self:
        """Fresh ones for these strips, of their kind of numbers."""
        n, (s, gauss_points, k) = control_points, strips.modes.shape
        size = 2 * n - 6 + strips.coupled + 7
        shapes = (
            (s, 2 * n + k + 3, 2 * n),
            (s, size + k + 1, size),
            (s, k),
            (s, LANES, gauss_points),
            (4, -(-n * (n + 1) // 16) * 8),
            (s, 16),
            (17, 8),
        )
        local = cls(*aligned(*shapes, dtype=strips.along.dtype))
        local.lanes[:, GIVEN + 3 : FORCE_AT] = 1.0  # of ``curl_law``, where nothing curls
        return local

    @property
    def points(self) -> Array:
        """Control points (S, 2 n)."""
        return self.nodal[:, POINTS]
