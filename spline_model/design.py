"""A design: strips and bodies by their geometry and material, and how they are discretised."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import HatModes, LegendreModes, SplineBasis, bezier, cubic_bspline, singular
from spline_model.effects.boundary import GROUND
from spline_model.effects.elastic import MEASURES
from spline_model.errors import (
    InvalidParameter,
    is_finite,
    require_choice,
    require_count,
    require_not_negative,
    require_positive,
)

BASES = ("bezier", "bspline")
STRETCH_FORMS = ("mixed", "consistent", "inextensible")
FIRST_POINTS = 6
"""Control points of a design that leaves them open, where no accuracy chooses them."""
SLIDE_STIFFNESS = 10.0
"""Default stiffness of the strains that the axial modes do not see in statics, in EI/L^2.

With control_points - 2 modes the control points of a straight strip slide along it without
resistance and the tangent at rest is singular. Any value from 1e-6 to 10 mends that and moves
the static error by some factors only: 10 is best for n = 5 and 8 and several times the least
for n = 6 and 10 (results of convergence/slide_stiffness); from 100 on the strip begins to lock.
"""
NOT_GIVEN = math.nan
"""Area and second moment of a strip that has them from its width and thickness."""
ROUNDED = 1e-3
"""Relative difference to which a printed area and second moment agree with those of the sides."""


def swinging_slide_stiffness(control_points: int) -> float:
    """The default slide stiffness of a motion, in EI/L^2: 100 ((n - 2) / 6)^3.

    In a motion the sliding has inertia and must be fast against the strips' bending, or it
    takes part in the swing; how stiff it may be before it locks grows with n. The rule goes
    through the best values for n = 4, 6 and 8 (results of convergence/slide_stiffness).
    """
    return 100.0 * ((control_points - 2) / 6.0) ** 3


class Described(TypedDict, total=False):
    """Keywords of ``Discretisation``."""

    control_points: int | None
    axial_modes: int | None
    basis: str
    measure: str
    stretch: str
    gauss_points: int | None
    slide_stiffness: float | None


@dataclass(frozen=True, kw_only=True)
class Discretisation:
    """How every strip is described.

    control_points n >= 4, or None for as many as an answer's accuracy takes (``spline_model.accuracy``;
    FIRST_POINTS where nothing estimates its error); axial_modes m in 1 ... n - 1, default n - 2;
    basis "bezier" (degree n - 1) or "bspline" (cubic); measure "material", or with consistent stretch
    "spatial" (Eqs 10, 13) or "printed" (forces of Eqs 12, 15); stretch "mixed", "consistent" (Eq 13 by
    quadrature) or "inextensible"; gauss_points in each knot span, default degree + 3, which follows the
    primary branch to a half turn where n - 1 points lose it; slide_stiffness of the strains
    that the axial modes do not see, in EI/L^2, 0 for none, default SLIDE_STIFFNESS in statics
    and ``swinging_slide_stiffness`` in motions and modes (``Mechanism.in_motion``). What makes
    the tangent of a straight strip singular is refused with the reason (``spline_model.basis.singular``).
    """

    control_points: int | None = None
    axial_modes: int | None = None
    basis: str = "bezier"
    measure: str = "material"
    stretch: str = "mixed"
    gauss_points: int | None = None
    slide_stiffness: float | None = None

    def __post_init__(self) -> None:
        if self.control_points is not None:
            require_count("control_points", self.control_points, 4)
        for name in ("axial_modes", "gauss_points"):
            if self.control_points is None and getattr(self, name) is not None:
                raise InvalidParameter(
                    name, getattr(self, name), "control_points beside it, which it goes with"
                )
        require_choice("basis", self.basis, BASES)
        require_choice("measure", self.measure, MEASURES)
        require_choice("stretch", self.stretch, STRETCH_FORMS)
        if self.slide_stiffness is not None:
            require_not_negative("slide_stiffness", self.slide_stiffness, "EI/L^2")
        if self.gauss_points is not None:
            require_count("gauss_points", self.gauss_points, 1)
        if self.measure != "material" and self.stretch != "consistent":
            only = f"consistent, the only form with measure = {self.measure}"
            raise InvalidParameter("stretch", self.stretch, only)
        if self.axial_modes is not None:
            if self.stretch == "consistent":
                raise InvalidParameter("axial_modes", self.axial_modes, "none with stretch = consistent")
            require_count("axial_modes", self.axial_modes, 1, self.points - 1)
        axial = None if self.stretch == "consistent" else self.modes
        reason = singular(self.spline, self.points_a_span, axial, self.slide > 0)
        if reason:
            raise InvalidParameter("discretisation", reason, "a strip whose tangent at rest is regular")

    @property
    def points(self) -> int:
        """Control points that were given, or those of a design that leaves them open."""
        return FIRST_POINTS if self.control_points is None else self.control_points

    @cached_property
    def spline(self) -> SplineBasis:
        """The basis of the control points."""
        return (bezier if self.basis == "bezier" else cubic_bspline)(self.points)

    @cached_property
    def modes(self) -> LegendreModes | HatModes:
        """The axial-force modes: Legendre's for one span, hats for a B-spline."""
        count = self.points - 2 if self.axial_modes is None else self.axial_modes
        return LegendreModes(count=count) if self.basis == "bezier" else HatModes(count=count)

    @property
    def slide(self) -> float:
        """The slide stiffness that was given, or that of statics [EI/L^2]."""
        return SLIDE_STIFFNESS if self.slide_stiffness is None else self.slide_stiffness

    @property
    def points_a_span(self) -> int:
        """Gauss points in each knot span."""
        return self.spline.degree + 3 if self.gauss_points is None else self.gauss_points


