"""The cross-axis flexural pivot of the paper's Fig 2 as a scene."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import (
    AxialModes,
    HatModes,
    LegendreModes,
    SlideModes,
    SplineBasis,
    bezier,
    cubic_bspline,
)
from spline_model.effects import (
    GROUND,
    Bending,
    BodyInertia,
    Clamp,
    DrivenRotation,
    MixedStretching,
    Stretching,
    StripInertia,
)
from spline_model.errors import InvalidParameter, require_choice, require_count, require_positive
from spline_model.scene import Body, Effect, Scene, Strip

BASES = ("bezier", "bspline")
STRETCH_FORMS = ("mixed", "consistent", "inextensible")
BODY = "body"
STRIPS = ("strip_1", "strip_2")
SWINGING_SLIDE_STIFFNESS = 100.0
"""The value for a pivot in motion: its sliding must be fast against the strips' bending, or it takes part."""
SLIDE_STIFFNESS = 10.0
"""Default stiffness of the strains that the axial modes do not see, in EI/L^2.

With control_points - 2 modes the control points of a straight strip slide along it without
resistance and the tangent at rest is singular. Any value from 1e-6 to 10 mends that; near 10
the error of every n from 4 to 10 is least (results of convergence/slide_stiffness), and from
100 on the strip begins to lock.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class Pivot:
    """A cross-axis pivot: its scene without a drive, and what was derived from its design.

    clamp_points (2, 2, 2) [strip, ground / body end, xy] in m and clamp_directions (2, 2, 2)
    unit tangents, at rest; centre (2,) of the body; rotation of the whole figure by
    ``orientation`` about A1.
    """

    scene: Scene
    flexural_rigidity: float
    axial_rigidity: float
    linear_density: float
    clamp_points: NDArray[np.float64]
    clamp_directions: NDArray[np.float64]
    centre: NDArray[np.float64]
    strip_mass: float
    body_mass: float
    body_moment_of_inertia: float

    def driven(self, rotation: float) -> Scene:
        """The scene with the body's rotation driven to ``rotation`` at load factor 1 (Eq 7)."""
        drive = DrivenRotation(body=BODY, angle=rotation)
        return Scene(strips=self.scene.strips, bodies=self.scene.bodies, effects=(*self.scene.effects, drive))

    def released(self) -> Scene:
        """The scene with the inertia of strips and body, and without a drive."""
        inertia = (
            *(StripInertia(strip=name, linear_density=self.linear_density) for name in STRIPS),
            BodyInertia(body=BODY, mass=self.body_mass, moment_of_inertia=self.body_moment_of_inertia),
        )
        effects = (*self.scene.effects, *inertia)
        return Scene(strips=self.scene.strips, bodies=self.scene.bodies, effects=effects)

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
    control_points: int = 6,
    axial_modes: int | None = None,
    basis: str = "bezier",
    measure: str = "material",
    stretch: str = "mixed",
    gauss_points: int | None = None,
    slide_stiffness: float = SLIDE_STIFFNESS,
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
    control_points : n >= 4 of each strip. axial_modes : m in 1 ... n - 1, default n - 2.
    basis : "bezier" (degree n - 1) or "bspline" (cubic).
    measure : "material", "spatial" (Eqs 10, 13) or "printed" (forces of Eqs 12, 15).
    stretch : "mixed", "consistent" (Eq 13 by quadrature) or "inextensible".
    gauss_points : in each knot span; default degree + 3, which follows the primary branch
        to a half turn where n - 1 points lose it.
    slide_stiffness : of the strains that the axial modes do not see, in EI/L^2; 0 for none.

    Source: paper, section 2 and Table 1.
    """
    _check_design(length, inclination, crossing_ratio, area, second_moment_of_area, youngs_modulus, density)
    require_positive("body_mass", body_mass, "kg")
    require_positive("body_moment_of_inertia", body_moment_of_inertia, "kg m^2")
    require_count("control_points", control_points, 4)
    require_choice("basis", basis, BASES)
    points, directions = _clamps_at_rest(length, inclination, crossing_ratio, orientation)
    centre = points[:, 1].mean(axis=0) + _rotation(orientation) @ np.asarray(centre_offset, dtype=float)
    spline = bezier(control_points) if basis == "bezier" else cubic_bspline(control_points)
    count = spline.degree + 3 if gauss_points is None else gauss_points
    flexural_rigidity = youngs_modulus * second_moment_of_area
    axial_rigidity = youngs_modulus * area
    axial = _axial_modes(spline, axial_modes, stretch)
    slide = slide_stiffness * flexural_rigidity / length**2

    effects: list[Effect] = []
    for name in STRIPS:
        effects.append(
            Bending(strip=name, flexural_rigidity=flexural_rigidity, measure=measure, gauss_points=count)
        )
        effects += _stretching(name, axial_rigidity, stretch, measure, count, spline, axial, slide)
        effects += [Clamp(strip=name, end="start", to=GROUND), Clamp(strip=name, end="end", to=BODY)]
    strips = tuple(
        Strip(name=name, basis=spline, control_points=_straight(spline, *points[i]))
        for i, name in enumerate(STRIPS)
    )
    return Pivot(
        scene=Scene(strips=strips, bodies=(Body(name=BODY, centre=centre),), effects=tuple(effects)),
        flexural_rigidity=flexural_rigidity,
        axial_rigidity=axial_rigidity,
        linear_density=density * area,
        clamp_points=points,
        clamp_directions=directions,
        centre=centre,
        strip_mass=density * area * length,
        body_mass=body_mass,
        body_moment_of_inertia=body_moment_of_inertia,
    )


def _axial_modes(spline: SplineBasis, count: int | None, stretch: str) -> LegendreModes | HatModes:
    """The axial-force modes of a strip: Legendre's for one span, hats for a B-spline."""
    require_choice("stretch", stretch, STRETCH_FORMS)
    if count is not None and stretch == "consistent":
        raise InvalidParameter("axial_modes", count, "none with stretch = consistent, which has no modes")
    modes = spline.control_points - 2 if count is None else count
    require_count("axial_modes", modes, 1, spline.control_points - 1)
    one_span = spline.degree == spline.control_points - 1
    return LegendreModes(count=modes) if one_span else HatModes(count=modes)


