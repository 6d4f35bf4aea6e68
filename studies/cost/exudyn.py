"""The pivot in Exudyn: ground, body, joints, drive and sensors, with strips of either kind of its elements.

The build without range checks, `exudynCPPfast`, is loaded where the processor has AVX2. The body is attached
by a `GenericJoint` at either strip, the ground ends by constraints of their coordinates, which are cheaper
than joints.

`exudyn_ancf`: planar ANCF cable elements, `ObjectANCFCable2D`. Law: a rod without shear and without the
inertia of its sections, extension |r'| - 1 over the length at rest, and the material measure of curvature,
d(angle)/ds0: the theory of the spline and of the corotational finite elements, so that all tend to one limit.
Two nodes with position and slope, cubic between them. Source: Gerstmayr and Shabana, Nonlinear Dynamics 45
(2006) 109-130; manual of Exudyn 1.13.

Exudyn's reduced rules of integration save 5 to 10 % of the time; no rule has the smallest error throughout.

`exudyn_exact`: planar geometrically exact beams, `ObjectBeamGeometricallyExact2D`. Law: Reissner's rod:
extension and shear from the position's derivative in the axes of the section, curvature from the section's
own angle over the length at rest, with shear compliance 1 / (k G A), k = 5/6, and the inertia of the
sections' rotation. This is another theory than that of a rod without shear: its answers are to be held
against their own limit, which is that of this repository's Reissner elements to 2e-9.

Shear is kept because Table 1 has it.

Elements have three nodes: 1e-3 takes 20 of those with two, and three of these. Source: manual of Exudyn
1.13; Simo and Vu-Quoc, CMAME 58 (1986) 79-116.

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

import contextlib
import importlib.util
import io
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from studies.answers.reference import SolvedMotion, SolvedPath
from studies.cases.problem import Problem
from studies.cost.model import Model, geometry_of, steps_of, turns_of
from studies.errors import Unanswered
from studies.kinds import Array

#: Shear correction of a rectangular section, k.
SHEAR_CORRECTION = 5.0 / 6.0
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


def _path(
    system_of: Callable[..., System],
    problem: Problem,
    *,
    relative_tolerance: float = 1e-8,
    **settings: Any,
) -> SolvedPath:
    """Return the path, one load step an increment.

    Args:
        system_of: makes the system of a pivot and of the settings of its strips.
        relative_tolerance: of Newton's residual against that at the step's start [1].
    """
    system, turns = system_of(problem, **settings), turns_of(problem)
    seconds = _driven(system, _static(system, len(turns) - 1, relative_tolerance), turns)
    moved, torque = (system.stored(sensor) for sensor in (system.place, system.reaction))
    rest = np.array(system.mbs.GetNode(system.body)["referenceCoordinates"][:2])
    centre = moved[:, 1:3] + rest
    return SolvedPath(rotation=turns, centre=centre, torque=torque[:, 1], solve_s=seconds)


def _swing(
    system_of: Callable[..., System],
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
        spectral_radius: at infinite frequency, 0 to 1. The others as of `_path`.
    """
    steps = steps_of(duration, step)
    system = system_of(problem, **settings)
    _hold_at(system, problem.rotation)
    asked, solver = _quiet(system), system.exu.MainSolverImplicitSecondOrder()
    moving = asked.timeIntegration
    moving.endTime, moving.numberOfSteps, moving.verboseMode = duration, steps, 0
    moving.generalizedAlpha.spectralRadius = spectral_radius
    _tune(system, asked, moving, relative_tolerance)
    seconds = _run(system, solver, asked)
    record = system.stored(system.place)
    return SolvedMotion(time=record[:, 0], rotation=record[:, 3], solve_s=seconds)


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


def _driven(system: System, asked: Any, turns: Array) -> float:
    """Solve the static path through `turns`; return what its steps took [s]."""

    def before_step(mbs: Any, load_factor: float) -> bool:
        mbs.SetObjectParameter(system.drive, "offset", turns[round(load_factor * (len(turns) - 1))])
        return True

    system.mbs.SetPreStepUserFunction(before_step)
    return _run(system, system.exu.MainSolverStatic(), asked)


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


def _loaded() -> tuple[Any, Any]:
    """Return Exudyn, in its build without range checks, and its items."""
    vars(sys)["exudynFast"] = True  # asks for the fast build
    with contextlib.redirect_stdout(io.StringIO()):  # it announces the build
        import exudyn
        import exudyn.itemInterface as items
    exudyn.config.printToConsole = False
    return exudyn, items


