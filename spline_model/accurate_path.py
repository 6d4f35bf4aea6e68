"""A static path to a wanted accuracy: trial paths with more and more control points, compared by state."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.accuracy import search
from spline_model.design import Design, StripDesign
from spline_model.estimate import ErrorEstimate
from spline_model.solution import StaticSolution, Status

Array = NDArray[np.float64]

NOTHING = 1e-9
"""Displacement in lengths, turn [rad], torque in stiffness times 1 rad, and force in moment over length,
below which there is none but round-off."""
SAME_STATE = 1e-9
"""The same of states before the end: those of increments are the same, of arcs they are not."""
SAME_END = 1e-3
"""Difference of load factors, and of rotations [rad], at which paths stop that stop at the same thing."""


class Errors(NamedTuple):
    """Largest errors over a path, relative [1], as ``ErrorEstimate`` has them."""

    trajectory: float
    torque: float
    stiffness: float
    section_forces: float
    stress: float


def solve_accurately(
    design: Design, accuracy: float, solve: Callable[[int], StaticSolution], *, least: float | None = None
) -> StaticSolution:
    """The path with as many control points as the accuracy takes.

    solve: the answer with a number of control points. An accuracy that is not reached is the status
    NOT_CONVERGED of the best answer, or only where its error is not below ``least``: the answer's resolution
    tells it else. A path that stops at the same thing with any number is compared up to
    there and returned with its reason; where none is followed to the same end, it is that of the most points.
    """
    solved = cache(solve)

    def attempt(fewer: int, more: int) -> tuple[float, tuple[StaticSolution, Errors]] | None:
        coarse, fine = solved(fewer), solved(more)
        if not _end_alike(coarse, fine):
            return None
        errors = distances(design, coarse, fine)
        return max(errors), (coarse, errors)

    outcome = search(design, accuracy, attempt)
    if outcome.found is None:
        return solved(outcome.trials[-1])
    answer, errors = outcome.found
    estimate = ErrorEstimate(
        accuracy=accuracy,
        **errors._asdict(),
        control_points=outcome.control_points,
        trials=outcome.trials,
    )
    failed = outcome.error > max(accuracy, least or 0.0)
    if failed and answer.status is Status.CONVERGED:
        answer = replace(answer, status=Status.NOT_CONVERGED, message=outcome.message)
    return replace(answer, estimate=estimate)


def _end_alike(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths have the same status, and where they stop early about the same end."""
    return one.status is other.status and (one.status is Status.CONVERGED or _in_step(one, other))


def distances(design: Design, answer: StaticSolution, better: StaticSolution) -> Errors:
    """Errors of an answer against a better one, each over the largest magnitude on its path.

    Places over the largest displacement, turns over the largest turn, section forces over the largest force
    and the largest moment. What is none but round-off is held against its unit: strip length, rad, EI/L.
    Paths by arc length have no states in common but their ends, which are compared then.
    """
    length = max(strip.length for strip in design.strips)
    moment = max(strip.flexural_rigidity / strip.length for strip in design.strips)
    stress = max(strip.flexural_rigidity / strip.length / _modulus(strip) for strip in design.strips)
    rows = slice(None) if _in_step(answer, better) else slice(-1, None)

    def error(of: Callable[[StaticSolution], Array], unit: float) -> float:
        mine, right = of(answer)[rows], of(better)[rows]
        return _relative(mine - right, right, unit)

    return Errors(
        trajectory=max(error(_moved, length), error(_turned, 1.0)),
        torque=error(lambda path: path.torque, moment),
        stiffness=error(lambda path: path.stiffness, moment),
        section_forces=max(
            error(lambda path: path.bending_moment, moment),
            error(lambda path: np.stack((path.axial_force, path.shear_force), axis=1), moment / length),
        ),
        stress=error(lambda path: _stress(design, path), stress),
    )


def _in_step(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths have the states of the same load factors and rotations, about so where they end."""
    mine, others = (
        np.stack((p.load_factor, p.rotation if p.driven else p.load_factor)) for p in (one, other)
    )
    if mine.shape != others.shape:
        return False
    apart = np.abs(mine - others)
    return bool(apart[:, :-1].max(initial=0.0) <= SAME_STATE and apart[:, -1].max() <= SAME_END)


def _relative(apart: Array, right: Array, unit: float) -> float:
    """Largest of the differences over the largest that is right, or over the unit; 0 of nothing."""
    if right.size == 0 or np.isnan(right).all():
        return 0.0
    scale = float(np.abs(right).max())
    return float(np.abs(apart).max()) / (scale if scale > NOTHING * unit else unit)


def _moved(path: StaticSolution) -> Array:
    """Displacements x + iy of the bodies, or of the strips' ends where there are none (S, B) [m]."""
    places = np.stack(list(path.bodies.values()), axis=1) if path.bodies else path.shape[:, :, -1]
    moved = places - places[0]
    return np.asarray(moved[..., 0] + 1j * moved[..., 1])


def _turned(path: StaticSolution) -> Array:
    """Rotations of the bodies that are not driven (S, B) [rad]."""
    if not set(path.bodies) - {path.driven}:
        return np.zeros((len(path.load_factor), 0))
    return np.stack([at[:, 2] for name, at in path.bodies.items() if name != path.driven], axis=1)


def _modulus(strip: StripDesign) -> float:
    """Section modulus of the rectangle that A and I imply [m^3]."""
    return math.sqrt(strip.area * strip.second_moment_of_area / 3.0)


def _stress(design: Design, path: StaticSolution) -> Array:
    """Largest stress of each strip, |N|/A + |M|/W (S, G) [Pa]."""
    area = np.array([[strip.area] for strip in design.strips])
    modulus = np.array([[_modulus(strip)] for strip in design.strips])
    return np.asarray((np.abs(path.axial_force) / area + np.abs(path.bending_moment) / modulus).max(axis=2))
