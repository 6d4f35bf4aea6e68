"""Designs as the text of case files: a pivot by the declarations that read it, any case by its document."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from studies.cases.keys import EFFECT_KEYS, KEYS, MOMENTS
from studies.cases.problem import Problem
from studies.cases.rules import FREE, Key, Number


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
