"""Errors of the surrogate models over the whole range of rotation and of swings, against the refined spline.

The four-bar's link length and spring are fitted to the small-angle limit: its published coefficients were
not found.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.frequency import swing_frequency
from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.response import Response
from studies.answers.settings import SplineSettings
from studies.baselines import surrogate_figures
from studies.baselines.answer import SolvedPath
from studies.baselines.constraint_model import CHAINED, chained_constraint_model, constraint_model
from studies.baselines.constraint_strips import guide
from studies.baselines.four_bar import four_bar, link_length, spring
from studies.baselines.linear_pivot import (
    linear_pivot,
    pin_joint,
    shift_coefficient,
    small_angle_stiffness,
)
from studies.baselines.own import spline
from studies.baselines.variants import PSEUDO_RIGID, SURROGATES
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Claim, Part, Study, Tables
from studies.kinds import Array
from studies.model_form.account import CASE as GUIDE
from studies.model_form.account import LOADS, guide_design, guide_shape
from studies.paper import formulations
from studies.published.solve import moved

CASE = "cross_axis_pivot"
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
#: Spline that swings of less than the full amplitude are held against, and its step [s].
SWING = SplineSettings(control_points=8)
SWING_STEP = 2e-5


def _paths() -> Answer:
    """Return errors over the path (a row a model and degree), the reference's uncertainty and the times."""
    problem = named_case(CASE)
    turns = np.linspace(0.0, problem.rotation, STATES)
    limit = spline.static_path(problem, turns, control_points=REFINED)
    _paths = {name: each.static_path(problem, turns).timed(9) for name, each in SURROGATES.items()}
    rows = [row for name, path in _paths.items() for row in _rows(name, path, limit)]
    fine = replace(problem, increments=STATES - 1)
    for name in SPLINES:
        rows += _rows(name, answer_static(fine, formulations.SETTINGS[name]), limit)
    _paths[spline.model] = spline.static_path(problem, turns).timed(9)
    near = _rows("check", spline.static_path(problem, turns, control_points=CHECK), limit)
    uncertainty = [
        {"quantity": name, "unit": "1", "uncertainty": max(abs(row[name]) for row in near)}
        for name in QUANTITIES
    ]
    timings = [
        {"model": name, "task": f"path of {STATES - 1} increments", "solve_s": path.solve_s}
        for name, path in _paths.items()
    ]
    return {"errors": rows, "reference": uncertainty, "timings": timings}


def _rows(name: str, path: SolvedPath | Response, limit: SolvedPath) -> list[dict[str, Any]]:
    """Return the errors at each rotation: trajectory >= 0, the others signed [1]."""
    torque = np.zeros(len(limit.torque))  # at rest there is none, but for round-off
    torque[1:] = relative_error(path.torque[1:], limit.torque[1:])
    columns = {
        "rotation_rad": path.rotation,
        "trajectory": trajectory_error(path.centre, limit.centre),
        "torque": torque,
        "stiffness": relative_error(path.stiffness, limit.stiffness),
    }
    return [
        {"model": name, **dict(zip(columns, row, strict=True))} for row in zip(*columns.values(), strict=True)
    ]


def _thresholds(tables: Tables) -> list[dict[str, Any]]:
    """Return the smallest rotation from which each error is above each level, by linear interpolation."""
    found = []
    for name, rows in tables["errors"].groupby("model", sort=False):
        for quantity in QUANTITIES:
            for level in LEVELS:
                angle = first_above(rows["rotation_rad"].to_numpy(), rows[quantity].abs().to_numpy(), level)
                found.append(
                    {
                        "model": name,
                        "quantity": quantity,
                        "level": level,
                        "rotation_deg": np.degrees(angle),
                        "status": "never" if np.isnan(angle) else "passed",
                    }
                )
    return found


