"""Static path and release in Exudyn, as fast as it was found to go.

What was tried on Table 1, for the whole path of 20 increments:

- `solve_s` is of `SolveSteps` of the solver's structure; `InitializeSolver`, which allocates, comes before.
  A run writes no file and no message; sensors keep its states.
- Steps are fixed. Modified Newton, with a new Jacobian at every load step, takes 45 to 66 % of the time of
  full Newton; that an iteration must reduce the residual to a tenth, lest a new Jacobian is made, saves
  another 15 to 20 % with the finest strips and changes nothing with others. In motion the default, a half, is
  faster.
- `EigenDense` is fastest up to some 120 coordinates, `EigenSparse` beyond; `EXUdense`, the default, is slower
  at any size, 5 times at 330 coordinates.
- The rotation is set once an increment, by a function before each step; a function that the constraint calls
  at every residual costs 5 % more.
- A relative tolerance of 1e-6 keeps torques to 1e-5 or better, 1e-8 to 1e-7: it is a setting. In motion 1e-4
  moves the rotation by less than 1e-3 rad and saves a quarter of the iterations of 1e-6; 1e-3 saves a third.
"""

import importlib.util
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.reference import SolvedMotion, SolvedPath
from studies.cases.problem import Problem
from studies.cost.model import Model, steps_of, turns_of
from studies.errors import Unanswered
from studies.kinds import Array

#: Coordinates from which on the sparse solver is the faster one.
SPARSE_FROM = 120
#: Largest increment of the static path to the start of a release [rad].
INCREMENT = np.pi / 40.0
#: Relative tolerance of the static path to the start of a release.
START_TOLERANCE = 1e-10
#: Period of the sensors [s]: below any step, so that every step is kept.
EVERY_STEP = 1e-12

#: Reduction of the residual below which a static iteration keeps its Jacobian.
CONTRACTION = 0.1


@dataclass(frozen=True, kw_only=True)
class System:
    """One pivot in Exudyn: its modules and numbers of what is asked later."""

    exu: Any
    container: Any
    mbs: Any
    body: int
    drive: int
    place: int
    reaction: int

    def stored(self, sensor: int) -> Array:
        """Return the values (T, 1 + K) of a sensor in the last run: time [s] or load factor [1], K values."""
        return np.array(self.mbs.GetSensorStoredData(sensor))


@dataclass(eq=False, kw_only=True)
class Exudyn(Model):
    """A kind of strip as a model; keywords in `settings` are those of `system_of`, which makes it of a
    pivot, and refuses what it cannot be."""

    system_of: Callable[..., System]

    def installed(self) -> bool:
        """Return whether Exudyn can be imported."""
        return importlib.util.find_spec("exudyn") is not None

    def path(
        self,
        problem: Problem,
        *,
        relative_tolerance: float = 1e-8,
        **settings: Any,
    ) -> SolvedPath:
        """Return the path, one load step an increment.

        Args:
            relative_tolerance: of Newton's residual against that at the step's start [1].
        """
        system, turns = self.system_of(problem, **settings), turns_of(problem)
        asked = _static(system, len(turns) - 1, relative_tolerance)
        solved, seconds = _driven(system, asked, turns)
        moved, torque = (system.stored(sensor) for sensor in (system.place, system.reaction))
        rest = np.array(system.mbs.GetNode(system.body)["referenceCoordinates"][:2])
        return SolvedPath(
            rotation=turns,
            centre=moved[:, 1:3] + rest,
            torque=torque[:, 1],
            solve_s=seconds,
            counters=_counters(solved),
        )

    def swing(
        self,
        problem: Problem,
        duration: float,
        *,
        step: float,
        relative_tolerance: float = 1e-4,
        spectral_radius: float = 0.9,
        **settings: Any,
    ) -> SolvedMotion:
        """Return the motion by generalised-alpha in steps of `step` [s].

        Args:
            spectral_radius: at infinite frequency, 0 to 1. The others as of `path`.
        """
        steps = steps_of(duration, step)
        system = self.system_of(problem, **settings)
        _hold_at(system, problem.rotation)
        asked, solver = _quiet(system), system.exu.MainSolverImplicitSecondOrder()
        moving = asked.timeIntegration
        moving.endTime, moving.numberOfSteps, moving.verboseMode = duration, steps, 0
        moving.generalizedAlpha.spectralRadius = spectral_radius
        _tune(system, asked, moving, relative_tolerance)
        seconds = _run(system, solver, asked)
        record = system.stored(system.place)
        return SolvedMotion(
            time=record[:, 0],
            rotation=record[:, 3],
            solve_s=seconds,
            counters=_counters(solver) | {"steps": steps},
        )


