"""How fast the sweeps over the constraints come to the direct solution of the impulses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.impulses.forces import fill_drag
from spline_model.impulses.printed import printed_advance
from spline_model.impulses.solver import ImpulseSolver, Run, State
from spline_model.impulses.stable import EULER, predict, solve_step

Array = NDArray[np.float64]


def sweep_errors(direct: ImpulseSolver, swept: ImpulseSolver, state: State, h: float, most: int) -> Array:
    """Error of the velocity after 1 ... ``most`` sweeps of the first linear system of a step, (most,) [1].

    In the kinetic norm, over the change of velocity in the step. Both solvers are of one scene and form, one
    of them without and one with sweeps, and the state is one of either.
    """
    mass = direct.motion.mass
    exact = _velocity(direct, state, h, 1)
    change = exact - state.v
    scale = np.sqrt(change @ mass @ change)
    errors = [_velocity(swept, state, h, sweeps) - exact for sweeps in range(1, most + 1)]
    return np.array([np.sqrt(error @ mass @ error) / scale for error in errors])


def contraction(errors: Array, floor: float = 1e-10) -> float:
    """Factor that a sweep leaves of the error, from the last three above the floor; above 1 it grows."""
    seen = errors[errors > floor]
    last = seen[-4:] if len(seen) >= 2 else errors[:2]
    return float((last[-1] / last[0]) ** (1.0 / (len(last) - 1)))


def _velocity(solver: ImpulseSolver, state: State, h: float, sweeps: int) -> Array:
    """The velocity (Q,) after that many sweeps of the first linear system of a step."""
    moving, space = Run(solver, state).moving, solver.space
    tiny = float(np.finfo(float).tiny)
    problem = solver.problem._replace(sweeps=sweeps, iterations=1, tolerance=tiny, least_part=1.0)
    if solver.form == "printed":
        printed_advance(moving, state.time, h, problem, space)
        return moving.v.copy()
    span, lag = predict(moving, h, EULER, problem.turns, space)
    fill_drag(state.z, problem, space)
    solve_step(span, lag, state.time + h, problem, space, moving.counters)
    return space.v.copy()
