"""Rewrite the figures of agreement, of cost and of hard cases in the README from the stored results.

    python -m studies readme

Only what stands between marks is written; everything there comes from results/data. Exit code 0:
done; 2: a study it needs was never run, or README.md has no marks.
"""

import argparse
from collections.abc import Iterable, Iterator

import pandas as pd

from studies.commands.digits import digits
from studies.commands.parser import Parser
from studies.errors import BadInput
from studies.record.files import write_whole
from studies.record.source import ROOT
from studies.record.store import Store
from studies.stability.summary import lines

README = ROOT / "README.md"
BEGIN = "<!-- agreement: written by `python -m studies readme` -->"
END = "<!-- end of agreement -->"
BEGIN_DIGITS = "<!-- digits: written by `python -m studies readme` -->"
END_DIGITS = "<!-- end of digits -->"
BEGIN_HARD = "<!-- hard cases: written by `python -m studies readme` -->"
END_HARD = "<!-- end of hard cases -->"

#: Control-point counts that the table shows for the default formulation.
COUNTS = (4, 6, 8, 12)
#: Formulations of Fig 6 in the order of the table.
SWINGS = {
    "n = 4, as the paper": "spline, 4 control points, as the paper integrates it",
    "n = 4, locking-free": "spline, 4 control points, locking-free",
    "n = 6": "spline, 6 control points, locking-free",
    "n = 10": "spline, 10 control points, locking-free",
    "FE, 20 elements": "finite elements, 20 a strip, as the paper",
}
CLAIMED = ("n = 4, as the paper", "n = 4, locking-free", "n = 6")


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command: there are none."""


def main(arguments: argparse.Namespace) -> int:
    """Rewrite the blocks; return the exit code."""
    write_whole(README, rewritten(README.read_text(encoding="utf-8"), Store()).encode())
    return 0


def rewritten(text: str, store: Store) -> str:
    """Return `text` with what stands between the marks made anew from the results in `store`.

    Raises:
        BadInput: the marks are missing, or a study was never run.
    """
    text = _between(text, BEGIN, END, _block(store))
    studies = ("work_precision/statics", "work_precision/dynamics")
    found = [_table(store, study, "digits_of_time") for study in studies]
    text = _between(text, BEGIN_DIGITS, END_DIGITS, digits(*found))
    return _between(text, BEGIN_HARD, END_HARD, lines(store))


def _between(text: str, begin: str, end: str, lines: Iterable[str]) -> str:
    """Return `text` with `lines` in place of what stands between the marks."""
    head, found_begin, rest = text.partition(begin)
    _, found_end, tail = rest.partition(end)
    if not (found_begin and found_end):
        raise BadInput(f"README.md: got no marks, expected {begin} and {end}")
    return "\n".join([f"{head}{begin}", "", *lines, "", f"{end}{tail}"])


def _block(store: Store) -> Iterator[str]:
    """Yield the lines between the marks."""
    splines = _table(store, "convergence/control_points", "map")
    meshes = _table(store, "convergence/elements", "meshes")
    limits = _table(store, "convergence/control_points", "reference")
    uncertain = dict(zip(limits["quantity"], limits["uncertainty"], strict=True))
    yield "| largest error over 0 to 90°, against refined finite elements | trajectory | torque | stiffness |"
    yield "|---|---|---|---|"
    bezier = splines[splines["basis"] == "bezier"]
    paper = bezier[(bezier["measure"] == "spatial") & (bezier["stretch"] == "consistent")]
    yield _errors("spline, 4 control points, as the paper integrates it", paper[paper["control_points"] == 4])
    default = bezier[(bezier["measure"] == "material") & (bezier["stretch"] == "mixed")]
    default = default[default["axial_modes"] == default["control_points"] - 2]
    for n in COUNTS:
        yield _errors(f"spline, {n} control points, locking-free", default[default["control_points"] == n])
    twenty = meshes[(meshes["element"] == "corotational") & (meshes["elements"] == 20)]
    yield _errors("finite elements, 20 a strip, as the paper", twenty)
    cells = " | ".join(f"{uncertain[name]:.0e}" for name in ("trajectory", "torque", "stiffness"))
    yield f"| *uncertainty of the reference* | {cells} |"
    yield ""
    yield from _swings(store)
    yield ""
    yield from _claims(store)


def _swings(store: Store) -> Iterator[str]:
    """Yield the table of the swing after the release: shift of the frequency and error of the rotation."""
    rows = _table(store, "paper/fig06_release", "summary").set_index("formulation")
    limits = _table(store, "paper/fig06_release", "reference").set_index("quantity")["uncertainty"]
    yield "| swing of 0.05 s from 90°, against refined finite elements | frequency | rotation |"
    yield "|---|---|---|"
    for name, label in SWINGS.items():
        row = rows.loc[name]
        yield f"| {label} | {row['frequency_shift']:+.1e} | {row['error_rotation_rad']:.1e} rad |"
    uncertain = f"{limits['frequency']:.0e} | {limits['rotation_rad']:.0e} rad"
    yield f"| *uncertainty of the reference* | {uncertain} |"


def _claims(store: Store) -> Iterator[str]:
    """Yield the table of the paper's claims: one row a claim, one column a formulation."""
    studies = ("paper/fig04_trajectory", "paper/fig05_stiffness", "paper/fig06_release")
    found = pd.concat([_table(store, study, "findings") for study in studies])
    yield "| claim of the paper | " + " | ".join(CLAIMED) + " |"
    yield "|---|" + "---|" * len(CLAIMED)
    for claim, rows in found.groupby("claim", sort=True):
        verdicts = rows.set_index("formulation").to_dict("index")
        cells = (f"{verdicts[name]['holds']} ({_percent(verdicts[name]['value'])})" for name in CLAIMED)
        yield f"| {claim} | " + " | ".join(cells) + " |"


def _table(store: Store, study: str, name: str) -> pd.DataFrame:
    try:
        return store.load_tables(study)[name]
    except FileNotFoundError:
        raise BadInput(f"{study}: got no stored tables, expected those of `make figures`") from None


def _errors(label: str, rows: pd.DataFrame) -> str:
    row = rows.iloc[0]
    cells = (f"{row[f'error_{name}']:.1e}" for name in ("trajectory", "torque", "stiffness"))
    return f"| {label} | " + " | ".join(cells) + " |"


def _percent(value: float) -> str:
    return f"{100.0 * value:.2g} %" if abs(value) < 1.0 else f"{100.0 * value:.0f} %"
