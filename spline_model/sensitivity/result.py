"""What the derivatives of a path are handed back as."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Quantity:
    """Values (...) of a quantity and its derivatives (..., P) by the parameters."""

    value: Array
    derivative: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Sensitivities:
    """Derivatives of a path of S states by P parameters, each over the parameter's SI unit.

    parameters: names, the last axis of every derivative. torque (S,) [N m]; stiffness (S,)
    [N m/rad]; centre (S, 2) of the body and body_shift (S, 2) from rest [m]; centre_shift (S, 2):
    displacement of the body's point that lies in the strips' crossing at rest, what the
    literature calls the pivot's centre shift [m]; bending_energy, axial_energy (S,) [J];
    fibre_stress (S, G, Q, 2) of G strips at Q stations, both extreme fibres [Pa]; stations (Q,);
    states: derivatives of the unknowns (S, N, P); counters: factorisations and back_substitutions.
    """

    parameters: tuple[str, ...]
    torque: Quantity
    stiffness: Quantity
    centre: Quantity
    body_shift: Quantity
    centre_shift: Quantity
    bending_energy: Quantity
    axial_energy: Quantity
    fibre_stress: Quantity
    stations: Array
    states: Array
    counters: dict[str, int]

    def largest_stress(self) -> Quantity:
        """Largest magnitude of the fibre stress (S,) [Pa]; its derivative is that of the point where it
        is, exact as long as there is one such point."""
        flat = self.fibre_stress.value.reshape(len(self.torque.value), -1)
        by = self.fibre_stress.derivative.reshape(*flat.shape, len(self.parameters))
        rows, where = np.arange(len(flat)), np.abs(flat).argmax(axis=1)
        sign = np.sign(flat[rows, where])
        return Quantity(value=np.abs(flat[rows, where]), derivative=sign[:, None] * by[rows, where])
