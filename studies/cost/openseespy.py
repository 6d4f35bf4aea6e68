"""The pivot with strips of OpenSees' corotational frame elements.

Law: `elasticBeamColumn` in a `Corotational` transformation: linear Euler-Bernoulli elements in axes that
follow the chord, without shear and, with masses lumped at the nodes, without the inertia of the sections.
Refined, they tend to the rod of the spline. `dispBeamColumn` with elastic sections gives the same digits in
1.2 times the time. The rigid body is a node with mass, tied to the strips' ends by frame elements
`LINK_FACTOR` times as stiff: OpenSees' `rigidLink` is linear in the rotation, and the path fails with it.

What was tried on Table 1, 20 elements (time of the whole path of 20 increments): `BandSPD` is the fastest
solver (`ProfileSPD`, `BandGeneral`, `SparseSYM` 1.1 times, `SuperLU` 1.4, `UmfPack` 2.7, `FullGeneral` 5.5
times its time); full Newton the fastest algorithm (`KrylovNewton` 1.1, `ModifiedNewton` 1.7, `BFGS` 2.4
times; with the initial tangent it fails). Driven by `DisplacementControl` of the rotation under a moment it
takes one iteration an increment fewer than by a prescribed rotation, with the same answers. The tolerance is
on the energy of an iteration, over EI/L. In motion `HHT` with 0.9 is the most accurate and reliable
(`Newmark` fails at 1e-5 s, `GeneralizedAlpha` at 2e-5 s, `TRBDF2` takes twice the solves); it needs the
acceleration of the body at the release to be given. `solve_s` is of `analyze`, step by step, with
the body's place read after each.
"""

import ctypes
import importlib.util
import os
import time
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from studies.answers.reference import SolvedMotion, SolvedPath
from studies.cases.problem import Problem
from studies.cost.model import Model, centre_of, ends_of, steps_of, turns_of
from studies.errors import Unanswered

#: Stiffness of the links that stand for the body, over the strips': 1e4 still moves the torque by 6e-5.
LINK_FACTOR = 1e6
#: Largest increment of the static path to the start of a release [rad], and its tolerance.
INCREMENT = np.pi / 40.0
START_TOLERANCE = 1e-16
MOST_ITERATIONS = 50
#: Of the method of integration, 2/3 to 1: 1 has none of its damping.
ALPHA = 0.9
BODY = 1


@cache
def _loaded() -> Any:
    """Return OpenSees' commands; its own library of linear algebra is loaded first, lest it is not found."""
    place = importlib.util.find_spec("openseespylinux")
    if place is not None and place.origin is not None:
        for library in sorted(Path(place.origin).parent.glob("lib/libblas.so*")):
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    import openseespy.opensees as commands

    commands.logFile(os.devnull, "-noEcho")
    return commands


def _installed() -> bool:
    """Return whether OpenSees can be imported."""
    try:
        _loaded()
    except (ImportError, OSError, RuntimeError):
        return False
    return True


def _path(problem: Problem, *, elements: int = 20, tolerance: float = 1e-8) -> SolvedPath:
    """Return the path.

    Args:
        elements: a strip [1].
        tolerance: of the energy of Newton's last iteration, in EI/L [1].
    """
    turns = turns_of(problem)
    ops = _driven(problem, elements, tolerance, float(turns[1]), moving=False)
    begin, states = time.perf_counter(), [np.zeros(3)]
    for turn in turns[1:]:
        if ops.analyze(1) != 0:
            raise Unanswered(f"OpenSees: no convergence at {turn:g} rad")
        states.append(np.array([*ops.nodeDisp(BODY)[:2], ops.getTime()]))
    seconds, answer = time.perf_counter() - begin, np.array(states)
    centre = problem.bodies[0].centre + answer[:, :2]
    return SolvedPath(rotation=turns, centre=centre, torque=answer[:, 2], solve_s=seconds)


def _swing(
    problem: Problem, duration: float, *, step: float, elements: int = 20, tolerance: float = 1e-8
) -> SolvedMotion:
    """Return the motion by the method of Hilber, Hughes and Taylor; `step` [s], the others as of `_path`."""
    steps = steps_of(duration, step)
    ops = _let_go(problem, elements, tolerance, problem.rotation)
    begin, rotation = time.perf_counter(), np.full(steps + 1, problem.rotation)
    for row in range(1, steps + 1):
        if ops.analyze(1, duration / steps) != 0:
            raise Unanswered(f"OpenSees: no convergence at {ops.getTime():g} s")
        rotation[row] = ops.nodeDisp(BODY)[2]
    seconds = time.perf_counter() - begin
    return SolvedMotion(time=np.linspace(0.0, duration, steps + 1), rotation=rotation, solve_s=seconds)


def _build(problem: Problem, elements: int, *, moving: bool) -> Any:
    """Make nodes, strips and body again: OpenSees has one model at a time. A moving one has masses."""
    ops, centre = _loaded(), centre_of(problem)
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(BODY, centre.real, centre.imag)
    if moving:
        ops.mass(BODY, problem.body_mass, problem.body_mass, problem.body_moment_of_inertia)
    ops.geomTransf("Corotational", 1)
    section = (problem.area, problem.youngs_modulus, problem.second_moment_of_area)
    link = (LINK_FACTOR * section[0], section[1], LINK_FACTOR * section[2])
    mass = ("-mass", problem.density * problem.area) if moving else ()
    element = 1
    for strip, (root, tip) in enumerate(ends_of(problem)):
        first = BODY + 1 + strip * (elements + 1)
        for node, place in enumerate(np.linspace(root, tip, elements + 1), first):
            ops.node(node, float(place.real), float(place.imag))
        ops.fix(first, 1, 1, 1)
        for node in range(first, first + elements):
            ops.element("elasticBeamColumn", element, node, node + 1, *section, 1, *mass)
            element += 1
        ops.element("elasticBeamColumn", element, BODY, first + elements, *link, 1)
        element += 1
    return ops


def _driven(problem: Problem, elements: int, tolerance: float, increment: float, *, moving: bool) -> Any:
    """Return OpenSees ready to drive the body by equal increments [rad]."""
    ops = _build(problem, elements, moving=moving)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(BODY, 0.0, 0.0, 1.0)
    ops.integrator("DisplacementControl", BODY, 3, increment)
    _solver(ops, problem, tolerance)
    ops.analysis("Static")
    return ops


def _let_go(problem: Problem, elements: int, tolerance: float, start: float) -> Any:
    """Return OpenSees at rest in the static state at `start`, without its moment, ready to move."""
    count = max(1, int(np.ceil(abs(start) / INCREMENT)))
    ops = _driven(problem, elements, START_TOLERANCE, start / count, moving=True)
    if ops.analyze(count) != 0:
        raise Unanswered(f"OpenSees: statics does not reach the start, {start:g} rad")
    moment = ops.getTime()
    ops.remove("loadPattern", 1)
    ops.wipeAnalysis()
    ops.setTime(0.0)
    ops.integrator("HHT", ALPHA)
    _solver(ops, problem, tolerance)
    ops.analysis("Transient")
    ops.setNodeAccel(BODY, 3, -moment / problem.body_moment_of_inertia, "-commit")
    return ops


def _solver(ops: Any, problem: Problem, tolerance: float) -> None:
    energy = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandSPD")
    ops.test("EnergyIncr", tolerance * energy, MOST_ITERATIONS)
    ops.algorithm("Newton")


openseespy_frame = Model(name="openseespy frame", path=_path, swing=_swing, installed=_installed)
