"""The pivot with strips of Exudyn's planar geometrically exact beams, `ObjectBeamGeometricallyExact2D`.

Law: Reissner's rod: extension and shear from the position's derivative in the axes of the section, curvature
from the section's own angle over the length at rest, with shear compliance 1 / (k G A), k = 5/6, and the
inertia of the sections' rotation. This is another theory than that of a rod without shear: its answers are
to be held against their own limit, which is that of this repository's Reissner elements to 2e-9.

Shear is kept because Table 1 has it. `shear_stiffness_factor` multiplies k G A: 1000 leaves 2e-6 of the
difference to the rod without shear, with the same errors of the elements, which do not lock, but takes three
times as long; at 1e4 Newton's method no longer meets its tolerance.

Elements with three nodes are the default: 1e-3 takes 20 of those with two, and three of these. Source:
manual of Exudyn 1.13; Simo and Vu-Quoc, CMAME 58 (1986) 79-116.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.baselines.answer import checked_choice, checked_count
from studies.baselines.peers.exudyn_code import Code
from studies.baselines.peers.exudyn_system import System, hold, installed, system_of
from studies.cases.problem import Problem
from studies.kinds import Array

__all__ = ["installed", "release", "static_path"]

MODEL = "exudyn exact"
#: Shear correction of a rectangular section, k.
SHEAR_CORRECTION = 5.0 / 6.0


@dataclass(frozen=True)
class Beams:
    """Strips of exact beams: elements a strip, nodes of an element, 2 or 3, and a factor on k G A [1]."""

    elements: int = 4
    nodes: int = 3
    shear_stiffness_factor: float = 1.0

    def __post_init__(self) -> None:
        checked_count("elements", self.elements, 1)
        checked_choice("nodes", self.nodes, (2, 3))

    def system(self, problem: Problem) -> System:
        """Return the pivot with such strips in Exudyn."""
        modulus = problem.youngs_modulus
        shear_modulus = modulus / (2.0 * (1.0 + problem.poisson_ratio))
        spans = self.nodes - 1

        def strip(items: Any, mbs: Any, zero: int, root: Array, direction: Array) -> tuple[int, float]:
            along = np.linspace(0.0, problem.length, spans * self.elements + 1)
            numbers = [
                mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*(root + s * direction), 0.0]))
                for s in along
            ]
            for first in range(0, spans * self.elements, spans):
                mbs.AddObject(
                    items.ObjectBeamGeometricallyExact2D(
                        length=problem.length / self.elements,
                        massPerLength=problem.density * problem.area,
                        crossSectionInertia=problem.density * problem.second_moment_of_area,
                        bendingStiffness=modulus * problem.second_moment_of_area,
                        axialStiffness=modulus * problem.area,
                        shearStiffness=self.shear_stiffness_factor
                        * SHEAR_CORRECTION
                        * shear_modulus
                        * problem.area,
                        nodeNumbers=numbers[first : first + self.nodes],
                    )
                )
            for coordinate in range(3):
                hold(items, mbs, zero, numbers[0], coordinate)
            return numbers[-1], 0.0

        return system_of(problem, strip)


CODE = Code(MODEL, Beams)
static_path, release = CODE.static_path, CODE.release
