"""Designs: what a case file may hold, a pivot or any mechanism of strips and bodies; read and written."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from studies.cases.document import is_mechanism, parsed
from studies.cases.effects import refuse_unknown_sides
from studies.cases.keys import BODY, DRIVE, EFFECT_KEYS, KEYS, MOMENTS, OWN, POINT, STRIP
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.cases.problem import FOLDER, Problem, read_problem
from studies.cases.rules import FREE, Key

#: Significant digits of a number that is made in the file's unit.
DIGITS = 15

Design = Problem | Mechanism


def read_design(path: str | Path, *, changes: str | None = None) -> Design:
    """Return the design in the case file at `path`.

    Args:
        path: of the file.
        changes: of its effects, "+gravity,-strip_inertia" or the whole list; None for the effects of the
            file.

    Raises:
        CaseError: the file cannot be used; one line.
    """
    return design_of(str(path), parsed(path), changes)


def design_of(where: str, document: Mapping[str, Any], changes: str | None = None) -> Design:
    """Return the design of a parsed case file, a mechanism if it has [[strips]]; CaseError as of
    `read_design`."""
    read = read_mechanism if is_mechanism(document) else read_problem
    design: Design = read(where, document, changes)
    refuse_unknown_sides(where, design.effects, design.strips)
    return design


def named_design(name: str) -> Design:
    """Return the design of that name in the suite; CaseError if there is none."""
    return read_design(FOLDER / f"{name}.toml")


def flexural_scale(design: Design) -> float:
    """Return the largest EI/L of the strips [N m], which torques and energies are compared with."""
    return max(strip.youngs_modulus * strip.second_moment_of_area / strip.length for strip in design.strips)


def fingerprint(design: Design) -> str:
    """Return the SHA-256 of a design's values, whatever the layout or comments of its file."""
    return hashlib.sha256(json.dumps(asdict(design), sort_keys=True).encode()).hexdigest()


def as_toml(document: Mapping[str, Any], remarks: Iterable[str] = ()) -> str:
    """Return the text of a case's document: tables, and arrays of tables, of numbers, texts and lists.

    Args:
        document: as a file is parsed. remarks: lines of comment to begin with.
    """
    lines = [f"# {remark}" for remark in remarks]
    for section, content in document.items():
        for table in content if isinstance(content, list) else [content]:
            nested = {name: value for name, value in table.items() if _is_nested(value)}
            if len(nested) < len(table) or not table:
                lines += ["", f"[[{section}]]" if isinstance(content, list) else f"[{section}]"]
                lines += [f"{name} = {_text(value)}" for name, value in table.items() if name not in nested]
            inner = {f"{section}.{name}": value for name, value in nested.items()}
            lines += as_toml(inner).splitlines() if inner else []
    return "\n".join(lines) + "\n"


def _is_nested(value: Any) -> bool:
    """Return whether a value of a table is a table of its own, or several."""
    several = isinstance(value, list) and bool(value)
    return all(isinstance(each, Mapping) for each in value) if several else isinstance(value, Mapping)


def document_of(design: Design) -> dict[str, Any]:
    """Return the document of a design's case, which gives the same design to the digits of a file.

    A section with known sides is described by its sides.
    """
    found: dict[str, Any] = {}
    if isinstance(design, Problem):
        for section in dict.fromkeys(key.section for key in KEYS):
            found[section] = _table([key for key in KEYS if key.section == section], design)
    else:
        found["strips"] = [{"tip": FREE} | _table((*STRIP, *OWN), strip) for strip in design.strips]
        found |= {"bodies": [_table(BODY, body) for body in design.bodies], "drive": _table(DRIVE, design)}
    found["scene"] = {"effects": list(design.effects.names)}
    found["points"] = [_table(POINT, point) for point in design.points]
    tables: dict[str, Any] = {}
    for name in design.effects.tables:
        every = [dict(_parameters(name, own)) for own in design.effects.every(name)]
        tables[name] = every if len(every) > 1 else every[0]
    return {name: own for name, own in found.items() if own} | ({"effects": tables} if tables else {})


def _table(keys: Iterable[Key], part: Any) -> dict[str, Any]:
    """Return the table of a part of a design."""
    implied = {key.attribute for key in MOMENTS} if getattr(part, "width", None) is not None else set()
    given = {key: getattr(part, key.attribute, None) for key in keys if key.attribute not in implied}
    return {key.name: _in_file(key, value) for key, value in given.items() if value is not None}


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
    if isinstance(value, str | bool):
        return json.dumps(value)
    if isinstance(value, Sequence):
        return f"[{', '.join(map(_text, value))}]"
    short = f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)
    return short if float(short) == value else repr(value)
