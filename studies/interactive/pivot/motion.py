"""The released pivot, step after step: one interface for the solvers of section 4.1."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from spline_model.compile import System, compile_scene
from spline_model.impulses.solver import Run
from spline_model.motion.energy_consistent import Stepper
from spline_model.motion.records import DISSIPATED, KINETIC, STRAIN
from spline_model.motion.start import Start, set_in_motion
from spline_model.motion.step import HALVED, NEWTON
from spline_model.pivot import BODY, STRIPS, Pivot
from spline_model.sequential_impulse import impulse_solver
from spline_model.solution import Later
from studies.kinds import Array

#: Least part of a step before the motion is given up: work stays bounded.
SMALLEST_PART = 2.0**-6


@dataclass(frozen=True, kw_only=True, eq=False)
class _Moving:
    """A state of the released pivot.

    pose, velocity (3,) of the body [m, m, rad and a second]; points (2, n, 2) [m]; energies [J]: kinetic,
    strain, dissipated by the strips' damping, lost to that of the steps; iterations of the last steps.
    """

    pose: Array
    velocity: Array
    points: Array
    kinetic: float
    strain: float
    dissipated: float
    lost: float
    iterations: int


class Motion(Protocol):
    """A solver that was started from a static state; `advance` takes steps and says whether it could."""

    def advance(self, steps: int, step: float) -> bool:
        """Take `steps` steps of `step` seconds; False where the solver fails, the last good state being
        kept."""

    def state(self) -> _Moving:
        """Return the present state."""


class _EnergyMotion:
    """The energy-consistent integrator, one call a frame."""

    def __init__(self, pivot: Pivot, z: Array, velocity: Array) -> None:
        self.system = released(pivot)
        motion = set_in_motion(self.system)
        self._stepper = Stepper(Start(motion, Later(z[None].copy), velocity))
        self._iterations = 0
        row = self._stepper.look()[2][0]
        self._start = float(row[KINETIC] + row[STRAIN])

    def advance(self, steps: int, step: float) -> bool:
        """Take steps, halved at need down to SMALLEST_PART."""
        stepper = self._stepper
        before, kept = int(stepper.counters[NEWTON]), stepper.kept()
        for _ in range(steps):
            if stepper.advance(0.0, step, SMALLEST_PART) < step:
                stepper.take_back(kept)
                return False
        self._iterations = int(stepper.counters[NEWTON]) - before
        return True

    @property
    def halved(self) -> int:
        """Steps that were halved so far."""
        return int(self._stepper.counters[HALVED])

    def state(self) -> _Moving:
        """Return the present state."""
        (z,), (v,), (row,) = self._stepper.look()
        kinetic, strain, dissipated = (float(row[place]) for place in (KINETIC, STRAIN, DISSIPATED))
        energies = kinetic, strain, dissipated, self._start - kinetic - strain - dissipated
        return moving(self.system, z, v, energies, self._iterations)


class _ImpulseMotion:
    """Sequential impulses in the form that is stable at any step, all impulses at once (Eq 30)."""

    def __init__(self, pivot: Pivot, z: Array, velocity: Array) -> None:
        self._solver = impulse_solver(pivot)
        self._start = self._out = Run(self._solver, self._solver.start_at(z, velocity)).outcome(
            0, 0, 0.0, False
        )
        self._dissipated = 0.0

    def advance(self, steps: int, step: float) -> bool:
        """Take steps; where one must be cut below its least part, none counts."""
        solver, begin = self._solver, self._out.state
        run = Run(solver, begin)
        free = np.zeros(len(solver.motion.drives.row), dtype=np.int64)
        taken = run.go(0, steps, step, begin.time, steps, free, solver.motion)
        out = run.outcome(taken, steps, begin.time + taken * step, False)
        if not out.complete:
            return False
        self._out = out
        self._dissipated += float(run.moving.totals[1])
        return True

    def state(self) -> _Moving:
        """Return the present state; what the strips' damping did not take is lost to that of the steps."""
        out, start = self._out, self._start
        lost = start.kinetic_energy + start.strain_energy - out.kinetic_energy - out.strain_energy
        lost -= self._dissipated
        return moving(
            self._solver.system,
            out.state.z,
            out.state.v,
            (out.kinetic_energy, out.strain_energy, self._dissipated, lost),
            out.counters["solves"],
        )


def released(pivot: Pivot) -> System:
    """Return the compiled scene of the released pivot."""
    return compile_scene(pivot.released())


def moving(
    system: System, z: Array, v: Array, energies: tuple[float, float, float, float], iterations: int
) -> _Moving:
    """Return the state from the unknowns, the velocities and the energies [J] as in `_Moving`."""
    body = system.layout.body(BODY)
    return _Moving(
        pose=z[body].copy(),
        velocity=v[body].copy(),
        points=np.stack([z[system.layout.strip(name)].reshape(-1, 2) for name in STRIPS]),
        kinetic=energies[0],
        strain=energies[1],
        dissipated=energies[2],
        lost=energies[3],
        iterations=iterations,
    )


#: Solvers of the released pivot by the name that the user chooses.
MOTIONS: dict[str, Callable[[Pivot, Array, Array], Motion]] = {
    "impulse": _ImpulseMotion,
    "energy": _EnergyMotion,
}
