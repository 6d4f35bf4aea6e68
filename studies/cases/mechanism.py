"""Designs: strips and bodies with what acts on them and how they are driven, in SI units and radians.

A cross-axis pivot is a design that its short form makes: two strips and a body of a few numbers.
"""

import cmath
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

from studies.cases.document import CaseError
from studies.cases.effects import OF_SIDES, Effects
from studies.cases.keys import BODY, CLAMP, DRIVE, GROUND, LOADS_FIRST, OWN, PIVOT, STRIP
from studies.cases.rules import Key
from studies.cases.section import Sectioned

#: Sine of the angle between strips below which they do not cross.
PARALLEL = 1e-9
#: Numbers that double precision bears: stiffness [N], mass per length [kg/m] or of a body; slenderness [1].
SCALES, MASSES, SLENDERNESS = (1e-60, 1e60), (0.0, 1e60), (0.1, 1e10)
#: What only answers ask for.
_BESIDE = ("outer_fibre", "yield_strength")
#: What strips and body of a pivot are called.
STRIPS, PIVOTED = ("strip_1", "strip_2"), "body"


@dataclass(frozen=True, kw_only=True)
class Strip(Sectioned):
    """A strip between two points [m]; the root is on the ground or a body, the tip on either or free.

    Attributes:
        tip: None for a free end. rise: sagitta of the circular arc at rest [m], to the left of start to end.
        root_joint, tip_joint: "clamp" or "hinge".
    """

    name: str
    start: tuple[float, float]
    end: tuple[float, float]
    root: str = GROUND
    tip: str | None
    root_joint: str = CLAMP
    tip_joint: str = CLAMP
    rise: float = 0.0

    @property
    def length(self) -> float:
        """Length of its axis at rest [m]."""
        chord = math.dist(self.start, self.end)
        half = 2.0 * math.atan2(2.0 * abs(self.rise), chord)
        return chord * half / math.sin(half) if self.rise else chord

    def scales(self) -> Iterator[tuple[str, float, tuple[float, float]]]:
        """Yield numbers at both ends that must be solvable: name, value, and least and largest value."""
        for b, t in (self.growth(0.0), self.growth(1.0)):
            area, inertia = self.area * b * t, self.second_moment_of_area * b * t * t * t
            bluntness = math.sqrt(area / inertia) if inertia > 0.0 else math.inf
            yield "stiffness EA [N]", self.youngs_modulus * area, SCALES
            yield "slenderness L sqrt(A/I) [1]", self.length * bluntness, SLENDERNESS
            yield "stiffness EI/L^2 [N]", self.youngs_modulus * inertia / self.length / self.length, SCALES
            yield "mass per length [kg/m]", self.density * area, SCALES


@dataclass(frozen=True, kw_only=True)
class Body:
    """A rigid body: centre of mass at rest [m], mass [kg], moment of inertia about it [kg m^2]."""

    name: str
    centre: tuple[float, float]
    mass: float
    moment_of_inertia: float

    def scales(self) -> Iterator[tuple[str, float, tuple[float, float]]]:
        """Yield numbers that must be solvable: name, value, and least and largest value."""
        yield "mass [kg]", self.mass, MASSES
        yield "moment of inertia [kg m^2]", self.moment_of_inertia, MASSES


@dataclass(frozen=True, kw_only=True)
class Point:
    """A point of a body whose displacement is reported: where it is at rest [m]."""

    name: str
    body: str
    at: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Mechanism:
    """The given data of a mechanism of flexures, of what acts on it, and of its drive.

    Args:
        strips, bodies: of different names.
        body: name of the driven, released and reported body; None if there is no body.
        rotation: end of the driven rotation, counter-clockwise [rad]; None: the rotation follows the loads.
        increments: equal increments of the path [1].
        effects: of the case.
        history, held: of a rotation that is prescribed in a motion: pairs of time [s] and factor [1], and
            begin and end [s]; None for a release.
        order: of loads and rotation, "loads first" or "together".
        points: of bodies, whose displacement is reported.
    """

    strips: tuple[Strip, ...]
    bodies: tuple[Body, ...]
    body: str | None
    rotation: float | None
    increments: int
    effects: Effects = field(default_factory=Effects)
    order: str = LOADS_FIRST
    history: tuple[tuple[float, float], ...] | None = None
    held: tuple[float, float] | None = None
    points: tuple[Point, ...] = ()

    @property
    def crossing_point(self) -> tuple[float, float] | None:
        """Point x, y [m] where the two strips of a pivot cross at rest; None of any other mechanism."""
        return None

    @property
    def crossing_of_chords(self) -> tuple[float, float] | None:
        """Point x, y [m] where two strips cross at rest that alone carry the only body on the ground; else
        None."""
        carried = [{strip.root, strip.tip} for strip in self.strips]
        if len(self.bodies) != 1 or carried != 2 * [{GROUND, self.bodies[0].name}]:
            return None
        (a, b), (c, d) = ((complex(*each.start), complex(*each.end)) for each in self.strips)
        one, other = b - a, d - c
        across = (one.conjugate() * other).imag
        if abs(across) < PARALLEL * abs(one) * abs(other):
            return None
        along = ((c - a).conjugate() * other).imag / across, ((c - a).conjugate() * one).imag / across
        if not 0.0 < min(along) <= max(along) < 1.0:
            return None
        return (a + along[0] * one).real, (a + along[0] * one).imag

    @property
    def tables(self) -> Mapping[str, tuple[tuple[Key, ...], Any]]:
        """Tables of a case file by name: their keys, and whose attributes these fill, a tuple of several."""
        strips = (*STRIP, *OWN), self.strips
        return {"strips": strips, "bodies": (BODY, self.bodies), "drive": (DRIVE, self)}

    def checked(self, where: str) -> Self:
        """Return the design; CaseError, in one line, for numbers that no model can solve, or an effect of the
        sides of a section where these are unknown."""
        parts: tuple[Strip | Body, ...] = (*self.strips, *self.bodies)
        for part in parts:
            for name, value, (low, high) in part.scales():
                if not low <= value <= high:
                    expected = f"{low:g} to {high:g}"
                    raise CaseError(f"{where}: {part.name}: {name}: got {value:.3g}, expected {expected}")
        named = [name for name in self.effects.names if name in OF_SIDES]
        without = [strip.name for strip in self.strips if strip.width is None]
        if named and without:
            expected = "width_m and thickness_m in place of area_m2 and second_moment_m4"
            got = f"got no sides for {' and '.join(named)}"
            raise CaseError(f"{where}: {without[0]}: {got}, expected {expected}")
        return self

    def changed(self, strip: Callable[[Strip], Mapping[str, Any]], **body: Any) -> Self:
        """Return the design with other attributes of each strip, which a function gives, and of the driven
        body."""
        strips = tuple(replace(each, **strip(each)) for each in self.strips)
        bodies = tuple(replace(each, **body) if each.name == self.body else each for each in self.bodies)
        return replace(self, strips=strips, bodies=bodies)

    def modelled(self, model: Any, **how: Any) -> Any:
        """Return the design in the form of a model, with its effects and discretisation."""
        strips = [model.StripDesign(**_keywords(strip)) for strip in self.strips]
        bodies = [model.BodyDesign(**_keywords(body)) for body in self.bodies]
        return model.compliant_mechanism(strips=strips, bodies=bodies, **how)


