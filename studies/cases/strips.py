"""What a strip of a case is made of: its section from one pair of keys, its material from a name or keys."""

from collections.abc import Mapping
from typing import Any

from studies.cases.document import CaseError
from studies.cases.keys import ELASTIC, MOMENTS, NAMED, SECTION, SIDES
from studies.cases.materials import MATERIALS

Values = Mapping[str, Any]


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
        values = MATERIALS[named].values() | values
    pair = SIDES if any(key.attribute in values for key in SIDES) else MOMENTS
    if not any(key.attribute in values for key in SECTION):
        expected = "width_m and thickness_m, or area_m2 and second_moment_m4"
        missing = " there nor in [section]" if shared else ""
        raise CaseError(f"{where}: {section}.width_m: got no such key{missing}, expected {expected}")
    for key, label in (*((key, section) for key in pair), *((key, material) for key in ELASTIC)):
        if key.attribute not in values:
            named_one = " or the name of a material" if key in ELASTIC and named is None else ""
            missing = f" there nor in [{key.section}]" if shared else ""
            expected = f"{key.rule.expected}{named_one}"
            raise CaseError(f"{where}: {label}.{key.name}: got no such key{missing}, expected {expected}")
    if pair is SIDES:
        values |= of_sides(values["width"], values["thickness"])
    return values


def of_sides(width: Any, thickness: Any) -> dict[str, Any]:
    """Return area b h [m^2] and second moment b h^3 / 12 [m^4] of a rectangle; sides may be arrays."""
    return {"area": width * thickness, "second_moment_of_area": width * thickness**3 / 12.0}


def refuse_both(where: str, found: Values, label: str) -> None:
    """Raise CaseError if both pairs, or parts of them, are given for one section."""
    one = [key.name for key in SIDES if key.attribute in found]
    other = [key.name for key in MOMENTS if key.attribute in found]
    if one and other:
        expected = "width_m and thickness_m, or area_m2 and second_moment_m4, not both"
        raise CaseError(f"{where}: {label}.{one[0]}: got it beside {other[0]}, expected {expected}")


def inherited(shared: Values, own: Values) -> dict[str, Any]:
    """Return what a strip has of its own and of what all have.

    A strip's own pair of a section takes the place of the other pair that all have, and its own named
    material that of all values of theirs.
    """
    left = dict(shared)
    for pair, other in ((SIDES, MOMENTS), (MOMENTS, SIDES)):
        if any(key.attribute in own for key in pair):
            left = without(left, [key.attribute for key in other])
    if NAMED.attribute in own:
        left = without(left, [key.attribute for key in ELASTIC] + ["yield_strength"])
    return left | dict(own)


def without(values: Values, names: list[str]) -> dict[str, Any]:
    """Return the values but for those of these names."""
    return {name: value for name, value in values.items() if name not in names}
