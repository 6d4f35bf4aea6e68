"""What accuracy costs in statics: error of the paper's path against time and against counted work.

Every model solves the path of Table 1 to 90 degrees in 20 increments, on one thread. The residual of a solved
state is below 1e-11 in the splines and 1e-10 in the elements, in EI/L^2; the other codes' own tolerance is
set so that it does not show. Each is held against the limit of its own theory (see `limits`), and the
distance of the theories is stated. Time is that of the increments alone (`solve_s`), the median of repeats;
work is counted from sizes (see `work`).
"""

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_release, answer_static
from studies.answers.reference import QUANTITIES
from studies.answers.settings import FeSettings, SplineSettings
from studies.baselines.compared import missing
from studies.baselines.own import spline
from studies.baselines.variant import Variant
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.record.marks import Slope
from studies.record.panels import CONTROL_POINTS, Axis, Curves, Panel, sheet
from studies.record.style import BASES, BLUE, GREEN, Look
from studies.work_precision.equal_error import diagram, digits, finer, joined, less
from studies.work_precision.limits import THEORIES, Limit, counted, limit_of_theory, path_errors
from studies.work_precision.series import ELEMENTS, LOOKS, SPLINE, other_paths, own_paths
from studies.work_precision.work import ELEMENT_FORCES, STRIPS, WORK, work_of

ERRORS = ("error_trajectory", "error_torque")
#: Errors at which models are compared.
TARGETS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)

#: Powers of the control points that work is held to, and their lines.
POWERS = ((1, ":"), (3, "--"))

#: Errors at which the two models are compared, and how it is said.
COMPARED = (1e-3, 1e-4, 1e-6)
AT_EQUAL = "At an error of {target:g} in path and torque"

#: Elements of the compiled motion from which the speed of compiled elements is taken.
COMPILED_ELEMENTS = 20

#: Basis -> control points; the range from which the exponent is taken.
COUNTS = {"bezier": (4, 6, 8, 12, 16, 20, 24), "bspline": (8, 12, 16, 24, 32, 48, 64)}
#: How often the path is timed, and that of a spline among others.
REPEAT, SPLINE_REPEAT = 7, 15


def _solved(variant: Variant) -> Answer:
    """Return errors over the path and at its end, those of the reference, work, and times of a setting."""
    repeat = SPLINE_REPEAT if variant.baseline is spline else REPEAT
    path, exact = variant.path(named_case(), repeat), _limit(variant.theory)
    name = {"series": variant.series, "setting": variant.setting}
    errors = {
        "series": variant.series,
        "family": variant.family,
        "setting": variant.setting,
        "count": variant.count,
        "theory": variant.theory,
        "status": path.status,
        **path_errors(path, exact.path),
        **{f"reference_{each}": exact.uncertainty[each] for each in QUANTITIES},
        **counted(WORK, path.work),
        "message": path.message,
    }
    times = {"solve_s": path.solve_s, "wall_s": path.wall_s, "repeats": repeat}
    return {"errors": errors, "timings": name | times}


@cache
def _limit(theory: str) -> Limit:
    """Return what settings of a theory are held against."""
    return limit_of_theory(named_case(), theory)


def _reference(theory: str) -> list[dict[str, Any]]:
    """Return a limit's uncertainty, and how far it is from the material one."""
    found = _limit(theory)
    apart = path_errors(found.path, _limit("material").path)
    return [
        {
            "theory": theory,
            "quantity": name,
            "uncertainty": found.uncertainty[name],
            "distance_to_material": apart[f"error_{name}"] if theory != "material" else math.nan,
            "source": found.source,
        }
        for name in QUANTITIES
    ]


def _language(tables: Tables) -> pd.DataFrame:
    """Return how much of the elements' time is the language: a row a setting of splines and elements.

    A time is work over speed: seconds = operations / (operations a second). So the ratio of two times is
    the ratio of their work, which is the method's, times the ratio of their speeds, which is the language's
    and the machine's. Three speeds are measured in the same run:

    - of the splines' compiled path, from its counted operations and its time;
    - of the elements' path, which is Python around numpy and a sparse solver, in the same way;
    - of the elements when compiled: their explicit motion evaluates the same element's forces in compiled
      code.

    The elements' path at the speed of their own compiled loop is what they would take in a compiled language;
    the fixed cost of calls, which has no operations, is language too.

    Columns: series, setting, flops, solve_s, flops_per_s, compiled_s (time at the speed of compiled elements;
    for splines their own), python_share (what is left of the time; 0 for splines).
    """
    rows = joined(tables)
    rows = rows[rows["series"].isin([SPLINE, ELEMENTS])]
    found = rows[["series", "setting", "flops", "solve_s"]].copy()
    found["flops_per_s"] = found["flops"] / found["solve_s"]
    own = found["series"] == SPLINE
    found["compiled_s"] = np.where(own, found["solve_s"], found["flops"] / _compiled_speed())
    found["python_share"] = 1.0 - found["compiled_s"] / found["solve_s"]
    return found


def _compiled_speed() -> float:
    """Return the operations a second of the elements' compiled loop [1/s].

    The loop also moves the nodes, which is not counted: the speed is a little more than what is returned.
    """
    motion = answer_release(
        named_case(), FeSettings(elements=COMPILED_ELEMENTS), duration=2e-3, records=10, repeat=5
    )
    elements = motion.counters["force_evaluations"] * STRIPS * COMPILED_ELEMENTS
    return elements * ELEMENT_FORCES / motion.solve_s


