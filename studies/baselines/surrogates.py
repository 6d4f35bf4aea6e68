"""Errors of the surrogate models over the whole range of rotation and of swings, against the refined spline.

The four-bar's link length and spring are fitted to the small-angle limit: its published coefficients were
not found.
"""

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.reference import Swing, errors
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.baselines import pseudo_rigid
from studies.baselines.answer import SolvedPath
from studies.baselines.compared import PSEUDO_RIGID, SURROGATES
from studies.baselines.constraint_model import constraint_model
from studies.baselines.own import spline
from studies.baselines.pseudo_rigid import four_bar, linear_pivot, pin_joint
from studies.cases.problem import Problem, named_case
from studies.engine import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.paper import formulations
from studies.record.marks import Level
from studies.record.panels import AMPLITUDE, ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import GREEN, LOOKS, ORANGE, PURPLE, YELLOW, Look

#: Splines beside them: what the paper wrote, the same count without locking, and the default.
SPLINES = (formulations.PAPER, formulations.LOCKING_FREE, "n = 6")
#: Control points of the reference, and those whose difference to it is its uncertainty.
REFINED, CHECK = 12, 10

#: States of a path: one a degree.
STATES = 91
QUANTITIES = ("trajectory", "torque", "stiffness")
LEVELS = (0.01, 0.05)

#: Amplitudes of the swings, over the end of the path.
AMPLITUDES = np.arange(1, 10) / 9.0
DURATION = formulations.DURATION
#: Step of the surrogates [s]: a hundredth of it moves their rotation by less than 1e-9 rad.
STEP = 1e-5
#: Spline that swings of less than the full amplitude are held against.
SWING = SplineSettings(control_points=8)


def _paths() -> Answer:
    """Return errors over the path (a row a model and degree) and the reference's uncertainty."""
    problem = named_case()
    turns = np.linspace(0.0, problem.rotation, STATES)
    limit, near = (spline.static_path(problem, turns, control_points=n) for n in (REFINED, CHECK))
    paths = {name: each.static_path(problem, turns) for name, each in SURROGATES.items()}
    fine = replace(problem, increments=STATES - 1)
    beside = {name: answer_static(fine, formulations.SETTINGS[name]) for name in SPLINES}
    found = [_errors(name, path, limit) for name, path in (paths | beside).items()]
    uncertainty = _errors("check", near, limit)[list(QUANTITIES)].abs().max()
    return {
        "errors": pd.concat(found),
        "reference": [
            {"quantity": name, "unit": "1", "uncertainty": value} for name, value in uncertainty.items()
        ],
    }


def _errors(name: str, path: SolvedPath | Response, limit: SolvedPath) -> pd.DataFrame:
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


def _released() -> Answer:
    """Return the motions from the end of the path and the reference's uncertainty."""
    problem = named_case()
    limit, check = (
        formulations.sampled(formulations.resolved(each), formulations.INSTANTS)
        for each in (SplineSettings(control_points=10), SWING)
    )
    motions = [_motion("reference", limit.rotation, limit)]
    for name, each in SURROGATES.items():
        motion = each.release(problem, start=problem.rotation, duration=DURATION, step=STEP)
        motions.append(_motion(name, np.interp(limit.time, motion.time, motion.rotation), limit))
    apart = float(np.abs(check.rotation - limit.rotation).max())
    uncertainty = {"quantity": "rotation", "unit": "rad", "uncertainty": apart}
    return {"motion": pd.concat(motions), "reference": uncertainty}


def _motion(name: str, rotation: Array, limit: Swing) -> pd.DataFrame:
    """Return a rotation at the instants of the limit beside its difference to that."""
    columns = {"time_s": limit.time, "rotation_rad": rotation, "difference_rad": rotation - limit.rotation}
    return pd.DataFrame({"model": name, **columns})


