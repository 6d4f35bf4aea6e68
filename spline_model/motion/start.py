"""From a compiled scene to a motion: its constants and consistent start."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.bordered import evaluate
from spline_model.compile import System
from spline_model.effects import MixedStretching, StripDamping
from spline_model.effects.base import Inertia
from spline_model.effects.history import factor_at
from spline_model.errors import InvalidParameter
from spline_model.mass import drag_matrix, mass_matrix
from spline_model.tables import YIELDING, Tables

Array = NDArray[np.float64]


class Motion(NamedTuple):
    """What does not change during a motion: N unknowns, Q coordinates, C clamps, M axial modes.

    tables: of the scene; mass (Q, Q) [kg, kg m^2]; drag (Q, Q) or (0, 0) [N s/m, N m s]; damped: whether
    strips have a relaxation time; relaxation (M,) that of the axial modes [s]; turns: places of the rotations
    in q; chord (C,) length of each clamp's end chord at rest [m]; rigidity (M, M) inverse compliance of the
    axial modes [N/m], zero where a strip is inextensible; unit (N,) and energy [J] make residuals
    dimensionless.
    """

    tables: Tables
    mass: Array
    drag: Array
    damped: bool
    relaxation: Array
    turns: NDArray[np.int64]
    chord: Array
    rigidity: Array
    unit: Array
    energy: float


@dataclass(frozen=True, eq=False)
class Start:
    """Where a motion begins: its motion, unknowns z (N,) known so far, and velocities v (Q,)."""

    system: System
    motion: Motion
    known: Array
    v: Array

    @cached_property
    def _consistent(self) -> tuple[Array, Array]:
        return initial_acceleration(self.system, self.motion, self.known, self.v)

    @property
    def acceleration(self) -> Array:
        """Consistent with the state, (Q,); worked out when it is first asked for."""
        return self._consistent[0]

    @property
    def z(self) -> Array:
        """The unknowns (N,) with the axial forces and multipliers that go with it."""
        return self._consistent[1]


def set_in_motion(system: System) -> Motion:
    """Mass matrix and tables of a system; refuses a scene whose coordinates have no inertia."""
    scene, layout, rest = system.scene, system.layout, system.rest
    if not scene.of(Inertia):
        raise InvalidParameter("effects", "no inertia", "strip_inertia and body_inertia for a motion")
    if any(effect.measure != "material" for effect in scene.of(MixedStretching)):
        raise InvalidParameter("measure", "spatial", "material for the motion of mixed strips")
    mixed = scene.of(MixedStretching)
    times = {effect.strip: effect.relaxation_time for effect in scene.of(StripDamping)}
    clamps = system.tables.clamps
    chords = [rest[i : i + 2] - rest[e : e + 2] for e, i in zip(clamps.end, clamps.inner, strict=True)]
    return Motion(
        tables=system.tables,
        mass=mass_matrix(scene, layout),
        drag=drag_matrix(scene, layout),
        damped=bool(scene.of(StripDamping)),
        relaxation=np.array([times.get(e.strip, 0.0) for e in mixed for _ in range(e.modes.count)]),
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
    evaluate(system, system.rest, 0.0, gradient, hessian)
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
    Psi_q along v, exact at rest. Loads are those of the motion's instant 0.
    """
    system = _with_first_loads(system, motion)
    layout = system.layout
    q, rest = slice(0, layout.coordinate_count), slice(layout.coordinate_count, layout.size)
    size, unit = layout.size, system.scales.unit
    gradient, hessian = np.empty(size), np.empty((size, size))
    free = z.copy()
    axial = slice(layout.coordinate_count, layout.multiplier_start)
    free[rest] = 0.0
    evaluate(system, free, 1.0, gradient, hessian)
    free[axial] = motion.rigidity @ gradient[axial]
    fixed = np.concatenate((np.diag(motion.rigidity) == 0, np.ones(size - layout.multiplier_start, bool)))
    for row, compliance in zip(
        system.tables.clamps.row + 2, system.tables.clamps.numbers[:, YIELDING], strict=True
    ):
        if compliance > 0.0:
            free[row], fixed[row - layout.coordinate_count] = gradient[row] / compliance, False
    evaluate(system, free, 1.0, gradient, hessian)
    rows = np.arange(size)[rest][fixed]
    jacobian, force = hessian[rows][:, q].copy(), -gradient[q].copy()

    drift = np.zeros(len(rows))
    speed = np.abs(v / unit[q]).max()
    if speed > 0:
        step = 1e-4 / speed
        ahead, behind = free.copy(), free.copy()
        ahead[q] += step * v
        behind[q] -= step * v
        evaluate(system, ahead, 1.0, gradient, hessian)
        drift = hessian[rows][:, q] @ v
        evaluate(system, behind, 1.0, gradient, hessian)
        drift = (drift - hessian[rows][:, q] @ v) / (2 * step)

    # a coordinate without mass stands in equilibrium already: least squares leave it at rest
    matrix = np.block([[motion.mass, jacobian.T], [jacobian, np.zeros((len(rows), len(rows)))]])
    heavy = np.diag(motion.mass).max()
    scale = np.concatenate((unit[q] / system.scales.length, np.full(len(rows), 1.0)))
    scale[len(motion.mass) :] = heavy / np.maximum(np.linalg.norm(jacobian * scale[q], axis=1), 1e-300)
    right = np.concatenate((force, -drift)) * scale
    scaled = matrix * scale[:, None] * scale
    solved = scale * np.linalg.lstsq(scaled, right, rcond=1e-14)[0]
    free[rows] = solved[len(motion.mass) :]
    return solved[: len(motion.mass)], free


def _with_first_loads(system: System, motion: Motion) -> System:
    """The system with the loads that act at the instant 0 of the motion's clock, at load factor 1."""
    loads = motion.tables.loads
    given = zip(loads.first, loads.pairs, strict=True)
    parts = np.array([factor_at(0.0, first, pairs, loads.times, loads.factors) for first, pairs in given])
    now = loads._replace(value=parts * loads.value) if parts.size else loads
    return system.with_tables(loads=now)


def require_compiled(system: System, name: str) -> None:
    """Refuse potentials in Python."""
    if system.open_potentials:
        names = [type(potential).__name__ for potential in system.open_potentials]
        raise InvalidParameter("integrator", name, f"generalised-alpha for {', '.join(names)}")


def require_conservative(motion: Motion, name: str) -> None:
    """Refuse a scene with damping, drives or loads: only the energy-consistent scheme has them."""
    others = motion.tables.drives.row.size + motion.tables.loads.coordinate.size
    if motion.drag.size or motion.damped or others:
        raise InvalidParameter("integrator", name, "energy (fixed step) for damping, loads and drives")
