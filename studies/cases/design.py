"""Case files of designs, read and written: of a pivot by its short form, or of any mechanism."""

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, fields, replace
from pathlib import Path
from typing import Any

from studies.cases import keys
from studies.cases.document import (
    CaseError,
    is_mechanism,
    nearest,
    parsed,
    refuse_sections,
    table,
    tables,
    values,
)
from studies.cases.effects import Effects, read_effects
from studies.cases.keys import EFFECT_KEYS, GROUND, MOMENTS
from studies.cases.mechanism import Body, Mechanism, Point, Problem, Strip
from studies.cases.rules import FREE, Key
from studies.cases.section import completed, inherited, refuse_both, renamed
from studies.errors import BadInput

#: Where the cases of the suite are, and their names.
FOLDER = Path(__file__).parent
SHIPPED = sorted(path.stem for path in FOLDER.glob("*.toml"))
#: Significant digits of a number that is made in the file's unit.
DIGITS = 15

Design = Mechanism


def case_file(name: str, folder: Path = Path()) -> str:
    """Return the file of a case: a path from `folder`, or one of the suite by its name.

    Raises:
        BadInput: neither; what was got and expected.
    """
    path, shipped = folder / name, name in SHIPPED
    if name.endswith(".toml") or path.is_file() or (path.exists() and not shipped):
        return str(path)
    if shipped:
        return str(FOLDER / f"{name}.toml")
    own = f"{name}.toml"
    expected = f"{nearest(name, SHIPPED)}, or a file that ends in .toml"
    raise BadInput(f"got {name}, expected {own if (folder / own).is_file() else expected}")


def read_design(path: str | Path, *, changes: str | None = None) -> Design:
    """Return the design in the case file at `path`.

    Args:
        path: of the file.
        changes: of its effects, "+gravity,-strip_inertia" or the whole list; None for the effects of the
            file.

    Raises:
        CaseError: the file is unreadable or not TOML, a section or key is missing, unknown or misspelt, a
            value has the wrong type or is outside its range, a name comes twice or stands for nothing. One
            line: file, key, got, expected.
    """
    return design_of(str(path), parsed(path), changes)


def design_of(where: str, document: Mapping[str, Any], changes: str | None = None) -> Design:
    """Return the design of a parsed case file, a mechanism if it has [[strips]]; CaseError as of
    `read_design`."""
    effects = read_effects(where, document, changes)
    found: Design = (_mechanism if is_mechanism(document) else _pivot)(where, document, effects)
    if points := _points(where, document, [body.name for body in found.bodies]):
        found = replace(found, points=points)
    return found.checked(where)


def _pivot(where: str, document: Mapping[str, Any], effects: Effects) -> Problem:
    """Return the pivot of a case file with its effects, without points."""
    refuse_sections(where, document, [*keys.PIVOT, *keys.ANY])
    found: dict[str, Any] = {}
    for section, own in keys.PIVOT.items():
        if section not in document:
            needed = ", ".join(key.name for key in [key for key in own if not key.optional] or own)
            raise CaseError(f"{where}: [{section}]: got no such section, expected one with {needed}")
        found |= values(where, own, renamed(where, table(where, document, section)), section)
    return Problem(**completed(where, found, "strip", "material"), effects=effects)


def _mechanism(where: str, document: Mapping[str, Any], effects: Effects) -> Mechanism:
    """Return the mechanism of a case file with its effects, without points."""
    refuse_sections(where, document, [*keys.MECHANISM, *keys.ANY])
    shared = {
        **values(where, keys.SECTION, renamed(where, table(where, document, "section")), "section"),
        **values(where, keys.MATERIAL, table(where, document, "material"), "material"),
    }
    refuse_both(where, shared, "section")
    given = tables(where, document, "bodies")
    bodies = tuple(Body(**values(where, keys.BODY, own, label)) for label, own in given)
    given = tables(where, document, "strips", needed=True)
    strips = tuple(_strip(where, own, label, shared) for label, own in given)
    names = [body.name for body in bodies]
    _refuse_twice(where, [*names, *(strip.name for strip in strips)])
    for strip in strips:
        for key, place in (("root", strip.root), ("tip", strip.tip)):
            if place is not None and place not in (GROUND, *names):
                expected = nearest(place, [GROUND, *([FREE] if key == "tip" else []), *names])
                raise CaseError(f"{where}: strips.{strip.name}.{key}: got {place}, expected {expected}")
    if "drive" not in document:
        raise CaseError(f"{where}: [drive]: got no such section, expected one with increments")
    drive = {"rotation": None} | values(where, keys.DRIVE, table(where, document, "drive"), "drive")
    drive["body"] = _body_of(where, "drive.body", drive.get("body"), names)
    return Mechanism(strips=strips, bodies=bodies, **drive, effects=effects)


