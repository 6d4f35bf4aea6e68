"""The paper's sequential impulse solver (section 4.1, Eqs 21 to 30), and a form that is stable at any step.

Both do an unconstrained update of strips and bodies one by one and then apply impulses until
the constraints hold, at a fixed step h.

"printed"  Elastic forces explicit, impulses at the level of velocities: symplectic Euler,
           first order, stable while omega h < 2 for the highest frequency of the constrained
           system. Nothing pulls positions back, so that the constraints drift.
"stable"   Elastic forces implicit, the axial ones as constraints with compliance, constraints
           fulfilled by the positions, iterations begun from the forces of the step before,
           backward differences of second order. What a step does not resolve is damped. No step
           gains energy while the ground holds the mechanism and no drive acts: where the
           differences would, the velocity is reduced.

Impulses are found at once ("direct", Eq 30 as it stands), by sweeps over the strips, each solved
with its axial forces and both clamps ("strips"), or over single constraints ("constraints").
Misprints of the paper are corrected: Eqs 22 and 23 begin from the state before, Eq 26 has the
transposed Jacobian, Eq 30 its minus sign.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import compile_scene
from spline_model.content import STEPS_PER_PERIOD
from spline_model.effects import DrivenDisplacement, DrivenRotation
from spline_model.errors import InvalidParameter, require_positive
from spline_model.impulses.forces import fill_drag
from spline_model.impulses.solver import TOLERANCE, ImpulseSolver, Outcome, Run, State
from spline_model.impulses.steps import EULER, predict, printed_advance, solve_step
from spline_model.mechanism import Mechanism
from spline_model.modes import linear_modes, static_state
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Steps
from spline_model.newton import Laps

__all__ = [
    "ImpulseSolver",
    "Outcome",
    "State",
    "contraction",
    "impulse_solver",
    "solve_impulses",
    "stability_limit",
    "sweep_errors",
]

Array = NDArray[np.float64]

STEP = 0.01
"""The paper's step: a quarter of the time between two pictures at 25 Hz [s]."""
SWEEPS = 30
"""Default of the most sweeps for one linear system."""
STABILITY_LIMIT = 2.0
"""omega h up to which symplectic Euler does not amplify an oscillation."""
_REASONS = {
    "printed": "the step is above the stability limit",
    "stable": "no part of the step can be solved, or a strip folds; take a shorter one",
}
"""Why a run of a form stops."""


def impulse_solver(
    pivot: Mechanism,
    *,
    body: str | None = None,
    form: str = "stable",
    impulses: str = "direct",
    sweeps: int = SWEEPS,
    tolerance: float = TOLERANCE,
) -> ImpulseSolver:
    """A solver for steps one at a time, of which the named body, or the only one, can be given a pose.

    Parameters
    ----------
    form : "printed" or "stable", see above.
    impulses, sweeps : how they are found, see above, and the most sweeps for one linear system. Sweeps
        over strips converge at any step, the slower the longer it is; those over constraints
        diverge in the stable form where the step is long against the strips' bending.
    tolerance : residual of a stable step and gap that ends the sweeps, in EI/L^2, EI/L, L, rad.

    Raises InvalidParameter.
    """
    mechanism = pivot.in_motion()
    mechanism.released()
    scene = mechanism.scene
    if mechanism.design.bodies:
        name = mechanism.design.body_named(body)
        drives = DrivenDisplacement(body=name, displacement=(0.0, 0.0)), DrivenRotation(body=name, angle=0.0)
        scene = mechanism.with_effects(*drives)
    return ImpulseSolver(
        mechanism, compile_scene(scene), form=form, impulses=impulses, sweeps=sweeps, tolerance=tolerance
    )


def stability_limit(pivot: Mechanism, rotation: float | None = None) -> float:
    """2 / omega [s] of the highest frequency about the static state at a rotation [rad], or undriven.

    The step of the printed form must stay below it.
    """
    mechanism = pivot.in_motion()
    system = compile_scene(mechanism.released())
    z = static_state(mechanism, rotation)[: system.layout.size]
    highest = linear_modes(system, z, system.mass)[0][-1]
    return STABILITY_LIMIT / math.sqrt(highest)


