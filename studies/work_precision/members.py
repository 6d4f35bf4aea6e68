"""Static paths and motions of every model as diagrams need them, and the limit that each theory tends to."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import relative_error, swing_frequency, trajectory_error
from studies.answers.motion import Motion
from studies.answers.reference import MESHES, QUANTITIES, limit_of
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.baselines.answer import BaselineFailed, SolvedMotion, SolvedPath
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array
from studies.work_precision.work import MOVED_WORK, WORK, work_of, work_of_motion

#: Names of columns of work in the counters of a baseline, where they differ.
THEIRS = {"iterations": "newton_iterations"}


def _counted(columns: Iterable[str], counters: Mapping[str, float]) -> dict[str, float]:
    """Return the columns of work from a model's counters, NaN of those that it does not count."""
    return {name: float(counters.get(name, counters.get(THEIRS.get(name, ""), math.nan))) for name in columns}


@dataclass(frozen=True, kw_only=True)
class Member:
    """One setting of a model.

    Attributes:
        setting: its name; count: how fine it is, among paths.
        family: the settings that differ from it in the step alone; step: [s], NaN where the model chooses.
        solve: the path of a problem, timed so many times [1], or its motion over a duration [s].
    """

    setting: str
    solve: Callable[[Any, Any], Any]
    count: int = 0
    family: str = "all"
    step: float = math.nan


def of_settings(settings: Settings, setting: str, count: int, accuracy: float | None = None) -> Member:
    """Return the member of one of the suite's own models; of a spline by itself with the wanted accuracy."""

    def solve(problem: Design, repeat: int) -> SolvedPath:
        answer = answer_static(problem, settings, repeat=repeat, accuracy=accuracy)
        chosen = {} if accuracy is None else {"control_points": answer.settings["control_points"]}
        return SolvedPath.of(answer, work=work_of(replace(settings, **chosen), answer.counters))

    return Member(setting=setting, count=count, solve=solve)


def of_baseline(module: Any, setting: str, count: int, **settings: Any) -> Member:
    """Return the member of a baseline's module; a pivot that it refuses is an answer that stopped."""

    def solve(problem: Problem, repeat: int) -> SolvedPath:
        rotations = np.linspace(0.0, problem.rotation, problem.increments + 1)
        try:
            path: SolvedPath = module.static_path(problem, rotations, **settings).timed(repeat)
        except (BaselineFailed, BadInput) as stopped:
            return _unsolved(str(stopped))
        return replace(path, work=_counted(WORK, path.work))

    return Member(setting=setting, count=count, solve=solve)


def _unsolved(message: str) -> SolvedPath:
    """Return the answer of a model that did not reach the end of the path."""
    nothing = np.full(0, np.nan)
    return SolvedPath(
        status="not_converged",
        message=message,
        rotation=nothing,
        centre=nothing.reshape(0, 2),
        torque=nothing,
        stiffness=nothing,
        solve_s=math.nan,
        work=_counted(WORK, {}),
    )


def path_errors(path: SolvedPath, against: SolvedPath) -> dict[str, float]:
    """Return the largest and the end errors of a whole path, NaN of one that stopped early and of what a
    model does not give.

    Keys: error_ with each of `QUANTITIES` (largest magnitude over the path), and the same with end_ for its
    last state.
    """
    names = [f"{kind}_{name}" for kind in ("error", "end") for name in QUANTITIES]
    if not path.converged or len(path.torque) < len(against.torque):
        return dict.fromkeys(names, math.nan)
    errors = {
        "trajectory": trajectory_error(path.centre, against.centre),
        "torque": np.abs(relative_error(path.torque, against.torque)),
        "stiffness": np.abs(relative_error(path.stiffness, against.stiffness)),
        "stress": np.full(len(path.torque), math.nan),
    }
    if path.max_stress is not None and against.max_stress is not None:
        errors["stress"] = np.abs(relative_error(path.max_stress, against.max_stress))
    largest = {f"error_{name}": float(values.max()) for name, values in errors.items()}
    return largest | {f"end_{name}": float(values[-1]) for name, values in errors.items()}


