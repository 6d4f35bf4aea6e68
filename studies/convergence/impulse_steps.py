"""Error, drift, energy and time of the sequential impulses against the step, and where their limits lie."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from studies.convergence.impulse_tables import PAPER_STEP, PARTS
from studies.engine.study import Claim, Study, Tables
from studies.record.style import BLUE, GREEN, GREY, ORANGE, RED, page

#: What "stable up to 2 / omega" is read as: the measured limit within this part of it.
NEAR = 0.01
#: Time of the four steps of a picture that an interactive scene can afford [ms].
AFFORDABLE = 1.0
#: Form -> label and look.
FORMS = {
    "printed": ("as printed", RED, "o"),
    "stable": ("stable form", BLUE, "D"),
}
#: Where a legend stands: below its panel, whose curves need all of it.
BENEATH: Any = {"fontsize": 7, "loc": "upper center", "bbox_to_anchor": (0.45, -0.22)}
#: Group of modes -> colour of its limit.
GROUPS = {"axial": ORANGE, "bending": GREEN, "swing": GREY}
#: Column -> label, factor, and the value below which a point is drawn on the edge.
QUANTITIES = {
    "error_rotation_rad": ("error of rotation [deg]", 180.0 / np.pi, 1e-6),
    "drift": ("gap of the clamps / L [1]", 1.0, 1e-16),
    "energy_change": ("|change of energy| [1]", 1.0, 1e-7),
    "motion_s": ("time for the motion [s]", 1.0, 1e-5),
}


def _step_size(tables: Tables) -> Figure:
    """Draw error, drift, energy and time against the step, one column a design."""
    rows = tables["steps"].merge(tables["timings"], on=["design", "form", "step_s"])
    names = list(dict.fromkeys(rows["design"]))
    figure = page(8.8, 9.2)
    panels = figure.subplots(len(QUANTITIES), len(names), sharex=True, sharey="row")
    for column, design in enumerate(names):
        mine = rows[rows["design"] == design]
        limits = tables["limits"].query("design == @design and sweeps == 0").set_index("group")
        for panel, (quantity, (label, factor, least)) in zip(
            panels[:, column], QUANTITIES.items(), strict=True
        ):
            for form, (name, colour, marker) in FORMS.items():
                chosen = mine[mine["form"] == form]
                value = (factor * chosen[quantity].abs()).clip(lower=least)
                panel.loglog(
                    chosen["step_s"], value, color=colour, marker=marker, label=name, markerfacecolor="none"
                )
            _marks(panel, limits["predicted_s"])
            panel.minorticks_off()  # hundreds of marks that say nothing
            if column == 0:
                panel.set_ylabel(label)
        _unstable(panels[0, column], mine)
        panels[0, column].set_title(f"{design}, released from 90°")
        panels[-1, column].set_xlabel("step h [s]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def _marks(panel: Axes, limits: pd.Series) -> None:
    """Mark the limits 2 / omega of the groups and the paper's step."""
    for group, step in limits.items():
        label = f"2/ω, {group} modes" if group != "swing" else "2/ω, rigid swing"
        panel.axvline(float(step), color=GROUPS[str(group)], linestyle="--", linewidth=1.0, label=label)
    panel.axvline(PAPER_STEP, color="#444444", linestyle=":", linewidth=1.2, label="the paper's 1/100 s")


def _unstable(panel: Axes, rows: pd.DataFrame) -> None:
    """Mark along the top the printed steps that blow up."""
    lost = rows[(rows["form"] == "printed") & (rows["status"] != "converged")]["step_s"]
    height = np.full(len(lost), 0.96)
    panel.plot(
        lost, height, "x", color=RED, transform=panel.get_xaxis_transform(), linestyle="",
        label="as printed: blows up", markersize=6,
    )  # fmt: skip


def _limits_and_sweeps(tables: Tables) -> Figure:
    """Draw measured over predicted limits, the error sweep by sweep, and what a sweep leaves."""
    figure = page(9.5, 5.2)
    limit, error, factor = figure.subplots(1, 3)
    _limits(limit, tables["limits"])
    _errors(error, tables["sweeps"])
    _factors(factor, tables["contraction"])
    return figure


def _limits(panel: Axes, rows: pd.DataFrame) -> None:
    low, high = 1e-7, 1.0
    panel.plot([low, high], [low, high], color="#bbbbbb", linewidth=1.0)
    for design, marker in (("Table 1", "o"), ("polymer", "s")):
        for group, colour in GROUPS.items():
            mine = rows[(rows["design"] == design) & (rows["group"] == group)]
            direct = mine[mine["sweeps"] == 0]
            panel.loglog(
                direct["predicted_s"], direct["measured_s"], marker, color=colour, markersize=6,
                label=f"{design}, {group}", linestyle="", markerfacecolor="none",
            )  # fmt: skip
    few = rows[(rows["sweeps"] > 0) & (rows["ratio"] < 0.99)]
    panel.loglog(
        few["predicted_s"], few["measured_s"], "x", color=RED, linestyle="", label="with 1, 2, 3 sweeps only"
    )
    panel.axhline(PAPER_STEP, color="#444444", linestyle=":", linewidth=1.2)
    panel.annotate("the paper's 1/100 s", (low, PAPER_STEP), (4, 3), textcoords="offset points", fontsize=8)
    panel.set(
        xlim=(low, high), ylim=(low, high), xlabel="2/ω of the spectrum [s]", ylabel="measured limit [s]"
    )
    panel.set_title("Limit as printed")
    panel.legend(**BENEATH)


def _errors(panel: Axes, rows: pd.DataFrame) -> None:
    looks = {
        ("printed", "constraints"): ("as printed, by constraint", RED, "-"),
        ("printed", "strips"): ("as printed, by strip", RED, "--"),
        ("stable", "constraints"): ("stable form, by constraint", BLUE, "-"),
        ("stable", "strips"): ("stable form, by strip", BLUE, "--"),
    }
    for (form, impulses), (label, colour, line) in looks.items():
        mine = rows[(rows["form"] == form) & (rows["impulses"] == impulses)]
        mine = mine[mine["step_s"] == mine["step_s"].min()]
        panel.semilogy(
            mine["sweep"], mine["error"].clip(lower=1e-16), line, color=colour, marker=".", label=label
        )
    step = 1e6 * rows["step_s"].min()
    panel.set(xlabel="sweeps", ylabel="error of the velocity change [1]", ylim=(1e-16, 1e3))
    panel.set_title(f"Sweeps, h = {step:.2g} µs")
    panel.legend(**BENEATH)


def _factors(panel: Axes, rows: pd.DataFrame) -> None:
    for impulses, line in (("constraints", "-"), ("strips", "--")):
        for form, (name, colour, marker) in FORMS.items():
            mine = rows[(rows["form"] == form) & (rows["impulses"] == impulses)]
            panel.loglog(
                mine["step_s"], mine["contraction"], line, color=colour, marker=marker,
                markerfacecolor="none", label=f"{name}, by {impulses[:-1]}",
            )  # fmt: skip
    panel.axhline(1.0, color="#444444", linewidth=0.9)
    panel.axvline(PAPER_STEP, color="#444444", linestyle=":", linewidth=1.2)
    panel.set(xlabel="step h [s]", ylabel="error after a sweep over that before [1]")
    panel.set_title("Left by a sweep")
    panel.legend(**BENEATH)


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
    figures={"impulse_step_size": _step_size, "impulse_limits": _limits_and_sweeps},
)
