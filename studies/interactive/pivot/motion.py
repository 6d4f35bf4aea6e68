"""The released pivot, step after step: one interface for the solvers of section 4.1."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.impulses.solver import Run
from spline_model.integrators.energy_consistent import TOLERANCE
from spline_model.integrators.events import drives_at
from spline_model.integrators.motion import initial_acceleration, set_in_motion
from spline_model.kernels.energy_step import HALVED, NEWTON, WHOLE, advance
from spline_model.kernels.record import DISSIPATED, KINETIC, STRAIN, record
from spline_model.pivot import BODY, STRIPS, Pivot
from spline_model.sequential_impulse import impulse_solver

Array = NDArray[np.float64]

#: Least part of a step before the motion is given up: work stays bounded.
SMALLEST_PART = 2.0**-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Moving:
    """A state of the released pivot.

    pose, velocity (3,) of the body [m, m, rad and a second]; points (2, n, 2) [m]; kinetic, strain,
    dissipated
    energies [J]; iterations of the last steps.
    """

    pose: Array
    velocity: Array
    points: Array
    kinetic: float
    strain: float
    dissipated: float
    iterations: int


class Motion(Protocol):
    """A solver that was started from a static state; `advance` takes steps and says whether it could."""

    def advance(self, steps: int, step: float) -> bool:
        """Take `steps` steps of `step` seconds; False where the solver fails, the last good state being
        kept."""

    def state(self) -> Moving:
        """Return the present state."""


class EnergyMotion:
    """The energy-consistent integrator, one call a frame."""

    def __init__(self, pivot: Pivot, z: Array, velocity: Array) -> None:
        self.system = released(pivot)
        self._motion = set_in_motion(self.system)
        self._acceleration, self._z = initial_acceleration(self.system, self._motion, z, velocity)
        self._v = velocity.copy()
        self._counters, self._totals = np.zeros(WHOLE + 1, dtype=np.int64), np.zeros(2)
        self._active = drives_at(self._motion, 0.0)
        self._iterations = 0

    def advance(self, steps: int, step: float) -> bool:
        """Take steps, halved at need down to SMALLEST_PART."""
        before = int(self._counters[NEWTON])
        kept = self._z.copy(), self._v.copy(), self._acceleration.copy(), self._totals.copy()
        for _ in range(steps):
            done = advance(
                self._z, self._v, self._acceleration, 0.0, step, step, step * SMALLEST_PART,
                self._active, self._motion, TOLERANCE, self._counters, self._totals,
            )  # fmt: skip
            if done < step:
                for array, value in zip(
                    (self._z, self._v, self._acceleration, self._totals), kept, strict=True
                ):
                    array[:] = value
                return False
        self._iterations = int(self._counters[NEWTON]) - before
        return True

    @property
    def halved(self) -> int:
        """Steps that were halved so far."""
        return int(self._counters[HALVED])

    def state(self) -> Moving:
        """Return the present state."""
        row = np.zeros(7)
        record(self._z, self._v, self._motion, np.empty(len(self._motion.rigidity)), self._totals, row)
        energies = float(row[KINETIC]), float(row[STRAIN]), float(row[DISSIPATED])
        return moving(self.system, self._z, self._v, energies, self._iterations)


class ImpulseMotion:
    """Sequential impulses in the form that is stable at any step, all impulses at once (Eq 30)."""

    def __init__(self, pivot: Pivot, z: Array, velocity: Array) -> None:
        self._solver = impulse_solver(pivot)
        self._start = self._out = Run(self._solver, self._solver.start_at(z, velocity)).outcome(
            0, 0, 0.0, False
        )

    def advance(self, steps: int, step: float) -> bool:
        """Take steps; where one must be cut below its least part, none counts."""
        out = self._solver.step(self._out.state, step, steps)
        if not out.complete:
            return False
        self._out = out
        return True

    def state(self) -> Moving:
        """Return the present state; what the steps' own damping took counts as dissipated."""
        out, start = self._out, self._start
        lost = start.kinetic_energy + start.strain_energy - out.kinetic_energy - out.strain_energy
        return moving(
            self._solver.system,
            out.state.z,
            out.state.v,
            (out.kinetic_energy, out.strain_energy, lost),
            out.counters["solves"],
        )


def released(pivot: Pivot) -> System:
    """Return the compiled scene of the released pivot."""
    return compile_scene(pivot.released())


def moving(
    system: System, z: Array, v: Array, energies: tuple[float, float, float], iterations: int
) -> Moving:
    """Return the state from the unknowns, the velocities and the energies [J] as in `Moving`."""
    body = system.layout.body(BODY)
    return Moving(
        pose=z[body].copy(),
        velocity=v[body].copy(),
        points=np.stack([z[system.layout.strip(name)].reshape(-1, 2) for name in STRIPS]),
        kinetic=energies[0],
        strain=energies[1],
        dissipated=energies[2],
        iterations=iterations,
    )


#: Solvers of the released pivot by the name that the user chooses.
MOTIONS: dict[str, Callable[[Pivot, Array, Array], Motion]] = {
    "impulse": ImpulseMotion,
    "energy": EnergyMotion,
}
