"""Swings of the paper's pivot after its release, computed once however many studies ask."""

from functools import cache
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release
from studies.answers.motion import Motion
from studies.answers.settings import Settings, SplineSettings
from studies.answers.swing import RECORDS, SwingReference, sampled, swing_reference
from studies.cases.problem import named_case
from studies.kinds import Array
from studies.paper.formulations import CASE

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
    return answer_release(named_case(CASE), settings, duration=duration, records=RECORDS, **options)


def resolved(settings: SplineSettings, *, duration: float = DURATION) -> Motion:
    """Return the spline's motion at a step that no longer matters."""
    step = STEPS[settings.points]
    return released(settings, duration=duration, integrator="explicit", step=step)


@cache
def reference() -> SwingReference:
    """Return the swing in the limit of refinement of the finite elements."""
    return swing_reference(named_case(CASE), duration=DURATION, instants=INSTANTS)


def rotation_error(motion: Motion, against: Array, instants: Array = INSTANTS) -> float:
    """Return the largest difference of the rotation to `against` at `instants` [rad]; NaN if it stopped
    early."""
    if not motion.converged:
        return float("nan")
    return float(np.abs(sampled(motion, instants).rotation - against).max())
