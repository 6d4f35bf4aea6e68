"""The paper's claims and what became of each, for three formulations."""

from typing import Any

import pandas as pd

from report.facts import Cell, Derived, Listing
from report.forms import count, percent
from report.pick import where
from report.results import Results
from studies.record.style import LOOKS, RED
from studies.stability.maps import LOOKS as OUTCOME_LOOKS

#: Formulations that the claims are held against.
CLAIMED = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")
STUDIES_OF_CLAIMS = (
    "paper/fig03_snapshots",
    "paper/fig04_trajectory",
    "paper/fig05_stiffness",
    "paper/fig06_release",
)
#: Colours of a claim that holds and of one that does not: those of right and wrong in the maps.
VERDICTS = {"yes": OUTCOME_LOOKS["right"][0], "no": RED}


def findings(results: Results) -> pd.DataFrame:
    """Return the findings on all claims of the paper's Figs 3 to 6."""
    return pd.concat([results.table(study, "findings") for study in STUDIES_OF_CLAIMS])


def _claims(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = []
    for claim, some in findings(results).groupby("claim", sort=True):
        verdicts = some.set_index("formulation")
        cells: list[Cell] = [str(claim)]
        for name in CLAIMED:
            if name not in verdicts.index:
                cells.append("–")
                continue
            row: Any = verdicts.loc[name]
            cells.append(
                {"text": f"{row['holds']} ({percent(row['value'])})", "colour": VERDICTS[str(row["holds"])]}
            )
        rows.append(cells)
    return ["claim of the paper, as it is read", *(LOOKS[name].label for name in CLAIMED)], rows


def _held(formulation: str) -> Derived:
    def made(results: Results) -> int:
        rows = where(findings(results), formulation=formulation)
        return int((rows["holds"] == "yes").sum())

    return Derived(made=made, form=count)


FACTS = {
    "claims.paper": _held(CLAIMED[0]),
    "claims.locking-free": _held(CLAIMED[1]),
    "claims.tried": Derived(
        made=lambda results: int((findings(results)["formulation"] == CLAIMED[0]).sum()), form=count
    ),
}
LISTINGS = {"claims": Listing(made=_claims)}
