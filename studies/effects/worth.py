"""What each effect is worth for four designs."""

from dataclasses import replace
from typing import Any

import pandas as pd

from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_moments
from studies.effects.audit import audit
from studies.effects.scenes import CHANGES, SIZES
from studies.engine import Answer, Claim, Part, Study

SETTINGS = SplineSettings(control_points=6)
TOLERANCE = 1e-3

WORTH = ("design", "scene", "dropped", "status", *CHANGES, "largest", *SIZES, "reason")


def _designs() -> dict[str, Problem]:
    """Return the four designs: Table 1, ten times more slender, with a heavy and with a light body."""
    given = named_case()
    slender = of_moments(given.area / 10.0, given.second_moment_of_area / 1000.0)
    found = {"Table 1": given, "ten times more slender": replace(given, **slender)}
    for name, factor in (("heavier", 10.0), ("lighter", 0.1)):
        body: Any = {each: factor * getattr(given, each) for each in ("body_mass", "body_moment_of_inertia")}
        found[f"body ten times {name}"] = replace(given, **body)
    return found


def _audited(name: str) -> Answer:
    """Return the worth of a design's effects (a row a scene: changes, size, or why there is no answer), the
    times (of the full scene over the scene's) and the cheapest scene."""
    found = audit(_designs()[name], SETTINGS, TOLERANCE)
    full, *rows = ({"design": name, **each.row(found.full)} for each in (found.full, *found.rows))
    best = found.cheapest.row(found.full) | {"design": name, "tolerance": found.tolerance}
    best["effects"] = " ".join(best["effects"])
    return {
        "worth": pd.DataFrame([row | {"dropped": row["dropped"][0]} for row in rows])[list(WORTH)],
        "timings": pd.DataFrame([full, *rows])[["design", "scene", "time_ratio", "wall_s"]],
        "cheapest": pd.DataFrame([best])[["design", "tolerance", "scene", "effects", "largest"]],
    }


STUDY = Study(
    parts=(Part(at=_designs, ask=_audited, alone=True),),
    claims=(
        Claim(
            claim=f"The answer is within {TOLERANCE:g} without it",
            formulation="{design}, {scene}",
            quantity="the largest change of path, torque, frequencies and loss",
            rows=lambda tables: tables["worth"].query("status == 'converged'"),
            value="largest",
            most=TOLERANCE,
        ),
    ),
)