def _stretching(
    strip: str,
    axial_rigidity: float,
    stretch: str,
    measure: str,
    gauss_points: int,
    spline: SplineBasis,
    axial: LegendreModes | HatModes,
    slide: float,
) -> list[Effect]:
    """The stretching effects of one strip: by quadrature, or mixed with the slide stiffness [N]."""
    if stretch == "consistent":
        return [
            Stretching(strip=strip, axial_rigidity=axial_rigidity, measure=measure, gauss_points=gauss_points)
        ]
    if measure == "printed":
        raise InvalidParameter("stretch", stretch, "consistent, the only form that the printed forces have")
    parts: list[tuple[float, AxialModes]] = [
        (0.0 if stretch == "inextensible" else 1.0 / axial_rigidity, axial)
    ]
    if slide > 0 and axial.count < spline.control_points - 1:
        parts.append((1.0 / slide, SlideModes(basis=spline, axial=axial)))
    return [
        MixedStretching(
            strip=strip, axial_compliance=compliance, modes=modes, measure=measure, gauss_points=gauss_points
        )
        for compliance, modes in parts
    ]


def _check_design(
    length: float,
    inclination: float,
    crossing_ratio: float,
    area: float,
    second_moment_of_area: float,
    youngs_modulus: float,
    density: float,
) -> None:
    require_positive("length", length, "m")
    require_positive("area", area, "m^2")
    require_positive("second_moment_of_area", second_moment_of_area, "m^4")
    require_positive("youngs_modulus", youngs_modulus, "Pa")
    require_positive("density", density, "kg/m^3")
    if not 0 < inclination < math.pi / 2:
        raise InvalidParameter("inclination", inclination, "an angle between 0 and pi/2 [rad]")
    if not 0 < crossing_ratio < 1:
        raise InvalidParameter("crossing_ratio", crossing_ratio, "a number between 0 and 1")


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


def _straight(
    basis: SplineBasis, start: NDArray[np.float64], end: NDArray[np.float64]
) -> NDArray[np.float64]:
    return np.asarray(start + basis.greville[:, None] * (end - start))
