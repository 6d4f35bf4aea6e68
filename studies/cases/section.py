"""Sections of strips: sides, or area and second moment; depth; and what a case gives of them."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from studies.cases import keys
from studies.cases.document import CaseError
from studies.cases.keys import DEPTH, MATERIAL, MATERIALS, MOMENTS, NAMED, SECTION, SIDES

if TYPE_CHECKING:  # a template of a case waits for no arrays
    from studies.kinds import Array

Values = Mapping[str, Any]


#: Numbers of a strip that double precision bears: stiffness [N] or mass per length [kg/m], slenderness [1].
SCALES, SLENDERNESS = (1e-60, 1e60), (0.1, 1e10)


class Sectioned:
    """What has a section: modulus, area, second moment and, where it is no rectangle, its depth [m]."""

    youngs_modulus: float
    area: float
    second_moment_of_area: float
    section_depth: float | None
    width: float | None

    @property
    def depth(self) -> float:
        """Depth of the section [m]: as given, or that of the rectangle with its A and I."""
        depth: float = self.rectangle()["thickness"] if self.section_depth is None else self.section_depth
        return depth

    @property
    def depth_is_assumed(self) -> bool:
        """Whether the depth is that of a rectangle which no one named: only A and I are known."""
        return self.width is None and self.section_depth is None

    def rectangle(self) -> dict[str, Any]:
        """Return width and thickness [m] of the rectangle with its A and I."""
        return rectangle_of(self.area, self.second_moment_of_area)

    def extreme_fibre_strain(self, axial_force: "Array", bending_moment: "Array") -> "Array":
        """Return max |N/(EA) +- M d/(2 EI)|, the larger magnitude of the two extreme fibres (d: the depth).

        Exact for plane sections and small strain; neglects shear, the strips' initial curvature and the
        clamps' notches.

        Args:
            axial_force: N, any shape [N].
            bending_moment: M, the same shape [N m].
        """
        modulus, inertia = self.youngs_modulus, self.second_moment_of_area
        axial = axial_force / (modulus * self.area)
        bending = bending_moment * self.depth / (2.0 * modulus * inertia)
        return abs(axial) + abs(bending)


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
    refuse_both(where, found, section)
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


def _root(area: float, inertia: float) -> float:
    """Return sqrt(A/I), without end where the second moment is too small for a number."""
    return math.sqrt(area / inertia) if inertia > 0.0 else math.inf


def out_of_scale(strip: Any) -> str:
    """Return in words the first number made of a strip that no solve can bear, or nothing."""
    area, inertia, modulus = strip.area, strip.second_moment_of_area, strip.youngs_modulus
    made = {
        "stiffness EA [N]": (modulus * area, SCALES),
        "slenderness L sqrt(A/I) [1]": (strip.length * _root(area, inertia), SLENDERNESS),
        "stiffness EI/L^2 [N]": (modulus * inertia / strip.length / strip.length, SCALES),
        "mass per length [kg/m]": (strip.density * area, SCALES),
    }
    return _beyond(made)


def too_heavy(mass: float, inertia: float) -> str:
    """Return in words that a body's mass or moment of inertia is more than any solve can bear, or nothing."""
    none = (0.0, SCALES[1])
    return _beyond({"mass [kg]": (mass, none), "moment of inertia [kg m^2]": (inertia, none)})


def _beyond(made: Mapping[str, tuple[float, tuple[float, float]]]) -> str:
    for name, (value, (low, high)) in made.items():
        if not low <= value <= high:
            return f"{name}: got {value:.3g}, expected {low:g} to {high:g}"
    return ""


def of_sides(width: Any, thickness: Any) -> dict[str, Any]:
    """Return area b h [m^2] and second moment b h^3 / 12 [m^4] of a rectangle; sides may be arrays."""
    return {
        "area": width * thickness,
        "second_moment_of_area": width * thickness * thickness * thickness / 12.0,
    }


def of_moments(area: float, second_moment_of_area: float) -> dict[str, Any]:
    """Return a section of that A [m^2] and I [m^4], whose sides are not known, to replace another by."""
    return {
        "area": area,
        "second_moment_of_area": second_moment_of_area,
        "width": None,
        "thickness": None,
    }


def rectangle_of(area: float, second_moment_of_area: float) -> dict[str, float]:
    """Return width and thickness [m] of the rectangle with that A and I: sqrt(12 I / A) thick."""
    thickness = math.sqrt(12.0 * second_moment_of_area / area)
    return {"width": area / thickness, "thickness": thickness}


def refuse_both(where: str, found: Values, label: str) -> None:
    """Raise CaseError if both pairs, or parts of them, are given for one section."""
    one = [key.name for key in SIDES if key.attribute in found]
    other = [key.name for key in (*MOMENTS, DEPTH) if key.attribute in found]
    if one and other:
        expected = "width_m and thickness_m, or area_m2 and second_moment_m4 (with section_depth_m), not both"
        raise CaseError(f"{where}: {label}.{one[0]}: got it beside {other[0]}, expected {expected}")


def inherited(shared: Values, own: Values) -> dict[str, Any]:
    """Return what a strip has of its own and of what all have.

    A strip's own pair of a section takes the place of the other pair that all have, and its own named
    material that of all values of theirs.
    """
    left = dict(shared)
    for pair, other in ((SIDES, MOMENTS), (MOMENTS, SIDES)):
        if any(key.attribute in own for key in pair):
            left = without(left, [key.attribute for key in (*other, DEPTH)])
    if NAMED.attribute in own:
        left = without(left, [key.attribute for key in keys.ELASTIC] + ["yield_strength"])
    return left | dict(own)


def without(values: Values, names: list[str]) -> dict[str, Any]:
    """Return the values but for those of these names."""
    return {name: value for name, value in values.items() if name not in names}
