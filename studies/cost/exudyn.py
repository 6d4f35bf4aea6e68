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
import re
import sys
import time
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from studies.answers.reference import SolvedMotion, SolvedPath
from studies.cases.problem import Problem
from studies.cost.model import Model, Places, centre_of, ends_of, steps_of, turns_of
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


class _System:
    """One pivot in Exudyn.

    Attributes:
        exu, mbs: Exudyn, and the system of bodies. zero: marker of a coordinate that is zero.
        body, drive, place, reaction: numbers of the body's node, of the constraint of its rotation, and of
            the sensors of its coordinates and of the torque.
    """

    def __init__(self, strip: "_Strip", problem: Problem, elements: int) -> None:
        self.exu, self._items = _loaded()
        self._container = self.exu.SystemContainer()
        self.mbs = self._container.AddSystem()
        centre, kinds = centre_of(problem), self.exu.OutputVariableType
        self.body = self.add("NodeRigidBody2D", referenceCoordinates=[centre.real, centre.imag, 0.0])
        inertia = {"mass": problem.body_mass, "inertia": problem.body_moment_of_inertia}
        self.add("ObjectRigidBody2D", nodeNumber=self.body, **inertia)
        self.zero = self.add("MarkerNodeCoordinate", nodeNumber=self.add("NodePointGround"), coordinate=0)
        for root, tip in ends_of(problem):
            self._attach(tip - centre, *strip(self, problem, np.linspace(root, tip, 2 * elements + 1)))
        self.drive = self.hold(self.body, 2)
        coordinates = {"storeInternal": True, "outputVariableType": kinds.Coordinates}
        self.place = self.add("SensorNode", nodeNumber=self.body, **coordinates)
        force = {"storeInternal": True, "outputVariableType": kinds.Force}
        self.reaction = self.add("SensorObject", objectNumber=self.drive, **force)
        self.mbs.Assemble()

    def add(self, kind: str, **values: Any) -> int:
        """Add a node, object, marker or sensor of that class; return its number."""
        (group,) = re.findall("^(?:Node|Object|Marker|Sensor)", kind)
        number: int = getattr(self.mbs, f"Add{group}")(getattr(self._items, kind)(**values))
        return number

    def hold(self, node: int, coordinate: int) -> int:
        """Hold one coordinate of a node where it is at rest; return the number of the constraint."""
        marker = self.add("MarkerNodeCoordinate", nodeNumber=node, coordinate=coordinate)
        return self.add("ObjectConnectorCoordinate", markerNumbers=[self.zero, marker], offset=0.0)

    def _attach(self, place: complex, last: int, angle: float) -> None:
        """Join the node `last`, of axes at `angle` [rad], rigidly to the body, at `place` from its centre."""
        cosine, sine = np.cos(angle), np.sin(angle)
        axes = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        there = self.exu.HT(rotation=axes, translation=[place.real, place.imag, 0.0])
        markers = [
            self.add("MarkerBodyRigid", bodyNumber=0, localHT=there),
            self.add("MarkerNodeRigid", nodeNumber=last),
        ]
        self.add("ObjectJointGeneric", markerNumbers=markers, constrainedAxes=[1, 1, 0, 0, 0, 1])

    def settings(self, solver: str, steps: int, tolerance: float) -> tuple[Any, Any]:
        """Return settings of a run of fixed steps that writes no file, keeps every step in the sensors, and
        has the faster linear solver for the number of coordinates; and those of `solver` among them."""
        asked = self.exu.SimulationSettings()
        asked.solution.file.write = False
        asked.solution.sensors.writePeriod = EVERY_STEP
        own = getattr(asked, solver)
        own.verboseMode = own.stepInformation = 0
        own.adaptiveStep = False
        own.newton.useModifiedNewton = True
        own.newton.relativeTolerance = tolerance
        setattr(own, "numberOfLoadSteps" if solver == "staticSolver" else "numberOfSteps", steps)
        kinds, data = self.exu.LinearSolverType, self.mbs.systemData
        sparse = data.ODE2Size() + data.AEsize() >= SPARSE_FROM
        asked.linearSolver.solverType = kinds.EigenSparse if sparse else kinds.EigenDense
        asked.linearSolver.reuseAnalyzedPattern = sparse
        return asked, own

    def drive_through(self, turns: Array, tolerance: float, *, modified: bool = True) -> float:
        """Solve the static path through rotations (S,) [rad] by modified or full Newton iterations; return
        what its steps took [s]."""
        asked, static = self.settings("staticSolver", len(turns) - 1, tolerance)
        static.computeLoadsJacobian = 0
        static.newton.modifiedNewtonContractivity = CONTRACTION
        static.newton.useModifiedNewton = modified

        def before_step(mbs: Any, load_factor: float) -> bool:
            mbs.SetObjectParameter(self.drive, "offset", turns[round(load_factor * (len(turns) - 1))])
            return True

        self.mbs.SetPreStepUserFunction(before_step)
        return self.run(self.exu.MainSolverStatic(), asked)

    def release_at(self, start: float) -> None:
        """Drive the body to `start` [rad] and release it there, at rest."""
        count = max(1, int(np.ceil(abs(start) / INCREMENT)))
        self.drive_through(np.linspace(0.0, start, count + 1), START_TOLERANCE, modified=False)
        data = self.mbs.systemData
        initial = self.exu.ConfigurationType.Initial
        data.SetSystemState(systemStateList=data.GetSystemState(), configuration=initial)
        self.mbs.SetObjectParameter(self.drive, "activeConnector", False)
        self.mbs.SetPreStepUserFunction(0)

    def run(self, solver: Any, asked: Any) -> float:
        """Run a solver and return what its steps took [s]; raises Unanswered unless it reaches the end."""
        try:
            solver.InitializeSolver(self.mbs, asked)
            begin = time.perf_counter()
            reached = solver.SolveSteps(self.mbs, asked)
            seconds = time.perf_counter() - begin
            solver.FinalizeSolver(self.mbs, asked)
        except (self.exu.SolverError, RuntimeError, ValueError) as error:
            raise Unanswered(f"Exudyn: {str(error).splitlines()[0]}") from None
        if not reached:
            raise Unanswered(f"Exudyn: no convergence at load factor or time {solver.it.currentTime:g}")
        return seconds

    def stored(self, sensor: int) -> Array:
        """Return the values (T, 1 + K) of a sensor in the last run: time [s] or load factor [1], K values."""
        return np.array(self.mbs.GetSensorStoredData(sensor))


