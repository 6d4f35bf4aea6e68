"""Where the steps of the sequential impulses as printed have their limit, against the spectrum."""

from dataclasses import replace
from itertools import product
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from spline_model.mechanism import Mechanism
from spline_model.sequential_impulse import solve_impulses, stability_limit
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_moments
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.record.panels import MARK, Axis, Curves, Level, Panel, sheet
from studies.record.style import GREEN, GREY, ORANGE, Look

#: Group of modes -> settings of a spline whose fastest mode belongs to it: strips that stretch, strips that
#: only bend, and strips whose shape follows the body, so that nothing but the swing is left.
GROUPS: dict[str, SplineSettings] = {
    "axial": SplineSettings(control_points=6),
    "bending": SplineSettings(control_points=5, axial_modes=4, stretch="inextensible", penalty_stiffness=0.0),
    "swing": SplineSettings(control_points=4, axial_modes=3, stretch="inextensible", penalty_stiffness=0.0),
}
#: Looks of designs and groups of modes.
LOOKS = {
    (design, group): Look(label=f"{design}, {group}", colour=colour, line="", marker=marker, hollow=True)
    for design, marker in (("Table 1", "o"), ("polymer", "s"))
    for group, colour in zip(GROUPS, (ORANGE, GREEN, GREY), strict=True)
}
EQUAL = Look(label="_equal", colour=MARK)

#: The paper's step [s].
PAPER_STEP = 0.01
#: What "stable up to 2 / omega" is read as: the measured limit within this part of it.
NEAR = 0.01
#: Rotation of the swing whose stability is tried [rad], steps of a trial [1] and end of the bisection [1].
SMALL, TRIAL, BRACKET = 1e-4, 2000, 2e-4


def _designs() -> dict[str, Problem]:
    """Return Table 1, and the same pivot with strips of a polymer, 10 mm x 0.8 mm, and a small body."""
    given = named_case()
    polymer = replace(
        given,
        **of_moments(8e-6, 1e-2 * 8e-4**3 / 12.0),
        youngs_modulus=2e9,
        density=1100.0,
        body_mass=0.05,
        body_moment_of_inertia=2e-5,
    )
    return {"Table 1": given, "polymer": polymer}


def _limit(design: str, group: str) -> Answer:
    """Return the largest step at which a small swing of the printed form stays bounded, by bisection.

    Columns: predicted_s = 2 / omega of the highest frequency at rest, measured_s, ratio.
    """
    pivot: Mechanism = put(_designs()[design], GROUPS[group], moving=True).modelled
    predicted = stability_limit(pivot)
    how: dict[str, Any] = {"start": SMALL, "form": "published", "records": 1}
    low, high = 0.0, 1.5
    while high - low > BRACKET:
        middle = 0.5 * (low + high)
        step = middle * predicted
        run = solve_impulses(pivot, duration=TRIAL * step, step=step, **how)
        low, high = (middle, high) if run.status.value == "converged" else (low, middle)
    ratio = 0.5 * (low + high)
    measured = {"predicted_s": predicted, "measured_s": ratio * predicted, "ratio": ratio}
    return {"limits": {"design": design, "group": group, **measured}}


def _figure(tables: Tables) -> Figure:
    """Draw measured over predicted limits."""
    ends = (1e-7, 1.0)
    panel = Panel(
        Axis("predicted_s", "2/ω of the spectrum [s]", log=True, limits=ends),
        Axis("measured_s", "measured limit as printed [s]", log=True, limits=ends),
        (
            Curves(tables["limits"], LOOKS, by=("design", "group"), more={"markersize": 6}),
            Curves(pd.DataFrame({"predicted_s": ends, "measured_s": ends}), EQUAL),
            Level(PAPER_STEP, words="the paper's 1/100 s", line=":"),
        ),
    )
    return sheet(6.3, 4.4, [[panel]], legend=3)


STUDY = Study(
    parts=(Part(at=lambda: product(_designs(), GROUPS), ask=_limit),),
    claims=(
        Claim(
            claim=f"The form as printed is stable up to 2/ω (within {100 * NEAR:g} %)",
            formulation="{design}, {group} modes",
            quantity="the measured limit over 2/ω",
            rows=lambda tables: tables["limits"],
            value="ratio",
            holds=lambda row: abs(row["ratio"] - 1.0) <= NEAR,
        ),
        Claim(
            claim="Section 4.1: h = 1/100 s",
            formulation="{design}, {group} modes, as printed",
            quantity="h over the limit",
            rows=lambda tables: tables["limits"],
            value=lambda row: PAPER_STEP / row["measured_s"],
            most=1.0,
        ),
    ),
    figures={"impulse_limits": _figure},
)
