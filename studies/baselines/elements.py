"""The suite's own finite elements with the interface of a baseline, so that all are timed alike."""

from dataclasses import replace
from typing import Any

from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings
from studies.baselines.answer import (
    BaselineFailed,
    SolvedMotion,
    SolvedPath,
    checked_release,
    checked_rotations,
)
from studies.cases.problem import Problem

model = "finite elements"


def installed() -> bool:
    """Return True: the model is this repository's."""
    return True


def static_path(problem: Problem, rotations: Any, *, repeat: int = 1, elements: int = 20) -> SolvedPath:
    """Drive the body through equal `rotations` (S,) [rad], the first of which is 0; increments are timed.

    Raises:
        BaselineFailed: the path is not reached.
    """
    turns = checked_rotations(rotations)
    asked = replace(problem, rotation=float(turns[-1]), increments=len(turns) - 1)
    answer = answer_static(asked, FeSettings(elements=elements), repeat=repeat)
    if not answer.converged:
        raise BaselineFailed(f"{elements} elements: {answer.message}")
    return SolvedPath(
        rotation=turns,
        centre=answer.centre,
        torque=answer.torque,
        stiffness=answer.stiffness,
        solve_s=answer.solve_s,
        wall_s=answer.wall_s,
        work=answer.counters,
    )


def release(
    problem: Problem,
    *,
    start: float,
    duration: float,
    step: float,
    repeat: int = 1,
    elements: int = 20,
    integrator: str = "generalised-alpha",
) -> SolvedMotion:
    """Let go of the body at rest at `start` [rad] and follow it for `duration` [s]; its steps are timed.

    Args:
        step: [s]; of central differences not read: they take the longest that is stable.

    Raises:
        BaselineFailed: the motion stopped early.
    """
    steps = checked_release(start, duration, step)
    own: dict[str, Any] = {} if integrator == "central-difference" else {"step": duration / steps}
    motion = answer_release(
        problem, FeSettings(elements=elements), start=start, duration=duration, records=min(steps, 2500),
        integrator=integrator, repeat=repeat, **own,
    )  # fmt: skip
    if not motion.converged:
        raise BaselineFailed(f"{elements} elements: {motion.message}")
    return SolvedMotion(
        time=motion.time, rotation=motion.rotation, solve_s=motion.solve_s, work=motion.counters
    )
