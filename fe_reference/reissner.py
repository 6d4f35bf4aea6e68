"""Planar geometrically exact beam element with shear, two nodes, one integration point, as scikit-fem forms.

With the position r(s), the turn phi(s) of the cross-section from the reference, its unit normal t = (cos,
sin)(phi + a) and n = t turned by +90 deg, where a is the angle of the reference tangent:

    eps = r'.t - 1,    gamma = r'.n,    kappa = phi'        (' = d/ds, reference arc length)
    U = integral of (EA eps^2 + k G A gamma^2 + EI kappa^2) / 2 ds        [J]

Both fields are linear in an element and the integral is taken at its midpoint: no locking, error of second
order in the element length. Exact for any displacement and rotation within linear elastic section laws in
these strains.

Source: E. Reissner, J. Appl. Math. Phys. (ZAMP) 23 (1972) 795-804; J. C. Simo, L. Vu-Quoc, Comput. Methods
Appl. Mech.
Eng. 58 (1986) 79-116.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, BilinearForm, DiscreteField, LinearForm

from .mesh import Elements

Array = NDArray[np.float64]


def _variation(v: Any, w: Any) -> tuple[Array, Array, Array]:
    """Return the first variation of (eps, gamma, kappa) in the direction of the field v."""
    slope_x, slope_y, turn = v.grad[0, 0], v.grad[1, 0], v[2]
    eps = slope_x * w.cos + slope_y * w.sin + turn * w.gamma
    gamma = slope_y * w.cos - slope_x * w.sin - turn * (1.0 + w.eps)
    return eps, gamma, v.grad[2, 0]


def _section_forces(w: Any) -> tuple[Array, Array, Array]:
    return w.EA * w.eps, w.GA * w.gamma, w.EI * w.kappa


@LinearForm
def internal_force(v: Any, w: Any) -> Any:
    """Virtual work of the section forces: N d(eps) + V d(gamma) + M d(kappa)."""
    (axial, shear, moment), (eps, gamma, kappa) = _section_forces(w), _variation(v, w)
    return axial * eps + shear * gamma + moment * kappa


def _material(u: Any, v: Any, w: Any) -> Any:
    (eps_u, gamma_u, kappa_u), (eps_v, gamma_v, kappa_v) = _variation(u, w), _variation(v, w)
    return w.EA * eps_u * eps_v + w.GA * gamma_u * gamma_v + w.EI * kappa_u * kappa_v


@BilinearForm
def material_stiffness(u: Any, v: Any, w: Any) -> Any:
    """The part of the second variation that comes from the change of the strains alone."""
    return _material(u, v, w)


@BilinearForm
def tangent_stiffness(u: Any, v: Any, w: Any) -> Any:
    """Second variation of the energy: material part, and forces times second variation of strains."""
    axial, shear, _ = _section_forces(w)

    def normal_slope(a: Any) -> Any:
        return a.grad[1, 0] * w.cos - a.grad[0, 0] * w.sin

    def axial_slope(a: Any) -> Any:
        return a.grad[0, 0] * w.cos + a.grad[1, 0] * w.sin

    eps_uv = u[2] * normal_slope(v) + v[2] * normal_slope(u) - u[2] * v[2] * (1.0 + w.eps)
    gamma_uv = -u[2] * axial_slope(v) - v[2] * axial_slope(u) - u[2] * v[2] * w.gamma
    return _material(u, v, w) + axial * eps_uv + shear * gamma_uv


class Reissner:
    """Forces, tangents and energies of Reissner elements; same interface as `corotational.Corotational`."""

    def __init__(self, elements: Elements, basis: Basis) -> None:
        self.elements = elements
        self.basis = basis
        self._tangent = (elements.chord / elements.length)[:, :, None]
        self._angle = np.arctan2(elements.chord[1], elements.chord[0])[:, None]
        self._rigidities = {
            "EA": DiscreteField(elements.axial_rigidity[:, None]),
            "GA": DiscreteField(elements.shear_rigidity[:, None]),
            "EI": DiscreteField(elements.flexural_rigidity[:, None]),
        }

    @property
    def force_rigidity(self) -> Array:
        """The larger of EA and kGA of the elements (E,) [N]."""
        return np.maximum(self.elements.axial_rigidity, self.elements.shear_rigidity)

    def _state(self, displacement: Array) -> dict[str, DiscreteField]:
        """Return the strains at the midpoints and the direction of the sections as scikit-fem fields."""
        field: Any = self.basis.interpolate(self._nodal(displacement))
        (slope_x, slope_y, kappa), turn = field.grad[:, 0], field[2]
        cosine, sine = np.cos(turn + self._angle), np.sin(turn + self._angle)
        # r'.t - 1 with r' = T + u' and T.t = cos(turn): the 1 cancels exactly for small turns
        eps = slope_x * cosine + slope_y * sine - 2.0 * np.sin(0.5 * turn) ** 2
        gamma = slope_y * cosine - slope_x * sine - np.sin(turn)
        values = {"eps": eps, "gamma": gamma, "kappa": kappa, "cos": cosine, "sin": sine}
        return {name: DiscreteField(value) for name, value in values.items()} | self._rigidities

    def _nodal(self, displacement: Array) -> Array:
        """Return the global vector of an element-wise displacement (6, E)."""
        vector = np.zeros(self.basis.N)
        vector[self.basis.element_dofs] = displacement
        return vector

    def forces(self, displacement: Array) -> Array:
        """Return the nodal forces and moments (6, E) [N, N m] that hold the elements: the gradient of U."""
        return internal_force.elemental(self.basis, **self._state(displacement)).data.reshape(6, -1)

    def tangents(self, displacement: Array) -> Array:
        """Return the derivative (6, 6, E) of the nodal forces."""
        return tangent_stiffness.elemental(self.basis, **self._state(displacement)).data.reshape(6, 6, -1)

    def material_tangents(self, displacement: Array) -> Array:
        """Return the part of it that comes from the change of the strains alone, (6, 6, E)."""
        return material_stiffness.elemental(self.basis, **self._state(displacement)).data.reshape(6, 6, -1)

    def axial_strains(self, displacement: Array) -> Array:
        """Return eps at the midpoints (E,)."""
        strain: Array = self._state(displacement)["eps"][:, 0]
        return strain

    def axial_slopes(self, displacement: Array) -> Array:
        """Return d eps / d u, (6, E) [1/m]."""
        w, length = self._state(displacement), self.elements.length
        c, s, half = w["cos"][:, 0] / length, w["sin"][:, 0] / length, 0.5 * w["gamma"][:, 0]
        return np.stack([-c, -s, half, c, s, half])

    def axial_curvatures(self, displacement: Array) -> Array:
        """Return d^2 eps / d u^2, (6, 6, E) [1/m^2]."""
        w, length = self._state(displacement), self.elements.length
        c, s = 0.5 * w["cos"][:, 0] / length, 0.5 * w["sin"][:, 0] / length
        zero, turned = np.zeros_like(c), np.array([0.0, 0.0, 1.0, 0.0, 0.0, 1.0])
        mixed = np.stack([s, -c, zero, -s, c, zero])[:, None] * turned[None, :, None]
        both = np.outer(turned, turned)[..., None] * 0.25 * (1.0 + w["eps"][:, 0])
        second: Array = mixed + mixed.transpose(1, 0, 2) - both
        return second

    def energies(self, displacement: Array) -> tuple[Array, Array, Array]:
        """Return bending, axial and shear energy of the elements, three arrays (E,) [J]."""
        w = self._state(displacement)
        length = self.elements.length
        terms = (("EI", "kappa"), ("EA", "eps"), ("GA", "gamma"))
        bending, axial, shear = (0.5 * length * (w[r] * w[strain] ** 2)[:, 0] for r, strain in terms)
        return bending, axial, shear

    def distortion(self, displacement: Array) -> float:
        """Return the largest turn of an element end from its midpoint [rad]."""
        return float(0.5 * np.abs(displacement[5] - displacement[2]).max())