@dataclass(frozen=True, kw_only=True)
class StripDesign:
    """A strip between two points, from ``root`` to ``tip``: the ground, a body, or None (free tip).

    start, end [m]; area [m^2], second_moment_of_area [m^4], youngs_modulus [Pa], density
    [kg/m^3]; width b and thickness t in the plane of bending [m], both or neither: of a rectangular
    section, whose area b t and second moment b t^3 / 12 then need not be given, and where they are must
    agree to ROUNDED (and count as given); poisson_ratio is for the section's curl (``clamped_width``,
    ``anticlastic``); rise: sagitta of the circular arc at rest [m], positive to the left of
    start -> end, 0 for a straight strip.
    """

    name: str
    start: tuple[float, float]
    end: tuple[float, float]
    area: float = NOT_GIVEN
    second_moment_of_area: float = NOT_GIVEN
    youngs_modulus: float
    density: float
    poisson_ratio: float = 0.3
    root: str = GROUND
    tip: str | None = None
    rise: float = 0.0
    width: float | None = None
    thickness: float | None = None

    def __post_init__(self) -> None:
        if self.width is not None or self.thickness is not None:
            self._take_sides()
        elif NOT_GIVEN in (self.area, self.second_moment_of_area):
            raise InvalidParameter("area", "none", "area and second_moment_of_area, or width and thickness")
        require_positive("area", self.area, "m^2")
        require_positive("second_moment_of_area", self.second_moment_of_area, "m^4")
        require_positive("youngs_modulus", self.youngs_modulus, "Pa")
        require_positive("density", self.density, "kg/m^3")
        require_positive("length", self.chord, "m")
        if not (is_finite(self.poisson_ratio) and -1.0 < self.poisson_ratio <= 0.5):
            raise InvalidParameter(
                "poisson_ratio", self.poisson_ratio, "a number above -1 and at most 0.5 [1]"
            )
        if not abs(self.rise) < self.chord / 2:
            expected = f"less than half the chord, {self.chord / 2:g}, or two strips with a massless body [m]"
            raise InvalidParameter(f"rise of {self.name}", self.rise, expected)

    def _take_sides(self) -> None:
        """Area and second moment from width and thickness, compared with them where they are given."""
        for name, side in (("width", self.width), ("thickness", self.thickness)):
            if side is None:
                raise InvalidParameter(name, side, "width and thickness, both or neither")
            require_positive(name, side, "m")
        assert self.width is not None and self.thickness is not None
        area = self.width * self.thickness
        for name, made in (("area", area), ("second_moment_of_area", area * self.thickness**2 / 12.0)):
            given = getattr(self, name)
            if given is NOT_GIVEN:
                object.__setattr__(self, name, made)
            elif not abs(given - made) <= ROUNDED * made:
                raise InvalidParameter(name, given, f"{made:.6g}, that of width and thickness, or none")

    @property
    def chord(self) -> float:
        """Distance of the ends [m]."""
        return math.dist(self.start, self.end)

    @property
    def length(self) -> float:
        """Arc length at rest [m]."""
        if self.rise == 0.0:
            return self.chord
        half = 2.0 * math.atan2(2.0 * abs(self.rise), self.chord)
        return self.chord * half / math.sin(half)

    @property
    def flexural_rigidity(self) -> float:
        """EI [N m^2]."""
        return self.youngs_modulus * self.second_moment_of_area

    @property
    def axial_rigidity(self) -> float:
        """EA [N]."""
        return self.youngs_modulus * self.area

    @property
    def linear_density(self) -> float:
        """mu = rho A [kg/m]."""
        return self.density * self.area

    def control_points(self, basis: SplineBasis) -> NDArray[np.float64]:
        """Control points at rest (n, 2): exact for a straight strip, the least-squares arc otherwise.

        The arc's ends and end tangents are met exactly; its parametrisation is by arc length.
        """
        start, end = np.asarray(self.start, dtype=float), np.asarray(self.end, dtype=float)
        straight = start + basis.greville[:, None] * (end - start)
        if self.rise == 0.0:
            return np.asarray(straight)
        return _arc(basis, start, end, self.rise, self.length)


