"""The pivot with strips of Exudyn's planar ANCF cable elements, `ObjectANCFCable2D`.

Law: a rod without shear and without the inertia of its sections, extension |r'| - 1 over the length at rest,
and the material measure of curvature, d(angle)/ds0: the theory of the spline and of the corotational finite
elements, so that all tend to one limit. Two nodes with position and slope, cubic between them. Source:
Gerstmayr and Shabana, Nonlinear Dynamics 45 (2006) 109-130; manual of Exudyn 1.13.

`integration` is Exudyn's `useReducedOrderIntegration`: 0 Gauss rules of order 9 (axial) and 5 (bending), 1
of 7 and 3, 2 mixed Lobatto and Gauss. Their errors differ by a factor of two or three, now one and now the
other being the smallest; 1 and 2 save 5 to 10 % of the time.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from studies.baselines.answer import checked_choice, checked_count
from studies.baselines.peers.exudyn_code import Code
from studies.baselines.peers.exudyn_system import System, hold, installed, system_of
from studies.cases.problem import Problem
from studies.kinds import Array

__all__ = ["installed", "release", "static_path"]

MODEL = "exudyn ancf"


@dataclass(frozen=True)
class Cables:
    """Strips of ANCF cables: elements a strip [1]; integration: rule, 0, 1 or 2."""

    elements: int = 8
    integration: int = 0

    def __post_init__(self) -> None:
        checked_count("elements", self.elements, 1)
        checked_choice("integration", self.integration, (0, 1, 2))

    def system(self, problem: Problem) -> System:
        """Return the pivot with such strips in Exudyn."""

        def strip(items: Any, mbs: Any, zero: int, root: Array, direction: Array) -> tuple[int, float]:
            places = root + np.linspace(0.0, problem.length, self.elements + 1)[:, None] * direction
            nodes = [
                mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[*place, *direction]))
                for place in places
            ]
            for pair in pairwise(nodes):
                mbs.AddObject(
                    items.ObjectANCFCable2D(
                        length=problem.length / self.elements,
                        massPerLength=problem.density * problem.area,
                        bendingStiffness=problem.youngs_modulus * problem.second_moment_of_area,
                        axialStiffness=problem.youngs_modulus * problem.area,
                        nodeNumbers=list(pair),
                        useReducedOrderIntegration=self.integration,
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


CODE = Code(MODEL, Cables)
static_path, release = CODE.static_path, CODE.release
