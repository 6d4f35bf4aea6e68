"""What a digit costs: the tables of docs/findings.md made from the work-precision studies."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import pandas as pd

#: Series in the order of the columns, with their labels.
STATICS = {
    "spline": "spline",
    "exudyn exact": "Exudyn, exact beam",
    "exudyn ancf": "Exudyn, ANCF cable",
    "openseespy frame": "OpenSees",
    "finite elements": "finite elements",
    "four-bar": "pseudo-rigid",
}
DYNAMICS = {
    "spline": "spline",
    "spline, energy-consistent": "spline, large implicit steps",
    "exudyn ancf": "Exudyn, ANCF cable",
    "openseespy frame": "OpenSees",
    "finite elements": "finite elements",
}


def digits(statics: pd.DataFrame, dynamics: pd.DataFrame) -> Iterator[str]:
    """Yield both tables: rows of errors, columns of models.

    Args:
        statics, dynamics: `digits_of_time` of either study.
    """
    yield "| error of path and torque, 0 to 90° |" + _head(STATICS, statics)
    yield from _rows(statics, STATICS, lambda target: f"{target:.0e}")
    yield ""
    yield "| error of the rotation, 0.05 s of swing |" + _head(DYNAMICS, dynamics)
    yield from _rows(dynamics, DYNAMICS, lambda target: f"{target:g} rad")


def _columns(labels: Mapping[str, str], found: pd.DataFrame) -> list[str]:
    """Return the series that were solved: a code that is not installed has no column."""
    solved = set(found["series"])
    return [name for name in labels if name in solved]


def _head(labels: Mapping[str, str], found: pd.DataFrame) -> str:
    names = [labels[name] for name in _columns(labels, found)]
    return " " + " | ".join(names) + " |\n|---|" + "---|" * len(names)


def _rows(found: pd.DataFrame, labels: Mapping[str, str], shown: Callable[[float], str]) -> Iterator[str]:
    for target in sorted(set(found["target"]), reverse=True):
        rows = found[found["target"] == target].set_index("series").to_dict("index")
        cells = [_cell(rows[name], name == next(iter(labels))) for name in _columns(labels, found)]
        yield f"| {shown(target)} | " + " | ".join(cells) + " |"


def _cell(row: Mapping[str, Any], first: bool) -> str:
    """Return setting and time, and of the others how many times that of the first."""
    if pd.isna(row["solve_s"]):
        return "–"
    time = _time(float(row["solve_s"]))
    ratio = "" if first or pd.isna(row["ratio"]) else f" (× {_rounded(float(row['ratio']))})"
    return f"{row['setting']}: {time}{ratio}"


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.2g} ms" if seconds < 0.1 else f"{seconds:.2g} s"


def _rounded(ratio: float) -> str:
    return f"{ratio:.2g}" if ratio < 100.0 else f"{float(f'{ratio:.2g}'):.0f}"
