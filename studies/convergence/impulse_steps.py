"""Error, drift, energy and time of the sequential impulses against the step, and where their limits lie."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.convergence.impulse_tables import PAPER_STEP, PARTS
from studies.engine import Claim, Study, Tables
from studies.record.digits import Digits
from studies.record.marks import Level, Slope
from studies.record.panels import STEP, Axis, Curves, Mark, Panel, sheet
from studies.record.style import BLUE, GREEN, GREY, ORANGE, RED, Look

#: What "stable up to 2 / omega" is read as: the measured limit within this part of it.
NEAR = 0.01
#: Time of the four steps of a picture that an interactive scene can afford [ms].
AFFORDABLE = 1.0
#: Looks of the forms, and lines of what the impulses go by.
FORMS = {
    "printed": Look(label="as printed", colour=RED, marker="o", hollow=True),
    "stable": Look(label="stable form", colour=BLUE, marker="D", hollow=True),
}
IMPULSES = {"constraints": "-", "strips": "--"}
#: Where a legend stands: below its panel, whose curves need all of it.
BENEATH: Any = {"fontsize": 7, "loc": "upper center", "bbox_to_anchor": (0.45, -0.22)}
#: Looks of the groups of modes.
GROUPS = {
    name: Look(label=name, colour=colour, line="", hollow=True)
    for name, colour in {"axial": ORANGE, "bending": GREEN, "swing": GREY}.items()
}
QUANTITIES = (
    Axis("error_rotation_rad", "error of rotation [deg]", factor=180.0 / np.pi, log=True, least=1e-6),
    Axis("drift", "gap of the clamps / L [1]", log=True, least=1e-16),
    Axis("energy_change", "|change of energy| [1]", log=True, least=1e-7),
    Axis("motion_s", "time for the motion [s]", log=True, least=1e-5),
)


def _step_size(tables: Tables) -> Figure:
    """Draw error, drift, energy and time against the step, one column a design."""
    rows = tables["steps"].merge(tables["timings"], on=["design", "form", "step_s"])
    columns, titles = [], []
    for design, mine in rows.groupby("design", sort=False):
        limits = tables["limits"].query("design == @design and sweeps == 0").set_index("group")["predicted_s"]
        marks: list[Mark] = [Curves(mine, FORMS, by="form"), *_marks(limits)]
        panels = [Panel(replace(STEP, label="step h [s]"), y, marks) for y in QUANTITIES]
        lost = mine[(mine["form"] == "printed") & (mine["status"] != "converged")]["step_s"]
        panels[0] = replace(panels[0], marks=[*marks, _Unstable(lost)])
        columns.append(panels)
        titles.append(f"{design}, released from 90°")
    return sheet(8.8, 9.2, list(zip(*columns, strict=True)), columns=titles, legend=4)


def _marks(limits: pd.Series) -> list[Level]:
    """Return marks of the limits 2 / omega of the groups, and of the paper's step."""
    marks = []
    for group, step in limits.items():
        label = f"2/ω, {group} modes" if group != "swing" else "2/ω, rigid swing"
        look = GROUPS[str(group)].colour
        marks.append(Level(float(step), label=label, colour=look, line="--", upright=True))
    return [*marks, Level(PAPER_STEP, label="the paper's 1/100 s", line=":", upright=True)]


@dataclass(frozen=True)
class _Unstable:
    """Marks along the top of a panel at the printed steps that blow up."""

    steps: pd.Series

    def draw(self, panel: Axes, x: Axis, y: Axis) -> None:
        """Draw the marks."""
        panel.plot(
            self.steps, np.full(len(self.steps), 0.96), "x", color=RED, linestyle="", markersize=6,
            transform=panel.get_xaxis_transform(), label="as printed: blows up",
        )  # fmt: skip


def _limits_and_sweeps(tables: Tables) -> Figure:
    """Draw measured over predicted limits, the error sweep by sweep, and what a sweep leaves."""
    panels = [_limits(tables["limits"]), _errors(tables["sweeps"]), _factors(tables["contraction"])]
    return sheet(9.5, 5.2, [panels])


