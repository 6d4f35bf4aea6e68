"""A design: strips and bodies by their geometry and material."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import Bezier
from spline_model.discretisation import Discretisation
from spline_model.effects.boundary import GROUND
from spline_model.effects.elastic import Taper
from spline_model.errors import (
    InvalidParameter,
    is_finite,
    require_choice,
    require_finite,
    require_not_negative,
    require_positive,
)

Array = NDArray[np.float64]

LARGEST_OPENING = math.radians(100.0)
"""Angle of an arc at rest above which it is cut into segments."""
NOT_GIVEN = math.nan
"""Area and second moment of a strip that has them from its width and thickness."""
CLAMP, HINGE = JOINTS = ("clamp", "hinge")
"""How the end of a strip is joined to the ground or a body: built in, or free to turn about its point."""
ROUNDED = 1e-3
"""Relative difference to which a printed area and second moment agree with those of the sides."""


@dataclass(frozen=True, kw_only=True)
class StripDesign:
    """A strip between two points, from ``root`` to ``tip``.

    Parameters
    ----------
    name : str
    start, end : (2,) m
        Clamped points at rest.
    area, second_moment_of_area : float, m^2 and m^4
        Section; not needed with `width` and `thickness`.
    youngs_modulus, density : float, Pa and kg/m^3
    poisson_ratio : float, 1, default 0.3
        Used by `clamped_width` and `anticlastic` only.
    root, tip : str
        "ground" (default of the root), the name of a body, or None for a free tip (default).
    rise : float, m, default 0
        Sagitta of the circular arc at rest, positive to the left of start -> end; 0 for a straight strip,
        half the chord for a half circle, more for longer arcs.
    width, thickness : float, m, default None
        Rectangular section b and t, both or neither; t is in the plane of bending. Area b t and second moment
        b t^3 / 12 must agree to ROUNDED if they are given too, and then count as given.
    width_end, thickness_end : float, m, default None
        Sides at the end of a taper, between which they change linearly along the strip. Width, thickness,
        area and second moment are those at the start.
    root_joint, tip_joint : str, default "clamp"
        "clamp", or "hinge" about which the end turns freely on ground or body.

    Raises
    ------
    InvalidParameter
        A value outside its range, half a section, or sections that do not agree.

    Examples
    --------
    >>> strip = StripDesign(
    ...     name="strip", start=(0.0, 0.0), end=(0.1, 0.0), width=0.01, thickness=1e-3,
    ...     youngs_modulus=206e9, density=7850.0,
    ... )
    >>> print(f"{strip.second_moment_of_area:.3e} m^4")
    8.333e-13 m^4
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
    width_end: float | None = None
    thickness_end: float | None = None
    root_joint: str = CLAMP
    tip_joint: str = CLAMP

    def __post_init__(self) -> None:
        require_choice(f"root_joint of {self.name}", self.root_joint, JOINTS)
        require_choice(f"tip_joint of {self.name}", self.tip_joint, JOINTS)
        if self.tip is None and self.tip_joint != CLAMP:
            raise InvalidParameter(f"tip_joint of {self.name}", self.tip_joint, "clamp of a free end")
        sides = (self.width, self.thickness, self.width_end, self.thickness_end)
        if any(side is not None for side in sides):
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
        require_finite(f"rise of {self.name}", self.rise, "m")

    def _take_sides(self) -> None:
        """Area and second moment from width and thickness, compared with them where they are given."""
        for name, side in (("width", self.width), ("thickness", self.thickness)):
            if side is None:
                raise InvalidParameter(name, side, "width and thickness, both or neither")
            require_positive(name, side, "m")
            if (at_end := getattr(self, f"{name}_end")) is not None:
                require_positive(f"{name}_end", at_end, "m")
        assert self.width is not None and self.thickness is not None
        area = self.width * self.thickness
        for name, made in (("area", area), ("second_moment_of_area", area * self.thickness**2 / 12.0)):
            given = getattr(self, name)
            if not (given is NOT_GIVEN or abs(given - made) <= ROUNDED * made):
                raise InvalidParameter(name, given, f"{made:.6g}, that of width and thickness, or none")
            if given is NOT_GIVEN or self.taper is not None:  # a taper has those of its sides
                object.__setattr__(self, name, made)

    @property
    def taper(self) -> Taper | None:
        """The taper of the section, None of a constant one."""
        if self.width_end is None and self.thickness_end is None:
            return None
        sides = (self.width, self.width_end), (self.thickness, self.thickness_end)
        taper = Taper(*(end / start if start and end else 1.0 for start, end in sides))
        return None if taper == (1.0, 1.0) else taper

    @property
    def chord(self) -> float:
        """Distance of the ends [m]."""
        return math.dist(self.start, self.end)

    @property
    def length(self) -> float:
        """Arc length at rest [m]."""
        if self.rise == 0.0:
            return self.chord
        return self.chord * self.opening / math.sin(self.opening)

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

    @property
    def opening(self) -> float:
        """Half the angle of the arc at rest [rad], positive to the left; 0 for a straight strip."""
        return 2.0 * math.atan2(2.0 * self.rise, self.chord)

    def at(self, shares: Array) -> Array:
        """Return points at rest (P, 2) [m] at shares (P,) of the length from the root."""
        start, end = np.asarray(self.start, dtype=float), np.asarray(self.end, dtype=float)
        if self.rise == 0.0:
            return np.asarray(start + np.asarray(shares)[:, None] * (end - start))
        along, half = (end - start) / self.chord, self.opening
        turn, radius = half * (1.0 - 2.0 * np.asarray(shares)), self.length / (2.0 * half)
        x = radius * (math.sin(half) - np.sin(turn))
        y = radius * (np.cos(turn) - math.cos(half))
        return np.asarray(start + np.outer(x, along) + np.outer(y, (-along[1], along[0])))

    def control_points(self, basis: Bezier) -> Array:
        """Return control points at rest (n, 2) [m]: exact for a straight strip, the least-squares arc
        otherwise.

        The arc's ends and end tangents are met exactly; its parametrisation is by arc length.
        """
        n = basis.control_points
        if self.rise == 0.0:
            return self.at(np.arange(n) / (n - 1.0))
        start, end = np.asarray(self.start, dtype=float), np.asarray(self.end, dtype=float)
        along, half = (end - start) / self.chord, self.opening
        left, reach = np.array([-along[1], along[0]]), self.length / basis.degree
        points = np.zeros((n, 2))
        points[0], points[-1] = start, end
        points[1] = start + reach * (math.cos(half) * along + math.sin(half) * left)
        points[-2] = end - reach * (math.cos(half) * along - math.sin(half) * left)
        if n > 4:
            u = basis.gauss_rule(basis.degree + 5)[0]
            values = basis.evaluate(u)
            known = values[:, [0, 1, -2, -1]] @ points[[0, 1, -2, -1]]
            points[2:-2] = np.linalg.lstsq(values[:, 2:-2], self.at(u) - known, rcond=None)[0]
        return points

    def pieces(self, count: int) -> tuple[Piece, ...]:
        """Return the strip in `count` pieces of equal length, root first, with joints between them."""
        if count == 1:
            return (Piece(self, self, (0.0, 1.0)),)
        cuts = np.linspace(0.0, 1.0, count + 1)
        points = [tuple(point) for point in self.at(cuts).tolist()]
        sides, own = {}, {}  # of a taper: in place of area and second moment
        if taper := self.taper:
            sides = {n: (getattr(self, n) * taper.side(n, cuts)).tolist() for n in Taper._fields}
            own = {"area": NOT_GIVEN, "second_moment_of_area": NOT_GIVEN}
        half = self.opening
        rise = self.length / (2.0 * half) * (1.0 - math.cos(half / count)) if half else 0.0
        ends = [self.root, *(f"{self.name}, joint {k}" for k in range(1, count)), self.tip]
        return tuple(
            Piece(
                replace(
                    self,
                    name=f"{self.name}, piece {k + 1}",
                    start=points[k],
                    end=points[k + 1],
                    rise=rise,
                    root=str(ends[k]),
                    tip=ends[k + 1],
                    **{name: each[k] for name, each in sides.items()},
                    **{f"{name}_end": each[k + 1] for name, each in sides.items()},
                    **own,
                    root_joint=self.root_joint if k == 0 else CLAMP,
                    tip_joint=self.tip_joint if k == count - 1 else CLAMP,
                ),
                self,
                (float(cuts[k]), float(cuts[k + 1])),
            )
            for k in range(count)
        )


