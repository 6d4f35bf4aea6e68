"""Steps from 1e-7 to 1e-2 s: no gain of energy, second order, and a warning where a step is too long."""

import math
from collections.abc import Mapping
from functools import cache
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_release
from studies.answers.metrics import observed_order
from studies.answers.motion import Motion
from studies.cases.problem import named_case
from studies.engine.study import Answer, Part
from studies.record.style import BLACK, BLUE, ORANGE, RED, page
from studies.stability import family, maps, swings

STEPS = (1e-7, 1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)
STARTS = (10, 45, 90, 135)
#: One swing of Table 1 from 90 degrees [s], over which the rotation is compared.
SWING = 0.012
#: Steps of a motion: at least, so that energy could drift; at most, so that the finest end in seconds.
FEWEST, MOST = 15, 1200

#: Steps of the table of orders and of its limit [s], and the duration of its motions [s].
ORDER_STEPS = (8e-4, 4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6, 3.125e-6)
LIMIT_STEP, ORDER_DURATION = 5e-7, 0.004


@cache
def _reference(degrees: float) -> Motion:
    """Return the refined swing from a rotation."""
    return swings.refined_swing(named_case(family.CASE), start=math.radians(degrees), duration=SWING)


def _settled(degrees: float) -> Answer:
    """Return how far a coarser and an independent swing are from the reference."""
    given = named_case(family.CASE)
    known: dict[str, Any] = {"start": math.radians(degrees), "duration": SWING}
    coarser = swings.refined_swing(given, **known, step=5e-6)
    other = answer_release(given, swings.INDEPENDENT, records=swings.RECORDS, **known)  # at their own step
    gap = swings.rotation_error(other, _reference(degrees))
    return {
        "references": {
            "case": f"from {degrees} deg",
            "refinement": swings.rotation_error(coarser, _reference(degrees)),
            "independent": gap,
            "settled": "yes" if gap < swings.TOLERANCE / 5.0 else "no",
        }
    }


def _outcomes_of(degrees: float, step: float) -> Answer:
    """Return the outcomes of all models at a step, with the gain of energy."""
    duration = min(max(round(SWING / step), FEWEST), MOST) * step
    known = {"start": math.radians(degrees), "duration": duration, "step": step}
    rows = []
    for name in swings.SWINGING:
        verdict = swings.judged_swing(name, named_case(family.CASE), _reference(degrees), **known)
        place = {"case": f"from {degrees} deg, {step:g} s", "x": step, "y": degrees, "model": name}
        rows.append({**place, **verdict})
    return {"outcomes": rows}


def order_table() -> pd.DataFrame:
    """Return error and observed order of the default against the step, from 90 degrees, for one spline."""
    problem, default = named_case(family.CASE), family.COLUMNS[family.DEFAULT]

    def swing(step: float) -> Motion:
        return answer_release(problem, default, duration=ORDER_DURATION, step=step, records=5)

    limit = swing(LIMIT_STEP).rotation
    answers = [swing(step) for step in ORDER_STEPS]
    errors = [float(np.abs(answer.rotation - limit).max()) for answer in answers]
    orders = [math.nan, *(observed_order(a, b) for a, b in pairwise(errors))]
    return pd.DataFrame(
        {
            "step_s": ORDER_STEPS,
            "error_rad": errors,
            "order": orders,
            "resolved": ["no" if answer.resolution else "yes" for answer in answers],
        }
    )


def _order_figure(tables: Mapping[str, pd.DataFrame]) -> Figure:
    figure = page(7.6, 3.2)
    left, right = figure.subplots(1, 2)
    order = tables["order"].sort_values("step_s")
    for resolved, colour, label in (("yes", BLUE, "resolved"), ("no", ORANGE, "said to be unresolved")):
        some = order[order["resolved"] == resolved]
        left.loglog(some["step_s"], some["error_rad"], "o", color=colour, label=label)
    slope = order["error_rad"].iloc[2] * (order["step_s"] / order["step_s"].iloc[2]) ** 2
    left.loglog(order["step_s"], slope, "--", color=BLACK, linewidth=0.9, label="order 2")
    left.set(xlabel="step [s]", ylabel="error of the rotation [rad]", title=f"{family.DEFAULT}, from 90°")
    left.legend(loc="upper left")
    mine = tables["outcomes"].query("model == @family.DEFAULT")
    for degrees, marker in zip(STARTS, "ovsD", strict=True):
        some = mine[mine["y"] == degrees].sort_values("x")
        right.loglog(some["x"], some["energy_gain"].clip(1e-17), marker + "-", label=f"from {degrees}°")
    right.axhline(1e-8, color=RED, linewidth=0.9)
    right.set(xlabel="step [s]", ylabel="gain of energy over that of the start [1]", ylim=(1e-17, 1e-6))
    right.legend(loc="upper left", ncols=2)
    return figure


STUDY = family.study(
    Part(at=lambda: STARTS, ask=_settled),
    Part(at=lambda: product(STARTS, STEPS), ask=_outcomes_of),
    Part(ask=lambda: {"order": order_table()}),
    figures={
        "stability_step_size": lambda tables: maps.outcome_map(
            tables["outcomes"],
            title="Release of Table 1: rotation of the first swing within 5 %, no gain of energy",
            xlabel="step [s]",
            ylabel="rotation at the release [deg]",
            xscale="log",
            xlim=(5e-8, 2e-2),
            ylim=(0.0, 145.0),
            xticks=(1e-7, 1e-5, 1e-3),
            xticklabels=("1e-7", "1e-5", "1e-3"),
            yticks=list(STARTS),
        ),
        "stability_step_order": _order_figure,
    },
)