def _system_of(problem: Problem, strip: Callable[..., tuple[int, float]]) -> System:
    """Return the pivot with the strips that `strip` makes.

    `strip(items, mbs, ground, root, direction)` adds one with its clamp, `ground` being a marker of a
    coordinate that is zero, and returns the number of the last node and the angle of its axes at rest [rad].
    """
    exu, items = _loaded()
    at_rest = geometry_of(problem)
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    node = mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*at_rest.centre, 0.0]))
    body = mbs.AddObject(
        items.ObjectRigidBody2D(
            mass=problem.body_mass, inertia=problem.body_moment_of_inertia, nodeNumber=node
        )
    )
    ground = mbs.AddNode(items.NodePointGround())
    zero = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for k in range(2):
        last, angle = strip(items, mbs, zero, at_rest.root[k], at_rest.direction[k])
        _attach(exu, items, mbs, body, at_rest.tip[k] - at_rest.centre, last, angle)
    turn = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
    drive = mbs.AddObject(items.CoordinateConstraint(markerNumbers=[zero, turn], offset=0.0))
    kinds = exu.OutputVariableType
    place = mbs.AddSensor(
        items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kinds.Coordinates)
    )
    reaction = mbs.AddSensor(
        items.SensorObject(objectNumber=drive, storeInternal=True, outputVariableType=kinds.Force)
    )
    mbs.Assemble()
    return System(
        exu=exu, container=container, mbs=mbs, body=node, drive=drive, place=place, reaction=reaction
    )


def _attach(exu: Any, items: Any, mbs: Any, body: int, place: Array, last: int, angle: float) -> None:
    """Join the node `last`, of axes at `angle` [rad], rigidly to the body, at `place` from its centre [m]."""
    cosine, sine = np.cos(angle), np.sin(angle)
    axes = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    there = exu.HT(rotation=axes, translation=[*place, 0.0])
    markers = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localHT=there)),
        mbs.AddMarker(items.MarkerNodeRigid(nodeNumber=last)),
    ]
    mbs.AddObject(items.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[1, 1, 0, 0, 0, 1]))


def _hold(items: Any, mbs: Any, zero: int, node: int, coordinate: int) -> None:
    """Hold one coordinate of a node where it is at rest."""
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    mbs.AddObject(items.CoordinateConstraint(markerNumbers=[zero, marker]))


def _cables(problem: Problem, *, elements: int = 8) -> System:
    """Return the pivot with so many ANCF cables a strip [1]."""

    def strip(items: Any, mbs: Any, zero: int, root: Array, direction: Array) -> tuple[int, float]:
        places = root + np.linspace(0.0, problem.length, elements + 1)[:, None] * direction
        nodes = [
            mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[*place, *direction]))
            for place in places
        ]
        for pair in pairwise(nodes):
            mbs.AddObject(
                items.ObjectANCFCable2D(
                    length=problem.length / elements,
                    massPerLength=problem.density * problem.area,
                    bendingStiffness=problem.youngs_modulus * problem.second_moment_of_area,
                    axialStiffness=problem.youngs_modulus * problem.area,
                    nodeNumbers=list(pair),
                )
            )
        _clamp(items, mbs, zero, nodes[0], direction)
        return nodes[-1], float(np.arctan2(direction[1], direction[0]))

    return _system_of(problem, strip)


def _clamp(items: Any, mbs: Any, zero: int, node: int, direction: Array) -> None:
    """Hold the place of the first node, and its slope along `direction`, whose length is left to stretch."""
    _hold(items, mbs, zero, node, 0)
    _hold(items, mbs, zero, node, 1)
    ground = mbs.AddNode(items.NodePointGround())
    mbs.AddObject(
        items.ObjectConnectorCoordinateVector(
            markerNumbers=[
                mbs.AddMarker(items.MarkerNodeCoordinates(nodeNumber=ground)),
                mbs.AddMarker(items.MarkerNodeCoordinates(nodeNumber=node)),
            ],
            scalingMarker0=[],
            scalingMarker1=np.array([[0.0, 0.0, -direction[1], direction[0]]]),
            offset=[0.0],
        )
    )


def _beams(problem: Problem, *, elements: int = 4) -> System:
    """Return the pivot with so many exact beams a strip, of three nodes each [1]."""
    modulus = problem.youngs_modulus
    shear_modulus = modulus / (2.0 * (1.0 + problem.poisson_ratio))

    def strip(items: Any, mbs: Any, zero: int, root: Array, direction: Array) -> tuple[int, float]:
        numbers = [
            mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*(root + s * direction), 0.0]))
            for s in np.linspace(0.0, problem.length, 2 * elements + 1)
        ]
        for first in range(0, 2 * elements, 2):
            mbs.AddObject(
                items.ObjectBeamGeometricallyExact2D(
                    length=problem.length / elements,
                    massPerLength=problem.density * problem.area,
                    crossSectionInertia=problem.density * problem.second_moment_of_area,
                    bendingStiffness=modulus * problem.second_moment_of_area,
                    axialStiffness=modulus * problem.area,
                    shearStiffness=SHEAR_CORRECTION * shear_modulus * problem.area,
                    nodeNumbers=numbers[first : first + 3],
                )
            )
        for coordinate in range(3):
            _hold(items, mbs, zero, numbers[0], coordinate)
        return numbers[-1], 0.0

    return _system_of(problem, strip)


def _model(name: str, system_of: Callable[..., System], *, sheared: bool = False) -> Model:
    """Return the model of a pivot whose strips `system_of` makes."""
    return Model(
        name=name,
        path=partial(_path, system_of),
        swing=partial(_swing, system_of),
        sheared=sheared,
        installed=lambda: importlib.util.find_spec("exudyn") is not None,
    )


exudyn_ancf = _model("exudyn ancf", _cables)
exudyn_exact = _model("exudyn exact", _beams, sheared=True)
