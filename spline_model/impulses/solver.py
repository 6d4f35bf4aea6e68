"""The solver as an object: a compiled scene, its work space, and steps from state to state."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import RootCompliance
from spline_model.effects.elastic import ANTICLASTIC
from spline_model.errors import InvalidParameter, require_choice, require_count, require_positive
from spline_model.impulses.arrays import (
    COUNTS,
    ENERGY,
    IMPULSES,
    RESIDUAL,
    Moving,
    Problem,
    Space,
)
from spline_model.impulses.forces import strain_energy
from spline_model.impulses.steps import printed_advance, stable_advance
from spline_model.mechanism import Mechanism
from spline_model.modes import static_state
from spline_model.motion.arrays import zeros
from spline_model.motion.records import KINETIC, STRAIN, WEIGHT, Records, Whole, rows_of
from spline_model.motion.start import Motion, set_in_motion
from spline_model.strip.compiled import copy, kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FORMS = ("printed", "stable")
COUNTERS = ("steps", "solves", "sweeps", "halved_steps", "limited_steps")
TOLERANCE = 1e-9
"""Residual of a stable step, and gap that sweeps close, in EI/L^2, EI/L, L and rad."""


@dataclass(frozen=True, kw_only=True, eq=False)
class State:
    """Where a motion is. A step leaves it as it is and returns another.

    z (N,) unknowns: coordinates, axial forces, multipliers; v (Q,) velocities; earlier (2, Q) coordinates
    and velocities of the step before, which count if ``known`` is 1 and not if it is 0;
    time [s]; held: whether a pose was imposed in the step that led here.
    """

    z: Array
    v: Array
    earlier: Array
    known: int
    time: float
    held: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What steps led to.

    state: after the last step that was taken; taken, asked: numbers of steps; kinetic, strain and
    gravity energy [J]; constraint_residual [m], velocity_residual [m/s]; residual: the largest
    that a step left in its equations, or an impulse before the last had to close [1];
    counters: steps (halves count), solves, sweeps, halved_steps, limited_steps.
    """

    state: State
    taken: int
    asked: int
    kinetic_energy: float
    strain_energy: float
    gravity_energy: float
    constraint_residual: float
    velocity_residual: float
    residual: float
    counters: dict[str, int]

    @property
    def complete(self) -> bool:
        """Whether all steps were taken; if not, the state is the last good one."""
        return self.taken == self.asked


class ImpulseSolver:
    """Steps of one scene; ``spline_model.sequential_impulse.impulse_solver`` makes one.

    Holds work space, so that no two threads may use it at once. What it returns shares no memory
    with it: the same state and arguments give the same bits.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        system: System,
        *,
        form: str,
        impulses: str,
        sweeps: int,
        tolerance: float,
    ) -> None:
        require_choice("form", form, FORMS)
        require_choice("impulses", impulses, IMPULSES)
        require_positive("tolerance", tolerance, "1")
        require_count("sweeps", sweeps, 1)
        self.motion, soft = set_in_motion(system), form == "stable"
        self.motion.require_compiled("sequential impulses")
        held = "another one for sequential impulses"
        if ANTICLASTIC in mechanism.design.curling:
            raise InvalidParameter("effects", ANTICLASTIC, held)
        if system.scene.of(RootCompliance):
            raise InvalidParameter("effects", "root_compliance", held)
        self.mechanism, self.system, self.form = mechanism, system, form
        self.problem = Problem.of(
            self.motion, soft=soft, impulses=impulses, sweeps=sweeps, tolerance=tolerance
        )
        sizes = {"N": len(self.problem.unit), "Q": len(self.problem.mass), "R": len(self.problem.rows)}
        self.space = zeros(Space, sizes | {"M": len(self.problem.rigidity)})

    def start(self, rotation: float | None = None, body: str | None = None) -> State:
        """The static state at the rotation [rad] of a body, or undriven: where the paper's releases start.

        Raises ConvergenceError if statics does not reach it.
        """
        if rotation is not None and not math.isfinite(rotation):
            raise InvalidParameter("rotation", rotation, "a finite angle [rad]")
        return self.start_at(static_state(self.mechanism.at_start(), rotation, body=body))

    def start_at(self, z: Array, v: Array | None = None) -> State:
        """A state at the unknowns z (N or more,), at rest or with velocity v (Q,).

        z may be another system's of the same strips and bodies, such as of statics with other drives:
        what it has beyond this one's is left out. The constraints should hold in both.
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
        motion = self.motion
        if pose is not None:
            motion = self._driven(state, np.asarray(pose, dtype=float), h * count)
        if (pose is not None) != state.held:
            state = replace(state, known=0)
        active = np.full(len(motion.drives.row), int(pose is not None), dtype=np.int64)
        run = Run(self, state)
        taken = run.go(0, count, h, state.time, count, active, motion)
        return run.outcome(taken, count, state.time + taken * h, pose is not None)

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


