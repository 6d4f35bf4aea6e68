"""The stored results as the report reads them: fresh tables, and nothing else."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from report.errors import ReportError
from studies.record.store import Store
from studies.registry import STUDIES


class Results:
    """The tables of all studies. A stale or missing one ends the build where it is first asked for.

    Attributes:
        store: where the results are.
        stale: study -> why, of those that are not fresh; filled only where `allow_stale` let them pass.
        read: studies that were read from so far.
    """

    def __init__(self, store: Store, *, allow_stale: bool = False) -> None:
        self.store = store
        self.stale: dict[str, str] = {}
        self.read: set[str] = set()
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
            self.read.add(study)
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
