"""Linearised natural frequencies and shapes, at rest and about any static state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, null_space

from spline_model.basis import SlideModes
from spline_model.compile import System, compile_scene
from spline_model.effects import MixedStretching
from spline_model.errors import InvalidParameter, require_count
from spline_model.kernels.assemble import assemble
from spline_model.mass import mass_matrix
from spline_model.pivot import BODY, STRIPS, Pivot
from spline_model.statics import STATIONS, solve_path

Array = NDArray[np.float64]

SLIDE_SHARE = 0.5
"""A mode with more of its strain energy than this in the slide stiffness is one of the control
points' sliding along the strip: a number of the discretisation, not of the pivot."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Modes:
    """Natural modes, lowest first.

    frequency (F,) [Hz], negative where the state is unstable (growth rate over 2 pi);
    shapes (F, G, P, 2) and body_shapes (F, 3): displacement of the strips' stations and of
    the body (x, y, theta) at unit modal mass; slide_frequency: those left out as slide modes
    [Hz]; held: whether the body's rotation was held.
    """

    frequency: Array
    shapes: Array
    body_shapes: Array
    slide_frequency: Array
    rotation: float
    held: bool


def natural_frequencies(
    pivot: Pivot, *, rotation: float = 0.0, count: int = 10, held: bool = False, increments: int = 20
) -> Modes:
    """Modes about the static state at ``rotation`` [rad].

    The drive's torque acts on as a dead moment (``held=False``) or the rotation is fixed
    (``held=True``). Raises ConvergenceError if statics does not reach the state.
    """
    require_count("count", count, 1)
    system = compile_scene(pivot.driven(rotation) if held else pivot.released())
    z = np.zeros(system.layout.size)
    z[:] = static_state(pivot, rotation, increments)[: system.layout.size]
    scene = pivot.released()
    mass = mass_matrix(scene, system.layout)
    values, vectors, share = linear_modes(system, z, mass)
    slide = share > SLIDE_SHARE
    frequency = np.sign(values) * np.sqrt(np.abs(values)) / (2 * np.pi)
    kept = np.flatnonzero(~slide)[:count]
    layout = system.layout
    shapes = [
        np.moveaxis(vectors[layout.strip(name)][:, kept].reshape(-1, 2, len(kept)), 2, 0) for name in STRIPS
    ]
    values_at = [system.scene.strip(name).basis.evaluate(STATIONS) for name in STRIPS]
    return Modes(
        frequency=frequency[kept],
        shapes=np.stack([b @ s for b, s in zip(values_at, shapes, strict=True)], axis=1),
        body_shapes=vectors[layout.body(BODY)][:, kept].T,
        slide_frequency=frequency[slide],
        rotation=rotation,
        held=held,
    )


def static_state(pivot: Pivot, rotation: float, increments: int = 20) -> Array:
    """The unknowns z of the static state at ``rotation``, the drive's multiplier last."""
    if rotation == 0.0:
        return compile_scene(pivot.driven(1.0)).rest
    return np.asarray(solve_path(pivot, rotation, increments).states[-1])


def linear_modes(system: System, z: Array, mass: Array) -> tuple[Array, Array, Array]:
    """Squared circular frequencies, shapes in q (columns) and slide share, of a state.

    The axial forces are condensed, inextensible strips and clamps become constraints on
    whose null space the problem is solved: K and M of the free coordinates alone.
    """
    layout, unit = system.layout, system.scales.unit
    if not np.any(mass):
        raise InvalidParameter("effects", "no inertia", "strip or body inertia for a natural mode")
    count = layout.coordinate_count
    gradient, hessian = np.empty(layout.size), np.empty((layout.size, layout.size))
    assemble(z, system.tables, 0.0, gradient, hessian)
    hessian *= unit[:, None] * unit
    stiffness = hessian[:count, :count].copy()
    rows = [hessian[layout.multiplier_start :, :count]]
    slide = np.zeros_like(stiffness)
    for i, effect in enumerate(system.scene.of(MixedStretching)):
        at = layout.axial_modes(i)
        coupling = hessian[at, :count]
        if effect.axial_compliance == 0:
            rows.append(coupling)
            continue
        part = coupling.T @ np.linalg.solve(-hessian[at, at], coupling)
        stiffness += part
        if isinstance(effect.modes, SlideModes):
            slide += part
    constraints = np.concatenate(rows)
    constraints = constraints / np.linalg.norm(constraints, axis=1, keepdims=True)
    free = null_space(constraints)
    scaled_mass = mass * unit[:count, None] * unit[:count]
    values, vectors = eigh(free.T @ stiffness @ free, free.T @ scaled_mass @ free)
    shapes = free @ vectors
    strain = np.einsum("im,ij,jm->m", shapes, stiffness, shapes)
    share = np.einsum("im,ij,jm->m", shapes, slide, shapes) / np.abs(strain)
    return values, shapes * unit[:count, None], share
