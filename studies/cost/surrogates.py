"""Errors of the surrogate models over the whole range of rotation, against the refined spline.

The four-bar's link length and spring are fitted to the small-angle limit: its published coefficients were
not found.
"""

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_static
from studies.answers.reference import SolvedPath, errors, largest_errors
from studies.answers.response import Response
from studies.cases.problem import named_case
from studies.cost.model import spline
from studies.cost.settings import PSEUDO_RIGID, SURROGATES
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.paper import formulations

#: Splines beside them: what the paper wrote, the same count without locking, and the default.
SPLINES = (formulations.PAPER, formulations.LOCKING_FREE, formulations.SIX)
#: Control points of the reference, and those whose difference to it is its uncertainty.
REFINED, CHECK = 12, 10

#: States of a path: one a degree.
STATES = 91
QUANTITIES = ("trajectory", "torque", "stiffness")
LEVELS = (0.01, 0.05)


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


def _thresholds(tables: Tables) -> list[dict[str, Any]]:
    """Return the smallest rotation from which each error is above each level, by linear interpolation."""
    found = []
    for name, rows in tables["errors"].groupby("model", sort=False):
        for quantity, level in product(QUANTITIES, LEVELS):
            angle = _first_above(rows["rotation_rad"].to_numpy(), rows[quantity].abs().to_numpy(), level)
            row = {"model": name, "quantity": quantity, "level": level, "rotation_deg": np.degrees(angle)}
            found.append({**row, "status": "never" if np.isnan(angle) else "passed"})
    return found


def _first_above(rotation: Array, error: Array, level: float) -> float:
    """Return the rotation at which an error first passes a level [rad]; NaN if it never does.

    An error that is above the level at rest, or at the first state that has one, passes it there. Torque has
    no error at rest, where there is none.
    """
    above = np.flatnonzero(error > level)
    if not len(above):
        return float("nan")
    after = int(above[0])
    if after == 0 or (after == 1 and error[0] == 0.0 and error[1] > error[2]):
        return 0.0
    before = after - 1
    part = (level - error[before]) / (error[after] - error[before])
    return float(rotation[before] + part * (rotation[after] - rotation[before]))


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
    made={"thresholds": _thresholds},
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
