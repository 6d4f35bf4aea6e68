"""Bad starts: crumpled, reversed, coincident and other wrong guesses lead to the right state, or nowhere."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from spline_model.pivot import Pivot
from spline_model.statics import solve_from, solve_statics
from studies.answers.models import built, model_of
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.engine.study import Answer, Part, Tables
from studies.kinds import Array
from studies.stability import family, maps

ASKED = (family.DEFAULT, family.LOCKING_FREE, family.PAPER)
ROTATIONS = (45, 90, 120)
#: Largest error of the torque, and of the unknowns, against the path from rest: both are solved to round-off.
TOLERANCE = 1e-7
#: Sizes of random displacements of the control points [L], and how many of each.
SIZES, SEEDS = (1e-3, 1e-2, 0.1, 1.0, 10.0), 3


def _figure(tables: Tables) -> Figure:
    """Draw the map over the kinds of guess and the rotation."""
    outcomes = tables["outcomes"]
    kinds = sorted(dict.fromkeys(outcomes["guess"]), reverse=True)
    place = {kind: i for i, kind in enumerate(kinds)}
    return maps.outcome_map(
        outcomes.assign(y=outcomes["guess"].map(place)),
        title="A state of Table 1 from a bad guess: that of the path from rest, or a refusal",
        xlabel="rotation [deg]",
        ylabel="guess",
        xlim=(30.0, 135.0),
        ylim=(-0.7, len(kinds) - 0.3),
        xticks=list(ROTATIONS),
        yticks=range(len(kinds)),
        yticklabels=kinds,
    )


def _outcomes_of(model: str, degrees: float) -> Answer:
    """Return the outcomes of one model's guesses at a rotation."""
    settings = family.PATHS[family.SIX if model == family.DEFAULT else model]
    given = replace(named_case(family.CASE), rotation=math.radians(degrees))
    pivot, _ = built(model_of(settings), given, settings, moving=False)
    path = solve_statics(pivot, rotation=given.rotation, raise_on_failure=False)
    rows = []
    for name, guess in _guesses(pivot, settings, given.rotation):
        attempt = partial(_recovered, pivot, given.rotation, guess, path)
        place = {"case": f"{name}, {degrees} deg", "guess": name, "x": degrees, "model": model}
        rows.append(place | family.judged(attempt, TOLERANCE))
    return {"outcomes": rows}


def _recovered(pivot: Pivot, rotation: float, guess: Array, path: Any) -> family.Found:
    answer = solve_from(pivot, rotation=rotation, guess=guess, raise_on_failure=False)
    reached = answer.status.value == "converged"
    error = abs(answer.torque[-1] / path.torque[-1] - 1.0) if reached else 0.0
    return family.Found(error=float(error), reached=reached, reason=answer.message, counters=answer.counters)


def _guesses(pivot: Pivot, settings: Any, rotation: float) -> Iterator[tuple[str, Array]]:
    """Yield names and unknowns of guesses that no path would make."""
    assert isinstance(settings, SplineSettings)
    good = solve_statics(pivot, rotation=rotation, raise_on_failure=False).states[-1]
    length = float(np.linalg.norm(pivot.clamp_points[0, 1] - pivot.clamp_points[0, 0]))
    points = 2 * 2 * settings.points  # of both strips, x and y
    for size in SIZES:
        for seed in range(SEEDS):
            bent = good.copy()
            bent[:points] += size * length * np.random.default_rng(seed).standard_normal(points)
            yield f"points moved by {size:g} L", bent
    backwards = good.copy()
    for start in (0, points // 2):
        strip = slice(start, start + points // 2)
        backwards[strip] = good[strip].reshape(-1, 2)[::-1].ravel()
    yield "control points reversed", backwards
    yield "all points coincident", np.concatenate((np.full(points, 0.3 * length), good[points:]))
    yield "everything zero", np.zeros_like(good)
    inward = good.copy()
    inward[2:4] = 2 * good[0:2] - good[2:4]
    yield "first tangent reversed", inward
    other = solve_statics(pivot, rotation=-rotation, raise_on_failure=False).states[-1]
    yield "state of the opposite rotation", other
    wound = good.copy()
    wound[points + 2] += 2.0 * math.pi
    yield "body wound once more", wound
    yield "no numbers", np.full_like(good, np.nan)


STUDY = family.study(
    Part(at=lambda: product(ASKED, ROTATIONS), ask=_outcomes_of),
    figures={"stability_bad_starts": _figure},
)
