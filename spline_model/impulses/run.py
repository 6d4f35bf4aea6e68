"""A run of steps from a state: its arrays, what it records, and where it ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spline_model.impulses.advance import COUNTS, ENERGY, RESIDUAL, advance
from spline_model.impulses.energies import energy_of
from spline_model.impulses.space import Log, Moving
from spline_model.impulses.state import Outcome, State
from spline_model.impulses.totals import HALVED, LIMITED, SOLVES, STEPS, SWEEPS
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import KINETIC, POSITION, STRAIN, VELOCITY, WEIGHT, record
from spline_model.motion.start import Records

if TYPE_CHECKING:
    from spline_model.impulses.solver import ImpulseSolver

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class Run:
    """The arrays of a run from a state, and what it records."""

    def __init__(self, solver: ImpulseSolver, state: State, records: int = 1) -> None:
        self.solver = solver
        z, v, motion = state.z.copy(), state.v.copy(), solver.motion
        self.moving = Moving(
            z=z,
            v=v,
            earlier_q=state.earlier_q.copy(),
            earlier_v=state.earlier_v.copy(),
            status=np.array([state.known, 0.0, energy_of(z, v, motion, solver.space.strains)]),
            counters=np.zeros(5, dtype=np.int64),
            totals=np.zeros(2),
        )
        self.log = Log(
            states=np.zeros((records + 1, z.size)),
            rates=np.zeros((records + 1, v.size)),
            rows=np.zeros((records + 1, 7)),
        )

    def go(
        self, first: int, last: int, h: float, time: float, every: int, active: Indices, motion: Motion
    ) -> int:
        """Take the steps first ... last - 1; returns the number of the first that was not taken."""
        solver = self.solver
        stable = solver.form == "stable"
        return int(
            advance(
                self.moving,
                self.log,
                time,
                h,
                first,
                last,
                every,
                stable,
                active,
                motion,
                solver.blocks,
                solver.options,
                solver.space,
            )
        )

    def change(self, v: Array, lost: float) -> None:
        """Give the run other velocities, which takes the energy ``lost`` [J]: it starts anew from here."""
        moving, solver = self.moving, self.solver
        moving.v[:] = v
        moving.totals[1] += lost
        moving.status[COUNTS] = 0.0
        moving.status[ENERGY] = energy_of(moving.z, moving.v, solver.motion, solver.space.strains)

    def row(self) -> Array:
        """The record of where the run stands (7,)."""
        moving, row = self.moving, np.zeros(7)
        record(moving.z, moving.v, self.solver.motion, self.solver.space.strains, moving.totals, row)
        return row

    def keep_start(self) -> None:
        """Record where the run stands as its start."""
        self.log.states[0], self.log.rates[0] = self.moving.z, self.moving.v
        self.log.rows[0] = self.row()

    def records(self, spacing: float, kept: int, message: str) -> Records:
        """The first ``kept`` records, ``spacing`` [s] apart; message: why the run stopped, if it did."""
        log = self.log
        return Records(
            time=np.arange(0.0, kept) * spacing,
            states=log.states[:kept],
            velocities=log.rates[:kept],
            rows=log.rows[:kept],
            message=message,
            counters=named(self.moving.counters),
        )

    def outcome(self, taken: int, asked: int, time: float, held: bool) -> Outcome:
        """Where the run stands, for who asked for steps."""
        moving, row, system = self.moving, self.row(), self.solver.system
        weight = system.tables.weight
        return Outcome(
            state=State(
                z=moving.z,
                v=moving.v,
                earlier_q=moving.earlier_q,
                earlier_v=moving.earlier_v,
                known=int(moving.status[COUNTS]),
                time=time,
                held=held,
            ),
            taken=taken,
            asked=asked,
            kinetic_energy=float(row[KINETIC]),
            strain_energy=float(row[STRAIN]),
            gravity_energy=float(row[WEIGHT] + weight @ system.rest[: weight.size]),
            constraint_residual=float(row[POSITION]),
            velocity_residual=float(row[VELOCITY]),
            residual=float(moving.status[RESIDUAL]),
            counters=named(moving.counters),
        )


def named(counters: Indices) -> dict[str, int]:
    """Counters by name."""
    return {
        "steps": int(counters[STEPS]),
        "solves": int(counters[SOLVES]),
        "sweeps": int(counters[SWEEPS]),
        "halved_steps": int(counters[HALVED]),
        "limited_steps": int(counters[LIMITED]),
    }
