"""The pivot's design space: crossing ratio, inclination and slenderness over a range of +-45 degrees.

Wanted at once: much stiffness at rest, little variation of it over the range, little shift of the centre and
little stress. Which designs no other one betters, where Table 1 lies among them, and what the crossing ratio
0.1273 of Haringx and Wittrick (1/2 - sqrt(5)/6) does at finite rotations.
"""

import math
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.sweep import space_figure
from studies.sweep.points import CONVERGED
from studies.sweep.read import plan_of
from studies.sweep.run import sweep
from studies.sweep.space_figure import dominating, not_dominated

CASE = "cross_axis_pivot"

#: The sample, as in examples/design_space.toml.
SPACE: dict[str, Any] = {
    "case": CASE,
    "model": "spline",
    "settings": {"control_points": 8},
    "set": {"drive": {"rotation_deg": 45}},
    "analysis": {"kind": "static", "both_sides": True},
    "sample": {"method": "sobol", "points": 4096},
    "vary": {
        "strip": {
            "crossing_ratio": {"from": 0.1, "to": 0.9},
            "inclination_deg": {"from": 25, "to": 65},
            "slenderness": {"from": 15, "to": 200, "scale": "log"},
        }
    },
}
#: Slenderness of the maps over the other two, and their grid.
MAP_SLENDERNESS, MAP_RATIOS, MAP_INCLINATIONS = 50.0, 41, 17
#: Crossing ratios around Wittrick's at three inclinations [deg].
RATIOS, INCLINATIONS = np.linspace(0.1, 0.2, 101), (30.0, 45.0, 60.0)
WITTRICK = space_figure.WITTRICK["0.1273"]
#: Stress and stiffness of that pivot over those at one half, for small rotations.
LINEAR_STRESS = 1.0 + math.sqrt(5.0)
LINEAR_STIFFNESS = 4.0 * (1.0 - 3.0 * WITTRICK * (1.0 - WITTRICK))
#: Elements a strip by which designs of the front are checked, and how far they may be off.
ELEMENTS, AGREEMENT = 60, 0.01

KEYS = ("crossing_ratio", "inclination_deg", "slenderness")
QUANTITIES = {
    "stiffness_rest_Nm_per_rad": -1.0,
    "stiffness_variation": 1.0,
    "centre_shift_max_m": 1.0,
    "stress_max_Pa": 1.0,
}
"""What is wanted: large (-1) or small (1)."""


def _swept() -> Answer:
    """Return the sample with the front, maps, ratios around Wittrick's, and chosen designs by elements.

    Tables: designs (a row a point; front: "yes" for one that is not bettered); map (a grid at one
    slenderness); ratios (shift, stress and stiffness against the crossing ratio); checks and comparison
    (designs of the front by both models); findings, from all digits.
    """
    designs = _rows(SPACE)
    costs = _costs(designs)
    designs["front"] = np.where(not_dominated(costs), "yes", "no")
    near = [*RATIOS.tolist(), WITTRICK, 0.5]
    ratios = pd.concat(
        [_rows(_over(crossing_ratio=near, inclination_deg=[angle])) for angle in INCLINATIONS],
        ignore_index=True,
    )
    checks, comparison = _checks(designs, costs)
    tables = {"designs": designs, "ratios": ratios, "checks": checks, "comparison": comparison}
    tables["map"] = _rows(_map())
    findings = [finding for claim in CLAIMS for finding in claim(tables)]
    return {name: rounded(rows) for name, rows in tables.items()} | {"findings": findings}


