"""Facts, conditions and tables: what the text may quote, and the stored results it comes from.

The modules of `report.content` enter them by name in `FACTS`, `HOLDS` and `LISTINGS`.
"""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from report.forms import Form
from studies.errors import BadInput
from studies.record.store import Store, inputs
from studies.registry import STUDIES

#: A table of the report: its heading, then rows of cells, one for each part of the heading.
Table = Iterable[Sequence[str]]


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

    def figures(self) -> dict[str, str]:
        """Return the hash of every vector figure by its name; none is stale."""
        return {
            file.removesuffix(".svg"): digest
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
        state = self.store.state(study, inputs(STUDIES[study], cases))
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
        said: where it comes from, for messages.
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


#: What the text may quote, by name: numbers, conditions, tables.
FACTS: dict[str, Fact] = {}
HOLDS: dict[str, Fact] = {}
LISTINGS: dict[str, Fact] = {}


def table(given: Table) -> dict[str, Any]:
    """Return heading and rows; ValueError without rows, or with one of another length than the heading."""
    head, *rows = given
    if not rows or any(len(row) != len(head) for row in rows):
        raise ValueError(f"got no rows, or rows of another length than {len(head)}")
    return {"head": head, "rows": rows}


def listing(name: str) -> Callable[[Callable[[Results], Table]], None]:
    """Return a decorator that registers a function of the results as the table `name`."""
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
        rows = results.table(self._study, self._table)
        for name, value in (self._equal | equal).items():
            rows = rows[_column(rows, name) == value]
            if rows.empty:
                raise LookupError(f"no row with {name} = {value}")
        return rows

    def value(self, results: Results, name: str, /, **equal: Any) -> Any:
        """Return the value of a column in the one row that there is; LookupError when there are more."""
        rows = self.rows(results, **equal)
        if len(rows) != 1:
            raise LookupError(f"{len(rows)} rows with {equal}, expected one")
        return _column(rows, name).iloc[0]

    def at(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the value of a column in the one row that there is."""
        return self._fact(lambda results: self.value(results, name, **equal), form)

    def largest(self, name: str, form: Form, /, **equal: Any) -> Fact:
        """Return the fact that is the largest magnitude of a column."""
        return self._fact(lambda results: _column(self.rows(results, **equal), name).abs().max(), form)

    def table(self, shown: Mapping[str, tuple[str, Form]], *, by: str) -> Fact:
        """Return the table with a row for each of the rows, in the order of the column `by`.

        Args:
            shown: heading -> the column below it, and how its values are written.
            by: name of a column.
        """

        def made(results: Results) -> Table:
            yield list(shown)
            for row in self.rows(results).sort_values(by).to_dict("records"):
                yield [form(row[name]) for name, form in shown.values()]

        return self._fact(made, table)

    def found(self, claim: str, *formulations: str, holds: str = "yes") -> Fact:
        """Return the condition that all findings on a claim are `holds`.

        Args:
            claim: how the claim begins.
            formulations: the findings on these alone; on all without any.
            holds: "yes" or "no".
        """

        def made(results: Results) -> bool:
            rows = self.rows(results)
            rows = rows[rows["claim"].str.startswith(claim)]
            if formulations:
                rows = rows[rows["formulation"].isin(formulations)]
            if len(rows) < max(1, len(formulations)):
                raise LookupError(f"{len(rows)} findings on {claim!r}")
            return bool((rows["holds"] == holds).all())

        return self._fact(made, bool)

    def _fact(self, made: Callable[[Results], Any], form: Callable[[Any], Any]) -> Fact:
        return Fact(made=made, form=form, said=f"{self._study}/{self._table}")


def _column(rows: pd.DataFrame, name: str) -> Any:
    """Return a column of `rows`; LookupError when they have none of that name."""
    if name not in rows:
        raise LookupError(f"no column {name}, there are {', '.join(rows.columns)}")
    return rows[name]