def _limits(rows: pd.DataFrame) -> Panel:
    ends = (1e-7, 1.0)
    looks = {
        (design, group): replace(look, label=f"{design}, {group}", marker=marker)
        for design, marker in (("Table 1", "o"), ("polymer", "s"))
        for group, look in GROUPS.items()
    }
    few = Look(label="with 1, 2, 3 sweeps only", colour=RED, line="", marker="x")
    direct = Curves(rows[rows["sweeps"] == 0], looks, by=("design", "group"), more={"markersize": 6})
    return Panel(
        Axis("predicted_s", "2/ω of the spectrum [s]", log=True, limits=ends),
        Axis("measured_s", "measured limit [s]", log=True, limits=ends),
        (
            direct,
            Curves(rows[(rows["sweeps"] > 0) & (rows["ratio"] < 0.99)], few),
            Slope(through=ends[:1] * 2, power=1, span=ends, label="_", line="-"),
            Level(PAPER_STEP, words="the paper's 1/100 s", line=":"),
        ),
        title="Limit as printed",
        legend=BENEATH,
    )


def _swept_looks() -> dict[tuple[str, str], Look]:
    """Return the looks of the forms by what their impulses go by."""
    return {
        (form, impulses): replace(look, label=f"{look.label}, by {impulses[:-1]}", line=line)
        for impulses, line in IMPULSES.items()
        for form, look in FORMS.items()
    }


def _errors(rows: pd.DataFrame) -> Panel:
    groups = ["form", "impulses"]
    least = rows[rows["step_s"] == rows.groupby(groups)["step_s"].transform("min")]
    label = "error of the velocity change [1]"
    return Panel(
        Axis("sweep", "sweeps"),
        Axis("error", label, log=True, least=1e-16, limits=(1e-16, 1e3)),
        (Curves(least, _swept_looks(), by=groups, more={"marker": "."}),),
        title=f"Sweeps, h = {1e6 * rows['step_s'].min():.2g} µs",
        legend=BENEATH,
    )


def _factors(rows: pd.DataFrame) -> Panel:
    return Panel(
        replace(STEP, label="step h [s]"),
        Axis("contraction", "error after a sweep over that before [1]", log=True),
        (
            Curves(rows, _swept_looks(), by=("form", "impulses")),
            Level(1.0),
            Level(PAPER_STEP, line=":", upright=True),
        ),
        title="Left by a sweep",
        legend=BENEATH,
    )


STUDY = Study(
    parts=PARTS,
    claims=(
        Claim(
            claim=f"The form as printed is stable up to 2/ω (within {100 * NEAR:g} %)",
            formulation="{design}, {group} modes",
            quantity="the measured limit over 2/ω",
            rows=lambda tables: tables["limits"].query("sweeps == 0"),
            value="ratio",
            holds=lambda row: abs(row["ratio"] - 1.0) <= NEAR,
        ),
        Claim(
            claim="Section 4.1: h = 1/100 s",
            formulation="{design}, {group} modes, as printed",
            quantity="h over the limit",
            rows=lambda tables: tables["limits"].query("sweeps == 0"),
            value=lambda row: PAPER_STEP / row["measured_s"],
            most=1.0,
        ),
        Claim(
            claim="The stable form gains no energy at any step up to 1/100 s",
            formulation="{design}",
            quantity="the largest gain",
            rows=lambda tables: (
                tables["steps"]
                .query("form == 'stable'")
                .groupby("design", as_index=False)
                .agg(gain=("energy_gain", "max"), whole=("status", lambda each: (each == "converged").all()))
            ),
            value="gain",
            holds=lambda row: row["whole"] and row["gain"] <= 1e-12,
        ),
    ),
    claims_of_time=(
        Claim(
            claim=f"Four steps take at most {AFFORDABLE:g} ms at the 95th percentile",
            formulation="{design}, n = {control_points}, h = {step_s:g} s",
            quantity="the 95th percentile of the processor's time over it",
            rows=lambda tables: tables["timings_of_pictures"],
            value=lambda row: row["cpu_95_ms"] / AFFORDABLE,
            most=1.0,
        ),
    ),
    digits={"contraction": Digits(relative=1e-3)},
    figures={"impulse_step_size": _step_size, "impulse_limits": _limits_and_sweeps},
)
