"""Shapes and section forces along the strips, from the states of a path."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, SplineBasis
from spline_model.compile import System
from spline_model.effects import Clamp, MixedStretching, Stretching, StripGravity
from spline_model.effects.base import Constraint

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sections:
    """Along one strip at P stations, for S states.

    shape (S, P, 2) [m]; axial_force N and bending_moment M by the constitutive law, so
    that the oscillation of a locking strain is seen; shear_force V from the balance with
    the clamp's reaction and the strip's weight (no law gives it in a shear-rigid strip), so
    of a static state only; (S, P) [N, N m, N].
    """

    shape: Array
    axial_force: Array
    bending_moment: Array
    shear_force: Array


def sections(system: System, states: Array, strip_name: str, stations: Array) -> Sections:
    """Recover one strip's sections at ``stations`` (P,), u in [0, 1]; states (S, N)."""
    scene, layout = system.scene, system.layout
    strip = scene.strip(strip_name)
    basis = strip.basis
    points = states[:, layout.strip(strip_name)].reshape(len(states), -1, 2)
    values = _basis_at(basis, tuple(stations))
    shape, tangent, bend = (each @ points for each in values)
    speed = np.hypot(tangent[..., 0], tangent[..., 1])
    at_rest = [each @ strip.control_points for each in values[1:]]
    rest_speed = np.hypot(*at_rest[0].T)
    rest_curvature = _cross(at_rest[0], at_rest[1]) / rest_speed**3

    bending = scene.bending_of(strip_name)
    moment = np.zeros_like(speed)
    if bending is not None:
        length = rest_speed if bending.measure == "material" else speed
        strain = _cross(tangent, bend) / speed**2 / length - rest_curvature - bending.natural_curvature
        moment = bending.flexural_rigidity * strain

    force = np.zeros_like(speed)
    for consistent in scene.of(Stretching):
        if consistent.strip == strip_name:
            force += consistent.axial_rigidity * (speed / rest_speed - 1.0 - consistent.natural_strain)
    for i, mixed in enumerate(scene.of(MixedStretching)):
        if mixed.strip == strip_name:
            first, modes = _modes_at(mixed.modes, tuple(stations))
            columns = first[:, None] + np.arange(modes.shape[1])
            force += np.einsum("pk,spk->sp", modes, states[:, layout.axial_modes(i)][:, columns])

    normal = np.stack((-tangent[..., 1], tangent[..., 0]), axis=-1) / speed[..., None]
    pull = -clamp_reactions(system, states, strip_name, "start")[:, None, :2]
    for weight in scene.of(StripGravity):
        if weight.strip == strip_name:
            mass = weight.linear_density * strip.length_to(stations)
            pull = pull - mass[:, None] * np.asarray(weight.acceleration)
    return Sections(
        shape=shape,
        axial_force=force,
        bending_moment=moment,
        shear_force=np.einsum("spi,spi->sp", np.broadcast_to(pull, normal.shape), normal),
    )


@lru_cache(maxsize=64)
def _basis_at(basis: SplineBasis, stations: tuple[float, ...]) -> tuple[Array, Array, Array]:
    """The basis and its first two derivatives at stations; kept."""
    u = np.array(stations)
    return basis.evaluate(u), basis.evaluate(u, 1), basis.evaluate(u, 2)


@lru_cache(maxsize=64)
def _modes_at(modes: AxialModes, stations: tuple[float, ...]) -> tuple[NDArray[np.int64], Array]:
    """Axial modes at stations; kept."""
    return modes.evaluate(np.array(stations))


def clamp_reactions(system: System, states: Array, strip: str, end: str) -> Array:
    """Force and moment of the clamp on that end of the strip (S, 3) [N, N, N m]; zero if free."""
    for i, constraint in enumerate(system.scene.of(Constraint)):
        if isinstance(constraint, Clamp) and (constraint.strip, constraint.end) == (strip, end):
            return np.asarray(states[:, system.layout.rows(i)])
    return np.zeros((len(states), 3))


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
