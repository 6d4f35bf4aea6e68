"""The cross-axis flexural pivot of the paper's Fig 2 as a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.design import SLIDE_STIFFNESS, BodyDesign, StripDesign, swinging_slide_stiffness
from spline_model.effects.registry import DEFAULT_EFFECTS
from spline_model.errors import InvalidParameter, require_positive
from spline_model.mechanism import Mechanism, mechanism
from spline_model.scene import Scene

__all__ = ["BODY", "SLIDE_STIFFNESS", "STRIPS", "Pivot", "cross_axis_pivot", "swinging_slide_stiffness"]

BODY = "body"
STRIPS = ("strip_1", "strip_2")


@dataclass(frozen=True, kw_only=True, eq=False)
class Pivot:
    """A cross-axis pivot: its mechanism, and what was derived from its design.

    clamp_points (2, 2, 2) [strip, ground / body end, xy] in m and clamp_directions (2, 2, 2)
    unit tangents, at rest; centre (2,) of the body.
    """

    mechanism: Mechanism
    flexural_rigidity: float
    axial_rigidity: float
    linear_density: float
    clamp_points: NDArray[np.float64]
    clamp_directions: NDArray[np.float64]
    centre: NDArray[np.float64]
    strip_mass: float
    body_mass: float
    body_moment_of_inertia: float

    @property
    def scene(self) -> Scene:
        """The scene without a driven rotation."""
        return self.mechanism.scene

    def driven(self, rotation: float) -> Scene:
        """The scene with the body's rotation driven to ``rotation`` [rad] at load factor 1 (Eq 7)."""
        return self.mechanism.driven(rotation)

    def released(self) -> Scene:
        """The scene in motion, without the drive."""
        return self.mechanism.released()

    def derived(self) -> dict[str, Any]:
        """Derived data by name, for comparison with another model's."""
        names = (
            "flexural_rigidity",
            "axial_rigidity",
            "linear_density",
            "clamp_points",
            "clamp_directions",
            "centre",
            "strip_mass",
            "body_mass",
            "body_moment_of_inertia",
        )
        return {name: getattr(self, name) for name in names}


def cross_axis_pivot(
    *,
    length: float,
    inclination: float,
    crossing_ratio: float,
    area: float,
    second_moment_of_area: float,
    youngs_modulus: float,
    poisson_ratio: float,
    density: float,
    body_mass: float,
    body_moment_of_inertia: float,
    centre_offset: tuple[float, float] = (0.0, 0.0),
    orientation: float = 0.0,
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    **discretisation: Any,
) -> Pivot:
    """The pivot of Table 1, or any other design, in SI units and radians.

    Parameters
    ----------
    length : L of each strip [m]. inclination : of the strips to the x axis [rad].
    crossing_ratio : distance of the crossing from the ground end over L, in (0, 1).
    area, second_moment_of_area : of a strip's section [m^2, m^4].
    poisson_ratio : taken for the sake of one signature; a shear-rigid strip ignores it.
    centre_offset : of the body's centre of mass from the midpoint of B1 B2 [m].
    orientation : turns the whole pivot about A1 [rad].
    effects, parameters : names of the effects of the scene, and the parameters of each.
    discretisation : keywords of ``spline_model.design.Discretisation`` (control_points,
        axial_modes, basis, measure, stretch, gauss_points, slide_stiffness).

    Source: paper, section 2 and Table 1.
    """
    require_positive("length", length, "m")
    require_positive("body_mass", body_mass, "kg")
    require_positive("body_moment_of_inertia", body_moment_of_inertia, "kg m^2")
    if not 0 < inclination < math.pi / 2:
        raise InvalidParameter("inclination", inclination, "an angle between 0 and pi/2 [rad]")
    if not 0 < crossing_ratio < 1:
        raise InvalidParameter("crossing_ratio", crossing_ratio, "a number between 0 and 1")
    points, directions = _clamps_at_rest(length, inclination, crossing_ratio, orientation)
    centre = points[:, 1].mean(axis=0) + _rotation(orientation) @ np.asarray(centre_offset, dtype=float)
    strips = [
        StripDesign(
            name=name,
            start=tuple(points[i, 0]),
            end=tuple(points[i, 1]),
            tip=BODY,
            area=area,
            second_moment_of_area=second_moment_of_area,
            youngs_modulus=youngs_modulus,
            poisson_ratio=poisson_ratio,
            density=density,
        )
        for i, name in enumerate(STRIPS)
    ]
    body = BodyDesign(
        name=BODY, centre=tuple(centre), mass=body_mass, moment_of_inertia=body_moment_of_inertia
    )
    return Pivot(
        mechanism=mechanism(
            strips=strips, bodies=[body], effects=effects, parameters=parameters, **discretisation
        ),
        flexural_rigidity=youngs_modulus * second_moment_of_area,
        axial_rigidity=youngs_modulus * area,
        linear_density=density * area,
        clamp_points=points,
        clamp_directions=directions,
        centre=centre,
        strip_mass=density * area * length,
        body_mass=body_mass,
        body_moment_of_inertia=body_moment_of_inertia,
    )


def mechanism_in_motion(pivot: Pivot | Mechanism) -> Mechanism:
    """The mechanism of a pivot, or any other, as it swings."""
    return (pivot.mechanism if isinstance(pivot, Pivot) else pivot).in_motion()


def _clamps_at_rest(
    length: float, inclination: float, crossing_ratio: float, orientation: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Clamp points and unit tangents, (2, 2, 2) each: strips from ground to body, crossing at r L."""
    cos, sin = math.cos(inclination), math.sin(inclination)
    tangents = np.array([[cos, sin], [-cos, sin]])
    ground = np.array([[0.0, 0.0], [2 * crossing_ratio * length * cos, 0.0]])
    points = np.stack((ground, ground + length * tangents), axis=1)
    turn = _rotation(orientation)
    return points @ turn.T, np.repeat((tangents @ turn.T)[:, None], 2, axis=1)


def _rotation(angle: float) -> NDArray[np.float64]:
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