def _arc(
    basis: SplineBasis, start: NDArray[np.float64], end: NDArray[np.float64], rise: float, length: float
) -> NDArray[np.float64]:
    """Control points of the circular arc from start to end with that sagitta."""
    along = (end - start) / math.dist(start, end)
    left = np.array([-along[1], along[0]])
    half = 2.0 * math.atan2(2.0 * rise, math.dist(start, end))
    u = basis.gauss_rule(basis.degree + 5)[0]
    turn = half * (1.0 - 2.0 * u)  # of the tangent against the chord
    radius = length / (2.0 * half)
    x = radius * (math.sin(half) - np.sin(turn))
    y = radius * (np.cos(turn) - math.cos(half))
    target = start + np.outer(x, along) + np.outer(y, left)
    n = basis.control_points
    points = np.zeros((n, 2))
    reach = length / basis.evaluate(np.array([0.0]), 1)[0, 1]
    points[0], points[-1] = start, end
    points[1] = start + reach * (math.cos(half) * along + math.sin(half) * left)
    points[-2] = end - reach * (math.cos(half) * along - math.sin(half) * left)
    if n > 4:
        values = basis.evaluate(u)
        known = values[:, [0, 1, -2, -1]] @ points[[0, 1, -2, -1]]
        points[2:-2] = np.linalg.lstsq(values[:, 2:-2], target - known, rcond=None)[0]
    return points


@dataclass(frozen=True, kw_only=True)
class BodyDesign:
    """A rigid body: centre at rest [m], mass [kg], moment of inertia about the centre [kg m^2]."""

    name: str
    centre: tuple[float, float]
    mass: float = 0.0
    moment_of_inertia: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("mass", self.mass, "kg")
        require_not_negative("moment_of_inertia", self.moment_of_inertia, "kg m^2")


@dataclass(frozen=True, kw_only=True)
class Design:
    """Strips and bodies with their discretisation; pre_strain holds curvature and strain, if any; curling
    the names of the effects of the sections' curl, which bending takes up."""

    strips: tuple[StripDesign, ...]
    bodies: tuple[BodyDesign, ...]
    discretisation: Discretisation
    pre_strain: Mapping[str, Any] = field(default_factory=dict)
    curling: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        names = {body.name for body in self.bodies}
        for strip in self.strips:
            for end in (strip.root, strip.tip):
                if end not in {*names, GROUND, None}:
                    raise InvalidParameter(f"end of {strip.name}", end, f"ground or one of {sorted(names)}")

    def body_named(self, name: str | None) -> str:
        """That name, or the only body's."""
        names = [body.name for body in self.bodies]
        if name is None and len(names) == 1:
            return names[0]
        if name not in names:
            raise InvalidParameter("body", name, f"one of {names}")
        return str(name)
