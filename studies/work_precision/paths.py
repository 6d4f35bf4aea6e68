"""Static paths of every model, ours and others', as diagrams need them, and the limit of each theory."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_path
from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.reference import MESHES, QUANTITIES, limit_of
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.baselines.answer import BaselineFailed, SolvedPath
from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.work_precision.work import work_of

#: Columns of machine-neutral work.
WORK = ("unknowns", "points", "iterations", "factorisation_flops", "assembly_flops", "flops")
#: Names of these in the counters of a baseline, where they differ.
THEIRS = {"iterations": "newton_iterations"}


def counted(
    columns: Iterable[str], counters: Mapping[str, float], theirs: Mapping[str, str] | None = None
) -> dict[str, float]:
    """Return the columns of work from a model's counters, NaN of those that it does not count.

    theirs: names of columns in the counters, where they differ.
    """
    names = theirs or {}
    return {name: float(counters.get(names.get(name, name), math.nan)) for name in columns}


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
        answer = answer_path(problem, settings, repeat=repeat, accuracy=accuracy)
        chosen = {} if accuracy is None else {"control_points": answer.settings["control_points"]}
        return SolvedPath(
            status=answer.status,
            message=answer.message,
            rotation=answer.rotation,
            centre=answer.centre,
            torque=answer.torque,
            stiffness=answer.stiffness,
            max_stress=answer.max_stress,
            solve_s=answer.solve_s,
            wall_s=answer.wall_s,
            work=dict(work_of(replace(settings, **chosen), answer.counters).row()),
        )

    return Member(setting=setting, count=count, solve=solve)


def of_baseline(module: Any, setting: str, count: int, **settings: Any) -> Member:
    """Return the member of a baseline's module; a pivot that it refuses is an answer that stopped."""

    def solve(problem: Problem, repeat: int) -> SolvedPath:
        rotations = np.linspace(0.0, problem.rotation, problem.increments + 1)
        try:
            path: SolvedPath = module.static_path(problem, rotations, repeat=repeat, **settings)
        except (BaselineFailed, BadInput) as stopped:
            return unsolved(str(stopped))
        return replace(path, work=counted(WORK, path.work, THEIRS))

    return Member(setting=setting, count=count, solve=solve)


def unsolved(message: str) -> SolvedPath:
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
        work=counted(WORK, {}),
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
    answers = [answer_path(problem, FeSettings(elements=count, element=element)) for count in MESHES]
    limit = limit_of(answers)
    return Limit(
        path=replace(
            unsolved(""),
            status="converged",
            centre=limit.centre,
            torque=limit.torque,
            stiffness=limit.stiffness,
            max_stress=limit.stress,
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
