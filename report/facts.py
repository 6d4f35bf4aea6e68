"""Facts, sentences that hold, and tables: what the text may quote, and the stored results it comes from.

The modules of `report.content` enter what is quoted here by name: numbers in `FACTS`, conditions and
tables as functions of the results under `holds` and `listing`.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import pandas as pd

from report.forms import Form
from studies.errors import BadInput
from studies.record.store import Store
from studies.registry import STUDIES

#: One cell of a table: text, or text with a colour beside it.
Cell = str | dict[str, str]
#: A table of the report: its heading, then rows of cells, one for each part of the heading.
Table = Iterable[Sequence[Cell]]
#: Heading -> the column below it and how its values are written, or the cell made of a whole row.
Shown = Mapping[str, tuple[str, Callable[[Any], Cell]] | Callable[[Any], Cell]]


class ReportError(BadInput):
    """A number, figure or sentence that the stored results do not give."""


class Results:
    """The tables of all studies. A stale or missing one ends the build where it is first asked for.

    Attributes:
        store: where the results are.
        stale: study -> why, of those that are not fresh; filled only where `allow_stale` let them pass.
    """

    def __init__(self, store: Store, *, allow_stale: bool = False) -> None:
        self.store = store
        self.stale: dict[str, str] = {}
        self._allow_stale = allow_stale
        self._tables: dict[str, dict[str, pd.DataFrame]] = {}

    def table(self, study: str, name: str) -> pd.DataFrame:
        """Return a stored table of `study`.

        Raises:
            ReportError: no such study or table, or the stored result is not that of today's source.
        """
        tables = self._of(study)
        if name not in tables:
            raise ReportError(f"{study}: got no table {name}, expected one of {', '.join(tables)}")
        return tables[name]

    def record(self, study: str) -> Mapping[str, Any]:
        """Return the provenance of `study`, which must be fresh as its tables."""
        self._of(study)
        return self.store.record(study)

    def figures(self) -> dict[str, tuple[str, str]]:
        """Return study and hash of every vector figure by its name; none is stale."""
        return {
            file.removesuffix(".svg"): (study, digest)
            for study in STUDIES
            for file, digest in self.record(study)["figures"].items()
            if file.endswith(".svg")
        }

    def _of(self, study: str) -> dict[str, pd.DataFrame]:
        if study not in self._tables:
            self._require_fresh(study)
            self._tables[study] = self.store.load_tables(study)
        return self._tables[study]

    def _require_fresh(self, study: str) -> None:
        if study not in STUDIES:
            raise ReportError(f"{study}: got no such study, expected one of {', '.join(STUDIES)}")
        remedy = f"expected a fresh result: `python -m studies run {study}`"
        try:
            cases = self.store.record(study)["inputs"]["cases"]
        except FileNotFoundError:
            raise ReportError(f"{study}: got no stored result, {remedy}") from None
        # the names of the cases are part of the source that is compared, so those noted suffice here and the
        # study, with the models behind it, need not be imported
        state = self.store.state(study, module=STUDIES[study], cases=cases)
        if state.kind == "fresh":
            return
        if state.kind == "missing" or not self._allow_stale:
            raise ReportError(f"{study}: got a {state.kind} result ({state.reason}), {remedy}")
        self.stale[study] = state.reason


@dataclass(frozen=True, kw_only=True)
class Fact:
    """A number of the text, a condition that a sentence rests on, or a table.

    Attributes:
        made: the value from all results; LookupError when a table does not have what it is made of.
        form: how the text gets it; ValueError when it cannot be written.
        said: where it comes from, or what must be true, for messages.
    """

    made: Callable[[Results], Any]
    form: Callable[[Any], Any]
    said: str = "several tables"

    def given(self, name: str, results: Results) -> Any:
        """Return what the text gets.

        Raises:
            ReportError: the value is not there, or not a finite number.
        """
        try:
            value = self.made(results)
            if isinstance(value, float) and not math.isfinite(value):
                raise ValueError(f"{value} is no number to write")
            return self.form(value)
        except ReportError:
            raise
        except (LookupError, TypeError, ValueError) as error:
            raise ReportError(f"{name}: {error} ({self.said})") from None


class _Register(dict[str, Fact]):
    """Facts by name, each entered once."""

    def __setitem__(self, name: str, fact: Fact) -> None:
        if name in self:
            raise ReportError(f"report.content: got {name} twice, expected one of a name")
        super().__setitem__(name, fact)

    def __ior__(self, given: Any) -> Self:  # type: ignore[misc, override]
        for name, fact in given.items():
            self[name] = fact
        return self


#: What the text may quote, by name: numbers, conditions, tables.
FACTS, HOLDS, LISTINGS = _Register(), _Register(), _Register()


def holds(name: str, *, timed: bool = False) -> Callable[[Callable[[Results], Any]], None]:
    """Enter a condition: a function of the results whose docstring says what must be true.

    `timed`: whether it rests on measured seconds. Its sentence is then replaced by what was not so in the run
    that the tables are of, where others are no longer printed at all: a machine may be busy.
    """

    def enter(test: Callable[[Results], Any]) -> None:
        words = " ".join((test.__doc__ or name).split())

        def form(value: Any) -> dict[str, Any]:
            return {"holds": bool(value), "words": words, "timed": timed}

        HOLDS[name] = Fact(made=test, form=form, said=words)

    return enter


def table(given: Table) -> dict[str, Any]:
    """Return heading and rows; ValueError without rows, or with one of another length than the heading."""
    head, *rows = given
    if not rows or any(len(row) != len(head) for row in rows):
        raise ValueError(f"got no rows, or rows of another length than {len(head)}")
    return {"head": head, "rows": rows}


def listing(name: str) -> Callable[[Callable[[Results], Table]], None]:
    """Enter a table: a function of the results."""
    return lambda made: LISTINGS.__setitem__(name, Fact(made=made, form=table, said="a table"))


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
        said = f"{self._study}/{self._table}"
        return Fact(made=lambda results: pick(self.rows(results, **equal)), form=form, said=said)

    def at(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the value of a column in the one row that there is."""
        return self.fact(_only(name, equal), form, **equal)

    def table(self, shown: Shown, *, by: str | None = None) -> Fact:
        """Return the table with a row for each of the rows, in the order of the column `by`."""

        def made(results: Results) -> Table:
            rows = self.rows(results)
            return columns(rows.sort_values(by) if by else rows, shown)

        return Fact(made=made, form=table, said="a table")

    def largest(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the largest magnitude of a column."""
        return self.fact(lambda rows: _column(rows, name).abs().max(), form, **equal)

    def least(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the smallest magnitude of a column."""
        return self.fact(lambda rows: _column(rows, name).abs().min(), form, **equal)


def _only(name: str, equal: Mapping[str, Any]) -> Callable[[pd.DataFrame], Any]:
    def pick(rows: pd.DataFrame) -> Any:
        if len(rows) != 1:
            raise LookupError(f"{len(rows)} rows with {equal}, expected one")
        return _column(rows, name).iloc[0]

    return pick


def columns(rows: pd.DataFrame, shown: Shown) -> Table:
    """Return a table with a row for each of `rows`."""
    yield list(shown)
    for row in rows.to_dict("records"):
        yield [made(row) if callable(made) else made[1](row[made[0]]) for made in shown.values()]


def where(rows: pd.DataFrame, /, **equal: Any) -> pd.DataFrame:
    """Return those of `rows` whose columns have the values `equal`.

    Raises:
        LookupError: no such column, or no such row.
    """
    for name, value in equal.items():
        rows = rows[_column(rows, name) == value]
        if rows.empty:
            raise LookupError(f"no row with {name} = {value}")
    return rows


def _column(rows: pd.DataFrame, name: str) -> Any:
    """Return a column of `rows`; LookupError when they have none of that name."""
    if name not in rows:
        raise LookupError(f"no column {name}, there are {', '.join(rows.columns)}")
    return rows[name]