#: Theories of a strip, by what their energies are measured in.
THEORIES = {
    "material": "bending per reference length, no shear",
    "spatial": "bending per current length, as the paper's Eq 10, no shear",
    "shear": "bending per reference length, with shear",
}
#: Control points of the spatial limit, and of the one below that says how uncertain it is.
SPATIAL = (15, 13)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """The limit of a theory.

    Attributes:
        path: the limit; its times mean nothing.
        uncertainty: largest relative error of it over the path, of each of `QUANTITIES` [1].
        source: what it was taken from.
    """

    path: SolvedPath
    uncertainty: Mapping[str, float]
    source: str


def limit_of_theory(problem: Design, theory: str) -> Limit:
    """Return the limit of a theory on a problem.

    Material and shear: the elements' limit of refinement, which shares no code with the splines. Spatial: no
    elements have it, so a spline finer than any that is shown, and its distance to a coarser one.

    Raises:
        NoReference: the elements do not reach the end of the path.
    """
    if theory == "spatial":
        return _spatial(problem)
    element = "corotational" if theory == "material" else "reissner"
    answers = [answer_static(problem, FeSettings(elements=count, element=element)) for count in MESHES]
    limit = limit_of(answers)
    return Limit(
        path=replace(
            _unsolved(""),
            status="converged",
            centre=limit.centre,
            torque=limit.torque,
            stiffness=limit.stiffness,
            max_stress=limit.max_stress,
        ),
        uncertainty=limit.uncertainty,
        source=f"{element} elements, {', '.join(map(str, MESHES))} a strip, extrapolated",
    )


def _spatial(problem: Design) -> Limit:
    fine, coarse = (
        of_settings(SplineSettings(control_points=n, measure="spatial"), "", n).solve(problem, 1)
        for n in SPATIAL
    )
    gap = path_errors(coarse, fine)
    return Limit(
        path=fine,
        uncertainty={name: gap[f"error_{name}"] for name in QUANTITIES},
        source=f"spline with {SPATIAL[0]} control points; its distance to one with {SPATIAL[1]}",
    )


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
            return _stopped(str(refused))
        if not motion.converged:
            return SolvedMotion.of(motion, repeats=0, work=_counted(MOVED_WORK, {}))
        repeats = _repeats_of(motion.solve_s)
        work = work_of_motion(settings, motion.counters)
        return SolvedMotion.of(
            motion, solve_s=run(TIMED_RECORDS, repeats).solve_s, repeats=repeats, work=work
        )

    return Member(setting=setting, family=family, step=options.get("step") or math.nan, solve=solve)


def moving_baseline(module: Any, setting: str, family: str, step: float, **options: Any) -> Member:
    """Return the member of a baseline's module; a pivot that it refuses is a motion that stopped."""

    def solve(problem: Problem, duration: float) -> SolvedMotion:
        try:
            motion: SolvedMotion = module.release(
                problem, start=problem.rotation, duration=duration, step=step, **options
            ).timed(1)
            repeats = _repeats_of(motion.solve_s)
            motion = motion.timed(repeats) if repeats > 1 else motion
        except (BaselineFailed, BadInput) as failure:
            return _stopped(str(failure))
        return replace(motion, repeats=repeats, work=_counted(MOVED_WORK, motion.work))

    return Member(setting=setting, family=family, step=step, solve=solve)


def _stopped(message: str) -> SolvedMotion:
    """Return the answer of a model that has no motion."""
    return SolvedMotion(
        status="not_converged",
        message=message,
        time=np.zeros(0),
        rotation=np.zeros(0),
        solve_s=math.nan,
        repeats=0,
        work=_counted(MOVED_WORK, {}),
    )


def _repeats_of(seconds: float) -> int:
    """Return how often a motion that takes so long is timed."""
    return int(min(REPEATS, max(1.0, AFFORDED / max(seconds, 1e-9))))


def at(motion: SolvedMotion | Motion, instants: Array) -> Array:
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