def first_above(rotation: Array, error: Array, level: float) -> float:
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
    """Return the motions from the end of the path, the reference's uncertainty and the times."""
    problem = named_case(CASE)
    limit = formulations.sampled(
        formulations.resolved(SplineSettings(control_points=10)), formulations.INSTANTS
    )
    check = formulations.sampled(formulations.resolved(SWING), formulations.INSTANTS)
    rows = [
        {"model": "reference", "time_s": t, "rotation_rad": p, "difference_rad": 0.0}
        for t, p in zip(limit.time, limit.rotation, strict=True)
    ]
    times = []
    for name, each in SURROGATES.items():
        motion = each.release(problem, start=problem.rotation, duration=DURATION, step=STEP).timed(9)
        rotation = np.interp(limit.time, motion.time, motion.rotation)
        rows += [
            {"model": name, "time_s": t, "rotation_rad": p, "difference_rad": p - q}
            for t, p, q in zip(limit.time, rotation, limit.rotation, strict=True)
        ]
        task = f"swing of {DURATION:g} s in {motion.work['steps']} steps"
        times.append({"model": name, "task": task, "solve_s": motion.solve_s})
    apart = float(np.abs(check.rotation - limit.rotation).max())
    uncertainty = {"quantity": "rotation", "unit": "rad", "uncertainty": apart}
    return {"motion": rows, "reference": uncertainty, "timings": times}


def _swung(part: float) -> Answer:
    """Return the frequencies of the swing of one amplitude, over the end of the path."""
    problem = named_case(CASE)
    amplitude = float(part) * problem.rotation
    options: dict[str, Any] = {"start": amplitude, "duration": DURATION}
    limit = answer_release(
        problem, SWING, **options, integrator="generalised-alpha", step=SWING_STEP
    ).frequency
    rows = []
    for name, each in SURROGATES.items():
        motion = each.release(problem, **options, step=STEP)
        frequency = swing_frequency(motion.time, motion.rotation).value
        rows.append(
            {
                "model": name,
                "amplitude_rad": amplitude,
                "frequency_Hz": frequency,
                "reference_Hz": limit,
                "shift": frequency / limit - 1.0,
            }
        )
    return {"swings": rows}


def _guided(load: float) -> Answer:
    """Return the displacement of a parallelogram under a load across it [EI/L^2], and that of its beams."""
    strip, shape = guide_design().strips[0], guide_shape()
    length = math.dist(strip.start, strip.end)
    limit = np.array(moved(GUIDE, "spline", "beam", load)) / (length, length, 1.0)
    rows = []
    for model, count in ((constraint_model.model, 1), (chained_constraint_model.model, CHAINED)):
        place = guide(shape["apart"], 1.0 / shape["thickness"], count).pushed(np.array([0.0, load]))
        for quantity, found, known in zip(("displacement_x", "displacement_y"), place, limit, strict=False):
            row = {"model": model, "load": load, "quantity": quantity, "found": found, "reference": known}
            rows.append({**row, "error": found / known - 1.0})
    return {"guide": rows}


def _parameters(problem: Problem) -> list[dict[str, Any]]:
    """Return what the surrogates were made with, and whether published or fitted."""
    rigidity = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    pin = float(pin_joint.static_path(problem, [0.0, problem.rotation]).stiffness[0])
    linear, fitted = "closed form", "fitted to small rotations"
    found = [
        (linear_pivot, "stiffness over EI/L", small_angle_stiffness(problem) / rigidity, linear),
        (
            linear_pivot,
            "centre shift over L and square of the rotation",
            shift_coefficient(problem) / problem.length,
            linear,
        ),
        (pin_joint, "stiffness over EI/L", pin / rigidity, "published"),
        (four_bar, "link length over L", link_length(problem), fitted),
        (four_bar, "spring over EI/L", spring(problem) / rigidity, fitted),
        (constraint_model, "beams a strip", 1, "published"),
        (chained_constraint_model, "beams a strip", CHAINED, "chosen"),
    ]
    return [
        {"model": each.model, "parameter": name, "value": value, "origin": origin}
        for each, name, value, origin in found
    ]


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
    cases=(CASE, f"published/cases/{GUIDE}"),
    parts=(
        Part(ask=_paths, alone=True),
        Part(ask=_released, alone=True),
        Part(at=lambda: AMPLITUDES, ask=_swung),
        Part(at=lambda: LOADS, ask=_guided),
        Part(ask=lambda: {"parameters": _parameters(named_case(CASE))}),
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
    figures={"surrogates": lambda tables: surrogate_figures.errors(tables, LEVELS)},
)
