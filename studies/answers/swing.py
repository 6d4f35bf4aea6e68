"""The reference that motions are held against: the limit of refinement of the explicit finite elements."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_release
from studies.answers.frequency import swing_frequency
from studies.answers.metrics import extrapolate
from studies.answers.motion import Motion
from studies.answers.reference import NoReference
from studies.answers.settings import FeSettings
from studies.cases.problem import Problem
from studies.kinds import Array

#: Meshes that the limit is taken from, a third apart: the work grows with the cube of the count, so that
#: doubling four times would take minutes. The critical step falls with the square of the element, and with it
#: the error of the step faster than that of the mesh.
MESHES = (16, 24, 36, 54)
RATIO = 1.5

#: Records of a motion [1]: some 80 a swing of Table 1, between which cubic interpolation is enough.
RECORDS = 1000


@dataclass(frozen=True, kw_only=True)
class Swing:
    """A motion at common instants, T of them.

    Attributes:
        time (T,) [s]; rotation (T,) [rad]; centre (T, 2) [m]; kinetic_energy, strain_energy (T,) [J].
    """

    time: Array
    rotation: Array
    centre: Array
    kinetic_energy: Array
    strain_energy: Array


@dataclass(frozen=True, kw_only=True)
class SwingReference:
    """Limit of refinement of a swing and how uncertain it is.

    Attributes:
        swing: the limit at the common instants.
        frequency: of the limit [Hz].
        uncertainty: (T,) of the rotation [rad]; centre_uncertainty: (T, 2) [m].
        frequency_uncertainty: relative [1].
        levels: the motions that it was taken from, the finest last.
    """

    swing: Swing
    frequency: float
    uncertainty: Array
    centre_uncertainty: Array
    frequency_uncertainty: float
    levels: tuple[Motion, ...]


def sampled(motion: Motion, instants: Array) -> Swing:
    """Return `motion` at `instants` [s] by cubic interpolation between its records."""

    def at(values: Array) -> Array:
        return np.asarray(CubicSpline(motion.time, values)(instants))

    return Swing(
        time=instants,
        rotation=at(motion.rotation),
        centre=at(motion.centre),
        kinetic_energy=at(motion.kinetic_energy),
        strain_energy=at(motion.strain_energy),
    )


def swing_reference(problem: Problem, *, duration: float, instants: Array) -> SwingReference:
    """Release `problem` from the end of its path on the meshes and return their limit at `instants` [s].

    Raises:
        NoReference: a motion stopped early.
    """
    levels = []
    for elements in MESHES:
        settings = FeSettings(elements=elements)
        answer = answer_release(problem, settings, duration=duration, records=RECORDS)
        if not answer.converged:
            raise NoReference(f"reference with {elements} elements: {answer.message}")
        levels.append(answer)
    return limit_of(levels, instants)


def limit_of(levels: Sequence[Motion], instants: Array) -> SwingReference:
    """Return the limit of motions on meshes that are each finer by `RATIO` than the one before."""
    swings = [sampled(level, instants) for level in levels]
    limits = {
        name: extrapolate([getattr(swing, name) for swing in swings], ratio=RATIO)
        for name in ("rotation", "centre", "kinetic_energy", "strain_energy")
    }
    rotation = limits["rotation"]
    before = extrapolate([swing.rotation for swing in swings[:-1]], ratio=RATIO).value
    frequency = swing_frequency(instants, rotation.value).value
    return SwingReference(
        swing=Swing(time=instants, **{name: limit.value for name, limit in limits.items()}),
        frequency=frequency,
        uncertainty=rotation.uncertainty,
        centre_uncertainty=limits["centre"].uncertainty,
        frequency_uncertainty=abs(swing_frequency(instants, before).value / frequency - 1.0),
        levels=tuple(levels),
    )
