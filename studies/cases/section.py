"""Sections of strips: sides, or area and second moment; outermost fibre; and what a case gives of them."""

import logging
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from studies.cases import keys
from studies.cases.document import CaseError
from studies.cases.keys import FIBRE, MATERIAL, MATERIALS, MOMENTS, NAMED, SECTION, SIDES, TAPER

if TYPE_CHECKING:  # a template of a case waits for no arrays
    from studies.kinds import Array

Values = Mapping[str, Any]

#: Older name of the key of the outermost fibre: twice its distance.
OLD_DEPTH = "section_depth_m"


@dataclass(frozen=True, kw_only=True)
class Sectioned:
    """Section and material of strips.

    Args:
        area, second_moment_of_area: A [m^2] and I [m^4] of the section, at the start of a strip; those of the
            sides, whatever is given, where these are known.
        width, thickness: of a rectangular section [m]; None where only A and I are known.
        width_end, thickness_end: of a tapered one, at the end [m]; None of a constant one.
        outer_fibre: distance of the outermost fibre from the neutral axis [m]; None of a rectangle, and where
            it is not known.
        youngs_modulus, poisson_ratio, density: of the material [Pa, 1, kg/m^3].
        yield_strength: that stresses must stay below [Pa]; None where none is known.
    """

    area: float = math.nan
    second_moment_of_area: float = math.nan
    width: float | None = None
    thickness: float | None = None
    width_end: float | None = None
    thickness_end: float | None = None
    outer_fibre: float | None = None
    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float | None = None

    def __post_init__(self) -> None:
        if self.width is not None and self.thickness is not None:
            for name, value in of_sides(self.width, self.thickness).items():
                object.__setattr__(self, name, value)

    @property
    def depth(self) -> float:
        """Depth of the section [m]: twice the distance of its outermost fibre; if this is unknown, the depth
        of the rectangle with its A and I."""
        fibre = self.fibre
        return self.rectangle()["thickness"] if math.isnan(fibre) else 2.0 * fibre

    @property
    def fibre(self) -> float:
        """Distance of the outermost fibre from the neutral axis [m]; NaN where it is not known."""
        if self.outer_fibre is not None:
            return self.outer_fibre
        return math.nan if self.thickness is None else self.thickness / 2.0

    def growth(self, places: Any) -> tuple[Any, Any]:
        """Return width and thickness over those at the start [1] at places [1] along the length."""
        sides = (self.width, self.width_end), (self.thickness, self.thickness_end)
        b, t = (1.0 + places * (end / start - 1.0 if start and end else 0.0) for start, end in sides)
        return b, t

    def rectangle(self) -> dict[str, Any]:
        """Return width and thickness [m] of the rectangle with its A and I."""
        return rectangle_of(self.area, self.second_moment_of_area)

    def extreme_fibre_strain(self, axial_force: "Array", bending_moment: "Array") -> Any:
        """Return max |N/(EA) +- M c/(EI)|, the larger magnitude of the two extreme fibres (c: `fibre`).

        Exact for plane sections and small strain; neglects shear, the strips' initial curvature and the
        clamps' notches. NaN where the outermost fibre is not known.

        Args:
            axial_force: N (..., P) [N] at P stations, evenly spaced from start to end.
            bending_moment: M, the same shape [N m].
        """
        modulus, inertia = self.youngs_modulus, self.second_moment_of_area
        from numpy import linspace

        axial = axial_force / (modulus * self.area)
        bending = bending_moment * self.fibre / (modulus * inertia)
        b, t = self.growth(linspace(0.0, 1.0, axial_force.shape[-1]))
        axial, bending = axial / (b * t), bending / (b * t * t)
        return abs(axial) + abs(bending)


