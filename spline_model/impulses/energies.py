"""Kinetic and potential energy of a state."""

from __future__ import annotations

from numba import njit

from spline_model.kernels.energy import strain_energy


@njit(cache=True, nogil=True)
def kinetic(v, mass):
    """Kinetic energy [J] of velocities v (Q,)."""
    energy = 0.0
    for i in range(v.size):
        for j in range(v.size):
            energy += 0.5 * v[i] * mass[i, j] * v[j]
    return energy


@njit(cache=True, nogil=True)
def potential(z, motion, strains):
    """Strain energy and potential of the weight [J] at z (N,); strains (M,) is work space."""
    energy = strain_energy(z, motion.tables, motion.rigidity, motion.mass.shape[0], strains)
    for i in range(motion.tables.weight.size):
        energy -= motion.tables.weight[i] * z[i]
    return energy


@njit(cache=True, nogil=True)
def energy_of(z, v, motion, strains):
    """Total energy [J]."""
    return kinetic(v, motion.mass) + potential(z, motion, strains)