#: Adds a strip of E elements with its clamp to the pivot, places (2 E + 1,) being their ends and middles;
#: returns the number of the last node and the angle of its axes at rest [rad].
_Strip = Callable[[_System, Problem, Places], tuple[int, float]]


def _path(strip: _Strip, problem: Problem, *, elements: int, relative_tolerance: float = 1e-8) -> SolvedPath:
    """Return the path, one load step an increment.

    Args:
        strip: adds a strip. elements: of it [1].
        relative_tolerance: of Newton's residual against that at the step's start [1].
    """
    system, turns = _System(strip, problem, elements), turns_of(problem)
    seconds = system.drive_through(turns, relative_tolerance)
    moved, torque = (system.stored(sensor) for sensor in (system.place, system.reaction))
    rest = np.array(system.mbs.GetNode(system.body)["referenceCoordinates"][:2])
    centre = moved[:, 1:3] + rest
    return SolvedPath(rotation=turns, centre=centre, torque=torque[:, 1], solve_s=seconds)


def _swing(
    strip: _Strip,
    problem: Problem,
    duration: float,
    *,
    elements: int,
    step: float,
    relative_tolerance: float = 1e-4,
    spectral_radius: float = 0.9,
) -> SolvedMotion:
    """Return the motion by generalised-alpha in steps of `step` [s].

    Args:
        spectral_radius: at infinite frequency, 0 to 1. The others as of `_path`.
    """
    steps = steps_of(duration, step)
    system = _System(strip, problem, elements)
    system.release_at(problem.rotation)
    asked, moving = system.settings("timeIntegration", steps, relative_tolerance)
    moving.endTime = duration
    moving.generalizedAlpha.spectralRadius = spectral_radius
    seconds = system.run(system.exu.MainSolverImplicitSecondOrder(), asked)
    record = system.stored(system.place)
    return SolvedMotion(time=record[:, 0], rotation=record[:, 3], solve_s=seconds)


