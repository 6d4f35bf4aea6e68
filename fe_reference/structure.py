"""A model made ready for computation: mesh, element law, dof numbering and exact master-slave reduction.

Reduced coordinates y: displacement and turn (u_x, u_y, phi) of every free node, strip by strip, then for
every body the displacement d (2,) of its reference point and its turn theta. Attached ends of strips follow
their bodies as in `attachments`.

Gravity and natural strains, where they are named, are part of the potential here. They can be applied in
part: `share` goes from 0 to 1 on the way from the shape at rest to the state under both.
"""

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csc_matrix
from skfem.assembly.form.coo_data import COOData

from .attachments import GROUND, Attachments
from .corotational import Corotational
from .effects.loads import DeadLoad, weight
from .effects.named import Gravity, PreStrain
from .effects.prestrain import NaturalStrain
from .mesh import reference_elements, strip_basis
from .reissner import Reissner

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]


class Structure:
    """Mesh, element law and reduction of a model about its bodies' centres or other points of the bodies.

    Args:
        model: what is made ready.
        points: reference points of the bodies at rest (B, 2) [m]; default: their centres.
    """

    def __init__(self, model: "Model", points: ArrayLike | None = None) -> None:
        self.model = model
        self.basis = strip_basis(model)
        self.elements = reference_elements(model)
        self.law: Corotational | Reissner = (
            Corotational(self.elements)
            if model.element == "corotational"
            else Reissner(self.elements, self.basis)
        )
        centres = np.array([body.centre for body in model.bodies])
        self.points: Array = np.reshape(centres if points is None else np.asarray(points), (-1, 2))
        self.strips, self.stations = len(model.strips), len(model.strips[0].nodes)
        self.attachments = Attachments(model, self.points)
        self._number()
        self._pattern()
        self.force_unit, self.moment_unit = self._units()
        self.scale = np.full(self.size, self.force_unit)
        self.scale[2::3] = self.moment_unit
        strain, gravity = model.effects.find(PreStrain), model.effects.find(Gravity)
        self.natural = None if strain is None else NaturalStrain(self, strain)
        self.weight: DeadLoad | None = None if gravity is None else weight(self, gravity)

    def _number(self) -> None:
        """Number the reduced coordinates; -1 marks what is clamped."""
        free = np.ones((self.strips, self.stations), dtype=bool)
        free[[strip.root == GROUND for strip in self.model.strips], 0] = False
        free[[strip.tip == GROUND for strip in self.model.strips], -1] = False
        free.ravel()[self.attachments.node] = False
        self.free_nodes = np.flatnonzero(free)
        self.first_body = 3 * len(self.free_nodes)
        self.size = self.first_body + 3 * len(self.points)
        self.turns = np.arange(self.first_body + 2, self.size, 3)
        reduced = np.full((free.size, 3), -1, dtype=np.int64)
        reduced[self.free_nodes] = np.arange(self.first_body).reshape(-1, 3)
        bodies = np.arange(self.first_body, self.size).reshape(-1, 3)
        reduced[self.attachments.node] = bodies[self.attachments.body]
        self.reduced_dofs = reduced.ravel()[self.basis.element_dofs]

    def _pattern(self) -> None:
        """Keep where element entries go: those of free coordinates, and those of the map's curvature."""
        rows, columns = np.broadcast_arrays(self.reduced_dofs[:, None], self.reduced_dofs[None, :])
        self._kept = ((rows >= 0) & (columns >= 0)).ravel()
        self._indices = np.array(
            [np.concatenate([part.ravel()[self._kept], self.turns]) for part in (rows, columns)],
            dtype=np.int32,
        )
        self._kept_force = (self.reduced_dofs >= 0).ravel()
        self._force_indices = self.reduced_dofs.ravel()[None, self._kept_force]

    def _units(self) -> tuple[float, float]:
        """Return EI/L^2 [N] and EI/L [N m] of the stiffest strip: what residuals are measured in."""
        length = max(strip.length for strip in self.model.strips)
        rigidity = max(strip.section.flexural_rigidity for strip in self.model.strips)
        return rigidity / length**2, rigidity / length

    @cached_property
    def constant_effects(self) -> bool:
        """Whether gravity or natural strains act, so that the shape at rest is not in equilibrium."""
        return self.weight is not None or self.natural is not None

    @cached_property
    def measure(self) -> Array:
        """What changes of the coordinates are multiplied with to count in strip lengths and rad, (size,)."""
        weight: Array = np.full(self.size, 1.0 / max(strip.length for strip in self.model.strips))
        weight[2::3] = 1.0
        return weight

    @property
    def constant_words(self) -> str:
        """What of weight and natural strains acts, in words."""
        acting = {"the weight": self.weight, "the natural strains": self.natural}
        return " and ".join(word for word, effect in acting.items() if effect is not None)

    def body_slice(self, body: int) -> slice:
        """Return where the coordinates of a body lie."""
        return slice(self.first_body + 3 * body, self.first_body + 3 * body + 3)

    def nodal_masses(self) -> Array:
        """Return the mass of the strips that falls to each node, half of every element (nodes,) [kg]."""
        half = 0.5 * self.elements.linear_density * self.elements.length
        ends = self.basis.mesh.t
        masses = np.zeros(self.strips * self.stations)
        np.add.at(masses, ends.ravel(), np.tile(half, 2))
        return masses

    def displacement(self, y: Array) -> Array:
        """Return displacement and turn of all nodes, (nodes, 3) [m, rad]."""
        full = np.zeros((self.strips * self.stations, 3))
        full[self.free_nodes] = y[: self.first_body].reshape(-1, 3)
        full[self.attachments.node] = self.attachments.displacement(y[self.first_body :].reshape(-1, 3))
        return full

    def velocity(self, y: Array, v: Array) -> Array:
        """Return the rates of displacement and turn of all nodes, (nodes, 3) [m/s, rad/s]."""
        full = np.zeros((self.strips * self.stations, 3))
        bodies = (part[self.first_body :].reshape(-1, 3) for part in (y, v))
        full[self.free_nodes] = v[: self.first_body].reshape(-1, 3)
        full[self.attachments.node] = self.attachments.velocity(*bodies)
        return full

    def element_displacement(self, y: Array) -> Array:
        """Return the displacements of the elements (6, E)."""
        local: Array = self.displacement(y).ravel()[self.basis.element_dofs]
        return local

    def element_forces(self, displacement: Array, share: float = 1.0) -> Array:
        """Return the forces of the elements (6, E), with a share of the natural strains."""
        forces = self.law.forces(displacement)
        return forces if self.natural is None else forces + share * self.natural.forces(displacement)

    def element_tangents(self, displacement: Array, share: float = 1.0) -> Array:
        """Return their derivatives (6, 6, E)."""
        tangents = self.law.tangents(displacement)
        return tangents if self.natural is None else tangents + share * self.natural.tangents(displacement)

    def reduced_force(self, forces: Array, y: Array) -> Array:
        """Assemble element forces (6, E) into the reduced coordinates, (size,) [N, N m]."""
        local = self.attachments.reduce_forces(forces, y[self.turns])
        data = local.ravel()[self._kept_force]
        assembled: Array = COOData(self._force_indices, data, (self.size,), None).toarray()
        return assembled

    def reduced_matrix(self, matrices: Array, y: Array, curvature: ArrayLike = 0.0) -> csc_matrix:
        """Assemble element matrices (6, 6, E) into the reduced coordinates as P^T K P + curvature (B,).

        The matrices are symmetric, so that the transpose of the assembled rows is the matrix by columns.
        """
        local = self.attachments.reduce_matrices(matrices, y[self.turns])
        added = np.broadcast_to(np.asarray(curvature, dtype=float), self.turns.shape)
        data = np.concatenate([local.ravel()[self._kept], added])
        assembled: csc_matrix = COOData(self._indices, data, (self.size, self.size), None).tocsr().T
        return assembled

    def internal_force(self, y: Array, share: float = 1.0) -> Array:
        """Return the gradient of the potential in the reduced coordinates, (size,) [N, N m]."""
        force = self.reduced_force(self.element_forces(self.element_displacement(y), share), y)
        return force if self.weight is None else force - share * self.weight.generalised(y)

    def tangent_stiffness(self, y: Array, share: float = 1.0) -> csc_matrix:
        """Return the second derivative of the potential in the reduced coordinates (size, size)."""
        u = self.element_displacement(y)
        curvature = self.attachments.curvature(self.element_forces(u, share), y[self.turns])
        if self.weight is not None:
            curvature = curvature - share * self.weight.curvature(y)
        return self.reduced_matrix(self.element_tangents(u, share), y, curvature)

    def energies(self, y: Array, share: float = 1.0) -> tuple[float, float, float]:
        """Return bending, axial and shear energy of the strips [J]."""
        u = self.element_displacement(y)
        bending, axial, shear = (float(part.sum()) for part in self.law.energies(u))
        if self.natural is not None:
            more_bending, more_axial = self.natural.energies(u, share)
            bending, axial = bending + more_bending, axial + more_axial
        return bending, axial, shear

    def gravity_energy(self, y: Array) -> float:
        """Return the energy of the full weight, zero in the shape at rest [J]."""
        return 0.0 if self.weight is None else -self.weight.work(y)

    def potential(self, y: Array, share: float = 1.0) -> float:
        """Return strain energy and energy of the weight, both in the given share [J]."""
        return sum(self.energies(y, share)) + share * self.gravity_energy(y)

    def share_force(self, y: Array) -> Array:
        """Return the derivative of the internal force in the share, (size,) [N, N m]."""
        rate = np.zeros(self.size)
        if self.natural is not None:
            rate += self.reduced_force(self.natural.forces(self.element_displacement(y)), y)
        if self.weight is not None:
            rate -= self.weight.generalised(y)
        return rate

    def share_energy(self, y: Array, share: float) -> tuple[float, float]:
        """Return first and second derivative of the potential in the share, at fixed y [J]."""
        rate, bend = self.gravity_energy(y), 0.0
        if self.natural is not None:
            rate += self.natural.energy_rate(self.element_displacement(y), share)
            bend = self.natural.energy_bend
        return rate, bend
