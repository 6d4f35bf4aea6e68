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

from typing import Any

import numpy as np

from studies.baselines.answer import Array, BaselineMotion, BaselinePath, checked_choice, checked_count
from studies.baselines.peers.exudyn_solve import follow, let_go
from studies.baselines.peers.exudyn_system import System, hold, installed, system_of
from studies.cases.problem import Problem

__all__ = ["installed", "release", "static_path"]

MODEL = "exudyn exact"
#: Shear correction of a rectangular section, k.
SHEAR_CORRECTION = 5.0 / 6.0


def static_path(
    problem: Problem,
    rotations: Any,
    *,
    repeat: int = 1,
    elements: int = 4,
    nodes: int = 3,
    shear_stiffness_factor: float = 1.0,
    relative_tolerance: float = 1e-8,
    solver: str = "tuned",
) -> BaselinePath:
    """Drive the body through `rotations` [rad], the first of which is 0, one load step each.

    Args:
        problem: the pivot.
        rotations: (S,) [rad].
        repeat: timed solves of the whole path [1].
        elements: a strip [1]; nodes: of an element, 2 or 3.
        shear_stiffness_factor: on k G A [1].
        relative_tolerance: of Newton's residual against that at the step's start [1].
        solver: "tuned", or "as delivered" for Exudyn's own defaults but for files and messages.

    Raises:
        BadInput: a setting out of range. BaselineFailed: no convergence.
    """
    settings = {
        "elements": elements,
        "nodes": nodes,
        "shear_stiffness_factor": shear_stiffness_factor,
        "relative_tolerance": relative_tolerance,
        "solver": solver,
    }
    system = _system(problem, elements, nodes, shear_stiffness_factor)
    return follow(system, rotations, model=MODEL, settings=settings, repeat=repeat)


def release(
    problem: Problem,
    *,
    start: float,
    duration: float,
    step: float,
    repeat: int = 1,
    elements: int = 4,
    nodes: int = 3,
    shear_stiffness_factor: float = 1.0,
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
        "nodes": nodes,
        "shear_stiffness_factor": shear_stiffness_factor,
        "relative_tolerance": relative_tolerance,
        "spectral_radius": spectral_radius,
    }
    return let_go(
        _system(problem, elements, nodes, shear_stiffness_factor),
        start=start,
        duration=duration,
        step=step,
        model=MODEL,
        settings=settings,
        repeat=repeat,
    )


def _system(problem: Problem, elements: int, nodes: int, factor: float) -> System:
    checked_count("elements", elements, 1)
    checked_choice("nodes", nodes, (2, 3))
    modulus = problem.youngs_modulus
    shear_modulus = modulus / (2.0 * (1.0 + problem.poisson_ratio))
    spans = nodes - 1

    def strip(items: Any, mbs: Any, zero: int, root: Array, direction: Array) -> tuple[int, float]:
        along = np.linspace(0.0, problem.length, spans * elements + 1)
        numbers = [
            mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*(root + s * direction), 0.0]))
            for s in along
        ]
        for first in range(0, spans * elements, spans):
            mbs.AddObject(
                items.ObjectBeamGeometricallyExact2D(
                    length=problem.length / elements,
                    massPerLength=problem.density * problem.area,
                    crossSectionInertia=problem.density * problem.second_moment_of_area,
                    bendingStiffness=modulus * problem.second_moment_of_area,
                    axialStiffness=modulus * problem.area,
                    shearStiffness=factor * SHEAR_CORRECTION * shear_modulus * problem.area,
                    nodeNumbers=numbers[first : first + nodes],
                )
            )
        for coordinate in range(3):
            hold(items, mbs, zero, numbers[0], coordinate)
        return numbers[-1], 0.0

    return system_of(problem, strip)