def _strip(where: str, given: Mapping[str, Any], label: str, shared: Mapping[str, Any]) -> Strip:
    """Return one strip, its section and material its own or those of all."""
    own = values(where, [*keys.STRIP, *keys.OWN], renamed(where, given), label)
    refuse_both(where, own, label)
    found = completed(where, inherited(shared, own), label, label, shared=True)
    if found["start"] == found["end"]:
        got = f"{where}: {label}.end_m: got {list(found['end'])}"
        raise CaseError(f"{got}, where it begins, expected a length")
    return Strip(**found)


def _points(where: str, document: Mapping[str, Any], bodies: Sequence[str]) -> tuple[Point, ...]:
    """Return the points of [[points]], each of one of the bodies."""
    found = []
    for label, given in tables(where, document, "points"):
        own = values(where, keys.POINT, given, label)
        found.append(Point(**own | {"body": _body_of(where, f"{label}.body", own.get("body"), bodies)}))
    _refuse_twice(where, [point.name for point in found])
    return tuple(found)


def _refuse_twice(where: str, names: Sequence[str]) -> None:
    for place, name in enumerate(names):
        if name in (GROUND, FREE) or name in names[:place]:
            expected = f"different names, none of them {GROUND} or {FREE}"
            raise CaseError(f"{where}: name: got {name}, expected {expected}")


def _body_of(where: str, label: str, body: str | None, names: Sequence[str]) -> str | None:
    """Return the body that is meant: the one named, or the only one."""
    if body is None and len(names) <= 1:
        return names[0] if names else None
    if body not in names:
        got = "no such key" if body is None else body
        expected = nearest(body or "", names) if names else "none, as there are no bodies"
        raise CaseError(f"{where}: {label}: got {got}, expected {expected}")
    return body


def named_design(name: str) -> Design:
    """Return the design of that name in the suite; CaseError if there is none."""
    return read_design(FOLDER / f"{name}.toml")


def flexural_scale(design: Design) -> float:
    """Return the largest EI/L of the strips [N m], which torques and energies are compared with."""
    return max(strip.youngs_modulus * strip.second_moment_of_area / strip.length for strip in design.strips)


def fingerprint(design: Design) -> str:
    """Return the SHA-256 of a design's values, whatever the layout or comments of its file."""
    given = {each.name for each in fields(design) if each.init}
    values = {name: value for name, value in asdict(design).items() if name in given}
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()


def as_toml(document: Mapping[str, Any], remarks: Iterable[str] = ()) -> str:
    """Return the text of a case's document: tables, and arrays of tables, of numbers, texts and lists.

    Args:
        document: as a file is parsed. remarks: lines of comment to begin with.
    """
    lines = [f"# {remark}" for remark in remarks]
    for section, content in document.items():
        for own in content if isinstance(content, list) else [content]:
            nested = {name: value for name, value in own.items() if _is_nested(value)}
            if len(nested) < len(own) or not own:
                lines += ["", f"[[{section}]]" if isinstance(content, list) else f"[{section}]"]
                lines += [f"{name} = {_text(value)}" for name, value in own.items() if name not in nested]
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
    found: dict[str, Any] = {
        name: [_table(rows, each) for each in part] if isinstance(part, tuple) else _table(rows, part)
        for name, (rows, part) in design.tables.items()
    }
    found["scene"] = {"effects": list(design.effects.names)}
    found["points"] = [_table(keys.POINT, point) for point in design.points]
    written = design.effects.each(lambda name, own: dict(_parameters(name, own))).tables
    found["effects"] = {n: list(own) if isinstance(own, tuple) else own for n, own in written.items()}
    return {name: own for name, own in found.items() if own}


def _table(rows: Iterable[Key], part: Any) -> dict[str, Any]:
    """Return the table of a part of a design."""
    implied = {key.attribute for key in MOMENTS} if getattr(part, "width", None) is not None else set()
    given = [key for key in rows if key.attribute not in implied]
    found = {key.name: _in_file(key, getattr(part, key.attribute, None)) for key in given}
    return {name: value for name, value in found.items() if value is not None}


def _parameters(effect: str, values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield key and value of an effect's parameters; those of one that was added to the splines' as they
    are."""
    known = {key.attribute: key for key in EFFECT_KEYS.get(effect, ())}
    for attribute, value in values.items():
        key = known.get(attribute)
        yield (attribute, value) if key is None else (key.name, _in_file(key, value))


def _in_file(key: Key, value: Any) -> Any:
    """Return the value of a key in the file's unit, to the digits that survive the way back."""
    found = key.rule.in_file(value)
    return found if key.rule.kind != "number" or found is None else float(f"{found:.{DIGITS}g}")


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