class Run:
    """The arrays of a run from a state, and what it records."""

    def __init__(self, solver: ImpulseSolver, state: State, records: int = 1) -> None:
        self.solver, size, count = solver, state.z.size, state.v.size
        self.moving = Moving(
            z=state.z.copy(),
            v=state.v.copy(),
            earlier=state.earlier.copy(),
            status=np.array([state.known, 0.0, 0.0]),
            counters=np.zeros(len(COUNTERS), dtype=np.int64),
            totals=np.zeros(2),
            states=np.zeros((records + 1, size)),
            rates=np.zeros((records + 1, count)),
            energies=np.zeros((records + 1, 3)),
        )
        self.moving.status[ENERGY] = self._energy()

    def go(
        self, first: int, last: int, h: float, time: float, every: int, active: Indices, motion: Motion
    ) -> int:
        """Take the steps first ... last - 1; returns the number of the first that was not taken."""
        solver = self.solver
        problem = solver.problem.with_drives(motion, active)
        stable = solver.form == "stable"
        return int(_advance(self.moving, time, h, first, last, every, stable, problem, solver.space))

    def _energy(self) -> float:
        (z, v), problem = self.moving[:2], self.solver.problem
        strain = strain_energy(z, v, problem, self.solver.space)
        return float(0.5 * v @ problem.mass @ v + strain - problem.weight @ z[: v.size])

    def change(self, v: Array, lost: float) -> None:
        """Give the run other velocities, which takes the energy ``lost`` [J]: it starts anew from here."""
        moving = self.moving
        moving.v[:] = v
        moving.totals[1] += lost
        moving.status[COUNTS] = 0.0
        moving.status[ENERGY] = self._energy()

    def keep_start(self) -> None:
        """Record where the run stands as its start."""
        moving, solver = self.moving, self.solver
        moving.states[0], moving.rates[0] = moving.z, moving.v
        moving.energies[0] = strain_energy(moving.z, moving.v, solver.problem, solver.space), *moving.totals

    def records(self, spacing: float, kept: int, message: str) -> Records:
        """The first ``kept`` records, ``spacing`` [s] apart; message: why the run stopped, if it did."""
        z, v, energies = (kinds[:kept] for kinds in self.moving[-3:])
        motion = self.solver.motion
        return Records(
            spacing=spacing,
            poses=z[:, motion.system.layout.poses],
            rows=rows_of(motion, z, v, energies),
            whole=Whole(motion, partial(tuple, (z, v))),
            message=message,
            counters=self._counters(),
        )

    def outcome(self, taken: int, asked: int, time: float, held: bool) -> Outcome:
        """Where the run stands, for who asked for steps."""
        moving, solver = self.moving, self.solver
        strain = strain_energy(moving.z, moving.v, solver.problem, solver.space)
        here, known = (moving.z[None], moving.v[None]), int(moving.status[COUNTS])
        (row,) = rows_of(solver.motion, *here, np.array([[strain, *moving.totals]]))
        (gap,) = Whole(solver.motion, partial(tuple, here)).gaps
        weight, rest = solver.system.weight, solver.system.rest
        return Outcome(
            state=State(z=moving.z, v=moving.v, earlier=moving.earlier, known=known, time=time, held=held),
            taken=taken,
            asked=asked,
            kinetic_energy=float(row[KINETIC]),
            strain_energy=float(row[STRAIN]),
            gravity_energy=float(row[WEIGHT] + weight @ rest[: weight.size]),
            constraint_residual=float(gap[0]),
            velocity_residual=float(gap[1]),
            residual=float(moving.status[RESIDUAL]),
            counters=self._counters(),
        )

    def _counters(self) -> dict[str, int]:
        return dict(zip(COUNTERS, self.moving.counters.tolist(), strict=True))


@kernel()
def _advance(moving, time, h, first, last, every, stable, problem, space):
    """Take the steps ``first`` ... ``last`` - 1 of length h, step 0 being at ``time`` [s].

    Returns the number of the first step that was not taken; ``moving`` stands at its begin. Every
    ``every``-th step's end is recorded.
    """
    for k in range(first, last):
        now = time + k * h
        if stable:
            done = stable_advance(moving, now, h, problem, space)
        else:
            done = printed_advance(moving, now, h, problem, space)
        if not done:
            return k
        if (k + 1) % every == 0:
            r = (k + 1) // every
            copy(moving.z, moving.states[r])
            copy(moving.v, moving.rates[r])
            moving.energies[r, 0] = strain_energy(moving.z, moving.v, problem, space)
            copy(moving.totals, moving.energies[r, 1:])
    return last


def _require_numbers(name: str, values: Array, least: int, most: float, unit: str) -> None:
    """Refuse anything but a vector of so many finite numbers."""
    if values.ndim != 1 or not least <= len(values) <= most:
        expected = f"{least}" if most == least else f"{least} or more"
        raise InvalidParameter(f"length of {name}", values.size, expected)
    if not np.isfinite(values).all():
        bad = float(values[~np.isfinite(values)][0])
        raise InvalidParameter(name, bad, f"finite numbers [{unit}]")
