"""What a sweep is, once DESIGNS.toml has been read: frozen values that go to workers as they are; and what it
may vary: the keys of a case, the settings of a model, and the slenderness of a pivot."""

import copy
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

from numpy.typing import NDArray

from studies.answers.settings import Settings, settings_of_model
from studies.cases import effects, keys
from studies.cases.design import Design, design_of
from studies.cases.document import is_mechanism, tables, values
from studies.cases.rules import Key, Rule, not_negative, number, positive, text, whole
from studies.cases.section import of_sides, rectangle_of

KINDS = ("static", "modes", "release")
#: Values of a key that varies: numbers, or other values as objects.
Column = NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class Task:
    """What every chunk of a sweep needs to know.

    Attributes:
        where: file that refusals name. case: document of the case with what is fixed by the sweep.
        model: as on the command line. settings: keywords of its settings.
        kind: of the analysis, one of `KINDS`.
        options: of modes (`rotation` [rad], `held`, `count`) or of a release (`duration` [s], ...).
        keys: that are varied. quantities: names of what is stored.
    """

    where: str
    case: dict[str, Any]
    model: str
    settings: dict[str, Any]
    kind: str
    options: dict[str, Any]
    keys: tuple[str, ...]
    quantities: tuple[str, ...]

    def design(self, values: Mapping[str, Any]) -> Design:
        """Return one design of the sweep; CaseError where a value is out of its range."""
        document = copy.deepcopy(self.case)
        put(document, values)
        return design_of(self.where, document)

    def settings_of(self, values: Mapping[str, Any]) -> Settings:
        """Return the settings of one design: those of the sweep, and those that it varies."""
        own = {key.partition(".")[2]: value for key, value in values.items() if is_setting(key)}
        return settings_of_model(self.model, **(self.settings | own))


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A sweep: the task, the values of each key that varies, in the file's units, designs a chunk, and what
    it was made from, to be kept beside it: DESIGNS.toml with its case."""

    task: Task
    columns: Mapping[str, Column]
    chunk: int
    content: dict[str, Any]

    @property
    def points(self) -> int:
        """Number of designs."""
        return len(next(iter(self.columns.values())))

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.points // self.chunk)

    def span(self, number: int) -> tuple[int, int]:
        """Return the first point of a chunk and the one behind its last."""
        return number * self.chunk, min((number + 1) * self.chunk, self.points)

    def rows(self, start: int, stop: int) -> dict[str, list[Any]]:
        """Return the designs from `start` to before `stop` as columns by key."""
        return {key: column[start:stop].tolist() for key, column in self.columns.items()}


def _dotted(rows: Iterable[Key]) -> dict[str, Key]:
    """Return keys by their section and name."""
    return {f"{key.section}.{key.name}": key for key in rows}


#: Keys of a pivot as a sweep names them.
PIVOT_KEYS = _dotted(keys.KEYS)
SETTINGS = "settings"
#: L over the thickness of a rectangular section of the case's width: sets the thickness.
SLENDERNESS = "strip.slenderness"
#: Keys of a section without known sides; a slenderness replaces them.
MOMENTS = ("strip.area_m2", "strip.second_moment_m4", "strip.outer_fibre_m")
TAPER = {f"strip.{key.name}" for key in keys.TAPER}
SECTION = (*MOMENTS, "strip.thickness_m")
#: Parts of a key that holds two numbers.
PARTS = {"x": 0, "y": 1}
#: The list of a scene's effects, as names with commas.
EFFECTS = "scene.effects"


def is_setting(key: str) -> bool:
    """Return whether a key of [vary] is of the settings, not of the case."""
    return key.startswith(f"{SETTINGS}.")


_SETTING_RULES: dict[str, Rule] = {
    "control_points": whole(4, 100),
    "axial_modes": whole(1, 100),
    "gauss_points": whole(1, 200),
    "elements": whole(1, 10_000),
    "penalty_stiffness": not_negative("EI/L^2"),
}


def _names(value: Any) -> list[str]:
    """Return the names of effects in a text with commas; ValueError unless all are known."""
    names = [name.strip() for name in text(NAMES.expected).parse(value).split(",")]
    for name in names:
        effects.require_known("effect", name)
    return names


#: What the strips and bodies of a mechanism must have, as keys go by it.
NAME = [key for key in keys.BODY if key.name == "name"]
#: A list of effects, written as names with commas.
NAMES = Rule(expected="names of effects with commas", read=_names)


def known(where: str, document: Mapping[str, Any], model: str) -> dict[str, Rule]:
    """Return the rule of every key that a sweep of the case's document with the model may vary.

    Raises CaseError where the parts of the case, whose keys go by their name or place, are no tables.
    """
    if is_mechanism(document):
        found = _of_mechanism(where, document)
    else:
        found = {name: key.rule for name, key in PIVOT_KEYS.items()} | {SLENDERNESS: positive("1")}
    found |= {name: key.rule for rows in keys.EFFECT_KEYS.values() for name, key in _dotted(rows).items()}
    for section, listed in keys.LISTS.items():
        for place, _ in enumerate(tables(where, document, section), start=1):
            rows = (key for effect in listed for key in keys.EFFECT_KEYS[effect])
            found |= {f"{section}.{place}.{key.name}": key.rule for key in rows}
    for name, rule in list(found.items()):
        if rule.kind == "pair":
            found |= {f"{name}.{part}": number("a finite number") for part in PARTS}
    settings = {
        f"{SETTINGS}.{each.name}": _SETTING_RULES.get(each.name, text("a name"))
        for each in fields(settings_of_model(model))
        if each.name != "element"
    }
    return {**found, EFFECTS: NAMES, **settings}


def _of_mechanism(where: str, document: Mapping[str, Any]) -> dict[str, Rule]:
    """Return the keys of a mechanism: `strips.NAME.key`, `bodies.NAME.key` and those of its sections."""
    shared = (*keys.SECTION, *keys.MATERIAL, *keys.DRIVE)
    found = {name: key.rule for name, key in _dotted(shared).items()}
    own = {"strips": (*keys.STRIP, *keys.OWN), "bodies": keys.BODY}
    for section, rows in own.items():
        for label, part in tables(where, document, section):
            name = values(where, NAME, {k: v for k, v in part.items() if k == "name"}, label)["name"]
            found |= {f"{section}.{name}.{key.name}": key.rule for key in rows}
    return {key: rule for key, rule in found.items() if rule.kind != "text"}


def _put(document: dict[str, Any], key: str, value: Any) -> None:
    """Set one key of a case's document in place; `value` in the file's unit.

    Parameters of effects that a list does not contain are removed.
    """
    if key == EFFECTS:
        value = NAMES.parse(value)
        tables = document.get("effects", {})
        document["effects"] = {name: table for name, table in tables.items() if name in value}
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
            named = {str(table.get("name", number)): table for number, table in enumerate(place, start=1)}
            place = named[each]
        else:
            place = place.setdefault(each, {})
    return place, name, part


def put(document: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Set the keys of one design in place, its list of effects first, a slenderness last; settings are not of
    the document."""
    for key, value in sorted(values.items(), key=lambda item: item[0] != EFFECTS):
        if key in MOMENTS:
            _to_moments(document["strip"])
        if key != SLENDERNESS and not is_setting(key):
            _put(document, key, value)
    if SLENDERNESS in values:
        strip = document["strip"]
        to_sides(strip)
        strip["thickness_m"] = strip["length_m"] / values[SLENDERNESS]


def _to_moments(section: dict[str, Any]) -> None:
    """Give a table of the document its section by area and second moment, in place of width and thickness."""
    _exchange(section, keys.SIDES, of_sides, keys.MOMENTS)


def to_sides(section: dict[str, Any]) -> None:
    """Give a table of the document its section by width and thickness, in place of area and second moment."""
    _exchange(section, keys.MOMENTS, rectangle_of, keys.SIDES)


def _exchange(
    section: dict[str, Any], given: Iterable[Key], make: Callable[..., Any], wanted: Iterable[Key]
) -> None:
    names = [key.name for key in given]
    if all(name in section for name in names):
        made = make(*(section.pop(name) for name in names))
        section |= {key.name: made[key.attribute] for key in wanted}
