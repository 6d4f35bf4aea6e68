"""The paper's sequential impulse solver (section 4.1, Eqs 21 to 30), and a form that is stable at any step.

Both do an unconstrained update of strips and bodies one by one and then apply impulses until
the constraints hold, at a fixed step h.

"published"  Elastic forces explicit, impulses at the level of velocities: symplectic Euler,
           first order, stable while omega h < 2 for the highest frequency of the constrained
           system. Nothing pulls positions back, so that the constraints drift.
"stable"   Elastic forces implicit, the axial ones as constraints with compliance, constraints
           fulfilled by the positions, iterations begun from the forces of the step before,
           backward differences of second order. What a step does not resolve is damped. No step
           gains energy while the ground holds the mechanism and no drive acts: where the
           differences would, the velocity is reduced.

Impulses are found at once (Eq 30), or, as published, by sweeps over single constraints (Eqs 24 to 26).
Misprints of the paper are corrected: Eqs 22 and 23 begin from the state before, Eq 26 has the
transposed Jacobian, Eq 30 its minus sign.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.content import STEPS_PER_PERIOD
from spline_model.effects import DrivenDisplacement, DrivenRotation
from spline_model.effects.elastic import ANTICLASTIC
from spline_model.errors import (
    InvalidParameter,
    present,
    require_choice,
    require_count,
    require_finite,
    require_positive,
)
from spline_model.impulses.arrays import Problem, Space
from spline_model.impulses.stepper import REASONS, Outcome, State, Stepper
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.modes import linear_modes
from spline_model.motion.arrays import zeros
from spline_model.motion.moves import Steps, carry
from spline_model.motion.records import Trajectory
from spline_model.motion.start import Motion, set_in_motion
from spline_model.newton import Laps
from spline_model.statics import static_state

Array = NDArray[np.float64]

STEP = 0.01
"""The paper's step: a quarter of the time between two pictures at 25 Hz [s]."""
TOLERANCE = 1e-9
"""Residual of a stable step, and gap that sweeps close, in EI/L^2, EI/L, L and rad."""
STABILITY_LIMIT = 2.0
"""omega h up to which symplectic Euler does not amplify an oscillation."""


class ImpulseSolver:
    """Steps of one scene; ``impulse_solver`` makes one.

    Holds work space, so that no two threads may use it at once. What it returns shares no memory
    with it: the same state and arguments give the same bits.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        system: System,
        *,
        form: str,
        sweeps: int | None,
        tolerance: float,
    ) -> None:
        form = present(form)
        require_choice("form", form, tuple(REASONS))
        require_positive("tolerance", tolerance, "1")
        if sweeps is not None:
            require_count("sweeps", sweeps, 1)
            if form == "stable":
                raise InvalidParameter("sweeps", sweeps, "none of the stable form, which is solved at once")
        mechanism.design.require_uncut("sequential impulses")
        self.motion, soft = set_in_motion(system), form == "stable"
        held = "another one for sequential impulses"
        if ANTICLASTIC in mechanism.design.curling:
            raise InvalidParameter("effects", ANTICLASTIC, held)
        self.mechanism, self.system, self.form = mechanism, system, form
        self.problem = Problem.of(self.motion, soft=soft, sweeps=sweeps, tolerance=tolerance)
        sizes = {"N": len(self.problem.unit), "Q": len(self.problem.mass), "R": len(self.problem.rows)}
        self.space = zeros(Space, sizes | {"M": len(self.problem.rigidity)})

    def start(self, rotation: float | None = None, body: str | None = None) -> State:
        """The static state at the rotation [rad] of a body, or undriven: where the paper's releases start.

        Raises ConvergenceError if statics does not reach it.
        """
        if rotation is not None:
            require_finite("rotation", rotation, "rad")
        return self.start_at(static_state(self.mechanism.at_start(), rotation, body=body))

    def start_at(self, z: Array, v: Array | None = None) -> State:
        """Return a state at the unknowns z (N or more,) [m, rad, N], at rest or with velocity v (Q,).

        z may be another system's of the same strips and bodies, such as of statics with other drives:
        its additional unknowns are ignored. The constraints should hold in both.
        """
        layout = self.system.layout
        count = layout.coordinate_count
        given = np.asarray(z, dtype=float)
        speed = np.zeros(count) if v is None else np.array(v, dtype=float)
        _require_numbers("z", given, count, math.inf, "m, rad, N")
        _require_numbers("v", speed, count, count, "m/s, rad/s")
        unknowns = np.zeros(layout.size)
        same = min(len(given), layout.size)
        unknowns[:same] = given[:same]
        unknowns[self.motion.drives.row] = 0.0
        earlier = np.array((unknowns[:count], speed))
        return State(z=unknowns, v=speed, earlier=earlier, known=0, time=0.0, held=False)

    def step(self, state: State, h: float, count: int = 1, pose: Array | None = None) -> Outcome:
        """Take ``count`` steps of length h [s].

        pose (3,): x, y [m] and rotation [rad] of the solver's body at the end of them, on a straight
        way from where it is; the body is caught if it was free, and free again without one.
        """
        require_positive("h", h, "s")
        require_count("count", count, 1)
        held = pose is not None
        if held != state.held:
            state = replace(state, known=0)
        stepper = self.stepper(state)
        if pose is not None:
            way = self._driven(state, np.asarray(pose, dtype=float), h * count)
            stepper.drive(way, np.ones_like(self.problem.active))
        taken = stepper.steps(state.time, h, 0, count, count + 1, np.zeros((0, stepper.width)))
        return stepper.outcome(taken, count, state.time + taken * h, held)

    def look(self, state: State) -> Outcome:
        """Return the outcome of no steps: what a state is."""
        return self.stepper(state).outcome(0, 0, state.time, state.held)

    def stepper(self, state: State) -> Stepper:
        """Return steps from a state on, in the solver's work space."""
        return Stepper(self.motion, self.problem, self.space, self.form, state)

    def _driven(self, state: State, pose: Array, duration: float) -> Motion:
        """The motion with its drives on the way from the state to the pose."""
        drives = self.motion.drives
        _require_numbers("pose", pose, drives.row.size, drives.row.size, "m, rad")
        here = state.z[drives.coordinate]
        way = drives._replace(
            origin=here,
            target=pose - here,
            first=np.zeros(pose.size, dtype=np.int64),
            pairs=np.full(pose.size, 2, dtype=np.int64),
            times=np.array([state.time, state.time + duration]),
            factors=np.array([0.0, 1.0]),
        )
        return replace(self.motion, drives=way)


