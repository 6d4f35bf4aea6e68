"""The keys that a sweep may vary: all of a case, the settings of a model, and the slenderness of a pivot."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from studies.answers.settings import FeSettings, SplineSettings
from studies.cases import effect_keys, effects, keys
from studies.cases.rules import Number, Pair, Rule, Text, Whole, not_negative, positive, shown

SETTINGS = "settings"
MODELS: dict[str, type[SplineSettings] | type[FeSettings]] = {
    "spline": SplineSettings,
    "fe": FeSettings,
    "fe-shear": FeSettings,
}
#: L over the thickness of a rectangular section of the case's width: sets the thickness, or area and second
#: moment where the case gives these.
SLENDERNESS = "strip.slenderness"
#: What it takes the place of.
SECTION = ("strip.area_m2", "strip.second_moment_m4", "strip.thickness_m", "strip.section_depth_m")
#: Parts of a key that holds two numbers.
PARTS = {"x": 0, "y": 1}
#: The list of a scene's effects, as names with commas.
EFFECTS = "scene.effects"

_SETTING_RULES: dict[str, Rule] = {
    "control_points": Whole(expected="a whole number from 4 to 100", low=4, high=100),
    "axial_modes": Whole(expected="a whole number from 1 to 100", low=1, high=100),
    "gauss_points": Whole(expected="a whole number from 1 to 200", low=1, high=200),
    "elements": Whole(expected="a whole number from 1 to 10000", low=1, high=10_000),
    "slide_stiffness": not_negative("EI/L^2"),
}


@dataclass(frozen=True, kw_only=True)
class Names:
    """A list of effects, written as names with commas."""

    expected: str = "names of effects with commas"

    def parse(self, value: Any) -> list[str]:
        """Return the names; ValueError unless `value` is a text of known effects."""
        if not isinstance(value, str) or not value:
            raise ValueError(f"got {shown(value)}, expected {self.expected}")
        names = [name.strip() for name in value.split(",")]
        for name in names:
            effects.require_known("effect", name)
        return names


def known(document: Mapping[str, Any], model: str) -> dict[str, Rule | Names]:
    """Return the rule of every key that a sweep of the case's document with the model may vary."""
    if isinstance(document.get("strips"), list):
        found = _of_mechanism(document)
    else:
        found = {f"{key.section}.{key.name}": key.rule for key in keys.KEYS}
        found[SLENDERNESS] = positive("1")
    for rows in effect_keys.KEYS.values():
        found |= {f"{key.section}.{key.name}": key.rule for key in rows}
    for name, rule in list(found.items()):
        if isinstance(rule, Pair):
            found |= {f"{name}.{part}": Number(expected="a finite number") for part in PARTS}
    settings = {
        f"{SETTINGS}.{each.name}": _SETTING_RULES.get(each.name, Text(expected="a name"))
        for each in fields(MODELS[model])
        if each.name != "element"
    }
    return {**found, EFFECTS: Names(), **settings}


def _of_mechanism(document: Mapping[str, Any]) -> dict[str, Rule]:
    """Return the keys of a mechanism: `strips.NAME.key`, `bodies.NAME.key` and those of its sections."""
    shared = (*keys.SECTION, *keys.MATERIAL, *keys.DRIVE)
    found = {f"{key.section}.{key.name}": key.rule for key in shared}
    own = {"strips": (*keys.STRIP, *keys.OWN), "bodies": keys.BODY}
    for section, rows in own.items():
        for part in document.get(section, []):
            found |= {f"{section}.{part['name']}.{key.name}": key.rule for key in rows}
    return {key: rule for key, rule in found.items() if not isinstance(rule, Text)}


def put(document: dict[str, Any], key: str, value: Any) -> None:
    """Set one key of a case's document in place; `value` in the file's unit.

    Of effects that a list of effects leaves out the parameters go with them.
    """
    if key == EFFECTS:
        value = Names().parse(value)
        tables = document.get("effects", {})
        document["effects"] = {name: table for name, table in tables.items() if name in value}
    *way, last = key.split(".")
    if last in PARTS and len(way) > 1:
        *way, pair = way
        place = _at(document, way)
        values = list(place.get(pair, (0.0, 0.0)))
        values[PARTS[last]] = value
        place[pair] = values
        return
    _at(document, way)[last] = value


def _at(document: dict[str, Any], way: list[str]) -> dict[str, Any]:
    """Return the table that the names lead to; of an array the one of that name."""
    place: Any = document
    for name in way:
        if isinstance(place, list):
            place = next(part for part in place if part.get("name") == name)
        else:
            place = place.setdefault(name, {})
    found: dict[str, Any] = place
    return found


def put_all(document: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Set the keys of one design in place, its list of effects first, a slenderness last; settings are not of
    the document."""
    for key, value in sorted(values.items(), key=lambda item: item[0] != EFFECTS):
        if key != SLENDERNESS and not key.startswith(f"{SETTINGS}."):
            put(document, key, value)
    if SLENDERNESS in values:
        strip = document["strip"]
        if "width_m" in strip:
            strip["thickness_m"] = strip["length_m"] / values[SLENDERNESS]
            return
        area, second = of_slenderness(
            values[SLENDERNESS], strip["length_m"], strip["area_m2"], strip["second_moment_m4"]
        )
        strip.update(area_m2=area, second_moment_m4=second)


def of_slenderness(slenderness: Any, length: Any, area: float, second: float) -> tuple[Any, Any]:
    """Return area [m^2] and second moment [m^4] of a rectangle of depth L / slenderness.

    Its width is that of the rectangle with the case's area and second moment; arguments may be arrays.
    """
    width = area / math.sqrt(12.0 * second / area)
    depth = length / slenderness
    return width * depth, width * depth**3 / 12.0