def _swung(part: float) -> Answer:
    """Return the frequencies of the swing of one amplitude, over the end of the path."""
    problem = named_case()
    options: dict[str, Any] = {"start": float(part) * problem.rotation, "duration": DURATION}
    limit = answer_release(problem, SWING, **options, integrator="leapfrog").frequency
    rows = []
    for name, each in SURROGATES.items():
        motion = each.release(problem, **options, step=STEP)
        frequency = swing_frequency(motion.time, motion.rotation).value
        row = {"model": name, "amplitude_rad": options["start"], "frequency_Hz": frequency}
        rows.append({**row, "reference_Hz": limit, "shift": frequency / limit - 1.0})
    return {"swings": rows}


def _parameters(problem: Problem) -> list[dict[str, Any]]:
    """Return what the surrogates were made with, and whether published or fitted."""
    rigidity = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    pin = float(pin_joint.static_path(problem, [0.0, problem.rotation]).stiffness[0])
    linear, fitted = "closed form", "fitted to small rotations"
    shift = pseudo_rigid.shift_coefficient(problem) / problem.length
    found = [
        (linear_pivot, "stiffness over EI/L", pseudo_rigid.small_angle_stiffness(problem) / rigidity, linear),
        (linear_pivot, "centre shift over L and square of the rotation", shift, linear),
        (pin_joint, "stiffness over EI/L", pin / rigidity, "published"),
        (four_bar, "link length over L", pseudo_rigid.link_length(problem), fitted),
        (four_bar, "spring over EI/L", pseudo_rigid.spring(problem) / rigidity, fitted),
        (constraint_model, "beams a strip", 1, "published"),
    ]
    columns = ("parameter", "value", "origin")
    return [{"model": each.model, **dict(zip(columns, row, strict=True))} for each, *row in found]


def _over_the_best(tables: Tables) -> list[dict[str, Any]]:
    """Return the largest error of each spline and quantity over that of the best pseudo-rigid body."""
    largest = tables["errors"].set_index("model")[list(QUANTITIES)].abs().groupby("model").max().T
    best = largest[list(PSEUDO_RIGID)].min(axis=1)
    return [
        {"model": name, "of": quantity, "ratio": largest[name][quantity] / best[quantity]}
        for name in SPLINES
        for quantity in QUANTITIES
    ]


#: Looks of the models.
MODELS = {
    "linear pivot": Look(label="linear pivot", colour=ORANGE),
    "pin joint": Look(label="pin joint", colour=PURPLE),
    "four-bar": Look(label="four-bar (fitted)", colour=GREEN),
    "beam constraint model": Look(label="beam constraint model", colour=YELLOW),
}
DRAWN = {name: replace(LOOKS[name], line="--", marker="") for name in SPLINES}
#: The smallest and the largest error that is drawn.
ERRORS = (1e-6, 30.0)


def _figure(tables: Tables) -> Figure:
    """Draw the static errors over the rotation, and the shift of the frequency over the amplitude."""
    path, torque, stiffness = (_static(tables["errors"], quantity) for quantity in QUANTITIES)
    below = [stiffness, _frequencies(tables["swings"])]
    return sheet(9.5, 6.4, [[replace(path, title="Static path to 90°"), torque], below], legend=4)


def _static(rows: pd.DataFrame, quantity: str) -> Panel:
    label = f"|error of the {quantity}| [1]"
    return Panel(
        replace(ROTATION, limits=(0, 90)),
        Axis(quantity, label, log=True, limits=ERRORS),
        (
            Curves(rows, MODELS | DRAWN, by="model"),
            *(Level(level, words=f"{level:.0%}", place=1.0) for level in LEVELS),
        ),
    )


def _frequencies(rows: pd.DataFrame) -> Panel:
    looks = {name: replace(look, marker="o") for name, look in MODELS.items()}
    return Panel(
        AMPLITUDE,
        Axis("shift", "shift of the frequency [%]", factor=100.0),
        (Curves(rows, looks, by="model"), Level(0.0)),
        title="Free swing",
    )


STUDY = Study(
    parts=(
        Part(ask=_paths),
        Part(ask=_released),
        Part(at=lambda: AMPLITUDES, ask=_swung),
        Part(ask=lambda: {"parameters": _parameters(named_case())}),
    ),
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
    figures={"surrogates": _figure},
)
