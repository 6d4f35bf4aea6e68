"""What the report reads: stored results, all fresh, rows picked out of their tables, and the gates."""

import tomllib
from collections.abc import Mapping
from functools import cache
from typing import Any

import pandas as pd

from studies.errors import BadInput
from studies.record.source import ROOT
from studies.record.store import Store
from studies.registry import STUDIES


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


def where(table: pd.DataFrame, /, **equal: Any) -> pd.DataFrame:
    """Return the rows of `table` whose columns have the values `equal`.

    Raises:
        LookupError: no such column, or no such row.
    """
    for name, value in equal.items():
        table = table[column(table, name) == value]
        if table.empty:
            raise LookupError(f"no row with {name} = {value}")
    return table


def column(table: pd.DataFrame, name: str) -> "pd.Series[Any]":
    """Return a column of `table`; LookupError when it has none of that name."""
    if name not in table:
        raise LookupError(f"no column {name}, there are {', '.join(table.columns)}")
    found: pd.Series[Any] = table[name]
    return found


@cache
def gates() -> dict[str, dict[str, Any]]:
    """Return every gate by name: limit, unit, measured, against."""
    return tomllib.loads((ROOT / "tests" / "gates.toml").read_text(encoding="utf-8"))