def impulse_solver(
    pivot: Mechanism,
    *,
    body: str | None = None,
    form: str = "stable",
    sweeps: int | None = None,
    tolerance: float = TOLERANCE,
) -> ImpulseSolver:
    """Return a solver for single steps, in which one body can be given a pose.

    Parameters
    ----------
    pivot : Mechanism
    body : str, default None
        Body that can be given a pose; None is the only one.
    form : str
        "published" or "stable" (default); see ``spline_model.sequential_impulse``.
    sweeps : int, default None
        Largest number of sweeps over single constraints for one linear system of the published form; None
        solves it directly. Sweeps converge slowly where strips cannot stretch.
    tolerance : float, EI/L^2, EI/L, m over L, rad, default 1e-9
        Residual of a stable step, and gap that ends the sweeps.

    Returns
    -------
    ImpulseSolver
        It has its own work space: one thread at a time may use it.

    Raises
    ------
    InvalidParameter
        A value outside its range, or an effect that impulses do not support.

    References
    ----------
    Valentini and Pezzuti (2013), section 4.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> impulse_solver(pivot).form
    'stable'
    """
    require_mechanism(pivot)
    mechanism = pivot.in_motion()
    mechanism.released()
    scene = mechanism.scene
    if mechanism.design.bodies:
        name = mechanism.design.body_named(body)
        drives = DrivenDisplacement(body=name, displacement=(0.0, 0.0)), DrivenRotation(body=name, angle=0.0)
        scene = mechanism.scene.with_effects(*drives)
    return ImpulseSolver(mechanism, compile_scene(scene), form=form, sweeps=sweeps, tolerance=tolerance)


def stability_limit(pivot: Mechanism, rotation: float | None = None) -> float:
    """Return the limit 2 / omega [s] of the step of the published form.

    omega is the highest frequency about the static state at a rotation [rad]; None drives no rotation.
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
    sweeps: int | None = None,
    tolerance: float = TOLERANCE,
    records: int | None = None,
) -> Trajectory:
    """Return the motion by sequential impulses from the static state at a rotation, at rest.

    Parameters
    ----------
    pivot : Mechanism
    start : float, rad, default None
        Rotation at the start.
    body, drive, duration, records
        As in ``spline_model.dynamics.solve_motion``; the duration in s.
    step : float, s, default 0.01
        Shortened so that a whole number of steps fits between the records.
    form, sweeps, tolerance
        As in `impulse_solver`.

    Returns
    -------
    Trajectory
        T records; arrays as in ``spline_model.dynamics.solve_motion``.

    Raises
    ------
    InvalidParameter
        A value outside its range.
    ConvergenceError
        Statics does not reach `start`.

    Notes
    -----
    A body that a drive re-clamps loses the velocity that the drive does not have. This energy counts as
    dissipated; the numerical damping of the stable form does not.

    References
    ----------
    Valentini and Pezzuti (2013), section 4.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> solve_impulses(pivot, start=0.1, duration=0.02, step=0.01).time.tolist()
    [0.0, 0.01, 0.02]
    """
    require_mechanism(pivot)
    mechanism = pivot.in_motion()
    for name, value in (("duration", duration), ("step", step)):
        require_positive(name, value, "s")
    if start is not None:
        require_finite("start", start, "rad")
    laps, body = Laps(), mechanism.design.body_named(body)
    released = mechanism.released()
    system = compile_scene(released if drive is None else released.with_effects(drive))
    solver = ImpulseSolver(mechanism, system, form=form, sweeps=sweeps, tolerance=tolerance)
    steps = Steps.of(duration, step, records, 2 * system.layout.size)
    laps.lap("compile")
    stepper = solver.stepper(solver.start(start, body))
    laps.lap("start")
    run = carry(stepper, steps)
    laps.lap("solve")
    settings = {"integrator": f"sequential impulses, {solver.form}", "step_s": steps.step}
    settings |= {} if sweeps is None else {"sweeps": sweeps}
    return Trajectory.of(
        system,
        run,
        effects=mechanism.effects,
        body=body,
        settings=settings,
        unresolved=partial(_resolution, solver, steps.step),
        still=lambda: False,
        laps=laps,
    )


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


def _require_numbers(name: str, values: Array, least: int, most: float, unit: str) -> None:
    """Refuse anything but a vector of so many finite numbers."""
    if values.ndim != 1 or not least <= len(values) <= most:
        expected = f"{least}" if most == least else f"{least} or more"
        raise InvalidParameter(f"length of {name}", values.size, expected)
    if not np.isfinite(values).all():
        bad = float(values[~np.isfinite(values)][0])
        raise InvalidParameter(name, bad, f"finite numbers [{unit}]")
