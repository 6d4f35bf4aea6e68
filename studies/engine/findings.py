"""Findings: whether a claim holds for a formulation, as a row made from the numbers."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import pandas as pd

Tables = Mapping[str, pd.DataFrame]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One claim held against one formulation.

    Attributes:
        claim: what the paper says, with the bound it is read as.
        formulation: which formulation it was held against.
        quantity: what was measured.
        value: measured [1].
        holds: whether the claim holds.
    """

    claim: str
    formulation: str
    quantity: str
    value: float
    holds: bool

    def sentence(self) -> str:
        """Return the finding as a sentence."""
        verdict = "holds" if self.holds else "does not hold"
        return f"{self.formulation}: {self.quantity} is {percent(self.value)}, so the claim {verdict}."

    def row(self) -> dict[str, Any]:
        """Return the columns claim, formulation, quantity, value, holds ("yes" or "no") and sentence."""
        return asdict(self) | {"holds": "yes" if self.holds else "no", "sentence": self.sentence()}


class Ratio(Finding):
    """A finding whose value says how many times."""

    def sentence(self) -> str:
        """Return the finding as a sentence."""
        verdict = "holds" if self.holds else "does not hold"
        return f"{self.formulation}: {self.quantity} is {self.value:.3g}, so the claim {verdict}."


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim that is held against rows of a study's tables, one finding a row.

    Attributes:
        claim, formulation, quantity: texts in which a column in braces stands for the row's value, formatted
            as `str.format` does.
        rows: of the tables, which rows are judged.
        value: the column that was measured [1], or what makes it of a row.
        holds: of a row, whether the claim holds. Without it: `least` <= value <= `most`.
        kind: of the findings: `Ratio` where the value says how many times.
    """

    claim: str
    formulation: str
    quantity: str
    rows: Callable[[Tables], pd.DataFrame | Iterable[dict[str, Any]]]
    value: str | Callable[[dict[str, Any]], float]
    holds: Callable[[dict[str, Any]], Any] | None = None
    least: float = -math.inf
    most: float = math.inf
    kind: type[Finding] = Finding

    def __call__(self, tables: Tables) -> Iterator[Finding]:
        """Yield the findings."""
        for row in records(self.rows(tables)):
            value = float(row[self.value] if isinstance(self.value, str) else self.value(row))
            within = self.least <= value <= self.most
            yield self.kind(
                claim=self.claim.format(**row),
                formulation=self.formulation.format(**row),
                quantity=self.quantity.format(**row),
                value=value,
                holds=bool(self.holds(row)) if self.holds else within,
            )


def records(rows: pd.DataFrame | Iterable[dict[str, Any]]) -> Iterable[dict[str, Any]]:
    """Return the rows of a table by column, or rows as they are."""
    if not isinstance(rows, pd.DataFrame):
        return rows
    return [{str(name): value for name, value in row.items()} for row in rows.to_dict("records")]


def percent(value: float) -> str:
    """Return a ratio in percent with two significant digits, in powers of ten where it is tiny."""
    if value == 0.0 or abs(value) >= 1e-5:
        hundredfold = 100.0 * value
        digits = 0 if hundredfold == 0.0 else max(0, 1 - math.floor(math.log10(abs(hundredfold))))
        return f"{hundredfold:.{digits}f} %"
    return f"{100.0 * value:.1e} %"
