"""A pivot as the text of a case file, from the declarations that read it."""

import json
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from studies.cases.effect_keys import KEYS as EFFECT_KEYS
from studies.cases.keys import KEYS, MOMENTS
from studies.cases.problem import Problem
from studies.cases.rules import FREE, Key, Number


def as_toml(problem: Problem, remarks: Iterable[str] = ()) -> str:
    """Return the case file of a pivot, which `read_case` reads as the same pivot.

    A section with known sides is written by these.

    Args:
        problem: what is written. remarks: lines of comment to begin with.
    """
    return "\n".join([*(f"# {remark}" for remark in remarks), *_lines(problem)]) + "\n"


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


def _text(value: Any) -> str:
    """Return a number, a text or a list as it stands in a TOML file."""
    if value is None:
        return f'"{FREE}"'
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, Sequence):
        return f"[{', '.join(map(_text, value))}]"
    return f"{value:.15g}" if isinstance(value, float) else str(value)
