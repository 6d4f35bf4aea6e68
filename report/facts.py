"""Facts, sentences that hold, and tables: what the text may quote, and where each of them comes from."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from report.errors import ReportError
from report.forms import Form
from report.pick import Pick
from report.results import Results


@dataclass(frozen=True, kw_only=True)
class Fact:
    """A number of the text.

    Attributes:
        study, table: where it is stored.
        pick: how it is selected there; form: how it is written.
    """

    study: str
    table: str
    pick: Pick
    form: Form

    def value(self, results: Results) -> Any:
        """Return the value; LookupError when the table does not have it."""
        return self.pick(results.table(self.study, self.table))

    def source(self) -> str:
        """Return where the value comes from, for messages."""
        return f"{self.study}/{self.table}"


@dataclass(frozen=True, kw_only=True)
class Derived:
    """A number made of several tables, or of a case, the gates or the versions.

    Attributes:
        made: the value from all results; form: how it is written.
    """

    made: Callable[[Results], Any]
    form: Form

    def value(self, results: Results) -> Any:
        """Return the value; LookupError when a table does not have what it is made of."""
        return self.made(results)

    def source(self) -> str:
        """Return where the value comes from, for messages."""
        return "several tables"


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


@dataclass(frozen=True, kw_only=True)
class Listing:
    """A table of the report: made from all results as a heading and rows of cells."""

    made: Callable[[Results], tuple[list[str], list[list[Cell]]]]


def fact(study: str, table: str, pick: Pick, form: Form) -> Fact:
    """Return a fact from one table."""
    return Fact(study=study, table=table, pick=pick, form=form)


def written(name: str, given: Fact | Derived, results: Results) -> str:
    """Return the text of a fact.

    Raises:
        ReportError: the value is not there, or not a finite number.
    """
    try:
        value = given.value(results)
        if not isinstance(value, str) and not math.isfinite(float(value)):
            raise ValueError(f"{value} is no number to write")
        return given.form(value)
    except (LookupError, TypeError, ValueError) as error:
        if isinstance(error, ReportError):
            raise
        raise ReportError(f"fact {name}: {error} ({given.source()})") from None


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


def listed(name: str, listing: Listing, results: Results) -> Mapping[str, Any]:
    """Return a table as heading and rows.

    Raises:
        ReportError: a row of another length than the heading, no row, or something that is not there.
    """
    try:
        head, rows = listing.made(results)
    except (LookupError, TypeError) as error:
        raise ReportError(f"table {name}: {error}") from None
    if not rows or any(len(row) != len(head) for row in rows):
        raise ReportError(f"table {name}: got no rows, or rows of another length than {len(head)}")
    return {"head": head, "rows": rows}
