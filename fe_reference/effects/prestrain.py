"""Natural strain and curvature of elements: what they add to energy, forces and tangents.

With natural strain e0 and natural curvature k0, both constant in an element of length l, its energy becomes

    U - EA l e0 eps - EI k0 (phi_2 - phi_1) + l (EA e0^2 + EI k0^2) / 2        [J]

where U is that without them. This holds for both elements: the curvature integrates to the difference of the
end rotations, and eps is constant. What is added to the forces is linear in (e0, k0), so that a share of them
adds that share.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .named import PreStrain

if TYPE_CHECKING:
    from ..structure import Structure

Array = NDArray[np.float64]


class NaturalStrain:
    """The natural strain and curvature of all elements of a structure.

    Attributes:
        axial, bending: EA e0 [N] and EI k0 [N m] of the elements (E,).
        axial_energy, bending_energy: l EA e0^2 / 2 and l EI k0^2 / 2, summed [J].
    """

    def __init__(self, structure: "Structure", value: PreStrain) -> None:
        e = structure.elements
        self.structure = structure
        self.axial: Array = e.axial_rigidity * value.strain
        self.bending: Array = e.flexural_rigidity * value.curvature
        self.axial_energy = 0.5 * float(np.sum(self.axial * e.length)) * value.strain
        self.bending_energy = 0.5 * float(np.sum(self.bending * e.length)) * value.curvature

    def forces(self, displacement: Array) -> Array:
        """Return what the full natural strains add to the forces of the elements (6, E) [N, N m]."""
        slope = self.structure.law.axial_slopes(displacement)
        added: Array = -self.axial * self.structure.elements.length * slope
        added[2] += self.bending
        added[5] -= self.bending
        return added

    def tangents(self, displacement: Array) -> Array:
        """Return what they add to the tangents (6, 6, E)."""
        tangents: Array = (
            -self.axial * self.structure.elements.length * self.structure.law.axial_curvatures(displacement)
        )
        return tangents

    def works(self, displacement: Array) -> tuple[float, float]:
        """Return the sums of EI k0 (phi_2 - phi_1) and of EA l e0 eps [J]."""
        bending = float(self.bending @ (displacement[5] - displacement[2]))
        stretch = self.structure.law.axial_strains(displacement)
        return bending, float(np.sum(self.axial * self.structure.elements.length * stretch))

    def energies(self, displacement: Array, share: float) -> tuple[float, float]:
        """Return what a share of them adds to bending and axial energy [J]."""
        bending, axial = self.works(displacement)
        return (
            share * (share * self.bending_energy - bending),
            share * (share * self.axial_energy - axial),
        )

    def energy_rate(self, displacement: Array, share: float) -> float:
        """Return the derivative of the energy in the share, at fixed displacement [J]."""
        return 2.0 * share * (self.bending_energy + self.axial_energy) - sum(self.works(displacement))

    @property
    def energy_bend(self) -> float:
        """Second derivative of the energy in the share [J]."""
        return 2.0 * (self.bending_energy + self.axial_energy)
