"""Case files as text: designs that are written as one, commented files to begin with, and the tables of the
page of case files; all from the declarations that read them."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from studies.cases import keys
from studies.cases.effects import DEFAULT
from studies.cases.keys import EFFECT_KEYS, KEYS, MOMENTS
from studies.cases.problem import Problem
from studies.cases.rules import FREE, Choice, Key, Number


def as_toml(problem: Problem, remarks: Iterable[str] = ()) -> str:
    """Return the case file of a pivot, which `read_case` reads as the same pivot.

    A section with known sides is written by these.

    Args:
        problem: what is written. remarks: lines of comment to begin with.
    """
    return "\n".join([*(f"# {remark}" for remark in remarks), *_lines(problem)]) + "\n"


def document_toml(document: Mapping[str, Any], remarks: Iterable[str] = ()) -> str:
    """Return the text of a case's document: tables, and arrays of tables, of numbers, texts and lists.

    Args:
        document: as it was parsed. remarks: lines of comment to begin with.
    """
    lines = [f"# {remark}" for remark in remarks]
    for section, content in document.items():
        for table in content if isinstance(content, list) else [content]:
            nested = {name: value for name, value in table.items() if isinstance(value, Mapping)}
            if len(nested) < len(table) or not table:
                lines += ["", f"[[{section}]]" if isinstance(content, list) else f"[{section}]"]
                lines += [
                    f"{name} = {_text(value, repr)}" for name, value in table.items() if name not in nested
                ]
            for name, inner in nested.items():
                lines += ["", f"[{section}.{name}]"]
                lines += [f"{key} = {_text(each, repr)}" for key, each in inner.items()]
    return "\n".join(lines) + "\n"


def _lines(problem: Problem) -> Iterator[str]:
    implied = {key.attribute for key in MOMENTS} if problem.width is not None else set()
    section = ""
    for key in KEYS:
        value = getattr(problem, key.attribute, None)
        if value is None or key.attribute in implied:
            continue
        if key.section != section:
            section = key.section
            yield from ("", f"[{section}]")
        yield f"{key.name} = {_in_file(key, value)}"
    yield from ("", "[scene]", f"effects = {_text(problem.effects.names)}")
    for name, values in problem.effects.tables.items():
        known = {key.attribute: key for key in EFFECT_KEYS.get(name, ())}
        yield from ("", f"[effects.{name}]")
        for attribute, value in values.items():
            if attribute in known:
                yield f"{known[attribute].name} = {_in_file(known[attribute], value)}"
            else:  # of an effect that was added to the splines'
                yield f"{attribute} = {_text(value)}"


def _in_file(key: Key, value: Any) -> str:
    """Return the value of a key in the file's unit."""
    return _text(key.rule.from_si(value) if isinstance(key.rule, Number) else value)


def _text(value: Any, number: Callable[[float], str] = "{:.15g}".format) -> str:
    """Return a number, a text or a list as it stands in a TOML file."""
    if value is None:
        return f'"{FREE}"'
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Sequence):
        return f"[{', '.join(_text(each, number) for each in value)}]"
    return number(value) if isinstance(value, float) else str(value)


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


#: Keys that may be left out and yet are shown in use: a section by its sides, a material by its name.
SHOWN = {keys.NAMED.name, *(key.name for key in keys.SIDES), "rotation_deg", "centre_offset_m"}
#: The effect that the template of a mechanism names beside the usual ones.
NAMES = "gravity"
#: Where the comments begin.
COLUMN = 36


def template(*, mechanism: bool) -> Iterator[str]:
    """Yield the lines of a case file to begin with, which can be solved as it is: of a pivot, or of a
    mechanism of one strip with a body at its end."""
    if mechanism:
        yield "# A mechanism of strips and bodies: as many [[strips]] and [[bodies]] as it has."
        yield "# Lines that begin with # may be taken out or put into use."
    else:
        yield "# A cross-axis flexural pivot. Lines that begin with # may be taken out or put into use."
    for title, rows in (MECHANISM if mechanism else PIVOT).items():
        yield ""
        yield title
        yield from _template_lines(rows)
    yield from _scene([NAMES] if mechanism else [])


def _template_lines(rows: Iterable[Key], prefix: str = "") -> Iterator[str]:
    """Yield a line for each key, with what it is; those that may be left out are comments."""
    for key in rows:
        used = not key.optional or key.name in SHOWN
        begin = f"{prefix if used else '# '}{key.name} = {key.example}"
        unit = f" [{key.unit}]" if key.unit not in ("", "1") else ""
        choice = f": {key.admitted}" if isinstance(key.rule, Choice) else ""
        default = "" if used else f"; left out: {key.default}"
        yield f"{begin:<{COLUMN}} # {key.meaning}{unit}{choice}{default}"


def _scene(named: list[str]) -> Iterator[str]:
    """Yield the scene, and the tables of all effects, those that are not named as comments."""
    yield ""
    yield f"# What acts: {', '.join(DEFAULT)} unless said otherwise, + adds to them."
    yield "[scene]"
    words = ", ".join(f'"+{name}"' for name in named or [NAMES])
    yield f"{'' if named else '# '}effects = [{words}]"
    for name, rows in keys.EFFECT_KEYS.items():
        if name in DEFAULT or (not rows and name not in named):
            continue
        mark = "" if name in named else "# "
        yield ""
        yield f"# {name}: {keys.EFFECTS[name]}"
        yield f"{mark}[effects.{name}]"
        yield from _template_lines(rows, mark)
