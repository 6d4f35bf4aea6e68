"""A model made ready for computation: mesh, element law, dof numbering and exact master-slave reduction.

Reduced coordinates y: displacement and turn (u_x, u_y, phi) of every free node, strip by strip, then
displacement d (2,) of a reference point of the body and its turn theta. The node of a strip attached at the
offset b from that point
follows exactly, without penalty and without extra unknowns:

    u = d + (R(theta) - 1) b,    phi = theta

Forces are reduced with the transpose of the derivative P of that map; the tangent is P^T K P plus the
curvature of the map, -(R b).f on the diagonal entry of theta, with f the force of the elements on the
attached node.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from skfem.assembly.form.coo_data import COOData

from .corotational import Corotational
from .mesh import reference_elements, strip_basis
from .reissner import Reissner

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]


class Structure:
    """Mesh, element law and reduction of a model about its body's centre or another point of the body."""

    def __init__(self, model: "Model", point: Array | None = None) -> None:
        self.model = model
        self.basis = strip_basis(model)
        self.elements = reference_elements(model)
        self.law: Corotational | Reissner = (
            Corotational(self.elements)
            if model.element == "corotational"
            else Reissner(self.elements, self.basis)
        )
        self.point = model.body.centre if point is None else point
        self.strips, self.stations = len(model.strips), len(model.strips[0].nodes)
        #: elements and full dofs (strips, ...) in strip order
        self.last_elements = np.arange(1, self.strips + 1) * (self.stations - 1) - 1
        self.attached = np.arange(1, self.strips + 1) * self.stations - 1
        self.offsets = np.array([strip.nodes[-1] for strip in model.strips]) - self.point
        self._number()
        self._pattern()
        self.force_unit, self.moment_unit = self._units()
        self.scale = np.full(self.size, self.force_unit)
        self.scale[2::3] = self.moment_unit

    def _number(self) -> None:
        """Number the reduced coordinates; -1 marks what is clamped."""
        node = np.zeros((self.strips, self.stations), dtype=np.int64)
        node[[not strip.clamped for strip in self.model.strips], 0] = 1
        node[:, 1:-1] = 1
        free = node.ravel() == 1
        self.free_nodes = np.flatnonzero(free)
        self.free_dofs = (3 * self.free_nodes[:, None] + np.arange(3)).ravel()
        self.size = 3 * len(self.free_nodes) + 3
        reduced = np.full((self.strips * self.stations, 3), -1, dtype=np.int64)
        reduced[free] = np.arange(self.size - 3).reshape(-1, 3)
        reduced[self.attached] = np.arange(self.size - 3, self.size)
        self.reduced_dofs = reduced.ravel()[self.basis.element_dofs]

    def _pattern(self) -> None:
        """Keep where element entries go: those of free coordinates, and the one of the map's curvature."""
        rows, columns = np.broadcast_arrays(self.reduced_dofs[:, None], self.reduced_dofs[None, :])
        self._kept = ((rows >= 0) & (columns >= 0)).ravel()
        last = np.array([self.size - 1])
        self._indices = np.array(
            [np.concatenate([part.ravel()[self._kept], last]) for part in (rows, columns)], dtype=np.int32
        )
        self._kept_force = (self.reduced_dofs >= 0).ravel()
        self._force_indices = self.reduced_dofs.ravel()[None, self._kept_force]

    def _units(self) -> tuple[float, float]:
        """Return EI/L^2 [N] and EI/L [N m] of the stiffest strip: what residuals are measured in."""
        length = max(strip.length for strip in self.model.strips)
        rigidity = max(strip.section.flexural_rigidity for strip in self.model.strips)
        return rigidity / length**2, rigidity / length

    def arms(self, theta: float) -> Array:
        """Return the offsets of the attached nodes from the point, turned by theta, (strips, 2) [m]."""
        c, s = np.cos(theta), np.sin(theta)
        turned: Array = self.offsets @ np.array([[c, s], [-s, c]])
        return turned

    def displacement(self, y: Array) -> Array:
        """Return displacement and turn of all nodes, (nodes, 3) [m, rad]."""
        full = np.zeros((self.strips * self.stations, 3))
        full[self.free_nodes] = y[:-3].reshape(-1, 3)
        s, half = np.sin(y[-1]), 2.0 * np.sin(0.5 * y[-1]) ** 2
        # R - 1 written with sines: no cancellation at small turns
        full[self.attached, :2] = y[-3:-1] + self.offsets @ np.array([[-half, s], [-s, -half]])
        full[self.attached, 2] = y[-1]
        return full

    def element_displacement(self, y: Array) -> Array:
        """Return the displacements of the elements (6, E)."""
        local: Array = self.displacement(y).ravel()[self.basis.element_dofs]
        return local

    def reduced_force(self, forces: Array, theta: float) -> Array:
        """Assemble element forces (6, E) into the reduced coordinates, (size,) [N, N m]."""
        arms, end = self.arms(theta), self.last_elements
        local = forces.copy()
        local[5, end] += arms[:, 0] * forces[4, end] - arms[:, 1] * forces[3, end]
        data = local.ravel()[self._kept_force]
        assembled: Array = COOData(self._force_indices, data, (self.size,), None).toarray()
        return assembled

    def reduced_matrix(self, matrices: Array, theta: float, curvature: float) -> csc_matrix:
        """Assemble element matrices (6, 6, E) into the reduced coordinates as P^T K P + curvature at theta.

        The matrices are symmetric, so that the transpose of the assembled rows is the matrix by columns.
        """
        arms, end = self.arms(theta), self.last_elements
        slope = np.stack([-arms[:, 1], arms[:, 0]])  # d u / d theta of the attached nodes
        local = matrices.copy()
        local[5][:, end] += slope[0] * local[3][:, end] + slope[1] * local[4][:, end]
        local[:, 5][:, end] += slope[0] * local[:, 3][:, end] + slope[1] * local[:, 4][:, end]
        data = np.append(local.ravel()[self._kept], curvature)
        assembled: csc_matrix = COOData(self._indices, data, (self.size, self.size), None).tocsr().T
        return assembled

    def internal_force(self, y: Array) -> Array:
        """Return the gradient of the strain energy in the reduced coordinates, (size,) [N, N m]."""
        return self.reduced_force(self.law.forces(self.element_displacement(y)), y[-1])

    def tangent_stiffness(self, y: Array) -> csc_matrix:
        """Return the second derivative of the strain energy in the reduced coordinates (size, size)."""
        u = self.element_displacement(y)
        pull = self.law.forces(u)[3:5, self.last_elements]
        curvature = -float(np.sum(self.arms(y[-1]).T * pull))
        return self.reduced_matrix(self.law.tangents(u), y[-1], curvature)

    def energies(self, y: Array) -> tuple[float, float, float]:
        """Return bending, axial and shear energy of the strips [J]."""
        bending, axial, shear = self.law.energies(self.element_displacement(y))
        return float(bending.sum()), float(axial.sum()), float(shear.sum())
