"""A study as a declaration: what is asked where, what follows from the answers, claims, and how it looks."""

import importlib.util
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from studies.cases.problem import TABLE_1
from studies.record.store import Digits

#: Tables of a study, by name.
Tables = Mapping[str, pd.DataFrame]
Row = dict[str, Any]
#: What one asking gives to tables, by their name: a row, rows or a table of its own.
Answer = Mapping[str, Row | Iterable[Row] | pd.DataFrame]


def finding(*, claim: str, formulation: str, quantity: str, value: float, holds: bool) -> Row:
    """Return the row of one claim held against one formulation, with the sentence that says it.

    Args:
        claim: what the paper says, with the bound it is read as.
        formulation: which formulation it was held against.
        quantity: what was measured.
        value: measured [1].
        holds: whether the claim holds, "yes" or "no" in the row.
    """
    verdict = "holds" if holds else "does not hold"
    return {
        "claim": claim,
        "formulation": formulation,
        "quantity": quantity,
        "value": value,
        "holds": "yes" if holds else "no",
        "sentence": f"{formulation}: {quantity} is {percent(value)}, so the claim {verdict}.",
    }


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim that is held against rows of a study's tables, one finding a row.

    Attributes:
        claim, formulation, quantity: texts in which a column in braces stands for the row's value, formatted
            as `str.format` does.
        rows: of the tables, which rows are judged.
        value: the column that was measured [1], or what makes it of a row.
        holds: of a row, whether the claim holds. Without it: `least` <= value <= `most`.
    """

    claim: str
    formulation: str
    quantity: str
    rows: Callable[[Tables], pd.DataFrame | Iterable[Row]]
    value: str | Callable[[Row], float]
    holds: Callable[[Row], Any] | None = None
    least: float = -math.inf
    most: float = math.inf

    def __call__(self, tables: Tables) -> Iterator[Row]:
        """Yield the findings."""
        for row in records(self.rows(tables)):
            value = float(row[self.value] if isinstance(self.value, str) else self.value(row))
            yield finding(
                claim=self.claim.format(**row),
                formulation=self.formulation.format(**row),
                quantity=self.quantity.format(**row),
                value=value,
                holds=bool(self.holds(row)) if self.holds else self.least <= value <= self.most,
            )


def records(rows: pd.DataFrame | Iterable[Row]) -> Iterable[Row]:
    """Return the rows of a table by column, or rows as they are."""
    if not isinstance(rows, pd.DataFrame):
        return rows
    return [{str(name): value for name, value in row.items()} for row in rows.to_dict("records")]


def percent(value: float) -> str:
    """Return a ratio [1] in percent with two significant digits, as a power of ten if it is tiny."""
    if value == 0.0 or abs(value) >= 1e-5:
        hundredfold = 100.0 * value
        digits = 0 if hundredfold == 0.0 else max(0, 1 - math.floor(math.log10(abs(hundredfold))))
        return f"{hundredfold:.{digits}f} %"
    return f"{100.0 * value:.1e} %"


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
        """Return the answer at a point as what can be kept and sent: rows that are yielded are all there."""
        given = self.ask(*point) if isinstance(point, tuple) else self.ask(point)
        return {
            name: rows if isinstance(rows, dict | pd.DataFrame) else list(rows)
            for name, rows in given.items()
        }


@dataclass(frozen=True, kw_only=True)
class Study:
    """What a module of a study holds as `STUDY`.

    Attributes:
        cases: names of the designs it reads, which its results depend on; the paper's pivot by default.
        parts: what is asked, in this order.
        made: tables that follow from those before them, by name: rows, or tables one below the other.
        claims: of all tables, the findings.
        figures: name -> what draws it from the tables as they come back from their files; none by default.
        varying: tables that differ from run to run, in addition to those with "time" in their name.
        digits: tolerances that are not those of `studies.record.store`, by "table.column" or "column"; None
            for a column that is not compared.
        missing: says in a line what this machine lacks for it, and nothing where it can be run.
    """

    cases: tuple[str, ...] = (TABLE_1,)
    parts: tuple[Part, ...]
    made: Mapping[str, Callable[[Tables], pd.DataFrame | Iterable[Any]]] = field(default_factory=dict)
    claims: tuple[Claim, ...] = ()
    figures: Mapping[str, Callable[[Tables], Figure]] = field(default_factory=dict)
    varying: tuple[str, ...] = ()
    digits: Mapping[str, Digits | None] = field(default_factory=dict)
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
        findings = given.pop("findings", [])
        tables = {name: _as_table(rows) for name, rows in given.items()}
        for name, make in self.made.items():
            tables[name] = _as_table(make(tables))
        findings.extend(row for claim in self.claims for row in claim(tables))
        return tables | ({"findings": _as_table(findings)} if findings else {})

    def draw(self, tables: Tables) -> dict[str, Figure]:
        """Return the figures by name."""
        return {name: make(tables) for name, make in self.figures.items()}


def _as_table(rows: pd.DataFrame | Iterable[Any]) -> pd.DataFrame:
    """Return rows, or tables one below the other, as one table."""
    if isinstance(rows, pd.DataFrame):
        return rows
    given: list[Any] = list(rows)
    if given and all(isinstance(each, pd.DataFrame) for each in given):
        whole: pd.DataFrame = pd.concat(given)
        return whole
    return pd.DataFrame(given)


def absent(modules: Iterable[str]) -> list[str]:
    """Return those of the modules that cannot be imported here."""
    return [name for name in modules if importlib.util.find_spec(name) is None]


def lacking(extra: str, names: list[str]) -> str:
    """Return in a line that packages are not there and how they come; nothing where none is absent."""
    if not names:
        return ""
    return f"it needs {', '.join(names)}: python -m pip install '.[{extra}]'"
