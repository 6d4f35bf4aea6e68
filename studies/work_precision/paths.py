"""Static paths of every model, ours and others', as what work-precision diagrams need of them."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.metrics import relative_error, trajectory_error
from studies.answers.settings import Settings
from studies.baselines.answer import BaselineFailed
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array
from studies.work_precision.work import work_of

QUANTITIES = ("trajectory", "torque", "stiffness")
#: Columns of machine-neutral work.
WORK = ("unknowns", "points", "iterations", "factorisation_flops", "assembly_flops", "flops")
#: Names of these in the counters of a baseline, where they differ.
THEIRS = {"iterations": "newton_iterations"}


@dataclass(frozen=True, kw_only=True)
class Answered:
    """The answer of any model.

    Attributes:
        status: "converged" or how it ended; message: why and where or when it stopped.
        solve_s: time of the increments or steps alone [s].
        work: machine-neutral work by column, NaN where it is not known.
    """

    status: str
    message: str
    solve_s: float
    work: Mapping[str, float]

    @property
    def converged(self) -> bool:
        """Whether it was followed to its end."""
        return self.status == "converged"


def counted(
    columns: Iterable[str], counters: Mapping[str, float], theirs: Mapping[str, str] | None = None
) -> dict[str, float]:
    """Return the columns of work from a model's counters, NaN of those that it does not count.

    theirs: names of columns in the counters, where they differ.
    """
    names = theirs or {}
    return {name: float(counters.get(names.get(name, name), math.nan)) for name in columns}


@dataclass(frozen=True, kw_only=True)
class SolvedPath(Answered):
    """A static path, S states, the unloaded one first; its work has the columns of `WORK`.

    Attributes:
        centre: (S, 2) [m]; torque: (S,) [N m]; stiffness: (S,) [N m / rad], NaN where a model gives none.
        wall_s: time of the whole answer [s], NaN if unknown.
    """

    centre: Array
    torque: Array
    stiffness: Array
    wall_s: float


@dataclass(frozen=True, kw_only=True)
class Member:
    """One setting of a model: its name, how fine it is, and how a path is asked of it."""

    setting: str
    count: int
    solve: Callable[[Problem, int], SolvedPath]


def of_settings(settings: Settings, setting: str, count: int) -> Member:
    """Return the member of one of the suite's own models."""

    def solve(problem: Problem, repeat: int) -> SolvedPath:
        answer = answer_static(problem, settings, repeat=repeat)
        return SolvedPath(
            status=answer.status,
            message=answer.message,
            centre=answer.centre,
            torque=answer.torque,
            stiffness=answer.stiffness,
            solve_s=answer.solve_s,
            wall_s=answer.wall_s,
            work=dict(work_of(settings, answer.counters).row()),
        )

    return Member(setting=setting, count=count, solve=solve)


def of_baseline(module: Any, setting: str, count: int, **settings: Any) -> Member:
    """Return the member of a baseline's module; a pivot that it refuses is an answer that stopped."""

    def solve(problem: Problem, repeat: int) -> SolvedPath:
        rotations = np.linspace(0.0, problem.rotation, problem.increments + 1)
        try:
            path = module.static_path(problem, rotations, repeat=repeat, **settings)
        except (BaselineFailed, BadInput) as stopped:
            return unsolved(str(stopped))
        return SolvedPath(
            status="converged",
            message="",
            centre=path.centre,
            torque=path.torque,
            stiffness=path.stiffness,
            solve_s=path.solve_s,
            wall_s=math.nan,
            work=counted(WORK, path.work, THEIRS),
        )

    return Member(setting=setting, count=count, solve=solve)


def unsolved(message: str) -> SolvedPath:
    """Return the answer of a model that did not reach the end of the path."""
    nothing = np.full(0, np.nan)
    return SolvedPath(
        status="not_converged",
        message=message,
        centre=nothing.reshape(0, 2),
        torque=nothing,
        stiffness=nothing,
        solve_s=math.nan,
        wall_s=math.nan,
        work=counted(WORK, {}),
    )


def path_errors(path: SolvedPath, against: SolvedPath) -> dict[str, float]:
    """Return the largest and the end errors of a whole path, NaN of one that stopped early.

    Keys: error_trajectory, error_torque, error_stiffness (largest magnitude over the path), and the same with
    end_ for its last state.
    """
    names = [f"{kind}_{name}" for kind in ("error", "end") for name in QUANTITIES]
    if not path.converged or len(path.torque) < len(against.torque):
        return dict.fromkeys(names, math.nan)
    errors = {
        "trajectory": trajectory_error(path.centre, against.centre),
        "torque": np.abs(relative_error(path.torque, against.torque)),
        "stiffness": np.abs(relative_error(path.stiffness, against.stiffness)),
    }
    largest = {f"error_{name}": float(values.max()) for name, values in errors.items()}
    return largest | {f"end_{name}": float(values[-1]) for name, values in errors.items()}
