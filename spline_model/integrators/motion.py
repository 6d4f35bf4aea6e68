"""From a compiled scene to a motion: its constants and consistent start; and what a run returns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import MixedStretching
from spline_model.effects.base import Inertia, Load
from spline_model.errors import InvalidParameter
from spline_model.kernels.assemble import assemble
from spline_model.kernels.motion import Motion
from spline_model.mass import mass_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Records:
    """R records of a run, the start first.

    time (R,) [s]; states (R, N); velocities (R, Q); rows (R, 4) kinetic and strain energy [J],
    largest constraint residual [m] and its rate [m/s]; message: empty, or why the run stopped.
    """

    time: Array
    states: Array
    velocities: Array
    rows: Array
    message: str
    counters: dict[str, int]


def set_in_motion(system: System) -> Motion:
    """Mass matrix and tables of a system; refuses a scene whose coordinates have no inertia."""
    scene, layout, rest = system.scene, system.layout, system.rest
    if not scene.of(Inertia):
        raise InvalidParameter("effects", "no inertia", "strip_inertia and body_inertia for a motion")
    if scene.of(Load):
        raise InvalidParameter("effects", "a load", "no load: these integrators release a scene")
    if any(effect.measure != "material" for effect in system.scene.of(MixedStretching)):
        raise InvalidParameter("measure", "spatial", "material for the motion of mixed strips")
    mass = mass_matrix(scene, layout)
    if np.linalg.eigvalsh(mass)[0] <= 0:
        raise InvalidParameter("effects", "coordinates without mass", "inertia for every strip and body")
    clamps = system.tables.clamps
    chords = [rest[i : i + 2] - rest[e : e + 2] for e, i in zip(clamps.end, clamps.inner, strict=True)]
    return Motion(
        tables=system.tables,
        mass=mass,
        turns=np.array([start + 2 for start in layout.bodies.values()], dtype=np.int64),
        chord=np.array([np.hypot(*chord) for chord in chords]),
        rigidity=axial_rigidity(system),
        unit=system.scales.unit,
        energy=system.scales.energy,
    )


def axial_rigidity(system: System) -> Array:
    """Inverse of the axial modes' compliance matrix, (M, M) [N/m]; zero for inextensible strips."""
    start, end = system.layout.coordinate_count, system.layout.multiplier_start
    size = system.layout.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    assemble(system.rest, system.tables, 0.0, gradient, hessian)
    compliance = -hessian[start:end, start:end]
    rigidity = np.zeros_like(compliance)
    for (first, count), effect in zip(system.layout.modes, system.scene.of(MixedStretching), strict=True):
        if effect.axial_compliance > 0:
            block = slice(first - start, first - start + count)
            rigidity[block, block] = np.linalg.inv(compliance[block, block])
    return rigidity


def initial_acceleration(system: System, motion: Motion, z: Array, v: Array) -> tuple[Array, Array]:
    """Consistent acceleration (Q,) and unknowns z (N,) at a state with velocity v (Q,).

    M a + dV/dq = Psi_q^T lambda with the constraints (and the inextensible strips' strains)
    differentiated twice: Psi_q a = -(Psi_q v)_q v, the right side by a central difference of
    Psi_q along v, exact at rest.
    """
    layout = system.layout
    q, rest = slice(0, layout.coordinate_count), slice(layout.coordinate_count, layout.size)
    size, unit = layout.size, system.scales.unit
    gradient, hessian = np.empty(size), np.empty((size, size))
    free = z.copy()
    axial = slice(layout.coordinate_count, layout.multiplier_start)
    free[rest] = 0.0
    assemble(free, motion.tables, 0.0, gradient, hessian)
    free[axial] = motion.rigidity @ gradient[axial]
    assemble(free, motion.tables, 0.0, gradient, hessian)
    fixed = np.concatenate((np.diag(motion.rigidity) == 0, np.ones(size - layout.multiplier_start, bool)))
    rows = np.arange(size)[rest][fixed]
    jacobian, force = hessian[rows][:, q].copy(), -gradient[q].copy()

    drift = np.zeros(len(rows))
    speed = np.abs(v / unit[q]).max()
    if speed > 0:
        step = 1e-4 / speed
        ahead, behind = free.copy(), free.copy()
        ahead[q] += step * v
        behind[q] -= step * v
        assemble(ahead, motion.tables, 0.0, gradient, hessian)
        drift = hessian[rows][:, q] @ v
        assemble(behind, motion.tables, 0.0, gradient, hessian)
        drift = (drift - hessian[rows][:, q] @ v) / (2 * step)

    matrix = np.block([[motion.mass, jacobian.T], [jacobian, np.zeros((len(rows), len(rows)))]])
    scale = np.concatenate((1 / np.sqrt(np.diag(motion.mass)), np.ones(len(rows))))
    scale[len(motion.mass) :] = 1 / np.sqrt((jacobian**2 / np.diag(motion.mass)).sum(axis=1))
    right = np.concatenate((force, -drift)) * scale
    solved = scale * np.linalg.solve(matrix * scale[:, None] * scale, right)
    free[rows] = solved[len(motion.mass) :]
    return solved[: len(motion.mass)], free