def _hold_at(system: System, start: float) -> None:
    """Drive the body to `start` [rad] and release it there, at rest."""
    count = max(1, int(np.ceil(abs(start) / INCREMENT)))
    asked = _static(system, count, START_TOLERANCE)
    asked.staticSolver.newton.useModifiedNewton = False
    _driven(system, asked, np.linspace(0.0, start, count + 1))
    data = system.mbs.systemData
    held = data.GetSystemState()
    data.SetSystemState(systemStateList=held, configuration=system.exu.ConfigurationType.Initial)
    system.mbs.SetObjectParameter(system.drive, "activeConnector", False)
    system.mbs.SetPreStepUserFunction(0)


def _driven(system: System, asked: Any, turns: Array) -> tuple[Any, float]:
    """Solve the static path through `turns`; return the solver and what its steps took [s]."""

    def before_step(mbs: Any, load_factor: float) -> bool:
        mbs.SetObjectParameter(system.drive, "offset", turns[round(load_factor * (len(turns) - 1))])
        return True

    system.mbs.SetPreStepUserFunction(before_step)
    solver = system.exu.MainSolverStatic()
    return solver, _run(system, solver, asked)


def _run(system: System, solver: Any, asked: Any) -> float:
    """Run a solver and return what its steps took [s]; raises Unanswered unless it reaches the end."""
    try:
        solver.InitializeSolver(system.mbs, asked)
        begin = time.perf_counter()
        reached = solver.SolveSteps(system.mbs, asked)
        seconds = time.perf_counter() - begin
        solver.FinalizeSolver(system.mbs, asked)
    except (system.exu.SolverError, RuntimeError, ValueError) as error:
        raise Unanswered(f"Exudyn: {str(error).splitlines()[0]}") from None
    if not reached:
        raise Unanswered(f"Exudyn: no convergence at load factor or time {solver.it.currentTime:g}")
    return seconds


def _static(system: System, steps: int, tolerance: float) -> Any:
    """Return the settings of the static solver."""
    asked = _quiet(system)
    static = asked.staticSolver
    static.numberOfLoadSteps = steps
    static.verboseMode = 0
    static.computeLoadsJacobian = 0
    static.newton.modifiedNewtonContractivity = CONTRACTION
    _tune(system, asked, static, tolerance)
    return asked


def _quiet(system: System) -> Any:
    """Return settings that write no file and keep every step in the sensors."""
    asked = system.exu.SimulationSettings()
    asked.solution.file.write = False
    asked.solution.sensors.writePeriod = EVERY_STEP
    return asked


def _tune(system: System, asked: Any, solver: Any, tolerance: float) -> None:
    """Set fixed steps and modified Newton, and the faster linear solver for the number of coordinates."""
    solver.adaptiveStep = False
    solver.stepInformation = 0
    solver.newton.useModifiedNewton = True
    solver.newton.relativeTolerance = tolerance
    kinds = system.exu.LinearSolverType
    size = system.mbs.systemData.ODE2Size() + system.mbs.systemData.AEsize()
    asked.linearSolver.solverType = kinds.EigenSparse if size >= SPARSE_FROM else kinds.EigenDense
    asked.linearSolver.reuseAnalyzedPattern = size >= SPARSE_FROM


def _counters(solver: Any) -> dict[str, int]:
    return {
        "unknowns": solver.GetODE2size() + solver.GetAEsize(),
        "newton_iterations": solver.it.newtonStepsCount,
        "factorisations": solver.it.newtonJacobiCount,
    }
