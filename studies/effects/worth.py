"""What each effect is worth for four designs, and what inextensible and massless strips save."""

from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes
from studies.answers.settings import SplineSettings
from studies.cases.design import named_design
from studies.cases.problem import Problem, named_case
from studies.effects import figures
from studies.effects.audit import Audit, audit
from studies.effects.beyond import ALL, SHEAR, prices
from studies.effects.scenes import Outcome, Variant, size_of, without
from studies.engine.study import Answer, Claim, Finding, Part, Study, Tables

CASE = "cross_axis_pivot"

SETTINGS = SplineSettings(control_points=6)
TOLERANCE = 1e-3

#: Control points for which the highest frequency is taken with and without stretching.
COUNTS = range(4, 9)
#: Mass of the body, and with it its moment of inertia, over that of Table 1.
MASSES = np.geomspace(0.03, 30.0, 13)

#: Designs for which what planar beams leave out is priced, by their cases; sized ones are in `design/sizing`.
PRICED = {
    "Table 1": CASE,
    "spring steel": "spring_steel_pivot",
    "titanium": "titanium_pivot",
    "large steel": "large_steel_pivot",
    "silicon": "silicon_pivot",
    "polymer": "polymer_pivot",
    "living hinge": "living_hinge",
    "four-bar linkage": "four_bar_of_flexures",
}

STRETCHING, INERTIA = "stretching", "strip_inertia"


def _designs() -> dict[str, Problem]:
    """Return the four designs: Table 1, ten times more slender, with a heavy and with a light body."""
    given = named_case(CASE)
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
    return {
        "worth": [_row(name, row) for row in found.rows],
        "timings": _times(name, found),
        "cheapest": _cheapest(name, found),
    }


def _priced(name: str) -> list[dict[str, Any]]:
    """Return what each effect that planar beams leave out is worth for a design, a row an effect."""
    return [
        {
            "design": name,
            "effect": row.effect,
            "status": row.status,
            "trajectory": row.trajectory,
            "stiffness": row.stiffness,
            "torque": row.torque,
            "stress": row.stress,
            "first_mode": row.mode,
            "largest": row.largest,
            "reason": row.reason,
        }
        for row in prices(named_design(PRICED[name]))
    ]


def _with_body(problem: Problem, factor: float) -> Problem:
    return replace(
        problem,
        body_mass=problem.body_mass * factor,
        body_moment_of_inertia=problem.body_moment_of_inertia * factor,
    )


def _row(design: str, row: Outcome) -> dict[str, Any]:
    size = row.size
    return {
        "design": design,
        "scene": row.variant.label,
        "dropped": row.variant.dropped[0],
        "status": row.status,
        "trajectory": row.trajectory,
        "torque": row.torque,
        "swing_frequency": row.swing,
        "first_mode": row.mode,
        "loss": row.loss,
        "largest": row.largest if np.isfinite(row.largest) else np.nan,
        "unknowns": size.unknowns if size else np.nan,
        "degrees_of_freedom": size.degrees_of_freedom if size else np.nan,
        "highest_frequency_Hz": size.highest_frequency if size else np.nan,
        "explicit_step_s": size.explicit_step if size else np.nan,
        "reason": row.reason,
    }


def _times(design: str, found: Audit) -> list[dict[str, Any]]:
    rows = [
        {
            "design": design,
            "scene": row.variant.label,
            "time_ratio": found.time_ratio(row),
            "wall_s": row.wall_s,
        }
        for row in (found.full, *found.rows)
    ]
    best = {"design": design, "scene": "cheapest", "time_ratio": found.ratio, "wall_s": found.seconds[1]}
    return [*rows, best]


def _cheapest(design: str, found: Audit) -> dict[str, Any]:
    best = found.cheapest
    return {
        "design": design,
        "tolerance": found.tolerance,
        "scene": best.variant.label,
        "effects": " ".join(best.variant.effects.names),
        "largest": best.largest,
    }


def _steps(control_points: int) -> list[dict[str, Any]]:
    """Return highest frequency and explicit step with and without stretching, at rest and at the release."""
    problem = named_case(CASE)
    full = Variant(dropped=(), effects=problem.effects)
    rows = []
    for variant in (full, without(full, [STRETCHING])):
        scene = replace(problem, effects=variant.effects)
        size = size_of(scene, SplineSettings(control_points=control_points))
        rows.append(
            {
                "control_points": control_points,
                "stretching": "yes" if STRETCHING in variant.effects.names else "no",
                "degrees_of_freedom": size.degrees_of_freedom,
                "highest_frequency_Hz": size.highest_frequency,
                "explicit_step_s": size.explicit_step,
            }
        )
    return rows


def _massless(factor: float) -> dict[str, Any]:
    """Return the shift of the first mode by massless strips under a body of `factor` times the given mass."""
    problem = _with_body(named_case(CASE), factor)
    full = Variant(dropped=(), effects=problem.effects)
    massive, massless = (
        answer_modes(replace(problem, effects=variant.effects), SETTINGS, count=1).frequency[0]
        for variant in (full, without(full, [INERTIA]))
    )
    strips = 2.0 * problem.density * problem.area * problem.length
    return {
        "mass_ratio": strips / problem.body_mass,
        "first_mode_Hz": massive,
        "massless_Hz": massless,
        "shift": massless / massive - 1.0,
    }


def _findings_of_time(tables: Tables) -> list[Finding]:
    """Return whether the cheapest scenes and the simpler strips take less time: these differ run by run."""
    times = tables["timings"].set_index(["design", "scene"])["time_ratio"].to_dict()
    asked = [
        (
            f"The cheapest scene within {TOLERANCE:g} is faster than the full one",
            row["design"],
            "cheapest",
            row["scene"],
        )
        for row in tables["cheapest"].to_dict("records")
    ]
    asked += [
        ("At the same step the simpler strips save time", "Table 1", scene, scene)
        for scene in ("inextensible strips", "massless strips")
    ]
    return [
        Finding(
            claim=claim,
            formulation=f"{design}, {label}",
            quantity="the time of the full scene over its own, less one,",
            value=float(times[design, scene]) - 1.0,
            holds=bool(times[design, scene] > 1.0),
        )
        for claim, design, scene, label in asked
    ]


def _gains(tables: Tables) -> list[dict[str, Any]]:
    """Return how many times longer the explicit step is without stretching, a row a count."""
    wide = tables["steps"].pivot(index="control_points", columns="stretching", values="explicit_step_s")
    return [{"n": n, "gain": float(row["no"] / row["yes"])} for n, row in wide.iterrows()]


def _exponent(tables: Tables) -> list[dict[str, Any]]:
    """Return how far the exponent of the shift by massless strips over the mass ratio is from one."""
    shift = tables["mass_ratio"].sort_values("mass_ratio")
    order = np.polyfit(np.log(shift["mass_ratio"]), np.log(shift["shift"].abs()), 1)[0]
    return [{"distance": abs(float(order) - 1.0)}]


STUDY = Study(
    cases=tuple(PRICED.values()),
    parts=(
        Part(at=_designs, ask=_audited, alone=True),
        Part(at=lambda: PRICED, ask=lambda name: {"beyond": _priced(name)}),
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
    claims_of_time=(_findings_of_time,),
    varying=("cheapest",),
    figures={
        "effects_worth": lambda tables: figures.worth(tables, list(_designs()), TOLERANCE),
        "effects_savings": figures.savings,
    },
)
