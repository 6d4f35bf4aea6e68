"""What each effect is worth for four designs, and what inextensible and massless strips save."""

import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_modes
from studies.answers.settings import SplineSettings
from studies.cases.design import named_design
from studies.cases.problem import TABLE_1, Problem, named_case
from studies.effects.audit import audit
from studies.effects.beyond import ALL, SHEAR, prices
from studies.effects.scenes import CHANGES, SIZES, Variant, size_of
from studies.engine import Answer, Claim, Part, Study, Tables, records
from studies.record.digits import Digits
from studies.record.marks import Level, Slope, Words
from studies.record.panels import CONTROL_POINTS, Axis, Curves, Mark, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, RED, Look

SETTINGS = SplineSettings(control_points=6)
TOLERANCE = 1e-3

#: Control points for which the highest frequency is taken with and without stretching.
COUNTS = range(4, 9)
#: Mass of the body, and with it its moment of inertia, over that of Table 1.
MASSES = np.geomspace(0.03, 30.0, 13)

#: Designs for which what planar beams leave out is priced, by their cases; sized ones are in `design/sizing`.
PRICED = {
    "Table 1": TABLE_1,
    "spring steel": "spring_steel_pivot",
    "titanium": "titanium_pivot",
    "large steel": "large_steel_pivot",
    "silicon": "silicon_pivot",
    "polymer": "polymer_pivot",
    "living hinge": "living_hinge",
    "four-bar linkage": "four_bar_of_flexures",
}

STRETCHING, INERTIA = "stretching", "strip_inertia"
#: Scenes whose strips cannot stretch, or have no mass.
SIMPLER = ("inextensible strips", "massless strips")

WORTH = ("design", "scene", "dropped", "status", *CHANGES, "largest", *SIZES, "reason")
#: Looks of the changes.
SHOWN = {
    "trajectory": Look(label="path", colour=BLACK, line="", marker="o", hollow=True),
    "torque": Look(label="torque", colour=ORANGE, line="", marker="s", hollow=True),
    "swing_frequency": Look(label="frequency of the swing", colour=BLUE, line="", marker="D", hollow=True),
    "first_mode": Look(label="first mode at rest", colour=GREEN, line="", marker="x"),
}
#: Changes below the first of these are drawn on the edge; the last is the other edge.
LEAST, MOST = 1e-7, 30.0
CHANGE = Axis("change", "|change| [1]", log=True, least=LEAST, limits=(LEAST, MOST), ticks=(1e-6, 1e-3, 1.0))


def _designs() -> dict[str, Problem]:
    """Return the four designs: Table 1, ten times more slender, with a heavy and with a light body."""
    given = named_case()
    return {
        "Table 1": given,
        "ten times more slender": replace(
            given, area=given.area / 10.0, second_moment_of_area=given.second_moment_of_area / 1000.0
        ),
        "body ten times heavier": _with_body(given, 10.0),
        "body ten times lighter": _with_body(given, 0.1),
    }


def _audited(name: str) -> Answer:
    """Return the worth of a design's effects (a row a scene: changes, size, or why there is no answer), the
    times (of the full scene over the scene's) and the cheapest scene."""
    found = audit(_designs()[name], SETTINGS, TOLERANCE)
    full, *rows = ({"design": name, **found.row(each)} for each in (found.full, *found.rows))
    best = found.row(found.cheapest) | {"design": name, "tolerance": found.tolerance}
    timed = best | {"scene": "cheapest", "time_ratio": found.ratio, "wall_s": found.seconds[1]}
    return {
        "worth": _columns(WORTH, [row | {"dropped": row["dropped"][0]} for row in rows]),
        "timings": _columns(("design", "scene", "time_ratio", "wall_s"), [full, *rows, timed]),
        "cheapest": _columns(
            ("design", "tolerance", "scene", "effects", "largest"),
            [best | {"effects": " ".join(best["effects"])}],
        ),
    }


