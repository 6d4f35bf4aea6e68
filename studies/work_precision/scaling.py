"""Cost of one Newton iteration over the number of control points: counted, timed and drawn."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.findings import Tables
from studies.engine.study import Answer
from studies.record.style import BLUE, GREEN, page
from studies.work_precision.work import work_of

CASE = "cross_axis_pivot"
#: Basis -> control points; the range from which the exponent is taken.
COUNTS = {"bezier": (4, 6, 8, 12, 16, 20, 24), "bspline": (8, 12, 16, 24, 32, 48, 64)}
#: Increments of the path that is timed, and how often it is.
INCREMENTS, REPEAT = 20, 7


def points() -> list[tuple[str, int]]:
    """Return bases and control points."""
    return [(basis, n) for basis, counts in COUNTS.items() for n in counts]


def iteration(basis: str, n: int) -> Answer:
    """Return scaling (unknowns, evaluations, flops of one) and scaling_of_time."""
    settings = SplineSettings(control_points=n, basis=basis)
    answer = answer_static(named_case(CASE), settings, repeat=REPEAT)
    work, evaluations = work_of(settings, answer.counters), answer.counters["factorisations"]
    row = {"basis": basis, "control_points": n}
    counted = {
        "status": answer.status,
        "unknowns": work.unknowns,
        "evaluations": evaluations,
        "assembly_flops": work.assembly_flops,
        "factorisation_flops": work.factorisation_flops,
    }
    timed = {"iteration_s": answer.solve_s / evaluations, "solve_s": answer.solve_s}
    return {"scaling": row | counted, "scaling_of_time": row | timed}


def _of_basis(table: pd.DataFrame, basis: str) -> pd.DataFrame:
    """Return the rows of one basis, sorted by count."""
    return table[table["basis"] == basis].sort_values("control_points")


def exponents(tables: Tables) -> dict[str, float]:
    """Return p of time ~ n^p of one iteration by least squares for each basis, beyond the smallest counts."""
    found = {}
    for basis, least in {"bezier": 8, "bspline": 16}.items():
        rows = _of_basis(tables["scaling_of_time"], basis)
        used = rows[rows["control_points"] >= least]
        found[basis] = float(np.polyfit(np.log(used["control_points"]), np.log(used["iteration_s"]), 1)[0])
    return found


def figure(tables: Tables) -> Figure:
    """Draw time and counted work of one Newton iteration over the control points."""
    drawn = page(9.5, 3.8)
    timed, counted = drawn.subplots(1, 2)
    styles = {
        "bezier": ("Bézier curve, condensed", BLUE, "x-"),
        "bspline": ("cubic B-spline, sparse from n = 24 on", GREEN, "o-."),
    }
    for basis, (label, colour, line) in styles.items():
        times, flops = (_of_basis(tables[name], basis) for name in ("scaling_of_time", "scaling"))
        n = times["control_points"].to_numpy(float)
        timed.loglog(n, 1e6 * times["iteration_s"], line, color=colour, label=label)
        total = flops["assembly_flops"] + flops["factorisation_flops"]
        counted.loglog(n, total, line, color=colour, label=label)
    counts = sorted(set(tables["scaling"]["control_points"]))
    for panel in (timed, counted):
        _slope(panel, counts[0], counts[-1])
        panel.set_xlabel("control points a strip, n")
        panel.set_xticks(counts, labels=[str(each) for each in counts])
        panel.minorticks_off()
    timed.set_ylabel("time of one iteration [µs]")
    counted.set_ylabel("operations of one iteration [1]")
    timed.legend()
    return drawn


def _slope(panel: Axes, first: int, last: int) -> None:
    """Draw lines of slope 1 and 3 from the lower left, within the panel."""
    low, high = panel.get_ylim()
    for power, line in ((1, ":"), (3, "--")):
        n = np.array([first, min(last, first * (high / low) ** (1.0 / power))])
        panel.plot(n, low * (n / first) ** power, line, color="#888888", linewidth=0.9, label=f"n^{power}")
    panel.set_ylim(low, high)
