"""What the static diagrams say, in sentences made from their numbers."""

from collections.abc import Iterator, Mapping

import pandas as pd

from studies.engine.findings import Finding
from studies.record.style import BASES
from studies.work_precision.scaling import exponents
from studies.work_precision.series import ELEMENTS, SPLINE

#: Errors at which the two models are compared.
COMPARED = (1e-3, 1e-4, 1e-6)


class Ratio(Finding):
    """A finding whose value says how many times."""

    def sentence(self) -> str:
        """Return the finding as a sentence."""
        verdict = "holds" if self.holds else "does not hold"
        return f"{self.formulation}: {self.quantity} is {self.value:.3g}, so the claim {verdict}."


def of_work(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
    """Return findings that do not depend on the machine."""
    found = list(_ratios(tables["digits"], "counted work"))
    for row in tables["reference"].to_dict("records"):
        shown = tables["errors"][tables["errors"]["theory"] == row["theory"]]
        error = shown[f"error_{row['quantity']}"]
        least = error.min()
        found.append(
            Finding(
                claim=f"The reference of the {row['quantity']} is ten times finer than every error",
                formulation=f"{row['theory']} theory",
                quantity="the uncertainty of the reference over the smallest error",
                value=float(row["uncertainty"] / least),
                holds=bool(row["uncertainty"] <= 0.1 * least),
            )
        )
    return found


def of_time(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
    """Return findings of time: they differ from run to run and machine to machine."""
    found = list(_ratios(tables["digits_of_time"], "time"))
    rows = tables["language"].set_index(["series", "setting"])
    seconds, python = (float(rows[name][(ELEMENTS, "20 elements")]) for name in ("solve_s", "python_share"))
    found.append(
        Finding(
            claim="The path on 20 elements takes less than 0.4 s",
            formulation="20 elements",
            quantity="its time over 0.4 s",
            value=seconds / 0.4,
            holds=seconds < 0.4,
        )
    )
    found.append(
        Finding(
            claim="Most of the elements' time is Python",
            formulation="20 elements",
            quantity="the share of the time that compiled elements would not take",
            value=python,
            holds=python > 0.5,
        )
    )
    limits = {"bezier": ("no faster than n^3", 3.0), "bspline": ("about linearly, up to n = 64", 1.25)}
    for basis, power in exponents(tables).items():
        claim, most = limits[basis]
        found.append(
            Finding(
                claim=f"The time of one iteration grows {claim}",
                formulation=BASES[basis],
                quantity="the observed exponent over the largest allowed one",
                value=power / most,
                holds=power <= most,
            )
        )
    return found


def _ratios(digits: pd.DataFrame, cost: str) -> Iterator[Finding]:
    """Yield how many times the splines' cost the others take at equal error."""
    others = digits[(digits["series"] != SPLINE) & digits["target"].isin(COMPARED) & digits["ratio"].notna()]
    for row in others.to_dict("records"):
        yield Ratio(
            claim=f"At an error of {row['target']:g} in path and torque the spline takes less {cost}",
            formulation=f"{row['series']}, {row['setting']}",
            quantity=f"its {cost} over that of the spline",
            value=float(row["ratio"]),
            holds=bool(row["ratio"] > 1.0),
        )
