"""Judge the results of another code by a reference solution of the benchmark pivot.

    python -m studies judge results/reference/beam.csv
    python -m studies judge results/reference/solid_neo_hookean.csv --reference solid_neo_hookean

The file is CSV with the columns quantity, at and value, as the tables in results/reference; docs/benchmark.md
explains them. Values are compared at the places of the reference: rotations in rad, mode numbers, times in s.
Values at other places are ignored. A quantity passes if no deviation exceeds the tolerance plus the
uncertainty of the reference. Exit code 0: all given quantities pass; 1: one deviates; 2: invalid input.
"""

import argparse
from pathlib import Path

import numpy as np
import pandas as pd

from studies.cases.document import nearest
from studies.commands.columns import plain, table
from studies.commands.parser import Argument, command
from studies.engine import percent
from studies.errors import BadInput
from studies.published.benchmark import FOLDER, QUANTITIES, THEORIES
from studies.record.store import read_csv

DEVIATES = 1
#: Largest relative distance between two places that are the same.
SAME = 1e-6
COLUMNS = ["quantity", "at", "value"]
RESULTS = Argument("file", "CSV file with the columns quantity, at, value", Path, metavar="RESULTS.csv")
REFERENCE = Argument(
    "--reference NAME", "solution to compare with, default beam", choices=tuple(THEORIES), default="beam"
)


@command(RESULTS, REFERENCE)
def main(arguments: argparse.Namespace) -> int:
    """Judge a file; return the exit code."""
    reference = read_csv((FOLDER / f"{arguments.reference}.csv").read_bytes())
    given = _read(arguments.file, reference["quantity"].unique().tolist())
    rows = [_judged(arguments.file, str(name), own, reference) for name, own in given.groupby("quantity")]
    print(f"{arguments.file}: compared with {arguments.reference} ({THEORIES[arguments.reference]})")
    heads = ("quantity", "compared", "largest deviation", "at", "allowed", "verdict")
    print("\n".join(table(map(plain, heads, zip(*rows, strict=True)))))
    return DEVIATES if "deviates" in [row[-1] for row in rows] else 0


def _judged(path: Path, name: str, own: pd.DataFrame, reference: pd.DataFrame) -> tuple[str, ...]:
    """Return quantity, number of places, largest deviation, its place, what is allowed there, verdict."""
    quantity, known = QUANTITIES[name], reference[reference["quantity"] == name]
    places = known["at"].to_numpy()
    row, place = np.nonzero(np.abs(own["at"].to_numpy()[:, None] - places) <= SAME * np.abs(places))
    if not len(row):
        expected = f"{quantity['at']}, for example {places[0]:.8g} or {places[-1]:.8g}"
        raise BadInput(f"{path}: {name}: got no value at a place of the reference, expected at: {expected}")
    true = known.iloc[place]
    deviation = (own["value"].to_numpy()[row] - true["value"].to_numpy()) / true["scale"].to_numpy()
    allowed = quantity["tolerance"] + (true["uncertainty"] / true["scale"]).to_numpy()
    worst = int(np.argmax(np.abs(deviation) - allowed))
    verdict = "pass" if abs(deviation[worst]) <= allowed[worst] else "deviates"
    compared, where = f"{len(set(place))} of {len(places)}", f"{true['at'].iloc[worst]:.6g}"
    return name, compared, percent(deviation[worst]), where, percent(allowed[worst]), verdict


def _read(path: Path, known: list[str]) -> pd.DataFrame:
    """Return the rows of a file of results; BadInput if a row is not of a known quantity or has no number."""
    try:
        rows = pd.read_csv(path, dtype=str, keep_default_na=False, index_col=False).fillna("")
    except (OSError, ValueError) as error:
        why = " ".join(str(getattr(error, "strerror", None) or error).split())
        raise BadInput(f"{path}: got no table ({why}), expected a CSV file in UTF-8") from None
    if not set(COLUMNS) <= set(rows) or rows.empty:
        got = f"{len(rows)} rows with the columns {', '.join(map(str, rows))}"
        raise BadInput(f"{path}: got {got}, expected rows with the columns {', '.join(COLUMNS)}")
    numbers = rows[COLUMNS[1:]].apply(pd.to_numeric, errors="coerce")
    wrong = (~np.isfinite(numbers)).assign(quantity=~rows["quantity"].isin(known))[COLUMNS]
    for line, name in np.argwhere(wrong.to_numpy())[:1]:
        got = rows[COLUMNS].iloc[line, name] or "nothing"
        expected = "a finite number" if name else nearest(got, known)
        raise BadInput(f"{path}: line {line + 2}: {COLUMNS[name]}: got {got}, expected {expected}")
    return pd.DataFrame(numbers.assign(quantity=rows["quantity"]))