def solve_impulses(
    pivot: Mechanism,
    *,
    start: float | None = None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
    duration: float = 0.05,
    step: float = STEP,
    form: str = "stable",
    impulses: str = "direct",
    sweeps: int = SWEEPS,
    tolerance: float = TOLERANCE,
    records: int | None = None,
) -> Trajectory:
    """Motion from the static state at the rotation ``start`` [rad] of a body, at rest, as ``solve_motion``.

    body, drive, duration, records: as there; form, impulses, sweeps, tolerance: as of
    ``impulse_solver``; step [s] is shortened so that a whole number of steps fits between the
    records. A body that a drive
    catches loses the velocity that the drive does not have, and with it energy, which counts as
    dissipated; what the stable form's steps damp does not.

    Raises InvalidParameter, and ConvergenceError if statics does not reach ``start``.
    """
    mechanism = pivot.in_motion()
    for name, value in (("duration", duration), ("step", step)):
        require_positive(name, value, "s")
    if start is not None and not math.isfinite(start):
        raise InvalidParameter("start", start, "a finite angle [rad]")
    laps, body = Laps(), mechanism.design.body_named(body)
    released = mechanism.released()
    system = compile_scene(released if drive is None else released.with_effects(drive))
    solver = ImpulseSolver(
        mechanism, system, form=form, impulses=impulses, sweeps=sweeps, tolerance=tolerance
    )
    steps = Steps.of(duration, step, records, 2 * system.layout.size)
    laps.lap("compile")
    run = Run(solver, solver.start(start, body), steps.records - 1)
    laps.lap("start")
    done = _follow(run, *steps)
    laps.lap("solve")
    message = "" if done == steps.steps else f"stopped at {done * steps.step:.6g} s: {_REASONS[form]}"
    settings = {"integrator": f"sequential impulses, {form}", "step_s": steps.step}
    settings |= {"impulses": impulses} | ({} if impulses == "direct" else {"sweeps": sweeps})
    return Trajectory.of(
        system,
        run.records(steps.spacing, done // steps.every + 1, message),
        effects=mechanism.effects,
        body=body,
        settings=settings,
        unresolved=partial(_resolution, solver, steps.step),
        laps=laps,
    )


def _follow(run: Run, h: float, steps: int, every: int) -> int:
    """Take the steps, drives beginning and ending at the nearest one; returns the number taken."""
    solver = run.solver
    motion = solver.motion
    before = np.zeros(len(motion.drives.row), dtype=np.int64)
    done = 0
    instants = {round(time / h) for time in motion.event_times(steps * h, h)} - {0, steps}
    for begin, end in pairwise((0, *sorted(instants), steps)):
        active = motion.drives_at((begin + 0.5) * h)
        z, v = run.moving.z, run.moving.v
        motion = motion.from_here(z, active, before, begin * h)
        run.change(*motion.catch(z, v, active, begin * h, h))
        if begin == 0:
            run.keep_start()
        done = run.go(begin, end, h, 0.0, every, active, motion)
        if done < end:
            return done
        before = active
    return done


def _resolution(solver: ImpulseSolver, h: float) -> str:
    """How far a step under-resolves the swing at rest, or an empty string."""
    squares = linear_modes(solver.system, solver.system.rest, solver.motion.mass)[0]
    period = 2 * math.pi / math.sqrt(squares[0]) if squares[0] > 0 else math.inf
    if h * STEPS_PER_PERIOD <= period:
        return ""
    return (
        f"the step of {h:g} s is {h / period:.3g} of the swing's period at rest: "
        f"take {period / STEPS_PER_PERIOD:.2g} s or less for its phase and amplitude"
    )


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
    problem = solver.problem._replace(sweeps=sweeps, iterations=1, tolerance=tiny)
    if solver.form == "printed":
        printed_advance(moving, state.time, h, problem, space)
        return moving.v.copy()
    span, lag = predict(moving, h, EULER, problem.turns, space)
    fill_drag(state.z, problem, space)
    solve_step(span, lag, state.time + h, problem, space, moving.counters)
    return space.v.copy()
