"""Facts, sentences that hold, and tables: what the text may quote, and where each of them comes from."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

from report.forms import Form, text
from report.results import Pick, ReportError, Results


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


Rows = list[list[Cell]]
#: A table of the report: its heading and rows of cells, one for each part of the heading.
Table = tuple[list[str], Rows]
#: Heading -> the column below it, and how its values are written.
Shown = dict[str, tuple[str, Form]]


def fact(study: str, table: str, pick: Pick, form: Form) -> Fact:
    """Return a fact from one table."""
    return Fact(made=lambda results: pick(results.table(study, table)), form=form, source=f"{study}/{table}")


def columns(rows: pd.DataFrame, shown: Shown) -> Table:
    """Return a table with a row for each of `rows`."""
    cells = ([form(row[name]) for name, form in shown.values()] for row in rows.to_dict("records"))
    return list(shown), [list(each) for each in cells]


def unmet(results: Results, tables: Iterable[tuple[str, str]], form: Form, measured: str) -> Table:
    """Return the findings that do not hold, of (study, table) each, or that there are none."""
    found = pd.concat([results.table(*each).query("holds == 'no'") for each in tables])
    shown = {
        "claim that does not hold": ("claim", text),
        "for": ("formulation", text),
        measured: ("value", form),
    }
    head, rows = columns(found, {**shown, measured: ("value", form)})
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


def listed(name: str, listing: Callable[[Results], Table], results: Results) -> Mapping[str, Any]:
    """Return a table as heading and rows.

    Raises:
        ReportError: a row of another length than the heading, no row, or something that is not there.
    """
    try:
        head, rows = listing(results)
    except (LookupError, TypeError) as error:
        raise ReportError(f"table {name}: {error}") from None
    if not rows or any(len(row) != len(head) for row in rows):
        raise ReportError(f"table {name}: got no rows, or rows of another length than {len(head)}")
    return {"head": head, "rows": rows}