@dataclass(frozen=True, kw_only=True)
class Problem(Sectioned, Mechanism):
    """A cross-axis pivot by its short form, which makes two strips of one section and one body.

    Args:
        length: length L of a strip [m].
        inclination: angle a of strip 1 to the ground plate at rest [rad].
        crossing_ratio: distance of the crossing point from the ground end over L [1].
        body_mass: mass of the moving body [kg].
        body_moment_of_inertia: about its centre of mass [kg m^2].
        centre_offset: of the centre of mass from the midpoint of B1 B2, in body axes [m].
        orientation: of the whole pivot, turned about A1, counter-clockwise [rad].
        rotation: as of any design, but never None.
    """

    length: float
    inclination: float
    crossing_ratio: float
    body_mass: float
    body_moment_of_inertia: float
    centre_offset: tuple[float, float] = (0.0, 0.0)
    orientation: float = 0.0
    rotation: float
    strips: tuple[Strip, ...] = field(init=False, repr=False, compare=False)
    bodies: tuple[Body, ...] = field(init=False, repr=False, compare=False)
    body: str = field(init=False, repr=False, compare=False, default=PIVOTED)

    def __post_init__(self) -> None:
        super().__post_init__()
        section = {each.name: getattr(self, each.name) for each in fields(Sectioned)}
        run, rise = self.length * math.cos(self.inclination), self.length * math.sin(self.inclination)
        turn, strips = cmath.rect(1.0, self.orientation), []
        for name, x, way in zip(STRIPS, (0.0, 2.0 * self.crossing_ratio * run), (run, -run), strict=True):
            start, end = x * turn, complex(x + way, rise) * turn
            ends: Any = {"start": (start.real, start.imag), "end": (end.real, end.imag)}
            strips.append(Strip(name=name, tip=self.body, **ends, **section))
        middle = sum(complex(*strip.end) for strip in strips) / 2.0
        centre = middle + complex(*self.centre_offset) * turn
        mass = {"mass": self.body_mass, "moment_of_inertia": self.body_moment_of_inertia}
        object.__setattr__(self, "strips", tuple(strips))
        object.__setattr__(self, "bodies", (Body(name=self.body, centre=(centre.real, centre.imag), **mass),))

    @property
    def crossing_point(self) -> tuple[float, float]:
        """Point x, y [m] where the two strips cross at rest; the origin is A1."""
        distance, angle = self.crossing_ratio * self.length, self.inclination + self.orientation
        return distance * math.cos(angle), distance * math.sin(angle)

    crossing_of_chords = crossing_point

    @property
    def tables(self) -> Mapping[str, tuple[tuple[Key, ...], Any]]:
        """As of any mechanism: those of the short form."""
        return {name: (rows, self) for name, rows in PIVOT.items()}

    def changed(self, strip: Callable[[Strip], Mapping[str, Any]], **body: Any) -> Self:
        """As of any mechanism: what both strips and the body have is changed in the short form."""
        of_body = {f"body_{name}": value for name, value in body.items()}
        return replace(self, **strip(self.strips[0]), **of_body)

    def modelled(self, model: Any, **how: Any) -> Any:
        """Return the pivot in the form of a model, which places the strips itself."""
        return model.cross_axis_pivot(**self.pivot_parameters(), **how)

    def pivot_parameters(self) -> dict[str, Any]:
        """Return the keyword arguments that `cross_axis_pivot` of either model takes, sides only if known."""
        driven = [each.name for each in fields(Mechanism)]
        return {name: value for name, value in _keywords(self).items() if name not in driven}


def _keywords(part: Any) -> dict[str, Any]:
    """Return the keyword arguments of a part for the models, without what is unknown of it."""
    given = {each.name: getattr(part, each.name) for each in fields(part) if each.name not in _BESIDE}
    return {name: value for name, value in given.items() if value is not None or name == "tip"}