class Piece(NamedTuple):
    """A piece of a ``whole`` strip, or all of it, and the shares of its length [1] between which it lies."""

    strip: StripDesign
    whole: StripDesign
    reach: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class BodyDesign:
    """A rigid body.

    Parameters
    ----------
    name : str
    centre : (2,) m
        Centre of mass at rest.
    mass : float, kg, default 0
    moment_of_inertia : float, kg m^2, default 0
        About the centre of mass.

    Raises
    ------
    InvalidParameter
        A negative mass or moment.

    Examples
    --------
    >>> BodyDesign(name="tip", centre=(0.1, 0.0), mass=0.05, moment_of_inertia=1e-5).mass
    0.05
    """

    name: str
    centre: tuple[float, float]
    mass: float = 0.0
    moment_of_inertia: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("mass", self.mass, "kg")
        require_not_negative("moment_of_inertia", self.moment_of_inertia, "kg m^2")


@dataclass(frozen=True, kw_only=True)
class Design:
    """Strips and bodies with their discretisation.

    Attributes
    ----------
    pre_strain : mapping of str to float, 1/m and 1
        Curvature and strain, if any.
    curling : tuple of str
        Names of the effects of the sections' curl.
    root_length : float, 1
        Length of the supports over the thickness; bending takes it up.
    """

    strips: tuple[StripDesign, ...]
    bodies: tuple[BodyDesign, ...]
    discretisation: Discretisation
    pre_strain: Mapping[str, Any] = field(default_factory=dict)
    curling: tuple[str, ...] = ()
    root_length: float = 0.0

    def __post_init__(self) -> None:
        names = {body.name for body in self.bodies}
        for strip in self.strips:
            for end in (strip.root, strip.tip):
                if end not in {*names, GROUND, None}:
                    raise InvalidParameter(f"end of {strip.name}", end, f"ground or one of {sorted(names)}")

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces that the strips are cut into, strip by strip."""
        return tuple(piece for strip in self.strips for piece in strip.pieces(self.discretisation.segments))

    @property
    def joints(self) -> tuple[BodyDesign, ...]:
        """The frames between pieces: bodies without mass."""
        inner = (piece.strip for piece in self.pieces if piece.reach[1] < 1.0)
        return tuple(BodyDesign(name=str(strip.tip), centre=strip.end) for strip in inner)

    def require_uncut(self, name: str) -> None:
        """Refuse strips in segments where an answer, of that name, does not know them."""
        for strip in self.strips:
            arc = 2.0 * abs(strip.opening)
            if arc > LARGEST_OPENING:
                most = f"at most {math.degrees(LARGEST_OPENING):g} deg for {name}: two strips, a body between"
                raise InvalidParameter(f"arc of strip {strip.name} [deg]", round(math.degrees(arc), 4), most)
        if (segments := self.discretisation.segments) != 1:
            raise InvalidParameter("segments", segments, f"1 for {name}")

    def body_named(self, name: str | None) -> str:
        """Return that name, or the name of the only body; InvalidParameter for an unknown name or several
        bodies."""
        names = [body.name for body in self.bodies]
        if name is None and len(names) == 1:
            return names[0]
        if name not in names:
            raise InvalidParameter("body", name, f"one of {names}")
        return str(name)
