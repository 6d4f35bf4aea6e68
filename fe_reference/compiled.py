"""The compiled gradient of the potential of a structure, in the reduced coordinates, with its arrays."""

import numpy as np
from numpy.typing import NDArray

from .effects.kernels import natural_forces, put_weight
from .effects.named import PreStrain
from .kernels import body_forces, internal_forces
from .structure import Structure

Array = NDArray[np.float64]


class CompiledForces:
    """Arrays that the compiled loops read and write for one structure, reduced about the centres of mass.

    Attributes:
        given: element kind, first nodes, element table, attached nodes, their bodies and offsets.
        conservative: natural strains (E, 2), weight of nodes (nodes, 3) and bodies (B, 3); of length zero
            where they are not named.
        work: nodal forces (nodes, 3), forces and moments on the bodies (B, 3), scratch of one element.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        e, ends = structure.elements, structure.attachments
        first = np.ascontiguousarray(structure.basis.mesh.t[0], dtype=np.int64)
        rows = [*e.chord, e.length, e.axial_rigidity, e.flexural_rigidity, e.shear_rigidity]
        table = np.ascontiguousarray(np.transpose(rows))
        shear = structure.model.element == "reissner"
        carried = (np.ascontiguousarray(ends.node), np.ascontiguousarray(ends.body), ends.offsets)
        self.given = (shear, first, table, *carried)
        self.conservative = (self._natural(), *self._weight())
        nodes, bodies = structure.strips * structure.stations, len(structure.points)
        self.work = (np.zeros((nodes, 3)), np.zeros((bodies, 3)), np.zeros(4))

    def _natural(self) -> Array:
        strain = self.structure.model.effects.find(PreStrain)
        if strain is None:
            return np.zeros((0, 2))
        return np.tile([strain.strain, strain.curvature], (len(self.structure.elements.length), 1))

    def _weight(self) -> tuple[Array, Array]:
        """Return the weight of nodes and bodies."""
        s = self.structure
        if s.weight is None:
            return np.zeros((0, 3)), np.zeros((0, 3))
        nodes = np.zeros((s.strips * s.stations, 3))
        nodes[s.free_nodes] = s.weight.vector[: s.first_body].reshape(-1, 3)
        return nodes, s.weight.vector[s.first_body :].reshape(-1, 3)

    def forces(self, y: Array) -> tuple[Array, float]:
        """Return the gradient of the potential (size,) [N, N m] and the strain energy [J] at y.

        The same as `Structure.internal_force` and the sum of `Structure.energies`, in far less time.
        """
        (shear, first, table, *_), (force, _, scratch) = self.given, self.work
        natural, weight, body_weight = self.conservative
        u, s = self.structure.displacement(y), self.structure
        energy: float = internal_forces(shear, first, table, u, force, scratch)
        energy += natural_forces(shear, first, table, natural, u, force)
        put_weight(weight, force)
        nodal, resultants = self.reduced(force, y[s.first_body :].reshape(-1, 3))
        put_weight(body_weight, resultants)
        return np.concatenate([nodal[s.free_nodes].ravel(), resultants.ravel()]), energy

    def reduced(self, force: Array, bodies: Array) -> tuple[Array, Array]:
        """Return nodal forces (nodes, 3) and what they make up on the bodies at their coordinates (B, 3)."""
        _, _, _, attached, carrier, offsets = self.given
        resultants = self.work[1]
        body_forces(bodies, attached, carrier, offsets, force, resultants)
        return force, resultants
