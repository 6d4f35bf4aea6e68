"""The formulations that the paper's figures compare, and their paths and swings, computed once."""

from functools import cache
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import (
    MESHES,
    RECORDS,
    Reference,
    SwingReference,
    reference,
    sampled,
    swing_reference,
)
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case
from studies.kinds import Array

PAPER = "n = 4, as the paper"
REFINED = "FE refined"
FE = "FE, 20 elements"
LOCKING_FREE = "n = 4, locking-free"

#: Spline formulations and the paper's finite elements; what each one is stands in `MEANING`.
SETTINGS: dict[str, Settings] = {
    PAPER: SplineSettings(control_points=4, measure="spatial", stretch="consistent"),
    "n = 4, printed forces": SplineSettings(control_points=4, measure="printed", stretch="consistent"),
    "n = 4, 3 Gauss points": SplineSettings(
        control_points=4, measure="spatial", stretch="consistent", gauss_points=3
    ),
    LOCKING_FREE: SplineSettings(control_points=4, axial_modes=2),
    "n = 6": SplineSettings(control_points=6),
    FE: FeSettings(elements=20),
}

#: What each formulation is, for tables and reports.
MEANING: dict[str, str] = {
    PAPER: "Eqs 10 and 13 integrated exactly: spatial measure, consistent stretch",
    "n = 4, printed forces": "the forces of Eqs 12 and 15 as printed, not the gradient of an energy",
    "n = 4, 3 Gauss points": "Eqs 10 and 13 with three Gauss points, too few to see the locking",
    LOCKING_FREE: "material measure, mixed stretch with two axial-force modes a strip",
    "n = 6": "material measure, mixed stretch with four axial-force modes a strip",
    FE: "corotational Euler-Bernoulli elements, 20 a strip, as the paper",
    REFINED: f"the same elements in the limit of refinement, from {', '.join(map(str, MESHES))} a strip",
}


@cache
def answer(name: str) -> Response:
    """Return the static path of a formulation, computed once however many figures ask."""
    return answer_static(named_case(), SETTINGS[name])


@cache
def refined() -> Reference:
    """Return the limit of refinement of the case's static path."""
    return reference(named_case())


#: Duration of the motion [s], and the instants at which swings are compared [s].
DURATION = 0.05
INSTANTS = np.linspace(0.0, DURATION, 501)

#: Steps [s] of the explicit integrator by control points. It is of order four: half the step moves the
#: rotation by less than 4e-5 rad within `DURATION`. (The default integrator, of order two, resolves the axial
#: waves that the release excites at steps below 4e-6 s only, and above that does not converge steadily.)
STEPS = {4: 4e-6, 5: 2e-6, 6: 1.5e-6, 7: 2e-6, 8: 2e-6, 9: 1.6e-6, 10: 1.25e-6}


@cache
def released(settings: Settings, *, duration: float = DURATION, **options: Any) -> Motion:
    """Return the motion after the release from the end of the case's path, or from `start` [rad]."""
    return answer_release(named_case(), settings, duration=duration, records=RECORDS, **options)


def resolved(settings: SplineSettings, *, duration: float = DURATION) -> Motion:
    """Return the spline's motion at a step that no longer matters."""
    step = STEPS[settings.points]
    return released(settings, duration=duration, integrator="explicit", step=step)


@cache
def refined_swing() -> SwingReference:
    """Return the swing in the limit of refinement of the finite elements."""
    return swing_reference(named_case(), duration=DURATION, instants=INSTANTS)


def rotation_error(motion: Motion, against: Array, instants: Array = INSTANTS) -> float:
    """Return the largest difference of the rotation to `against` at `instants` [rad]; NaN if it stopped
    early."""
    if not motion.converged:
        return float("nan")
    return float(np.abs(sampled(motion, instants).rotation - against).max())
