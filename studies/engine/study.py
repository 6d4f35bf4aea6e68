"""A study as a declaration: what is asked where, what follows from the answers, and what they look like."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.engine.findings import Finding, Tables
from studies.record.store import Digits

Row = dict[str, Any]
#: What one asking gives to tables, by their name: a row, rows, findings or a table of its own.
Answer = Mapping[str, Row | Iterable[Row] | Iterable[Finding] | pd.DataFrame]

FINDINGS, OF_TIME = "findings", "findings_of_time"


@dataclass(frozen=True, kw_only=True)
class Part:
    """One question, asked at every point.

    Attributes:
        ask: of a point, what it gives to which tables; a point that is a tuple is taken apart.
        at: returns the points, the same every time; without it the question is asked once.
        alone: whether nothing may run beside it, as where time or memory is measured.
    """

    ask: Callable[..., Answer]
    at: Callable[[], Iterable[Any]] = lambda: [()]
    alone: bool = False

    def answer(self, point: Any) -> Answer:
        """Return the answer at a point."""
        return self.ask(*point) if isinstance(point, tuple) else self.ask(point)


@dataclass(frozen=True, kw_only=True)
class Study:
    """What a module of a study holds as `STUDY`.

    Attributes:
        cases: names of the designs it reads, which its results depend on.
        parts: what is asked, in this order.
        made: tables that follow from those before them, by name.
        claims, claims_of_time: of all tables, the findings; those that differ from run to run apart.
        figures: name -> what draws it from the tables as they come back from their files.
        varying: tables that differ from run to run, beside those whose name says time.
        digits: columns that other work on the machine changes in their last digits, and how many hold.
        missing: says in a line what this machine lacks for it, and nothing where it can be run.
    """

    cases: tuple[str, ...]
    parts: tuple[Part, ...]
    made: Mapping[str, Callable[[Tables], pd.DataFrame | Iterable[Row]]] = field(default_factory=dict)
    claims: tuple[Callable[[Tables], Iterable[Finding]], ...] = ()
    claims_of_time: tuple[Callable[[Tables], Iterable[Finding]], ...] = ()
    figures: Mapping[str, Callable[[Tables], Figure]]
    varying: tuple[str, ...] = ()
    digits: Mapping[str, Digits] = field(default_factory=dict)
    missing: Callable[[], str] = str

    def varies(self, table: str) -> bool:
        """Whether a table differs from run to run."""
        return table in self.varying or "time" in table or "timing" in table

    def tables(self, answers: Iterable[Answer]) -> dict[str, pd.DataFrame]:
        """Return all tables from the answers of the parts at their points."""
        given: dict[str, list[Any]] = {}
        for answer in answers:
            for name, rows in answer.items():
                one = isinstance(rows, Mapping | pd.DataFrame)
                given.setdefault(name, []).extend([rows] if one else rows)
        findings = {name: given.pop(name, []) for name in (FINDINGS, OF_TIME)}
        tables = {name: _as_table(rows) for name, rows in given.items()}
        for name, make in self.made.items():
            tables[name] = _as_table(make(tables))
        for claim in self.claims:
            findings[FINDINGS].extend(claim(tables))
        for claim in self.claims_of_time:
            findings[OF_TIME].extend(claim(tables))
        return tables | {name: _as_table(rows) for name, rows in findings.items() if rows}

    def draw(self, tables: Tables) -> dict[str, Figure]:
        """Return the figures by name."""
        return {name: make(tables) for name, make in self.figures.items()}


def _as_table(rows: pd.DataFrame | Iterable[Any]) -> pd.DataFrame:
    """Return rows, findings or tables one below the other as one table."""
    if isinstance(rows, pd.DataFrame):
        return rows
    given: list[Any] = list(rows)
    if given and all(isinstance(each, pd.DataFrame) for each in given):
        whole: pd.DataFrame = pd.concat(given)
        return whole
    return pd.DataFrame([each.row() if isinstance(each, Finding) else each for each in given])
