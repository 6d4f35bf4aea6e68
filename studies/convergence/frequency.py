"""Frequency of the swing and of small motion against control points, elements and amplitude."""

from collections.abc import Iterator
from typing import Any

import pandas as pd

from studies.convergence.swing_sweep import PARTS
from studies.engine import Claim, Study, Tables
from studies.record.digits import Digits

SPLINE, TWENTY = "n = 6", "FE, 20 elements"

#: The part of a shift by which its prediction from statics may be off and still explain it.
EXPLAINED = 0.25
#: What "due to the number of control points" is read as: at most this part of the shift is left with more.
LEFT = 0.05
#: Both models "swing alike" within this part of the frequency: three times the error of 20 elements.
ALIKE = 1e-3


def _shifts_left(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield, for each stretch form, the shift of four control points, the part of it that the static path
    does not explain, and the part that is left with the most points."""
    for stretch in ("consistent", "mixed"):
        rows = tables["control_points"].query("stretch == @stretch").sort_values("control_points")
        shifts, implied = rows["shift"].to_numpy(float), rows["shift_from_statics"].to_numpy(float)
        yield {
            "stretch": stretch,
            "shift": shifts[0],
            "unexplained": abs(implied[0] / shifts[0] - 1.0),
            "most": int(rows["control_points"].iloc[-1]),
            "left": abs(shifts[-1] / shifts[0]),
        }


def _four(tables: Tables) -> list[dict[str, Any]]:
    """Return what of the shift of four control points locking makes, and what of it the first mode shows."""
    four = tables["control_points"].query("control_points == 4").set_index("stretch")["shift"]
    first = tables["modes"].query("model == 'spline' and mode == 1 and count == 4")["error"].iloc[0]
    return [
        {
            "locking": 1.0 - four["mixed"] / four["consistent"],
            "first_mode": abs(first / four["mixed"]),
        }
    ]


def _apart(tables: Tables) -> pd.DataFrame:
    """Return the difference of both models' frequencies by amplitude."""
    wide = tables["backbone"].pivot(index="amplitude_rad", columns="formulation", values="frequency_Hz")
    return (wide[SPLINE] / wide[TWENTY] - 1.0).rename("difference").reset_index()


STUDY = Study(
    parts=PARTS,
    claims=(
        Claim(
            claim="Section 3.2: four control points swing faster because they are stiffer",
            formulation="n = 4, {stretch} stretch",
            quantity="the part of the shift ({shift:+.2%}) that the static path does not explain",
            rows=_shifts_left,
            value="unexplained",
            holds=lambda row: row["shift"] > 0.0 and row["unexplained"] <= EXPLAINED,
        ),
        Claim(
            claim="Section 3.2: the shift is due to the number of control points",
            formulation="{stretch} stretch",
            quantity="the shift at n = {most} over that at n = 4",
            rows=_shifts_left,
            value="left",
            most=LEFT,
        ),
        Claim(
            claim="The shift at four control points is mostly membrane locking",
            formulation="n = 4, consistent stretch",
            quantity="the part of the shift that goes with an independent axial force",
            rows=_four,
            value="locking",
            holds=lambda row: row["locking"] > 0.5,
        ),
        Claim(
            claim="The first mode at rest shows the shift of the swing",
            formulation="n = 4, mixed stretch",
            quantity="the error of the first mode at rest over the shift of the swing",
            rows=_four,
            value="first_mode",
            holds=lambda row: row["first_mode"] > 0.5,
        ),
        Claim(
            claim="Both models swing alike at every amplitude from 2 to 90 degrees",
            formulation=SPLINE,
            quantity="the largest difference of the frequency to 20 finite elements",
            rows=lambda tables: [{"apart": _apart(tables)["difference"].abs().max()}],
            value="apart",
            most=ALIKE,
        ),
    ),
    digits={"findings.value": Digits(floor=1e-7), "modes.uncertainty": Digits(floor=1e-9)},
)
