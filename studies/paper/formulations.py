"""The formulations that figures compare, each named once, their paths and swings, and other quadratures."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from studies.answers import reference
from studies.answers.adapters import answer_release, answer_static
from studies.answers.motion import Motion
from studies.answers.reference import RECORDS, Reference, SwingReference, errors
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case
from studies.engine import Answer, Part, Study
from studies.record.style import BLACK, BLUE, GREY, ORANGE, PURPLE, RED, SKY, Look

PAPER, LOCKING_FREE, SIX = "n = 4, as the paper", "n = 4, locking-free", "n = 6"
REFINED, FE = "FE refined", "FE, 20 elements"
PRINTED = "n = 4, printed forces"

_AS_PAPER = SplineSettings(control_points=4, measure="spatial", stretch="consistent")
#: Settings of each formulation, none of the limit of refinement, and how it is drawn.
NAMED: dict[str, tuple[Settings | None, Look]] = {
    # the same elements in the limit of refinement
    REFINED: (None, Look(label="FE, refined", colour=BLACK)),
    # corotational Euler-Bernoulli elements, as many a strip as the paper has
    FE: (FeSettings(elements=20), Look(label="FE, 20 elements", colour=GREY, line="--", marker="s")),
    # Eqs 10 and 13 integrated exactly: spatial measure, consistent stretch
    PAPER: (_AS_PAPER, Look(label="spline n = 4, as the paper", colour=RED, marker="o")),
    # the forces of Eqs 12 and 15 as printed, not the gradient of an energy
    PRINTED: (
        replace(_AS_PAPER, measure="published"),
        Look(label="spline n = 4, printed forces", colour=PURPLE, line=":", marker="v"),
    ),
    # Eqs 10 and 13 with three Gauss points, too few to see the locking
    "n = 4, 3 Gauss points": (
        replace(_AS_PAPER, gauss_points=3),
        Look(label="spline n = 4, 3 Gauss points", colour=ORANGE, line="-.", marker="^"),
    ),
    # material measure, mixed stretch with two axial-force modes a strip; with four
    LOCKING_FREE: (
        SplineSettings(control_points=4, axial_modes=2),
        Look(label="spline n = 4, locking-free", colour=SKY, marker="D"),
    ),
    SIX: (SplineSettings(control_points=6), Look(label="spline n = 6", colour=BLUE, marker="x")),
}
SETTINGS = {name: settings for name, (settings, _) in NAMED.items() if settings is not None}
LOOKS = {name: look for name, (_, look) in NAMED.items()}


@cache
def path_of(name: str) -> Any:
    """Return the static path of a formulation, computed once however many figures ask."""
    return refined() if name == REFINED else answer_static(named_case(), SETTINGS[name])


@cache
def refined() -> Reference:
    """Return the limit of refinement of the case's static path."""
    return reference.reference(named_case())


#: Duration of the motion [s], and the instants at which swings are compared [s].
DURATION = 0.05
INSTANTS = np.linspace(0.0, DURATION, 501)

#: Steps [s] of the leapfrog by control points. Half the step moves the rotation by less than 1e-5 rad within
#: `DURATION`. (The default integrator resolves the axial waves that the release excites at steps below 4e-6 s
#: only, and above that does not converge steadily.)
STEPS = {4: 1e-6, 5: 1e-6, 6: 1e-6, 7: 1e-6, 8: 1e-6, 9: 8e-7, 10: 6.25e-7}


@cache
def released(settings: Settings, **options: Any) -> Motion:
    """Return the motion after the release from the end of the case's path, or from `start` [rad]."""
    return answer_release(named_case(), settings, duration=DURATION, records=RECORDS, **options)


def resolved(settings: Settings) -> Motion:
    """Return the motion at a step that no longer matters; elements choose their own."""
    if isinstance(settings, FeSettings):
        return released(settings)
    return released(settings, integrator="leapfrog", step=STEPS[settings.points])


@cache
def refined_swing() -> SwingReference:
    """Return the swing in the limit of refinement of the finite elements."""
    return reference.swing_reference(named_case(), duration=DURATION, instants=INSTANTS)


#: Gauss points of the paper's four control points: two do not see every stretch, the last are all but exact.
GAUSS = (3, 4, 5, 6, 8, 12)


def _integrated(points: int) -> Answer:
    """Return the errors of the paper's formulation with so many Gauss points."""
    path = answer_static(named_case(), replace(_AS_PAPER, gauss_points=points))
    error = errors(path, refined())
    row = {
        "gauss_points": points,
        "status": path.status,
        **{f"error_{name}": float(np.abs(error[name]).max()) for name in ("torque", "stiffness")},
        "error_stiffness_end": float(error["stiffness"][-1]),
    }
    return {"quadrature": row}


READINGS = Study(
    parts=(Part(at=lambda: GAUSS, ask=_integrated),),
)
"""Coarser and finer quadratures of four control points as the paper has them, which it does not state."""
