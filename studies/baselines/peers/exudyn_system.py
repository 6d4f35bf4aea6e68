"""The pivot in Exudyn, whatever its strips are made of: ground, body, joints, drive and sensors.

The build without range checks, `exudynCPPfast`, is loaded where the processor has AVX2. The body is attached
by a `GenericJoint` at either strip, the ground ends by constraints of their coordinates, which are cheaper
than joints.
"""

import contextlib
import importlib.util
import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.baselines.geometry import geometry_of
from studies.cases.problem import Problem
from studies.kinds import Array


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


def installed() -> bool:
    """Return whether Exudyn can be imported."""
    return importlib.util.find_spec("exudyn") is not None


def loaded() -> tuple[Any, Any]:
    """Return Exudyn, in its build without range checks, and its items."""
    vars(sys)["exudynFast"] = True  # asks for the fast build
    with contextlib.redirect_stdout(io.StringIO()):  # it announces the build
        import exudyn
        import exudyn.itemInterface as items
    exudyn.config.printToConsole = False
    return exudyn, items


def system_of(problem: Problem, strip: Callable[..., tuple[int, float]]) -> System:
    """Return the pivot with the strips that `strip` makes.

    `strip(items, mbs, ground, root, direction)` adds one with its clamp, `ground` being a marker of a
    coordinate that is zero, and returns the number of the last node and the angle of its axes at rest [rad].
    """
    exu, items = loaded()
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


def hold(items: Any, mbs: Any, zero: int, node: int, coordinate: int) -> None:
    """Hold one coordinate of a node where it is at rest."""
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    mbs.AddObject(items.CoordinateConstraint(markerNumbers=[zero, marker]))
