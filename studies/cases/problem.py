"""Read a case file into a `Problem`: the given data of one pivot, in SI units and radians."""

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from studies.cases.document import CaseError, is_mechanism, parsed, refuse_sections, table, values
from studies.cases.effects import read_effects
from studies.cases.keys import KEYS, LISTS, SIDES, TAPER
from studies.cases.mechanism import Body, Driven, Strip, read_points
from studies.cases.section import Sectioned, completed, of_sides, out_of_scale, renamed, too_heavy

__all__ = ["FOLDER", "TABLE_1", "CaseError", "Problem", "named_case", "read_problem"]

#: Name of the paper's pivot.
TABLE_1 = "cross_axis_pivot"
FOLDER = Path(__file__).parent

#: What only answers ask for, or stands for other values.
_BESIDE = ("outer_fibre", "yield_strength", "material")
#: What strips and body are called.
STRIPS, BODY = ("strip_1", "strip_2"), "body"
#: How far area and second moment may be from those of the sides [1].
ROUNDED = 1e-9


@dataclass(frozen=True, kw_only=True)
class Problem(Sectioned, Driven):
    """The given data of one cross-axis pivot and of the rotation it is driven through.

    Args:
        length: length L of a strip [m].
        inclination: angle a of strip 1 to the ground plate at rest [rad].
        crossing_ratio: distance of the crossing point from the ground end over L [1].
        body_mass: mass of the moving body [kg].
        body_moment_of_inertia: about its centre of mass [kg m^2].
        centre_offset: of the centre of mass from the midpoint of B1 B2, in body axes [m].
        orientation: of the whole pivot, turned about A1, counter-clockwise [rad].
        rotation: as of any design, but never None.

    Raises:
        CaseError: a value outside its admissible range.
    """

    length: float
    inclination: float
    crossing_ratio: float
    body_mass: float
    body_moment_of_inertia: float
    centre_offset: tuple[float, float] = (0.0, 0.0)
    orientation: float = 0.0
    rotation: float

    def __post_init__(self) -> None:
        for key in KEYS:
            value = getattr(self, key.attribute, None)
            if value is None and key.optional:
                continue
            try:
                key.rule.parse(key.rule.in_file(value))
            except ValueError as error:
                raise CaseError(f"{key.section}.{key.name}: {error}") from None
        self._check_section()
        heavy = too_heavy(self.body_mass, self.body_moment_of_inertia)
        for part, said in (("strip", out_of_scale(self)), ("body", heavy)):
            if said:
                raise CaseError(f"{part}: {said}")

    def _check_section(self) -> None:
        """Raise CaseError if the sides of the section are not those of its area and second moment."""
        if all(getattr(self, key.attribute) is None for key in (*SIDES, *TAPER)):
            return
        if self.outer_fibre is not None:
            got = f"strip.outer_fibre_m: got {self.outer_fibre:g} beside thickness_m"
            raise CaseError(f"{got}, expected none: that of a rectangle is half of its thickness")
        made = {} if None in (self.width, self.thickness) else of_sides(self.width, self.thickness)
        if not made or any(abs(getattr(self, n) / value - 1.0) > ROUNDED for n, value in made.items()):
            got = f"strip.width_m: got {self.width} by {self.thickness}"
            raise CaseError(f"{got}, expected both sides of a rectangle with A = {self.area:g} m^2")

    @property
    def crossing_point(self) -> tuple[float, float]:
        """Point x, y [m] where the two strips cross at rest; the origin is A1."""
        distance, angle = self.crossing_ratio * self.length, self.inclination + self.orientation
        return distance * math.cos(angle), distance * math.sin(angle)

    @property
    def crossing_of_chords(self) -> tuple[float, float]:
        """The crossing point [m], as of a mechanism."""
        return self.crossing_point

    @property
    def body(self) -> str:
        """Name of the body, as of a mechanism."""
        return BODY

    @property
    def strips(self) -> tuple[Strip, ...]:
        """The two strips, as of a mechanism."""
        own = {each.name: getattr(self, each.name) for each in fields(Strip) if hasattr(self, each.name)}
        run, rise = self.length * math.cos(self.inclination), self.length * math.sin(self.inclination)
        turn, found = cmath.rect(1.0, self.orientation), []
        for name, x, way in zip(STRIPS, (0.0, 2.0 * self.crossing_ratio * run), (run, -run), strict=True):
            start, end = x * turn, complex(x + way, rise) * turn
            ends: Any = {"start": (start.real, start.imag), "end": (end.real, end.imag)}
            found.append(Strip(name=name, tip=BODY, **ends, **own))
        return tuple(found)

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The one body, as of a mechanism."""
        middle = sum(complex(*strip.end) for strip in self.strips) / 2.0
        centre = middle + complex(*self.centre_offset) * cmath.rect(1.0, self.orientation)
        mass = {"mass": self.body_mass, "moment_of_inertia": self.body_moment_of_inertia}
        return (Body(name=BODY, centre=(centre.real, centre.imag), **mass),)

    def modelled(self, model: Any, **how: Any) -> Any:
        """Return the pivot in the form of a model, with its effects and discretisation."""
        return model.cross_axis_pivot(**self.pivot_parameters(), **how)

    def pivot_parameters(self) -> dict[str, Any]:
        """Return the keyword arguments that `cross_axis_pivot` of either model takes, sides only if known."""
        names = [key.attribute for key in KEYS if key.section != "drive" and key.attribute not in _BESIDE]
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


def named_case(case: str | Path = TABLE_1) -> Problem:
    """Return the pivot of that name in the suite (default: the benchmark pivot), or of a file.

    Raises:
        CaseError: the file is unreadable or not TOML, a section or key is missing, unknown or misspelt, a
            value has the wrong type or is outside its range. One line: file, key, got, expected.
    """
    own = FOLDER / f"{case}.toml"
    path = own if own.is_file() else Path(case)
    return read_problem(str(path), parsed(path))


def read_problem(path: str, content: Mapping[str, Any], changes: str | None = None) -> Problem:
    """Return the pivot of a parsed case file with its effects changed; CaseError as of `named_case`."""
    if is_mechanism(content):
        raise CaseError(f"{path}: [[strips]]: got a mechanism, expected a cross-axis pivot, with [strip]")
    sections = list(dict.fromkeys(key.section for key in KEYS))
    refuse_sections(path, content, [*sections, "scene", "effects", *LISTS, "points"])
    found: dict[str, Any] = {}
    for section in sections:
        keys = [key for key in KEYS if key.section == section]
        given = renamed(path, table(path, content, section))
        if section not in content:
            needed = ", ".join(key.name for key in [key for key in keys if not key.optional] or keys)
            raise CaseError(f"{path}: [{section}]: got no such section, expected one with {needed}")
        found |= values(path, keys, given, section)
    given = completed(path, found, "strip", "material")
    try:
        points, effects = read_points(path, content, [BODY]), read_effects(path, content, changes)
        return Problem(**given, effects=effects, points=points)
    except CaseError as error:
        text = str(error)
        raise error if text.startswith(path) else CaseError(f"{path}: {text}") from None
