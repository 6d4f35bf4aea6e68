"""Findings: whether a claim of the paper holds for a formulation, as a row made from the numbers."""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass

import pandas as pd


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


def table(findings: Iterable[Finding]) -> pd.DataFrame:
    """Return findings as a table: claim, formulation, quantity, value, holds ("yes" or "no") and sentence."""
    rows = [
        asdict(finding) | {"holds": "yes" if finding.holds else "no", "sentence": finding.sentence()}
        for finding in findings
    ]
    return pd.DataFrame(rows)


def percent(value: float) -> str:
    """Return a ratio in percent with two significant digits, in powers of ten where it is tiny."""
    if value == 0.0 or abs(value) >= 1e-5:
        hundredfold = 100.0 * value
        digits = 0 if hundredfold == 0.0 else max(0, 1 - math.floor(math.log10(abs(hundredfold))))
        return f"{hundredfold:.{digits}f} %"
    return f"{100.0 * value:.1e} %"