def _loaded() -> tuple[Any, Any]:
    """Return Exudyn, in its build without range checks, and its items."""
    vars(sys)["exudynFast"] = True  # asks for the fast build
    with contextlib.redirect_stdout(io.StringIO()):  # it announces the build
        import exudyn
        import exudyn.itemInterface as items
    exudyn.config.printToConsole = False
    return exudyn, items


def _rigidities(problem: Problem, places: Places) -> dict[str, float]:
    """Return what both kinds of elements are given."""
    return {
        "length": problem.length / (len(places) // 2),
        "massPerLength": problem.density * problem.area,
        "bendingStiffness": problem.youngs_modulus * problem.second_moment_of_area,
        "axialStiffness": problem.youngs_modulus * problem.area,
    }


def _cable(system: _System, problem: Problem, places: Places) -> tuple[int, float]:
    """Add a strip of ANCF cables, its slope held along the strip, whose length is left to stretch."""
    along = (places[-1] - places[0]) / problem.length
    slopes = [[place.real, place.imag, along.real, along.imag] for place in places[::2]]
    nodes = [system.add("NodePoint2DSlope1", referenceCoordinates=each) for each in slopes]
    for pair in pairwise(nodes):
        system.add("ObjectANCFCable2D", nodeNumbers=list(pair), **_rigidities(problem, places))
    for coordinate in range(2):
        system.hold(nodes[0], coordinate)
    clamped = (system.add("NodePointGround"), nodes[0])
    system.add(
        "ObjectConnectorCoordinateVector",
        markerNumbers=[system.add("MarkerNodeCoordinates", nodeNumber=node) for node in clamped],
        scalingMarker0=[],
        scalingMarker1=np.array([[0.0, 0.0, -along.imag, along.real]]),
        offset=[0.0],
    )
    return nodes[-1], float(np.angle(along))


def _beam(system: _System, problem: Problem, places: Places) -> tuple[int, float]:
    """Add a strip of exact beams, of three nodes each."""
    shear_modulus = problem.youngs_modulus / (2.0 * (1.0 + problem.poisson_ratio))
    own = _rigidities(problem, places) | {
        "crossSectionInertia": problem.density * problem.second_moment_of_area,
        "shearStiffness": SHEAR_CORRECTION * shear_modulus * problem.area,
    }
    at_rest = [[place.real, place.imag, 0.0] for place in places]
    nodes = [system.add("NodeRigidBody2D", referenceCoordinates=each) for each in at_rest]
    for first in range(0, len(nodes) - 1, 2):
        system.add("ObjectBeamGeometricallyExact2D", nodeNumbers=nodes[first : first + 3], **own)
    for coordinate in range(3):
        system.hold(nodes[0], coordinate)
    return nodes[-1], 0.0


def _model(name: str, strip: _Strip, *, sheared: bool = False) -> Model:
    """Return the model of a pivot whose strips `strip` adds."""
    return Model(
        name=name,
        path=partial(_path, strip),
        swing=partial(_swing, strip),
        sheared=sheared,
        installed=lambda: importlib.util.find_spec("exudyn") is not None,
    )


exudyn_ancf = _model("exudyn ancf", _cable)
exudyn_exact = _model("exudyn exact", _beam, sheared=True)
