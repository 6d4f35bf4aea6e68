"""The dynamic spline with the interface of a baseline, so that all are timed alike: compiled solve alone.

Static paths are timed around `spline_model.reduced.solve.run`, with geometry and quadrature prepared, as the
set-up of other codes is left out too.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from spline_model.compile import compile_scene
from spline_model.dynamics import Trajectory, solve_release
from spline_model.motion.explicit import flight
from spline_model.motion.start import set_in_motion
from spline_model.pivot import Pivot, cross_axis_pivot, swinging_slide_stiffness
from spline_model.preload import is_preloaded
from spline_model.reduced.elements import Elements, followed
from spline_model.reduced.equilibrium import EVALUATIONS, ITERATIONS
from spline_model.reduced.model import at_rest
from spline_model.reduced.path import Answer
from spline_model.reduced.solve import run
from studies.baselines.answer import (
    BaselineFailed,
    SolvedMotion,
    SolvedPath,
    checked_release,
    checked_rotations,
    median_seconds,
)
from studies.cases.problem import Problem
from studies.errors import BadInput

model = "spline"
#: Records of a leapfrog run, some 50 of every period of the strips' own oscillations.
RECORDS = 2500


def installed() -> bool:
    """Return True: the model is this repository's."""
    return True


def static_path(
    problem: Problem,
    rotations: Any,
    *,
    repeat: int = 1,
    control_points: int = 6,
    gauss_points: int | None = None,
) -> SolvedPath:
    """Drive the body through `rotations` (S,) [rad], the first of which is 0, in compiled code.

    Args:
        problem: the pivot.
        rotations: (S,) [rad].
        repeat: timed solves of the whole path [1].
        control_points: n a strip [1]; gauss_points: of its quadrature, default n + 2 [1].

    Raises:
        BadInput: a scene that the condensed path does not cover. BaselineFailed: the path is not reached.
    """
    turns = checked_rotations(rotations)
    largest = float(turns[np.abs(turns).argmax()])
    pivot = _pivot(problem, control_points=control_points, gauss_points=gauss_points)
    elements = followed(compile_scene(pivot.driven(largest)))
    if not isinstance(elements, Elements) or is_preloaded(elements.system):
        raise BadInput(f"spline: got the effects {', '.join(pivot.effects)}, expected an element's")
    scene, factors, start = elements.model, turns / largest, at_rest(elements.model)

    def prepare() -> Callable[[], Answer]:
        return lambda: run(elements, factors, start)

    answer = prepare()()
    if len(answer.y) < len(turns):
        raise BaselineFailed(f"spline with {control_points} control points: the path is not reached")
    seconds = median_seconds(prepare, repeat)
    return SolvedPath(
        rotation=turns,
        centre=answer.y[:, :2] * scene.length,
        torque=answer.reaction[:, 0] * scene.energy,
        stiffness=answer.stiffness * scene.energy,
        solve_s=seconds,
        work={
            "unknowns": len(start) - 1,
            "newton_iterations": int(answer.counters[ITERATIONS]),
            "factorisations": int(answer.counters[EVALUATIONS]),
        },
    )


def release(
    problem: Problem,
    *,
    start: float,
    duration: float,
    step: float,
    repeat: int = 1,
    control_points: int = 6,
    integrator: str = "energy",
) -> SolvedMotion:
    """Let go of the body at rest at `start` [rad] and follow it for `duration` [s] in steps of `step` [s].

    Timed is the compiled run of the leapfrog alone, its arrays prepared as those of other codes are; else
    `solve_release` less a release of one step: so set-up and the static path to the start are left out.

    Args:
        control_points: n a strip [1]; integrator: of `spline_model.dynamics`.

    Raises:
        BaselineFailed: the motion stopped early.
    """
    steps = checked_release(start, duration, step)
    h = duration / steps
    pivot = _pivot(
        problem,
        control_points=control_points,
        slide_stiffness=swinging_slide_stiffness(control_points),
    )
    every = max(1, steps // RECORDS) if integrator == "leapfrog" else 1
    records = {"records": steps // every} if every > 1 else {}

    def run(length: float, **more: Any) -> Callable[[], Any]:
        return lambda: solve_release(
            pivot, start=start, duration=length, step=h, integrator=integrator, check=False, **more
        )

    motion = run(duration, **records)()
    if motion.message:
        raise BaselineFailed(f"spline with {control_points} control points: {motion.message}")
    if integrator == "leapfrog":
        seconds = median_seconds(_leapfrog(pivot, motion), repeat)
    else:
        seconds = median_seconds(lambda: run(duration), repeat) - median_seconds(lambda: run(h), repeat)
    return SolvedMotion(
        time=motion.time,
        rotation=np.asarray(motion.rotation),
        solve_s=max(seconds, 0.0),
        work=dict(motion.counters),
    )


def _leapfrog(pivot: Pivot, motion: Trajectory) -> Callable[[], Callable[[], int]]:
    """Return what prepares the compiled run of a motion once more."""
    system = compile_scene(pivot.released())
    moving, step, rows = set_in_motion(system), motion.settings["step_s"], len(motion.time)
    every = motion.counters["steps"] // (rows - 1)

    def prepare() -> Callable[[], int]:
        start = flight(system, moving, motion.states[0], motion.velocities[0], rows - 1, "leapfrog")
        return lambda: start.fly(step, every)

    return prepare


def _pivot(problem: Problem, **discretisation: Any) -> Pivot:
    """Return the pivot in the spline model."""
    return cross_axis_pivot(
        **problem.pivot_parameters(),
        effects=problem.effects.names,
        parameters=problem.effects.parameters(),
        **discretisation,
    )
