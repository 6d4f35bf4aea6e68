"""The pivot with strips of Exudyn's planar ANCF cable elements, `ObjectANCFCable2D`.

Law: a rod without shear and without the inertia of its sections, extension |r'| - 1 over the length at rest,
and the material measure of curvature, d(angle)/ds0: the theory of the spline and of the corotational finite
elements, so that all tend to one limit. Two nodes with position and slope, cubic between them. Source:
Gerstmayr and Shabana, Nonlinear Dynamics 45 (2006) 109-130; manual of Exudyn 1.13.

`integration` is Exudyn's `useReducedOrderIntegration`: 0 Gauss rules of order 9 (axial) and 5 (bending), 1
of 7 and 3, 2 mixed Lobatto and Gauss. Their errors differ by a factor of two or three, now one and now the
other being the smallest; 1 and 2 save 5 to 10 % of the time.
"""

from itertools import pairwise
from typing import Any

import numpy as np

from studies.baselines.answer import Array, BaselineMotion, BaselinePath, checked_choice, checked_count
from studies.baselines.peers.exudyn_solve import follow, let_go
from studies.baselines.peers.exudyn_system import System, hold, installed, system_of
from studies.cases.problem import Problem

__all__ = ["installed", "release", "static_path"]

MODEL = "exudyn ancf"


def static_path(
    problem: Problem,
    rotations: Any,
    *,
    repeat: int = 1,
    elements: int = 8,
    integration: int = 0,
    relative_tolerance: float = 1e-8,
    solver: str = "tuned",
) -> BaselinePath:
    """Drive the body through `rotations` [rad], the first of which is 0, one load step each.

    Args:
        problem: the pivot.
        rotations: (S,) [rad].
        repeat: timed solves of the whole path [1].
        elements: a strip [1].
        integration: rule, 0, 1 or 2.
        relative_tolerance: of Newton's residual against that at the step's start [1].
        solver: "tuned", or "as delivered" for Exudyn's own defaults but for files and messages.

    Raises:
        BadInput: a setting out of range. BaselineFailed: no convergence.
    """
    settings = {
        "elements": elements,
        "integration": integration,
        "relative_tolerance": relative_tolerance,
        "solver": solver,
    }
    return follow(
        _system(problem, elements, integration), rotations, model=MODEL, settings=settings, repeat=repeat
    )


def release(
    problem: Problem,
    *,
    start: float,
    duration: float,
    step: float,
    repeat: int = 1,
    elements: int = 8,
    integration: int = 0,
    relative_tolerance: float = 1e-4,
    spectral_radius: float = 0.9,
) -> BaselineMotion:
    """Let go of the body at rest at `start` [rad] and follow it by generalised-alpha for `duration` [s].

    Args:
        step: [s]; spectral_radius: of generalised-alpha at infinite frequency, 0 to 1. The others as of
            `static_path`.

    Raises:
        BadInput: a setting out of range. BaselineFailed: no convergence.
    """
    settings = {
        "elements": elements,
        "integration": integration,
        "relative_tolerance": relative_tolerance,
        "spectral_radius": spectral_radius,
    }
    return let_go(
        _system(problem, elements, integration),
        start=start,
        duration=duration,
        step=step,
        model=MODEL,
        settings=settings,
        repeat=repeat,
    )


def _system(problem: Problem, elements: int, integration: int) -> System:
    checked_count("elements", elements, 1)
    checked_choice("integration", integration, (0, 1, 2))

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
                    useReducedOrderIntegration=integration,
                )
            )
        _clamp(items, mbs, zero, nodes[0], direction)
        return nodes[-1], float(np.arctan2(direction[1], direction[0]))

    return system_of(problem, strip)


def _clamp(items: Any, mbs: Any, zero: int, node: int, direction: Array) -> None:
    """Hold the place of the first node, and its slope along `direction`, whose length is left to stretch."""
    hold(items, mbs, zero, node, 0)
    hold(items, mbs, zero, node, 1)
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
