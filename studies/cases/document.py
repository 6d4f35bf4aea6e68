"""Case files as documents: parsing, and refusals that name file, key, what was got and what was expected."""

import difflib
import sys
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from studies.cases.rules import Key, Rule, shown
from studies.errors import BadInput

#: Names that a line can list, and how many of a longer list it shows.
MANY, SHOWN = 40, 3
#: Former name of a command, an option, a setting or a choice -> present name; accepted until version 0.3.
FORMER: dict[str, str] = {
    "capacity": "critical-load",
    "slide_stiffness": "penalty_stiffness",
    "printed": "published",
}


class CaseError(BadInput):
    """A case file, or a value of it, that cannot be used: file, key, got, expected in one line."""


def parsed(path: str | Path) -> dict[str, Any]:
    """Return the document at `path`; CaseError if it cannot be read or is not TOML."""
    try:
        return tomllib.loads(Path(path).read_bytes().decode("utf-8-sig"))
    except OSError as error:
        said = f"cannot be read ({error.strerror})"
    except UnicodeDecodeError:
        said = "got bytes that are not UTF-8 text"
    except tomllib.TOMLDecodeError as error:
        said = f"got text that is not TOML ({error})"
    except ValueError:
        said = "got a whole number that fills pages"
    except RecursionError:
        said = "got lists or tables nested too deep"
    raise CaseError(f"{path}: {said}, expected a TOML case file")


def is_mechanism(document: Mapping[str, Any]) -> bool:
    """Return whether a case's document describes strips and bodies in tables of their own, not a pivot."""
    return isinstance(document.get("strips"), list)


def values(where: str, keys: Iterable[Key], content: Mapping[str, Any], label: str) -> dict[str, Any]:
    """Return the values of a table by the attributes that they fill, in SI units.

    An optional key that is not in the file is omitted.

    Args:
        where: file name for error messages. keys: of the table. content: the parsed table.
        label: name of the table for error messages.

    Raises:
        CaseError: an unknown key, a missing key or a value outside its rule; one line.
    """
    keys = list(keys)
    refuse_unknown(where, label, content, [key.name for key in keys])
    found = {}
    for key in keys:
        if key.name in content:
            found[key.attribute] = admitted(where, f"{label}.{key.name}", key.rule, content[key.name])
        elif not key.optional:
            raise missing(where, key, label)
    return found


def admitted(where: str, label: str, rule: Rule, given: Any) -> Any:
    """Return a value in SI; CaseError, with the label, unless its rule admits it."""
    try:
        return rule.parse(given)
    except ValueError as error:
        raise CaseError(f"{where}: {label}: {error}") from None


def missing(where: str, key: Key, label: str) -> CaseError:
    """Return the error for a table without a key that it needs."""
    return CaseError(f"{where}: {label}.{key.name}: got no such key, expected {key.rule.expected}")


def refuse_unknown(where: str, label: str, content: Mapping[str, Any], names: Sequence[str]) -> None:
    """Raise CaseError if a table has a key that is not among `names`."""
    for name in content:
        if name not in names:
            expected = nearest(name, names)
            raise CaseError(f"{where}: {label}.{name}: got an unknown key, expected {expected}")


def refuse_sections(where: str, document: Mapping[str, Any], sections: Sequence[str]) -> None:
    """Raise CaseError if the document has a section that is not among `sections`, or values outside any."""
    for section, content in document.items():
        if section in sections:
            continue
        if not isinstance(content, dict | list):
            listed = ", ".join(f"[{name}]" for name in sections)
            raise CaseError(f"{where}: {section}: got a value outside any section, expected one of {listed}")
        expected = nearest(section, sections)
        raise CaseError(f"{where}: [{section}]: got an unknown section, expected {expected}")


def table(where: str, document: Mapping[str, Any], section: str) -> Mapping[str, Any]:
    """Return the content of a section, empty if it is not there; CaseError if it is no table."""
    content = document.get(section, {})
    if not isinstance(content, dict):
        mend = f' with name = "{content}"' if section == "material" and isinstance(content, str) else ""
        got = type(content).__name__
        raise CaseError(f"{where}: {section}: got {got}, expected a table [{section}]{mend}")
    return content


def tables(
    where: str, document: Mapping[str, Any], section: str, *, needed: bool = False, within: str = ""
) -> list[tuple[str, Mapping[str, Any]]]:
    """Return the tables of an array [[section]] with their labels for error messages: name, or number.

    Without the section, the list is empty. `within`: prefix of error messages.

    Raises:
        CaseError: the section is no array of tables, or it is missing and `needed`.
    """
    found = document.get(section, [])
    if (needed and not found) or not isinstance(found, list) or not all(isinstance(e, dict) for e in found):
        expected = f"tables [[{within}{section}]]"
        raise CaseError(f"{where}: {within}{section}: got {shown(found)}, expected {expected}")
    names = (each.get("name") for each in found)
    labels = (
        within + (f"{section}.{name}" if isinstance(name, str) else f"{section} number {place}")
        for place, name in enumerate(names, start=1)
    )
    return list(zip(labels, found, strict=True))


def nearest(name: str, known: Iterable[str], *, listed: Iterable[str] = (), what: str = "name") -> str:
    """Return the known name nearest to `name` as a phrase, or all that are `listed` (default: the known
    names).

    `what`: noun for the nearest name. Of more than `MANY` names, the `SHOWN` nearest are listed.
    """
    known = list(known)
    if near := difflib.get_close_matches(name, known, n=1):
        return f"{near[0]} (the nearest {what})"
    if listed or len(known) <= MANY:
        return "one of " + ", ".join(listed or known)
    few = difflib.get_close_matches(name, known, n=SHOWN, cutoff=0.0)
    return f"{', '.join(few)} or another of {len(known)} {what}s"


def present(word: str) -> str:
    """Return a name, or `--name=value`, under its present name; a former name is accepted with a warning."""
    former, sign, value = word.partition("=")
    if former not in FORMER:
        return word
    name = FORMER[former]
    print(f"studies: warning: {former} is now called {name}; version 0.3 ends {former}", file=sys.stderr)
    return name + sign + value


def one_of(where: str, label: str, value: Any, names: Sequence[str]) -> str:
    """Return a value that is one of these names; CaseError otherwise."""
    if not isinstance(value, str) or value not in names:
        raise CaseError(f"{where}: {label}: got {shown(value)}, expected {nearest(str(value), names)}")
    return value