def rounded(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the table to seven digits, more than the splines are good for: half the size."""
    numbers = rows.select_dtypes("float").columns
    return rows.assign(**{name: [float(f"{value:.7g}") for value in rows[name]] for name in numbers})


def _rows(content: Mapping[str, Any]) -> pd.DataFrame:
    """Return the keys and quantities of a sweep; a point without an answer is an error here."""
    with tempfile.TemporaryDirectory() as folder:
        sweep(plan_of("design_space", content, Path(folder)), Path(folder) / "sweep")
        found = pd.read_parquet(Path(folder) / "sweep" / "designs.parquet")
    lost = found[found["status"] != CONVERGED]
    if len(lost):
        raise ValueError(f"design space: point {lost['point'].iloc[0]}: {lost['reason'].iloc[0]}")
    named = found.rename(columns={f"strip.{key}": key for key in KEYS})
    return named[[key for key in KEYS if key in named] + list(QUANTITIES)]


def _over(**axes: Any) -> dict[str, Any]:
    """Return the sweep of a grid over crossing ratio and inclination at one slenderness."""
    strip = {**axes, "slenderness": [MAP_SLENDERNESS]}
    return SPACE | {"sample": {"method": "grid"}, "vary": {"strip": strip}}


def _map() -> dict[str, Any]:
    """Return the sweep of a grid over the range of the space."""
    points = {"crossing_ratio": MAP_RATIOS, "inclination_deg": MAP_INCLINATIONS}
    return _over(**{key: SPACE["vary"]["strip"][key] | {"points": n} for key, n in points.items()})


def _costs(designs: pd.DataFrame) -> Array:
    return np.column_stack([sign * designs[name] for name, sign in QUANTITIES.items()])


def _checks(designs: pd.DataFrame, costs: Array) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return the best design of the front in each quantity, the balanced one and Table 1 by both models."""
    chosen = {f"best {name}": int(np.argmin(costs[:, i])) for i, name in enumerate(space_figure.SHORT)}
    ranks = np.argsort(np.argsort(costs, axis=0), axis=0)
    front = np.flatnonzero(designs["front"] == "yes")
    chosen["balanced"] = int(front[np.argmin(ranks[front].max(axis=1))])
    given = named_case(CASE)
    table_one = {
        "crossing_ratio": given.crossing_ratio,
        "inclination_deg": math.degrees(given.inclination),
        "slenderness": given.length / given.depth,
    }
    rows = [designs.loc[place, list(KEYS)].to_dict() for place in chosen.values()] + [table_one]
    axes = {key: [float(row[key]) for row in rows] for key in KEYS}
    listed = SPACE | {"sample": {"method": "list"}, "vary": {"strip": axes}}
    splines = _rows(listed)
    elements = _rows(listed | {"model": "fe", "settings": {"elements": ELEMENTS}})
    checks = splines.assign(design=[*chosen, "Table 1"])
    return checks[["design", *splines.columns]], _compared(checks, elements)


def _compared(checks: pd.DataFrame, elements: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each design and quantity: by the spline, by the elements, and how far apart."""
    parts = []
    for name in QUANTITIES:
        spline, fe = checks[name], elements[name]
        # the variation is itself relative to the stiffness at rest
        scale = 1.0 if name == "stiffness_variation" else fe
        row = {"design": checks["design"], "quantity": name, "value": spline, "reference": fe}
        parts.append(pd.DataFrame(row | {"error": (spline - fe) / scale}))
    return pd.concat(parts, ignore_index=True)


def _bettered(tables: Tables) -> list[dict[str, Any]]:
    """Return how many designs there are, and which part of them betters Table 1 in all that counts."""
    checks = tables["checks"].set_index("design")
    costs = _costs(tables["designs"])
    return [{"designs": len(costs), "better": dominating(costs, _costs(checks.loc[["Table 1"]])[0]).mean()}]


def _of_wittrick(tables: Tables) -> Iterator[dict[str, Any]]:
    """Yield what the crossing ratio 0.1273 does at each inclination over the range, beside one half."""
    for inclination in INCLINATIONS:
        rows = tables["ratios"].query("inclination_deg == @inclination").sort_values("crossing_ratio")
        own, half = (int(np.argmin(np.abs(rows["crossing_ratio"] - ratio))) for ratio in (WITTRICK, 0.5))
        least = rows["crossing_ratio"].to_numpy()[np.argmin(rows["centre_shift_max_m"])]
        shift, stress, stiffness = (
            rows[name].to_numpy()[own] / rows[name].to_numpy()[half]
            for name in ("centre_shift_max_m", "stress_max_Pa", "stiffness_rest_Nm_per_rad")
        )
        yield {
            "inclination": inclination,
            "shift": shift,
            "least_off": abs(least - WITTRICK),
            "stress_off": abs(stress / LINEAR_STRESS - 1.0),
            "stiffness_off": abs(stiffness / LINEAR_STIFFNESS - 1.0),
        }


CLAIMS = (
    Claim(
        claim="Table 1 is not bettered in stiffness, its variation, shift and stress at once",
        formulation="{designs} designs over +-45 degrees",
        quantity="the share of designs that better it",
        rows=_bettered,
        value="better",
        most=0.0,
    ),
    Claim(
        claim=f"Chosen designs and Table 1 are the same by finite elements, within {AGREEMENT:.0%}",
        formulation=f"spline n = 8 against {ELEMENTS} elements",
        quantity="the largest relative difference",
        rows=lambda tables: [{"error": tables["comparison"]["error"].abs().max()}],
        value="error",
        most=AGREEMENT,
    ),
    *(
        Claim(
            claim=claim,
            formulation="inclination {inclination:g} degrees, +-45 degrees",
            quantity=quantity,
            rows=_of_wittrick,
            value=value,
            most=most,
        )
        for claim, quantity, value, most in (
            (
                "At the ratio 0.1273 the shift is below a tenth of that at one half",
                "its largest shift over that at one half",
                "shift",
                0.1,
            ),
            (
                "The ratio of least shift is still 0.1273, to 0.005",
                "the distance of the ratio of least shift from it",
                "least_off",
                0.005,
            ),
            (
                "Its stress is 3.236 times that at one half, to 5 %",
                "the distance of the ratio from 3.236, relative,",
                "stress_off",
                0.05,
            ),
            (
                "It is 2.667 times as stiff at rest, to 1 %",
                "the distance of the ratio from 2.667, relative,",
                "stiffness_off",
                0.01,
            ),
        )
    ),
)
STUDY = Study(
    cases=(CASE,),
    parts=(Part(ask=_swept, alone=True),),
    figures={"design_space": space_figure.space},
)
