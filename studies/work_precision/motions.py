"""Motions of every model after the release, as what work-precision diagrams need of them."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.frequency import swing_frequency
from studies.answers.settings import Settings
from studies.baselines.answer import BaselineFailed, SolvedMotion
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array
from studies.work_precision.paths import Member, counted
from studies.work_precision.work import work_of_motion

WORK = ("unknowns", "points", "steps", "evaluations", "factorisations", "flops")
#: Largest number of records: the strips' own oscillations, some 40 times as fast as the swing, need so many
#: for cubic interpolation to err by less than 1e-6 rad (1000 leave 8e-5 rad).
RECORDS = 4000
#: Records of a motion that is timed: these are read out by each model in its own way and are no part of it.
TIMED_RECORDS = 50
#: Time that repeats of one setting may take together [s], and their largest number.
AFFORDED, REPEATS = 0.3, 7


def moving(settings: Settings, setting: str, family: str = "all", **options: Any) -> Member:
    """Return the member of one of the suite's own models."""

    def solve(problem: Problem, duration: float) -> SolvedMotion:
        def run(records: int, repeat: int = 1) -> Any:
            return answer_release(
                problem, settings, duration=duration, records=records, repeat=repeat, **options
            )

        try:
            motion = run(RECORDS)
        except BadInput as refused:  # an integrator that the scene does not allow
            return stopped(str(refused))
        repeats = _repeats_of(motion.solve_s) if motion.converged else 0
        timed = run(TIMED_RECORDS, repeats) if repeats else motion
        return SolvedMotion(
            status=motion.status,
            message=motion.message,
            time=motion.time,
            rotation=motion.rotation,
            solve_s=timed.solve_s,
            repeats=repeats,
            work=work_of_motion(settings, motion.counters) if motion.converged else counted(WORK, {}),
        )

    return Member(setting=setting, family=family, step=options.get("step") or math.nan, solve=solve)


def moving_baseline(module: Any, setting: str, family: str, step: float, **options: Any) -> Member:
    """Return the member of a baseline's module; a pivot that it refuses is a motion that stopped."""

    def solve(problem: Problem, duration: float) -> SolvedMotion:
        def run(repeat: int) -> SolvedMotion:
            motion: SolvedMotion = module.release(
                problem, start=problem.rotation, duration=duration, step=step, repeat=repeat, **options
            )
            return motion

        try:
            motion = run(1)
            repeats = _repeats_of(motion.solve_s)
            motion = run(repeats) if repeats > 1 else motion
        except (BaselineFailed, BadInput) as failure:
            return stopped(str(failure))
        return replace(motion, repeats=repeats, work=counted(WORK, motion.work))

    return Member(setting=setting, family=family, step=step, solve=solve)


def stopped(message: str) -> SolvedMotion:
    """Return the answer of a model that has no motion."""
    return SolvedMotion(
        status="not_converged",
        message=message,
        time=np.zeros(0),
        rotation=np.zeros(0),
        solve_s=math.nan,
        repeats=0,
        work=counted(WORK, {}),
    )


def _repeats_of(seconds: float) -> int:
    """Return how often a motion that takes so long is timed."""
    return int(min(REPEATS, max(1.0, AFFORDED / max(seconds, 1e-9))))


def at(motion: SolvedMotion, instants: Array) -> Array:
    """Return the rotation at `instants` [s] by cubic interpolation, NaN beyond the last record."""
    if len(motion.time) < 2:
        return np.full(len(instants), math.nan)
    return np.asarray(CubicSpline(motion.time, motion.rotation, extrapolate=False)(instants))


def motion_errors(motion: SolvedMotion, rotation: Array, instants: Array) -> dict[str, float]:
    """Return the errors of a whole motion against a rotation (T,) at `instants`, NaN of one that stopped.

    Keys: error_rotation_rad (largest over the motion), end_rotation_rad, error_frequency (relative).
    """
    names = ("error_rotation_rad", "end_rotation_rad", "error_frequency")
    if not motion.converged:
        return dict.fromkeys(names, math.nan)
    # a last record may fall short of the end by round-off
    gap = np.abs(at(motion, np.minimum(instants, motion.time[-1])) - rotation)
    frequency = swing_frequency(motion.time, motion.rotation).value
    exact = swing_frequency(instants, rotation).value
    values = (float(gap.max()), float(gap[-1]), abs(frequency / exact - 1.0))
    return dict(zip(names, values, strict=True))