def _twenty(tables: Tables) -> pd.DataFrame:
    """Return how much of the time of twenty elements is the language."""
    return tables["language"].query("series == @ELEMENTS and setting == '20 elements'")


def _growth(tables: Tables) -> list[dict[str, Any]]:
    """Return p of time ~ n^p of one iteration by least squares for each basis, beyond the smallest counts."""
    asked = {"bezier": (8, "no faster than n^3", 3.0), "bspline": (16, "about linearly, up to n = 64", 1.25)}
    found = []
    for basis, (least, grows, most) in asked.items():
        rows = _of_basis(tables["scaling_of_time"], basis)
        used = np.log(rows[rows["control_points"] >= least][["control_points", "iteration_s"]])
        power = float(np.polyfit(used["control_points"], used["iteration_s"], 1)[0])
        found.append({"basis": BASES[basis], "power": power, "grows": grows, "most": most})
    return found


def _iterations_asked() -> list[tuple[str, int]]:
    """Return bases and control points."""
    return [(basis, n) for basis, counts in COUNTS.items() for n in counts]


def _iteration(basis: str, n: int) -> Answer:
    """Return scaling (unknowns, evaluations, flops of one) and scaling_of_time."""
    settings = SplineSettings(control_points=n, basis=basis)
    answer = answer_static(named_case(), settings, repeat=REPEAT)
    work, evaluations = work_of(settings, answer.counters), answer.counters["factorisations"]
    row = {"basis": basis, "control_points": n}
    counted = {
        "status": answer.status,
        "unknowns": work["unknowns"],
        "evaluations": evaluations,
        "assembly_flops": work["assembly_flops"],
        "factorisation_flops": work["factorisation_flops"],
    }
    timed = {"iteration_s": answer.solve_s / evaluations, "solve_s": answer.solve_s}
    return {"scaling": row | counted, "scaling_of_time": row | timed}


def _of_basis(table: pd.DataFrame, basis: str) -> pd.DataFrame:
    """Return the rows of one basis, sorted by count."""
    return table[table["basis"] == basis].sort_values("control_points")


def _scaling_figure(tables: Tables) -> Figure:
    """Draw time and counted work of one Newton iteration over the control points."""
    looks = {
        "bezier": Look(label="Bézier curve, condensed", colour=BLUE, marker="x"),
        "bspline": Look(label="cubic B-spline, sparse from n = 24 on", colour=GREEN, line="-.", marker="o"),
    }
    timed, counted = tables["scaling_of_time"], tables["scaling"]
    counted = counted.assign(flops=counted["assembly_flops"] + counted["factorisation_flops"])
    time = Axis("iteration_s", "time of one iteration [µs]", factor=1e6, log=True)
    work = Axis("flops", "operations of one iteration [1]", log=True)
    panels = []
    for rows, y in ((timed, time), (counted, work)):
        x, span = (
            replace(CONTROL_POINTS, log=True),
            (rows["control_points"].min(), rows["control_points"].max()),
        )
        start = (span[0], 0.8 * y.of(rows).min())
        slopes = [Slope(through=start, power=p, span=span, label=f"n^{p}", line=line) for p, line in POWERS]
        panels.append(Panel(x, y, (Curves(rows, looks, by="basis"), *slopes)))
    return sheet(9.5, 3.8, [panels], legend=4)


STUDY = Study(
    parts=(
        Part(at=lambda: THEORIES, ask=lambda theory: {"reference": _reference(theory)}),
        Part(at=lambda: [*own_paths(), *other_paths()], ask=_solved, alone=True),
        Part(at=_iterations_asked, ask=_iteration, alone=True),
    ),
    made=digits(ERRORS, "count", TARGETS) | {"language": _language},
    claims=(
        less("counted work", "digits", AT_EQUAL, COMPARED),
        finer(
            "The reference of the {quantity} is ten times finer than every error",
            "{theory} theory",
            within=("theory",),
        ),
    ),
    claims_of_time=(
        less("time", "digits_of_time", AT_EQUAL, COMPARED),
        Claim(
            claim="The path on 20 elements takes less than 0.4 s",
            formulation="{setting}",
            quantity="its time over 0.4 s",
            rows=_twenty,
            value=lambda row: row["solve_s"] / 0.4,
            holds=lambda row: row["solve_s"] < 0.4,
        ),
        Claim(
            claim="Most of the elements' time is Python",
            formulation="{setting}",
            quantity="the share of the time that compiled elements would not take",
            rows=_twenty,
            value="python_share",
            holds=lambda row: row["python_share"] > 0.5,
        ),
        Claim(
            claim="The time of one iteration grows {grows}",
            formulation="{basis}",
            quantity="the observed exponent over the largest allowed one",
            rows=_growth,
            value=lambda row: row["power"] / row["most"],
            holds=lambda row: row["power"] <= row["most"],
        ),
    ),
    varying=("language",),
    figures={
        "work_precision_statics": lambda tables: diagram(
            tables,
            {name: f"error of the {name} [1]" for name in ("trajectory", "torque", "stiffness")},
            rank="count",
            styles=LOOKS,
            part="increments",
        ),
        "work_precision_scaling": _scaling_figure,
    },
    missing=missing,
)