def completed(
    where: str, found: Values, section: str, material: str, *, shared: bool = False
) -> dict[str, Any]:
    """Return the values of a strip, by attribute in SI, with complete area, second moment and material.

    Args:
        where: file name for error messages. found: values of the case.
        section, material: names of the tables with these keys for error messages.
        shared: whether the keys may also stand in [section] and [material].

    Raises:
        CaseError: both pairs of a section, half a pair, or a key of the material missing; one line.
    """
    refuse_both(where, found, section)
    values = dict(found)
    named = values.pop(NAMED.attribute, None)
    if named is not None:
        own = MATERIALS[named]
        values = {key.attribute: own[key.attribute] for key in MATERIAL if key.attribute in own} | values
    pair = SIDES if any(key.attribute in values for key in (*SIDES, *TAPER)) else MOMENTS
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
    return values


def of_sides(width: Any, thickness: Any) -> dict[str, Any]:
    """Return area b h [m^2] and second moment b h^3 / 12 [m^4] of a rectangle; sides may be arrays."""
    return {
        "area": width * thickness,
        "second_moment_of_area": width * thickness * thickness * thickness / 12.0,
    }


def of_moments(area: float, second_moment_of_area: float) -> dict[str, Any]:
    """Return a section with that A [m^2] and I [m^4] and unknown sides, as values for a replacement."""
    unknown = dict.fromkeys(key.attribute for key in (*SIDES, *TAPER))
    return {"area": area, "second_moment_of_area": second_moment_of_area, **unknown}


def rectangle_of(area: float, second_moment_of_area: float) -> dict[str, float]:
    """Return width and thickness [m] of the rectangle with that A and I: sqrt(12 I / A) thick."""
    thickness = math.sqrt(12.0 * second_moment_of_area / area)
    return {"width": area / thickness, "thickness": thickness}


def refuse_both(where: str, found: Values, label: str) -> None:
    """Raise CaseError if both pairs, or parts of them, are given for one section."""
    one = [key.name for key in (*SIDES, *TAPER) if key.attribute in found]
    other = [key.name for key in (*MOMENTS, FIBRE) if key.attribute in found]
    if one and other:
        expected = f"width_m and thickness_m, or area_m2 and second_moment_m4 (with {FIBRE.name}), not both"
        raise CaseError(f"{where}: {label}.{one[0]}: got it beside {other[0]}, expected {expected}")


def refuse_tapers(where: str, strips: Iterable[Any], what: str) -> None:
    """Raise CaseError if a strip is tapered, which `what` does not support."""
    for strip in strips:
        if strip.width_end or strip.thickness_end:
            raise CaseError(f"{where}: {strip.name}: got a taper, expected a constant section for {what}")


def renamed(where: str, content: Values) -> Values:
    """Return a table with the key of the outermost fibre in place of its older name, with a warning."""
    depth = content.get(OLD_DEPTH)
    if not isinstance(depth, int | float) or isinstance(depth, bool) or FIBRE.name in content:
        return content
    _warn_of_name(where)
    return {FIBRE.name: depth / 2.0} | _without(content, [OLD_DEPTH])


@cache
def _warn_of_name(where: str) -> None:
    use = f"version 0.3 ends {OLD_DEPTH} (use: {FIBRE.name} = half of its value)"
    logging.getLogger("studies").warning("warning: %s: %s", where, use)


def inherited(shared: Values, own: Values) -> dict[str, Any]:
    """Return the values of a strip, its own before the shared ones.

    A strip's own pair of a section replaces the other pair of the shared values; its own named material
    replaces all shared values of the material.
    """
    left = dict(shared)
    for pair, other in (((*SIDES, *TAPER), MOMENTS), (MOMENTS, (*SIDES, *TAPER))):
        if any(key.attribute in own for key in pair):
            left = _without(left, [key.attribute for key in (*other, FIBRE)])
    if NAMED.attribute in own:
        left = _without(left, [key.attribute for key in keys.ELASTIC] + ["yield_strength"])
    return left | dict(own)


def _without(values: Values, names: list[str]) -> dict[str, Any]:
    """Return the values without those of these names."""
    return {name: value for name, value in values.items() if name not in names}
