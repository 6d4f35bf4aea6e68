"""Case files as text: designs that are written as one, and the tables of the page of case files, from the
declarations that read them."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from studies.cases import keys
from studies.cases.effects import DEFAULT
from studies.cases.keys import EFFECT_KEYS, KEYS, MOMENTS
from studies.cases.problem import Problem
from studies.cases.rules import FREE, Key

#: Significant digits of a number that is made in the file's unit.
DIGITS = 15


def as_toml(document: Mapping[str, Any], remarks: Iterable[str] = ()) -> str:
    """Return the text of a case's document: tables, and arrays of tables, of numbers, texts and lists.

    Args:
        document: as a file is parsed. remarks: lines of comment to begin with.
    """
    lines = [f"# {remark}" for remark in remarks]
    for section, content in document.items():
        for table in content if isinstance(content, list) else [content]:
            nested = {name: value for name, value in table.items() if isinstance(value, Mapping)}
            if len(nested) < len(table) or not table:
                lines += ["", f"[[{section}]]" if isinstance(content, list) else f"[{section}]"]
                lines += [f"{name} = {_text(value)}" for name, value in table.items() if name not in nested]
            for name, inner in nested.items():
                lines += ["", f"[{section}.{name}]"]
                lines += [f"{key} = {_text(each)}" for key, each in inner.items()]
    return "\n".join(lines) + "\n"


def document_of(problem: Problem) -> dict[str, dict[str, Any]]:
    """Return the document of a pivot's case, which is read as the same pivot to the digits that a file has.

    A section with known sides has these.
    """
    implied = {key.attribute for key in MOMENTS} if problem.width is not None else set()
    given = {key: getattr(problem, key.attribute, None) for key in KEYS if key.attribute not in implied}
    found: dict[str, dict[str, Any]] = {}
    for key, value in given.items():
        if value is not None:
            found.setdefault(key.section, {})[key.name] = _in_file(key, value)
    found["scene"] = {"effects": problem.effects.names}
    tables = {name: dict(_parameters(name, own)) for name, own in problem.effects.tables.items()}
    return found | ({"effects": tables} if tables else {})


def _parameters(effect: str, values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield key and value of an effect's parameters; those of one that was added to the splines' as they
    are."""
    known = {key.attribute: key for key in EFFECT_KEYS.get(effect, ())}
    for attribute, value in values.items():
        key = known.get(attribute)
        yield (attribute, value) if key is None else (key.name, _in_file(key, value))


def _in_file(key: Key, value: Any) -> Any:
    """Return the value of a key in the file's unit, to the digits that survive the way back."""
    return float(f"{key.rule.in_file(value):.{DIGITS}g}") if key.rule.kind == "number" else value


def _text(value: Any) -> str:
    """Return a number, a text or a list as it stands in a TOML file."""
    if value is None:
        return f'"{FREE}"'
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Sequence):
        return f"[{', '.join(map(_text, value))}]"
    short = f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)
    return short if float(short) == value else repr(value)


#: Tables of a pivot's file, and of a mechanism's, in the order of a file, with their keys.
PIVOT: dict[str, tuple[Key, ...]] = {
    f"[{section}]": tuple(key for key in keys.KEYS if key.section == section)
    for section in dict.fromkeys(key.section for key in keys.KEYS)
}
MECHANISM: dict[str, tuple[Key, ...]] = {
    "[[strips]]": keys.STRIP,
    "[[bodies]]": keys.BODY,
    "[section]": keys.SECTION,
    "[material]": keys.MATERIAL,
    "[drive]": keys.DRIVE,
}


def _mechanism() -> Iterator[str]:
    """Yield the tables of a mechanism's keys."""
    yield from _tables(MECHANISM)
    own = ", ".join(f"`{key.name}`" for key in keys.OWN)
    yield ""
    yield f"A strip may also have, in place of what `[section]` and `[material]` say of all: {own}."


def _effects() -> Iterator[str]:
    """Yield the table of effects, and that of the keys of their parameters."""
    yield "| effect | what it is | in a scene |"
    yield "|---|---|---|"
    for name, meaning in keys.EFFECTS.items():
        yield f"| `{name}` | {meaning} | {'unless taken out' if name in DEFAULT else 'where it is named'} |"
    yield ""
    yield from _tables({f"[effects.{name}]": rows for name, rows in keys.EFFECT_KEYS.items() if rows})


def _materials() -> Iterator[str]:
    """Yield the table of materials."""
    yield "| name | E [GPa] | Poisson's ratio [1] | density [kg/m^3] | yield strength [MPa] | what, source |"
    yield "|---|---:|---:|---:|---:|---|"
    for name, given in keys.MATERIALS.items():
        strength = "none" if given.yield_strength is None else f"{given.yield_strength / 1e6:g}"
        numbers = f"{given.youngs_modulus / 1e9:g} | {given.poisson_ratio:g} | {given.density:g} | {strength}"
        said = f"{given.title}. {given.source}. Found again: {given.checked}"
        yield f"| `{name}` | {numbers} | {said} |"


#: Tables of the page of case files, by the names of their places.
PAGE: dict[str, Callable[[], Iterator[str]]] = {
    "keys of a pivot": lambda: _tables(PIVOT),
    "keys of a mechanism": _mechanism,
    "effects": _effects,
    "materials": _materials,
}


def _tables(tables: dict[str, tuple[Key, ...]]) -> Iterator[str]:
    """Yield a heading and a table of keys for each table of a file."""
    for place, (title, rows) in enumerate(tables.items()):
        if place:
            yield ""
        yield f"`{title}`"
        yield ""
        yield from _rows(rows)


def _rows(rows: Iterable[Key]) -> Iterator[str]:
    yield "| key | unit | rule | where it is left out | meaning |"
    yield "|---|---|---|---|---|"
    for key in rows:
        default = key.default if key.optional else "refused"
        yield f"| `{key.name}` | {key.unit or '-'} | {key.admitted} | {default} | {key.meaning} |"
