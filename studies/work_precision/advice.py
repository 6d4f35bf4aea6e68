"""The cheapest setting of every model that meets an error on one pivot, found by trying them all."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_modes
from studies.answers.reference import NoReference
from studies.answers.settings import SplineSettings
from studies.baselines.own import spline
from studies.baselines.variant import grid, ranked
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.kinds import Array, Progress
from studies.record.progress import silent
from studies.work_precision import series
from studies.work_precision.equal_error import coarsest, worst
from studies.work_precision.limits import at, limit_of_theory, motion_errors, path_errors

#: What a setting is judged by.
PATH_ERRORS = ("error_trajectory", "error_torque")
MOTION_ERRORS = ("error_rotation", "error_frequency")
#: Control points that are tried in statics, and timed repeats of what is advised.
COUNTS, REPEAT = range(4, 17), 7
#: A motion is followed for this many periods of the first mode at rest.
PERIODS = 4.0
#: Instants at which swings are compared.
INSTANTS = 501
#: Steps of the paper's pivot, over its first period [s]: other pivots are tried at the same parts of theirs.
PERIOD = 1.0 / 76.0
#: Control points of the spline that motions are held against, and of the one that says how uncertain it is.
REFERENCE = (16, 14)


def advise_path(problem: Design, error: float, progress: Progress = silent) -> pd.DataFrame:
    """Return the advice for the static path of `problem`, each model against the limit of its own theory.

    A row a model: series, setting, meets (whether trajectory and torque are within `error` over the path, and
    stay so in all finer settings), error_trajectory, error_torque, error_stiffness, error_stress (NaN of a
    model that does not give it), uncertainty (the larger one of the limit's path and torque),
    uncertainty_stress, solve_s, wall_s, message (why a model has no answer). Of a model that does not meet
    the error it is the best setting.

    Raises:
        NoReference: the finite elements do not reach the end of the path.
    """
    tried = series.own_paths(COUNTS)
    tried += grid(spline, series.ITSELF, accuracy=(error,))
    tried += series.other_paths() if isinstance(problem, Problem) else []
    total = len(tried) + len({each.series for each in tried})
    limits = {theory: limit_of_theory(problem, theory) for theory in {each.theory for each in tried}}
    rows: list[dict[str, Any]] = []
    for each in tried:
        progress(len(rows), total)
        path, limit = each.path(problem, 1), limits[each.theory]
        rows.append(
            {"series": each.series, "family": each.family, "setting": each.setting, "rank": each.count}
            | path_errors(path, limit.path)
            | {"uncertainty": max(limit.uncertainty[name] for name in ("trajectory", "torque"))}
            | {"uncertainty_stress": limit.uncertainty["stress"]}
            | {"solve_s": path.solve_s, "wall_s": path.wall_s, "message": path.message}
        )
    found = _chosen(pd.DataFrame(rows), PATH_ERRORS, error)
    for place, row in found.iterrows():
        progress(len(rows), total)
        if not row["message"]:
            name = row["series"], row["setting"]
            again = next(each for each in tried if (each.series, each.setting) == name).path(problem, REPEAT)
            found.loc[place, ["solve_s", "wall_s"]] = again.solve_s, again.wall_s
    progress(total, total)
    return found


def advise_motion(problem: Design, error: float, progress: Progress = silent) -> pd.DataFrame:
    """Return the advice for the motion of `problem` after its release from the end of its path.

    Columns as of `advise_path`, with error_rotation (largest over the motion, over the rotation at the start)
    and error_frequency instead. All are held against a spline of `REFERENCE` control points.

    Raises:
        NoReference: that spline's motion stops early.
    """
    frequency = float(answer_modes(problem, SplineSettings(control_points=6), count=1).frequency[0])
    duration = PERIODS / frequency
    scale, start = 1.0 / frequency / PERIOD, abs(problem.rotation or 0.0)
    tried = series.own_swings(scale)
    tried += series.other_swings(scale) if isinstance(problem, Problem) else []
    total = len(REFERENCE) + len(tried)
    instants = np.linspace(0.0, duration, INSTANTS)
    integrator = _integrator(problem, duration)
    rotations: list[Array] = []
    for finest in grid(spline, "reference", control_points=REFERENCE, integrator=(integrator,)):
        progress(len(rotations), total)
        limit: Any = finest.swing(problem, duration)
        if not limit.converged:
            raise NoReference(f"reference with {finest.count} control points: {limit.message}")
        rotations.append(at(limit, np.minimum(instants, limit.time[-1])))
    uncertainty = float(np.abs(rotations[0] - rotations[1]).max()) / start
    rows: list[dict[str, Any]] = []
    for rank, each in ranked(tried):
        progress(len(REFERENCE) + len(rows), total)
        motion = each.swing(problem, duration)
        off = motion_errors(motion, rotations[0], instants)
        rows.append(
            {"series": each.series, "family": each.family, "setting": each.setting, "rank": rank}
            | {"error_rotation": off["error_rotation_rad"] / start}
            | {"error_frequency": off["error_frequency"], "uncertainty": uncertainty}
            | {"solve_s": motion.solve_s, "wall_s": motion.wall_s, "message": motion.message}
        )
    progress(total, total)
    return _chosen(pd.DataFrame(rows), MOTION_ERRORS, error)


def _integrator(problem: Design, duration: float) -> str:
    """Return the spline's most accurate integrator that the scene allows, by trying."""
    (trial,) = grid(spline, "trial", control_points=(4,), integrator=("leapfrog",))
    return "leapfrog" if trial.swing(problem, 0.1 * duration).converged else "energy"


def _chosen(rows: pd.DataFrame, columns: Sequence[str], error: float) -> pd.DataFrame:
    """Return a row a series: the fastest of the coarsest ones whose errors are kept, or the best one.

    Adds the column meets; of a series without any answer the first row stands.
    """
    within_error, now = coarsest(rows, columns, "rank", error), worst(rows, columns)
    found = []
    for name in rows["series"].unique():
        mine = rows[rows["series"] == name]
        within = within_error[within_error["series"] == name]
        best = now[mine.index].idxmin() if np.isfinite(now[mine.index]).any() else mine.index[0]
        place = within["solve_s"].idxmin() if len(within) else best
        found.append(rows.loc[place].to_dict() | {"meets": bool(len(within))})
    return pd.DataFrame(found)
