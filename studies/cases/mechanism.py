"""Read a case file of any strips and bodies into a `Mechanism`: given data in SI units and radians."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

from studies.cases import document, keys
from studies.cases.document import CaseError, tables
from studies.cases.effects import Effects, read_effects
from studies.cases.keys import CLAMP, GROUND, LOADS_FIRST, MATERIAL, SECTION, SIDES, TAPER
from studies.cases.rules import FREE
from studies.cases.section import (
    Sectioned,
    completed,
    inherited,
    out_of_scale,
    refuse_both,
    renamed,
    too_heavy,
    without,
)

Values = Mapping[str, Any]

#: Sine of the angle between strips below which they do not cross.
PARALLEL = 1e-9


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


@dataclass(frozen=True, kw_only=True)
class Body:
    """A rigid body: centre of mass at rest [m], mass [kg], moment of inertia about it [kg m^2]."""

    name: str
    centre: tuple[float, float]
    mass: float
    moment_of_inertia: float


@dataclass(frozen=True, kw_only=True)
class Point:
    """A point of a body whose displacement is reported: where it is at rest [m]."""

    name: str
    body: str
    at: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Driven:
    """The effects of a design and the path that it is driven through, of a pivot and of any mechanism.

    Args:
        rotation: end of the driven rotation, counter-clockwise [rad]; None: the rotation follows the loads.
        increments: equal increments of the path [1].
        effects: of the case.
        history, held: of a rotation that is prescribed in a motion: pairs of time [s] and factor [1], and
            begin and end [s]; None for a release.
        order: of loads and rotation, "loads first" or "together".
        points: of bodies, whose displacement is reported.
    """

    rotation: float | None
    increments: int
    effects: Effects = field(default_factory=Effects)
    order: str = LOADS_FIRST
    history: tuple[tuple[float, float], ...] | None = None
    held: tuple[float, float] | None = None
    points: tuple[Point, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Mechanism(Driven):
    """The given data of a mechanism of flexures and of its drive.

    Args:
        strips, bodies: of different names.
        body: name of the driven, released and reported body; None if there is no body.
    """

    strips: tuple[Strip, ...]
    bodies: tuple[Body, ...]
    body: str | None

    @property
    def crossing_point(self) -> None:
        """None: a mechanism has no crossing point, unlike a pivot."""

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

    def modelled(self, model: Any, **how: Any) -> Any:
        """Return the mechanism in the form of a model, with its effects and discretisation."""
        strips = [model.StripDesign(**_keywords(strip)) for strip in self.strips]
        bodies = [model.BodyDesign(**_keywords(body)) for body in self.bodies]
        return model.compliant_mechanism(strips=strips, bodies=bodies, **how)


def read_mechanism(path: str, content: Mapping[str, Any], changes: str | None = None) -> Mechanism:
    """Return the mechanism of a parsed case file, its effects changed as `read_design` says.

    Raises:
        CaseError: a section or key is missing, unknown or misspelt, a value is out of range, a name comes
            twice or stands for nothing. One line: file, key, got, expected.
    """
    document.refuse_sections(path, content, keys.SECTIONS)
    shared = {
        **document.values(path, SECTION, renamed(path, document.table(path, content, "section")), "section"),
        **document.values(path, MATERIAL, document.table(path, content, "material"), "material"),
    }
    refuse_both(path, shared, "section")
    bodies = tuple(_body(path, given, label) for label, given in tables(path, content, "bodies"))
    strips = tuple(
        _strip(path, given, label, shared) for label, given in tables(path, content, "strips", needed=True)
    )
    names = [body.name for body in bodies]
    _refuse_twice(path, [*names, *(strip.name for strip in strips)])
    for strip in strips:
        for key, place in (("root", strip.root), ("tip", strip.tip)):
            if place is not None and place not in (GROUND, *names):
                expected = document.nearest(place, [GROUND, *([FREE] if key == "tip" else []), *names])
                raise CaseError(f"{path}: strips.{strip.name}.{key}: got {place}, expected {expected}")
    if "drive" not in content:
        raise CaseError(f"{path}: [drive]: got no such section, expected one with increments")
    drive = document.values(path, keys.DRIVE, document.table(path, content, "drive"), "drive")
    drive = {"rotation": None} | drive | {"body": _body_of(path, "drive.body", drive.get("body"), names)}
    drive |= {"effects": read_effects(path, content, changes), "points": read_points(path, content, names)}
    return Mechanism(strips=strips, bodies=bodies, **drive)


def read_points(path: str, content: Mapping[str, Any], bodies: Sequence[str]) -> tuple[Point, ...]:
    """Return the points of [[points]], each of one of the bodies; CaseError as of `read_mechanism`."""
    found = []
    for label, given in tables(path, content, "points"):
        own = document.values(path, keys.POINT, given, label)
        own["body"] = _body_of(path, f"{label}.body", own.get("body"), list(bodies))
        found.append(Point(**own))
    _refuse_twice(path, [point.name for point in found])
    return tuple(found)


def _keywords(part: Strip | Body) -> dict[str, Any]:
    """Return the keyword arguments of a part for the models; the sides of a section only if they are
    given."""
    given = {each.name: getattr(part, each.name) for each in fields(part)}
    sides = [key.attribute for key in (*SIDES, *TAPER)]
    joints = [name for name in ("root_joint", "tip_joint") if given.get(name) == CLAMP]
    left = [*joints, *(name for name in sides if given.get(name) is None)]
    return without(given, ["yield_strength", "outer_fibre", *left])


def _strip(path: str, given: Mapping[str, Any], label: str, shared: Mapping[str, Any]) -> Strip:
    """Return one strip, its section and material its own or those of all."""
    own = document.values(path, [*keys.STRIP, *keys.OWN], renamed(path, given), label)
    refuse_both(path, own, label)
    found = completed(path, inherited(shared, own), label, label, shared=True)
    found["tip"] = None if found["tip"] == FREE else found["tip"]
    if found["start"] == found["end"]:
        raise CaseError(
            f"{path}: {label}.end_m: got {list(found['end'])}, where it begins, expected a length"
        )
    strip = Strip(**found)
    if said := out_of_scale(strip):
        raise CaseError(f"{path}: {label}: {said}")
    return strip


def _body(path: str, given: Mapping[str, Any], label: str) -> Body:
    """Return one body."""
    body = Body(**document.values(path, keys.BODY, given, label))
    if said := too_heavy(body.mass, body.moment_of_inertia):
        raise CaseError(f"{path}: {label}: {said}")
    return body


def _refuse_twice(path: str, names: list[str]) -> None:
    for place, name in enumerate(names):
        if name in (GROUND, FREE) or name in names[:place]:
            raise CaseError(
                f"{path}: name: got {name}, expected different names, none of them {GROUND} or {FREE}"
            )


def _body_of(path: str, label: str, body: str | None, names: list[str]) -> str | None:
    """Return the body that is meant: the one named, or the only one."""
    if body is None and len(names) <= 1:
        return names[0] if names else None
    if body not in names:
        got = "no such key" if body is None else body
        expected = document.nearest(body or "", names) if names else "none, as there are no bodies"
        raise CaseError(f"{path}: {label}: got {got}, expected {expected}")
    return body
