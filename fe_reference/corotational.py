"""Planar corotational Euler-Bernoulli beam element of two nodes, all elements at once.

The strains of an element are taken in the frame of its chord, which turns with it:

    eps = (l - l0) / l0,    theta_i = phi_i - beta,    i = 1, 2

with chord length l (l0 at rest), turn of the chord beta and turns of the nodes phi_i from the reference. The
energy is

    U = EA l0 eps^2 / 2 + (2 EI / l0) (theta_1^2 + theta_1 theta_2 + theta_2^2)        [J]

so that N = EA eps and M_1 = EI/l0 (4 theta_1 + 2 theta_2), M_2 = EI/l0 (2 theta_1 + 4 theta_2). Rotations of
the chord are exact; the element itself is a straight linear beam in its own frame, which leaves an error of
second order in l0 (the bow of the element does not shorten its chord). No shear, no rotary inertia of the
section.

Source: M. A. Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1 (1991), ch. 7.
"""

import numpy as np
from numpy.typing import NDArray

from .mesh import Elements

Array = NDArray[np.float64]


def wrapped(angle: Array) -> Array:
    """Return the angle [rad] less whole turns, in [-pi, pi]: nodes and chords may turn by any amount."""
    return angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi))


def outer(a: Array, b: Array) -> Array:
    """Return the products (6, 6, E) of two sets of rows (6, E)."""
    return a[:, None] * b[None, :]


def _directions(c: Array, s: Array) -> tuple[Array, Array]:
    """Return d l / d u and l d beta / d u (6, E) of chords along (c, s)."""
    zero = np.zeros_like(c)
    return np.stack([-c, -s, zero, c, s, zero]), np.stack([s, -c, zero, -s, c, zero])


class Corotational:
    """Forces, tangents and energies of corotational elements with given reference geometry.

    The displacement of an element is (u_x1, u_y1, phi_1, u_x2, u_y2, phi_2), arrays (6, E).
    """

    def __init__(self, elements: Elements) -> None:
        self.elements = elements

    @property
    def force_rigidity(self) -> Array:
        """EA of the elements, what strains of the axis are multiplied with (E,) [N]."""
        return self.elements.axial_rigidity

    def _frame(self, displacement: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Return chord length, its unit vector (2, E), strain and the two local turns."""
        e = self.elements
        step = displacement[3:5] - displacement[0:2]
        chord = e.chord + step
        length = np.hypot(*chord)
        # (l^2 - l0^2) / (l + l0) from the displacements: no cancellation of two nearly equal lengths
        strain = np.sum((2.0 * e.chord + step) * step, axis=0) / ((length + e.length) * e.length)
        turn = np.arctan2(e.chord[0] * chord[1] - e.chord[1] * chord[0], np.sum(e.chord * chord, axis=0))
        return (
            length,
            chord / length,
            strain,
            wrapped(displacement[2] - turn),
            wrapped(displacement[5] - turn),
        )

    def _end_moments(self, first: Array, second: Array) -> tuple[Array, Array]:
        rate = self.elements.flexural_rigidity / self.elements.length
        return rate * (4.0 * first + 2.0 * second), rate * (2.0 * first + 4.0 * second)

    def forces(self, displacement: Array) -> Array:
        """Return the nodal forces and moments (6, E) [N, N m] that hold the elements: the gradient of U."""
        length, (c, s), strain, first, second = self._frame(displacement)
        axial = self.elements.axial_rigidity * strain
        moment_1, moment_2 = self._end_moments(first, second)
        shear = (moment_1 + moment_2) / length
        force_x, force_y = axial * c + shear * s, axial * s - shear * c
        return np.stack([-force_x, -force_y, moment_1, force_x, force_y, moment_2])

    def tangents(self, displacement: Array) -> Array:
        """Return the derivative (6, 6, E) of the nodal forces: material part and both geometric parts."""
        length, (c, s), strain, first, second = self._frame(displacement)
        along, across = _directions(c, s)
        axial = self.elements.axial_rigidity * strain
        shear = sum(self._end_moments(first, second)) / length
        return (
            self._material(length, along, across)
            + axial / length * outer(across, across)
            + shear / length * (outer(along, across) + outer(across, along))
        )

    def material_tangents(self, displacement: Array) -> Array:
        """Return the part of the tangents that comes from the change of the strains alone, (6, 6, E)."""
        length, (c, s), *_ = self._frame(displacement)
        return self._material(length, *_directions(c, s))

    def _material(self, length: Array, along: Array, across: Array) -> Array:
        e = self.elements
        zero, one = np.zeros_like(length), np.ones_like(length)
        turn_1 = np.stack([zero, zero, one, zero, zero, zero]) - across / length
        turn_2 = np.stack([zero, zero, zero, zero, zero, one]) - across / length
        rate = e.flexural_rigidity / e.length
        return (
            e.axial_rigidity / e.length * outer(along, along)
            + rate * (4.0 * (outer(turn_1, turn_1) + outer(turn_2, turn_2)))
            + rate * (2.0 * (outer(turn_1, turn_2) + outer(turn_2, turn_1)))
        )

    def axial_strains(self, displacement: Array) -> Array:
        """Return eps of the elements (E,)."""
        return self._frame(displacement)[2]

    def axial_slopes(self, displacement: Array) -> Array:
        """Return d eps / d u, (6, E) [1/m]."""
        _, (c, s), *_ = self._frame(displacement)
        return _directions(c, s)[0] / self.elements.length

    def axial_curvatures(self, displacement: Array) -> Array:
        """Return d^2 eps / d u^2, (6, 6, E) [1/m^2]."""
        length, (c, s), *_ = self._frame(displacement)
        across = _directions(c, s)[1]
        return outer(across, across) / (length * self.elements.length)

    def energies(self, displacement: Array) -> tuple[Array, Array, Array]:
        """Return bending, axial and shear energy of the elements, three arrays (E,) [J]; the last is zero."""
        _, _, strain, first, second = self._frame(displacement)
        e = self.elements
        bending = 2.0 * e.flexural_rigidity / e.length * (first * first + first * second + second * second)
        return bending, 0.5 * e.axial_rigidity * e.length * strain**2, np.zeros_like(strain)

    def distortion(self, displacement: Array) -> float:
        """Return the largest local turn of an element end [rad]; the element means little if it is large.

        Local turns are taken less whole turns. Half the turn of one end from the other is never more than
        the larger of them, unless a node has gained a whole turn.
        """
        _, _, _, first, second = self._frame(displacement)
        apart = 0.5 * np.abs(displacement[5] - displacement[2])
        return float(max(np.abs(first).max(), np.abs(second).max(), apart.max()))
