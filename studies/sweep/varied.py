"""What a sweep and a sizing may vary: keys of a case, the slenderness of a pivot, settings of a model."""

import copy
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any

from studies.answers.settings import settings_of_model
from studies.cases import effects, keys
from studies.cases.document import is_mechanism, tables, values
from studies.cases.rules import Key, Rule, not_negative, number, positive, text, whole
from studies.cases.section import of_sides, rectangle_of

#: Prefix of the settings of a model.
SETTINGS = "settings."
#: L over the thickness of a rectangular section of the case's width: sets the thickness.
SLENDERNESS = "strip.slenderness"
#: Keys of a section without known sides; a slenderness replaces them.
MOMENTS = ("strip.area_m2", "strip.second_moment_m4", "strip.outer_fibre_m")
#: Parts of a key that holds two numbers.
PARTS = {"x": 0, "y": 1}
#: The list of a scene's effects, as names with commas.
EFFECTS = "scene.effects"

_SETTING_RULES: dict[str, Rule] = {
    "control_points": whole(4, 100),
    "axial_modes": whole(1, 100),
    "gauss_points": whole(1, 200),
    "elements": whole(1, 10_000),
    "penalty_stiffness": not_negative("EI/L^2"),
}


def _names(value: Any) -> list[str]:
    """Return the names of effects in a text with commas; ValueError unless all are known."""
    names = [name.strip() for name in text(_NAMES.expected).parse(value).split(",")]
    for name in names:
        effects.require_known("effect", name)
    return names


_NAMES = Rule(expected="names of effects with commas", read=_names)


def settings_rules(model: str) -> dict[str, Rule]:
    """Return the rule of every setting of a model."""
    names = (each.name for each in fields(settings_of_model(model)))
    return {name: _SETTING_RULES.get(name, text("a name")) for name in names if name != "element"}


def known(where: str, document: Mapping[str, Any], model: str) -> dict[str, Rule]:
    """Return the rule of every key that a sweep of the case's document with the model may vary.

    Raises CaseError where the parts of the case, whose keys go by their name or place, are no tables.
    """
    found = {f"{table}.{key.name}": key.rule for table, key in _keys(where, document)}
    for name, rule in list(found.items()):
        if rule.kind == "pair":
            found |= {f"{name}.{part}": number("a finite number") for part in PARTS}
    if not is_mechanism(document):
        found[SLENDERNESS] = positive("1")
    settings = {f"{SETTINGS}{name}": rule for name, rule in settings_rules(model).items()}
    return {**found, EFFECTS: _NAMES, **settings}


def _keys(where: str, document: Mapping[str, Any]) -> Iterator[tuple[str, Key]]:
    """Yield table and key of all keys that a case may have, with `strips.NAME` and `loads.1` as tables."""
    kind = keys.MECHANISM if is_mechanism(document) else keys.PIVOT
    own = {"strips": (*keys.STRIP, *keys.OWN), "bodies": keys.BODY}
    shared = {section: rows for section, rows in kind.items() if section not in own}
    for section, rows in shared.items():
        yield from ((section, key) for key in rows if key.rule.kind != "text")
    for section, rows in own.items() if is_mechanism(document) else ():
        for name in _names_of(where, document, section):
            yield from ((f"{section}.{name}", key) for key in rows if key.rule.kind != "text")
    yield from ((key.section, key) for rows in keys.EFFECT_KEYS.values() for key in rows)
    for section, listed in keys.LISTS.items():
        for place, _ in enumerate(tables(where, document, section), start=1):
            yield from ((f"{section}.{place}", key) for name in listed for key in keys.EFFECT_KEYS[name])


def _names_of(where: str, document: Mapping[str, Any], section: str) -> Iterator[str]:
    """Yield the names of the strips or bodies of a case."""
    for label, part in tables(where, document, section):
        given = {key: value for key, value in part.items() if key == "name"}
        yield values(where, keys.BODY[:1], given, label)["name"]


def put(document: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Set the keys of one design in place, its list of effects first, a slenderness last; settings are not of
    the document."""
    for key, value in sorted(values.items(), key=lambda item: item[0] != EFFECTS):
        if key in MOMENTS:
            _exchange(document["strip"], keys.SIDES, keys.MOMENTS)
        if key != SLENDERNESS and not key.startswith(SETTINGS):
            _put(document, key, value)
    if SLENDERNESS in values:
        strip = document["strip"]
        to_sides(strip)
        strip["thickness_m"] = strip["length_m"] / values[SLENDERNESS]


def _put(document: dict[str, Any], key: str, value: Any) -> None:
    """Set one key of a case's document in place; `value` in the file's unit.

    Parameters of effects that a list does not contain are removed.
    """
    if key == EFFECTS:
        value = _NAMES.parse(value)
        given = document.get("effects", {})
        document["effects"] = {name: table for name, table in given.items() if name in value}
    table, name, part = _place(document, key)
    if part is not None:
        pair = list(table.get(name, (0.0, 0.0)))
        pair[part] = value
        value = pair
    table[name] = value


def value_at(document: Mapping[str, Any], key: str) -> Any:
    """Return what stands at a key of a case's document, None where there is nothing."""
    table, name, part = _place(copy.deepcopy(dict(document)), key)
    found = table.get(name)
    return found if part is None or found is None else found[part]


def _place(document: dict[str, Any], key: str) -> tuple[dict[str, Any], str, int | None]:
    """Return the table that a key stands in, of an array the one of its name or number, its name there, and
    which number of a pair it is."""
    *way, name = key.split(".")
    part = PARTS.get(name) if len(way) > 1 else None
    if part is not None:
        *way, name = way
    place: Any = document
    for each in way:
        if isinstance(place, list):
            place = {str(table.get("name", number)): table for number, table in enumerate(place, start=1)}
        place = place.setdefault(each, {})
    return place, name, part


def to_sides(section: dict[str, Any]) -> None:
    """Give a table of the document its section by width and thickness, in place of area and second moment."""
    _exchange(section, keys.MOMENTS, keys.SIDES)


def _exchange(section: dict[str, Any], given: Iterable[Key], wanted: Iterable[Key]) -> None:
    """Replace both keys of a section that are given, if they are there, by both that are wanted."""
    names = [key.name for key in given]
    if all(name in section for name in names):
        make: Any = of_sides if given is keys.SIDES else rectangle_of
        made = make(*(section.pop(name) for name in names))
        section |= {key.name: made[key.attribute] for key in wanted}