def _columns(names: Iterable[str], rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return these columns of rows."""
    return [{name: row[name] for name in names} for row in rows]


def _with_body(problem: Problem, factor: float) -> Problem:
    return replace(
        problem,
        body_mass=problem.body_mass * factor,
        body_moment_of_inertia=problem.body_moment_of_inertia * factor,
    )


def _steps(control_points: int) -> list[dict[str, Any]]:
    """Return highest frequency and explicit step with and without stretching, at rest and at the release."""
    problem = named_case()
    full = Variant(dropped=(), effects=problem.effects)
    rows = []
    for variant in (full, full.without([STRETCHING])):
        size = size_of(variant.of(problem), SplineSettings(control_points=control_points))
        rows.append(
            {
                "control_points": control_points,
                "stretching": "yes" if STRETCHING in variant.effects.names else "no",
                **{name: size[name] for name in SIZES[1:]},
            }
        )
    return rows


def _massless(factor: float) -> dict[str, Any]:
    """Return the shift of the first mode by massless strips under a body of `factor` times the given mass."""
    problem = _with_body(named_case(), factor)
    full = Variant(dropped=(), effects=problem.effects)
    massive, massless = (
        answer_modes(variant.of(problem), SETTINGS, count=1).frequency[0]
        for variant in (full, full.without([INERTIA]))
    )
    strips = 2.0 * problem.density * problem.area * problem.length
    return {
        "mass_ratio": strips / problem.body_mass,
        "first_mode_Hz": massive,
        "massless_Hz": massless,
        "shift": massless / massive - 1.0,
    }


def _cheapest(tables: Tables) -> pd.DataFrame:
    """Return the cheapest scene of each design with its time, which differs run by run."""
    timed = tables["timings"].query("scene == 'cheapest'")[["design", "time_ratio"]]
    return tables["cheapest"].merge(timed, on="design")


def _gains(tables: Tables) -> list[dict[str, Any]]:
    """Return how many times longer the explicit step is without stretching, a row a count."""
    wide = tables["steps"].pivot(index="control_points", columns="stretching", values="explicit_step_s")
    return [{"n": n, "gain": float(row["no"] / row["yes"])} for n, row in wide.iterrows()]


def _exponent(tables: Tables) -> list[dict[str, Any]]:
    """Return how far the exponent of the shift by massless strips over the mass ratio is from one."""
    shift = tables["mass_ratio"].sort_values("mass_ratio")
    order = np.polyfit(np.log(shift["mass_ratio"]), np.log(shift["shift"].abs()), 1)[0]
    return [{"distance": abs(float(order) - 1.0)}]


def _worth(tables: Tables) -> Figure:
    """Draw the changes by every effect, one panel a design."""
    rows = tables["worth"].query("status != 'refused'")
    largest = rows.set_index("scene")[list(SHOWN)].abs().groupby("scene").max().max(axis=1)
    order = list(largest.sort_values(ascending=False).index)
    times = tables["timings"].set_index(["design", "scene"])["time_ratio"]
    panels = []
    for design in _designs():
        mine = rows[rows["design"] == design]
        changes = mine.melt(id_vars="scene", value_vars=list(SHOWN), var_name="what", value_name="change")
        curves = Curves(changes, SHOWN, by="what", more={"markersize": 5.5, "clip_on": False})
        words = _times(mine, times[design], order)
        marks: list[Mark] = [curves, Level(TOLERANCE, colour=RED, upright=True), *words]
        y = Axis("scene", "", names=order)
        panels.append(Panel(CHANGE, y, marks, title=textwrap.fill(design, 16)))
    title = f"Change by leaving out one effect of the full scene; line: {TOLERANCE:g}; left edge: no more"
    return sheet(9.5, 3.9, [panels], title=title, legend=len(SHOWN))


def _times(rows: pd.DataFrame, ratios: pd.Series, order: Sequence[str]) -> Iterator[Words]:
    """Yield how many times faster every scene is, or what there is of it without a motion."""
    for row in records(rows):
        ratio = float(ratios[row["scene"]])
        alone = "motion stops" if row["status"] == "not_converged" else "no motion"
        text = f"time x {1.0 / ratio:.2g}" if np.isfinite(ratio) else alone
        place = (MOST, order.index(row["scene"]))
        yield Words(text, place, by=(-2, 7), colour="#666666", side="right")


def _savings(tables: Tables) -> Figure:
    """Draw highest frequency and explicit step without stretching, and the shift by massless strips."""
    looks = {
        "yes": Look(label="stretching", colour=BLUE, marker="o"),
        "no": Look(label="inextensible", colour=ORANGE, marker="o"),
    }
    steps = (Curves(tables["steps"], looks, by="stretching"),)
    frequency = Axis("highest_frequency_Hz", "highest frequency [kHz]", factor=1e-3, log=True)
    step = Axis("explicit_step_s", "largest stable explicit step [µs]", factor=1e6, log=True)
    rows = tables["mass_ratio"].sort_values("mass_ratio")
    ratio, shift = rows["mass_ratio"], Axis("shift", "shift of the first mode [1]", log=True)
    start, span = (ratio.iloc[0], abs(rows["shift"].iloc[0])), (ratio.iloc[0], ratio.iloc[-1])
    massless = Panel(
        Axis("mass_ratio", "mass of strips / of body", log=True),
        shift,
        (
            Curves(rows, Look(label="massless strips", colour=BLUE, marker="o")),
            Slope(through=start, power=1, span=span, label="in proportion"),
        ),
        title="Strips without inertia",
        legend="best",
    )
    title = "Table 1, at rest and at 90°"
    highest = Panel(CONTROL_POINTS, frequency, steps, title=title, legend="best")
    return sheet(9.5, 3.6, [[highest, Panel(CONTROL_POINTS, step, steps), massless]])


STUDY = Study(
    cases=tuple(PRICED.values()),
    parts=(
        Part(at=_designs, ask=_audited, alone=True),
        # what each effect that planar beams leave out is worth
        Part(
            at=lambda: PRICED,
            ask=lambda name: {
                "beyond": [{"design": name, **row} for row in prices(named_design(PRICED[name]))]
            },
        ),
        # highest frequency and explicit step with and without stretching
        Part(at=lambda: COUNTS, ask=lambda n: {"steps": _steps(n)}),
        # shift of the first mode by massless strips
        Part(at=lambda: MASSES, ask=lambda factor: {"mass_ratio": _massless(float(factor))}),
    ),
    claims=(
        Claim(
            claim=f"The answer is within {TOLERANCE:g} without it",
            formulation="{design}, {scene}",
            quantity="the largest change of path, torque, frequencies and loss",
            rows=lambda tables: tables["worth"].query("status == 'converged'"),
            value="largest",
            most=TOLERANCE,
        ),
        Claim(
            claim="A planar beam without shear is within 1 % of one that has it, and of three dimensions",
            formulation="{design}, {effect}",
            quantity="the largest change of path, stiffness, torque, stress and first mode",
            rows=lambda tables: tables["beyond"][tables["beyond"]["effect"].isin((ALL, SHEAR))],
            value="largest",
            most=0.01,
        ),
        Claim(
            claim="Without stretching the largest stable explicit step is at least twice as long",
            formulation="n = {n}",
            quantity="the explicit step without over that with stretching",
            rows=_gains,
            value="gain",
            least=2.0,
        ),
        Claim(
            claim="The frequency shift by massless strips goes with the mass ratio",
            formulation="Table 1 with bodies of other masses",
            quantity="the distance of the observed exponent from 1",
            rows=_exponent,
            value="distance",
            most=0.1,
        ),
    ),
    claims_of_time=tuple(
        Claim(
            claim=claim,
            formulation="{design}, {scene}",
            quantity="the time of the full scene over its own, less one,",
            rows=rows,
            value=lambda row: row["time_ratio"] - 1.0,
            holds=lambda row: row["time_ratio"] > 1.0,
        )
        for claim, rows in (
            (f"The cheapest scene within {TOLERANCE:g} is faster than the full one", _cheapest),
            (
                "At the same step the simpler strips save time",
                lambda tables: tables["timings"].query("design == 'Table 1' and scene in @SIMPLER"),
            ),
        )
    ),
    varying=("cheapest",),
    digits=dict.fromkeys(("beyond.first_mode", "beyond.largest"), Digits(floor=1e-7)),
    figures={
        "effects_worth": _worth,
        "effects_savings": _savings,
    },
)
