"""Read a case file of any strips and bodies into a `Mechanism`: given data in SI units and radians."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from studies.cases import document, keys
from studies.cases.document import CaseError
from studies.cases.effects import Effects, read_effects
from studies.cases.keys import GROUND, LOADS_FIRST, MATERIAL, MATERIALS, MOMENTS, NAMED, SECTION, SIDES
from studies.cases.rules import FREE, shown

if TYPE_CHECKING:  # a template of a case waits for no arrays
    from studies.kinds import Array

Values = Mapping[str, Any]


class Sectioned:
    """What has a section: modulus, area, second moment and, where it is no rectangle, its depth [m]."""

    youngs_modulus: float
    area: float
    second_moment_of_area: float
    section_depth: float | None

    @property
    def depth(self) -> float:
        """Depth of the section [m]: as given, or that of the rectangle with its A and I."""
        depth: float = self.rectangle()["thickness"] if self.section_depth is None else self.section_depth
        return depth

    def rectangle(self) -> dict[str, Any]:
        """Return width and thickness [m] of the rectangle with its A and I."""
        return rectangle_of(self.area, self.second_moment_of_area)

    def extreme_fibre_strain(self, axial_force: "Array", bending_moment: "Array") -> "Array":
        """Return max |N/(EA) +- M d/(2 EI)|, the larger magnitude of the two extreme fibres (d: the depth).

        Exact for plane sections and small strain; leaves out shear, the strips' initial curvature and the
        clamps' notches.

        Args:
            axial_force: N, any shape [N].
            bending_moment: M, the same shape [N m].
        """
        modulus, inertia = self.youngs_modulus, self.second_moment_of_area
        axial = axial_force / (modulus * self.area)
        bending = bending_moment * self.depth / (2.0 * modulus * inertia)
        return abs(axial) + abs(bending)


@dataclass(frozen=True, kw_only=True)
class Strip(Sectioned):
    """A strip between two points [m], on the ground or on a body at its root, free or on either at its tip.

    tip: None for a free end. rise: sagitta of the circular arc it is at rest [m], to the left of start to
    end. width, thickness: of a rectangular section [m], None where only A and I are known. section_depth: of
    one that is no rectangle [m]. yield_strength: that stresses must stay below [Pa]; None where unknown.
    """

    name: str
    start: tuple[float, float]
    end: tuple[float, float]
    root: str = GROUND
    tip: str | None
    rise: float = 0.0
    area: float
    second_moment_of_area: float
    width: float | None = None
    thickness: float | None = None
    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float | None = None
    section_depth: float | None = None

    @property
    def length(self) -> float:
        """Distance of its ends at rest [m]."""
        return math.dist(self.start, self.end)


@dataclass(frozen=True, kw_only=True)
class Body:
    """A rigid body: centre of mass at rest [m], mass [kg], moment of inertia about it [kg m^2]."""

    name: str
    centre: tuple[float, float]
    mass: float
    moment_of_inertia: float


@dataclass(frozen=True, kw_only=True)
class Mechanism:
    """The given data of a mechanism of flexures and of how it is driven.

    Args:
        strips, bodies: of different names.
        body: the one that is driven, let go, and whose swing is reported; None where there is no body.
        rotation: that it is driven to [rad]; None: it follows the loads.
        increments: equal increments of the path [1].
        effects: of the scene.
        history, held: of the rotation in a motion that goes on with it, pairs of time [s] and factor, and its
            begin and end [s]; None for one that lets go.
        order: of loads and rotation, "loads first" or "together".
    """

    strips: tuple[Strip, ...]
    bodies: tuple[Body, ...]
    body: str | None
    rotation: float | None
    increments: int
    effects: Effects
    order: str = LOADS_FIRST
    history: tuple[tuple[float, float], ...] | None = None
    held: tuple[float, float] | None = None

    def mechanism_parameters(self) -> dict[str, list[dict[str, Any]]]:
        """Return strips and bodies as the keyword arguments of the designs of either model."""
        return {
            "strips": [_keywords(strip) for strip in self.strips],
            "bodies": [_keywords(body) for body in self.bodies],
        }


def read_mechanism(path: str, content: Mapping[str, Any], changes: str | None = None) -> Mechanism:
    """Return the mechanism of a parsed case file, its effects changed as `read_design` says.

    Raises:
        CaseError: a section or key is missing, unknown or misspelt, a value is out of range, a name comes
            twice or stands for nothing. One line: file, key, got, expected.
    """
    document.refuse_sections(path, content, keys.SECTIONS)
    shared = {
        **document.values(path, SECTION, document.table(path, content, "section"), "section"),
        **document.values(path, MATERIAL, document.table(path, content, "material"), "material"),
    }
    _refuse_both(path, shared, "section")
    bodies = tuple(
        Body(**document.values(path, keys.BODY, given, label))
        for label, given in _each(path, content, "bodies")
    )
    strips = tuple(_strip(path, given, label, shared) for label, given in _each(path, content, "strips"))
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
    drive = {"rotation": None} | drive | {"body": _driven(path, drive.get("body"), names)}
    return Mechanism(strips=strips, bodies=bodies, effects=read_effects(path, content, changes), **drive)


def _keywords(part: Strip | Body) -> dict[str, Any]:
    """Return what the models take of a part; the sides of a section only where they are given."""
    given = {each.name: getattr(part, each.name) for each in fields(part)}
    unsaid = [name for name in ("width", "thickness") if given.get(name) is None]
    return _without(given, ["yield_strength", "section_depth", *unsaid])


def _each(path: str, content: Mapping[str, Any], section: str) -> list[tuple[str, Mapping[str, Any]]]:
    """Return the tables of an array with the label that errors give them: by name, or by place."""
    tables = content.get(section, [])
    needed = section == "strips" and not tables
    if needed or not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        raise CaseError(f"{path}: {section}: got {shown(tables)}, expected tables [[{section}]]")
    found = []
    for place, each in enumerate(tables, start=1):
        name = each.get("name")
        found.append((f"{section}.{name}" if isinstance(name, str) else f"{section} number {place}", each))
    return found


def _strip(path: str, given: Mapping[str, Any], label: str, shared: Mapping[str, Any]) -> Strip:
    """Return one strip, its section and material its own or those of all."""
    own = document.values(path, [*keys.STRIP, *keys.OWN], given, label)
    _refuse_both(path, own, label)
    found = completed(path, _inherited(shared, own), label, label, shared=True)
    found["tip"] = None if found["tip"] == FREE else found["tip"]
    if found["start"] == found["end"]:
        raise CaseError(
            f"{path}: {label}.end_m: got {list(found['end'])}, where it begins, expected a length"
        )
    return Strip(**found)


def _refuse_twice(path: str, names: list[str]) -> None:
    for place, name in enumerate(names):
        if name in (GROUND, FREE) or name in names[:place]:
            raise CaseError(
                f"{path}: name: got {name}, expected different names, none of them {GROUND} or {FREE}"
            )


def _driven(path: str, body: str | None, names: list[str]) -> str | None:
    """Return the body that is driven: the one named, or the only one."""
    if body is None and len(names) <= 1:
        return names[0] if names else None
    if body not in names:
        got = "no such key" if body is None else body
        expected = document.nearest(body or "", names) if names else "none, as there are no bodies"
        raise CaseError(f"{path}: drive.body: got {got}, expected {expected}")
    return body


def completed(
    where: str, found: Values, section: str, material: str, *, shared: bool = False
) -> dict[str, Any]:
    """Return the values of a strip, by attribute in SI, with area, second moment and material complete.

    Args:
        where: file that errors name. found: what the case gives.
        section, material: how errors name the tables that these keys stand in.
        shared: whether they may also stand in [section] and [material].

    Raises:
        CaseError: both pairs of a section, half a pair, or a key of the material missing; one line.
    """
    _refuse_both(where, found, section)
    values = dict(found)
    named = values.pop(NAMED.attribute, None)
    if named is not None:
        own = MATERIALS[named]
        values = {key.attribute: own[key.attribute] for key in MATERIAL if key.attribute in own} | values
    pair = SIDES if any(key.attribute in values for key in SIDES) else MOMENTS
    if not any(key.attribute in values for key in SECTION):
        expected = "width_m and thickness_m, or area_m2 and second_moment_m4"
        missing = " there nor in [section]" if shared else ""
        raise CaseError(f"{where}: {section}.width_m: got no such key{missing}, expected {expected}")
    for key, label in (*((key, section) for key in pair), *((key, material) for key in keys.ELASTIC)):
        if key.attribute not in values:
            named_one = " or the name of a material" if key in keys.ELASTIC and named is None else ""
            missing = f" there nor in [{key.section}]" if shared else ""
            expected = f"{key.rule.expected}{named_one}"
            raise CaseError(f"{where}: {label}.{key.name}: got no such key{missing}, expected {expected}")
    if pair is SIDES:
        values |= of_sides(values["width"], values["thickness"])
    return values


def of_sides(width: Any, thickness: Any) -> dict[str, Any]:
    """Return area b h [m^2] and second moment b h^3 / 12 [m^4] of a rectangle; sides may be arrays."""
    return {"area": width * thickness, "second_moment_of_area": width * thickness**3 / 12.0}


def rectangle_of(area: float, second_moment_of_area: float) -> dict[str, float]:
    """Return width and thickness [m] of the rectangle with that A and I: sqrt(12 I / A) thick."""
    thickness = math.sqrt(12.0 * second_moment_of_area / area)
    return {"width": area / thickness, "thickness": thickness}


def _refuse_both(where: str, found: Values, label: str) -> None:
    """Raise CaseError if both pairs, or parts of them, are given for one section."""
    one = [key.name for key in SIDES if key.attribute in found]
    other = [key.name for key in MOMENTS if key.attribute in found]
    if one and other:
        expected = "width_m and thickness_m, or area_m2 and second_moment_m4, not both"
        raise CaseError(f"{where}: {label}.{one[0]}: got it beside {other[0]}, expected {expected}")


def _inherited(shared: Values, own: Values) -> dict[str, Any]:
    """Return what a strip has of its own and of what all have.

    A strip's own pair of a section takes the place of the other pair that all have, and its own named
    material that of all values of theirs.
    """
    left = dict(shared)
    for pair, other in ((SIDES, MOMENTS), (MOMENTS, SIDES)):
        if any(key.attribute in own for key in pair):
            left = _without(left, [key.attribute for key in other])
    if NAMED.attribute in own:
        left = _without(left, [key.attribute for key in keys.ELASTIC] + ["yield_strength"])
    return left | dict(own)


def _without(values: Values, names: list[str]) -> dict[str, Any]:
    """Return the values but for those of these names."""
    return {name: value for name, value in values.items() if name not in names}
