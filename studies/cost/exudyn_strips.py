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
"""

import contextlib
import io
import sys
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

from studies.cases.problem import Problem
from studies.cost.exudyn_solve import Exudyn, System
from studies.cost.model import geometry_of
from studies.kinds import Array

#: Shear correction of a rectangular section, k.
SHEAR_CORRECTION = 5.0 / 6.0


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


exudyn_ancf = Exudyn(name="exudyn ancf", system_of=_cables)
exudyn_exact = Exudyn(name="exudyn exact", sheared=True, system_of=_beams)
