"""Errors of the surrogate models over the whole range of rotation, against the refined spline.

The four-bar's link length and spring are fitted to the small-angle limit: its published coefficients were
not found.
"""

from dataclasses import replace
from typing import Any

import pandas as pd

from studies.answers.adapters import answer_static
from studies.answers.reference import SolvedPath, errors, largest_errors
from studies.answers.response import Response
from studies.cases.problem import named_case
from studies.cost.model import spline
from studies.cost.settings import PSEUDO_RIGID, SURROGATES
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.paper import formulations

#: Splines beside them: what the paper wrote, the same count without locking, and the default.
SPLINES = (formulations.PAPER, formulations.LOCKING_FREE, formulations.SIX)
#: Control points of the reference, and those whose difference to it is its uncertainty.
REFINED, CHECK = 12, 10

#: States of a path: one a degree.
STATES = 91
QUANTITIES = ("trajectory", "torque", "stiffness")


def _paths() -> Answer:
    """Return errors over the path (a row a model and degree) and the reference's uncertainty."""
    problem = replace(named_case(), increments=STATES - 1)
    limit, near = (spline.path(problem, control_points=n) for n in (REFINED, CHECK))
    paths = {name: each.path(problem) for name, each in SURROGATES.items()}
    paths |= {name: answer_static(problem, formulations.SETTINGS[name]) for name in SPLINES}
    known = largest_errors(near, limit)
    return {
        "errors": pd.concat(_errors(name, path, limit) for name, path in paths.items()),
        "reference": [{"quantity": name, "unit": "1", "uncertainty": known[name]} for name in QUANTITIES],
    }


def _errors(name: str, path: SolvedPath | Response, limit: Response) -> pd.DataFrame:
    """Return the errors at each rotation: trajectory >= 0, the others signed [1]."""
    found = errors(path, limit)
    found["torque"][0] = 0.0  # at rest there is none, but for round-off
    columns = {quantity: found[quantity] for quantity in QUANTITIES}
    return pd.DataFrame({"model": name, "rotation_rad": path.rotation, **columns})


def _over_the_best(tables: Tables) -> list[dict[str, Any]]:
    """Return the largest error of each spline and quantity over that of the best pseudo-rigid body."""
    largest = tables["errors"].set_index("model")[list(QUANTITIES)].abs().groupby("model").max().T
    best = largest[list(PSEUDO_RIGID)].min(axis=1)
    return [
        {"model": name, "of": quantity, "ratio": largest[name][quantity] / best[quantity]}
        for name in SPLINES
        for quantity in QUANTITIES
    ]


STUDY = Study(
    parts=(Part(ask=_paths),),
    claims=(
        Claim(
            claim="Dynamic splines are more accurate than pseudo-rigid-body models",
            formulation="{model}",
            quantity="the largest error of the {of} over the best such model's",
            rows=_over_the_best,
            value="ratio",
            holds=lambda row: row["ratio"] < 1.0,
        ),
    ),
)
