"""Facts, sentences that hold, and tables: what the text may quote, and where each of them comes from.

The modules of `report.content` enter them here by name: numbers with `facts`, conditions and tables as
functions of the results under `holds` and `listing`.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import pandas as pd

from report.forms import Form, text
from report.results import ReportError, Results, column, where

Entry = TypeVar("Entry")


@dataclass(frozen=True, kw_only=True)
class Fact:
    """A number of the text.

    Attributes:
        made: the value from all results; LookupError when a table does not have what it is made of.
        form: how it is written. source: where the value comes from, for messages.
    """

    made: Callable[[Results], Any]
    form: Form
    source: str = "several tables"


@dataclass(frozen=True, kw_only=True)
class Holds:
    """A condition that a sentence of the report rests on.

    Attributes:
        words: what must be true, for the message when it is not.
        test: whether it is true.
        timed: whether it rests on measured seconds. Its sentence is then replaced by what was not so in the
            run that the tables are of, where others are no longer printed at all: a machine may be busy.
    """

    words: str
    test: Callable[[Results], Any]
    timed: bool = False


#: One cell of a table: text, or text with a colour beside it.
Cell = str | dict[str, str]
Rows = list[Sequence[Cell]]
#: A table of the report: its heading and rows of cells, one for each part of the heading.
Table = tuple[list[str], Rows]
#: Heading -> the column below it and how its values are written, or the cell made of a whole row.
Shown = dict[str, tuple[str, Callable[[Any], Cell]] | Callable[[Any], Cell]]
Listing = Callable[[Results], Table]

#: What the text may quote, by name.
FACTS: dict[str, Fact] = {}
HOLDS: dict[str, Holds] = {}
LISTINGS: dict[str, Listing] = {}


def _enter(entries: dict[str, Entry], name: str, entry: Entry) -> None:
    if name in entries:
        raise ReportError(f"report.content: got {name} twice, expected one of a name")
    entries[name] = entry


def facts(given: Mapping[str, Fact]) -> None:
    """Enter facts by name."""
    for name, fact in given.items():
        _enter(FACTS, name, fact)


def holds(name: str, *, timed: bool = False) -> Callable[[Callable[[Results], Any]], None]:
    """Enter a condition: a function of the results whose docstring says what must be true."""

    def enter(test: Callable[[Results], Any]) -> None:
        _enter(HOLDS, name, Holds(words=" ".join((test.__doc__ or name).split()), test=test, timed=timed))

    return enter


def listing(name: str) -> Callable[[Listing], None]:
    """Enter a table: a function of the results."""
    return lambda made: _enter(LISTINGS, name, made)


class Stored:
    """Rows of a stored table, those with the values `equal`; methods narrow them further."""

    def __init__(self, study: str, table: str, /, **equal: Any) -> None:
        self._study, self._table, self._equal = study, table, equal

    def where(self, /, **equal: Any) -> "Stored":
        """Return those of the rows that have the values `equal` too."""
        return Stored(self._study, self._table, **self._equal, **equal)

    def rows(self, results: Results, /, **equal: Any) -> pd.DataFrame:
        """Return the rows; LookupError when there are none."""
        return where(results.table(self._study, self._table), **self._equal, **equal)

    def value(self, results: Results, name: str, /, **equal: Any) -> Any:
        """Return the value of a column in the one row that there is; LookupError when there are more."""
        return _only(name, equal)(self.rows(results, **equal))

    def fact(self, pick: Callable[[pd.DataFrame], Any], form: Form, /, **equal: Any) -> Fact:
        """Return a fact that `pick` makes of the rows."""
        source = f"{self._study}/{self._table}"
        return Fact(made=lambda results: pick(self.rows(results, **equal)), form=form, source=source)

    def at(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the value of a column in the one row that there is."""
        return self.fact(_only(name, equal), form, **equal)

    def largest(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the largest magnitude of a column."""
        return self.fact(lambda rows: column(rows, name).abs().max(), form, **equal)

    def least(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the smallest magnitude of a column."""
        return self.fact(lambda rows: column(rows, name).abs().min(), form, **equal)


def _only(name: str, equal: Mapping[str, Any]) -> Callable[[pd.DataFrame], Any]:
    def pick(rows: pd.DataFrame) -> Any:
        if len(rows) != 1:
            raise LookupError(f"{len(rows)} rows with {equal}, expected one")
        return column(rows, name).iloc[0]

    return pick


def columns(rows: pd.DataFrame, shown: Shown) -> Table:
    """Return a table with a row for each of `rows`."""
    cells: Rows = [
        [made(row) if callable(made) else made[1](row[made[0]]) for made in shown.values()]
        for row in rows.to_dict("records")
    ]
    return list(shown), cells


def unmet(results: Results, tables: Iterable[tuple[str, str]], form: Form, measured: str) -> Table:
    """Return the findings that do not hold, of (study, table) each, or that there are none."""
    found = pd.concat([results.table(*each).query("holds == 'no'") for each in tables])
    words: Shown = {"claim that does not hold": ("claim", text), "for": ("formulation", text)}
    head, rows = columns(found, {**words, measured: ("value", form)})
    return head, rows or [["none", "–", "–"]]


def written(name: str, given: Fact, results: Results) -> str:
    """Return the text of a fact.

    Raises:
        ReportError: the value is not there, or not a finite number.
    """
    try:
        value = given.made(results)
        if not isinstance(value, str) and not math.isfinite(float(value)):
            raise ValueError(f"{value} is no number to write")
        return given.form(value)
    except (LookupError, TypeError, ValueError) as error:
        if isinstance(error, ReportError):
            raise
        raise ReportError(f"fact {name}: {error} ({given.source})") from None


def held(name: str, condition: Holds, results: Results) -> dict[str, Any]:
    """Return whether a condition holds, with its words.

    Raises:
        ReportError: the results do not have what it asks for.
    """
    try:
        answer = bool(condition.test(results))
    except (LookupError, TypeError) as error:
        raise ReportError(f"condition {name}: {error} ({condition.words})") from None
    return {"holds": answer, "words": condition.words, "timed": condition.timed}


def listed(name: str, made: Listing, results: Results) -> dict[str, Any]:
    """Return a table as heading and rows.

    Raises:
        ReportError: a row of another length than the heading, no row, or something that is not there.
    """
    try:
        head, rows = made(results)
    except (LookupError, TypeError) as error:
        raise ReportError(f"table {name}: {error}") from None
    if not rows or any(len(row) != len(head) for row in rows):
        raise ReportError(f"table {name}: got no rows, or rows of another length than {len(head)}")
    return {"head": head, "rows": rows}
