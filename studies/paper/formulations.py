"""The formulations that the paper's figures compare, their paths and swings, and other readings."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from math import pi, sin
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release, answer_static
from studies.answers.metrics import swing_frequency
from studies.answers.motion import Motion
from studies.answers.reference import (
    MESHES,
    RECORDS,
    Reference,
    SwingReference,
    errors,
    largest_errors,
    reference,
    swing_reference,
)
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.effects import Effects
from studies.cases.problem import Problem, named_case
from studies.engine import Answer, Part, Study
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

#: Steps [s] of the leapfrog by control points. Half the step moves the rotation by less than 1e-5 rad within
#: `DURATION`. (The default integrator resolves the axial waves that the release excites at steps below 4e-6 s
#: only, and above that does not converge steadily.)
STEPS = {4: 1e-6, 5: 1e-6, 6: 1e-6, 7: 1e-6, 8: 1e-6, 9: 8e-7, 10: 6.25e-7}


@cache
def released(settings: Settings, **options: Any) -> Motion:
    """Return the motion after the release from the end of the case's path, or from `start` [rad]."""
    return answer_release(named_case(), settings, duration=DURATION, records=RECORDS, **options)


def resolved(settings: SplineSettings) -> Motion:
    """Return the spline's motion at a step that no longer matters."""
    step = STEPS[settings.points]
    return released(settings, integrator="leapfrog", step=step)


@cache
def refined_swing() -> SwingReference:
    """Return the swing in the limit of refinement of the finite elements."""
    return swing_reference(named_case(), duration=DURATION, instants=INSTANTS)


#: Gauss points of the paper's four control points: two do not see every stretch, the last are all but exact.
GAUSS = (3, 4, 5, 6, 8, 12)
#: Control points of what the assumptions are weighed with.
POINTS = 8
#: Share of critical damping of the swing.
DAMPING = 0.01
AS_READ = "midway between the upper clamps"


def _integrated(points: int) -> Answer:
    """Return the errors of the paper's formulation with so many Gauss points."""
    settings = SplineSettings(control_points=4, measure="spatial", stretch="consistent", gauss_points=points)
    path = answer_static(named_case(), settings)
    largest = largest_errors(path, refined())
    row = {
        "gauss_points": points,
        "status": path.status,
        "error_torque": largest["torque"],
        "error_stiffness": largest["stiffness"],
        "error_stiffness_end": float(errors(path, refined())["stiffness"][-1]),
    }
    return {"quadrature": row}


def _readings() -> Iterator[tuple[str, Problem]]:
    """Yield other readings of the case, that of the suite first."""
    case = named_case()
    yield AS_READ, case
    rise = (1.0 - case.crossing_ratio) * case.length * sin(case.inclination)
    for name, offset in (("at the crossing", -rise), ("as far above the upper clamps", rise)):
        yield f"centre of mass {name}", replace(case, centre_offset=(0.0, offset))
    yield (
        "gravity, the ground below",
        replace(case, effects=case.effects.renamed([*case.effects.names, "gravity"])),
    )
    frequency = swing_frequency(INSTANTS, _swing(case)).value
    lost = 2.0 * DAMPING * 2.0 * pi * frequency * case.body_moment_of_inertia
    damped = Effects(
        names=(*case.effects.names, "body_damping"),
        tables={"body_damping": {"translation": 0.0, "rotation": lost}},
    )
    yield f"damping, {DAMPING:.0%} of critical in the swing", replace(case, effects=damped)


def _swing(problem: Problem) -> Array:
    motion: Motion = answer_release(
        problem, SplineSettings(control_points=POINTS), duration=DURATION, records=len(INSTANTS) - 1,
        integrator="energy", step=DURATION / (10 * (len(INSTANTS) - 1)),
    )  # fmt: skip
    return np.interp(INSTANTS, motion.time, motion.rotation)


def _read() -> Answer:
    """Return a row a reading: travel of the centre [mm], frequency, and the rotation's largest difference."""
    rows, first = [], None
    for name, problem in _readings():
        path, swing = answer_static(problem, SplineSettings(control_points=POINTS)), _swing(problem)
        first = swing if first is None else first
        rows.append(
            {
                "reading": name,
                "travel_m": float(np.hypot(*(path.centre[-1] - path.centre[0]))),
                "torque_end_Nm": float(path.torque[-1]),
                "frequency_Hz": swing_frequency(INSTANTS, swing).value,
                "rotation_rad": float(np.abs(swing - first).max()),
            }
        )
    return {"readings": rows}


READINGS = Study(parts=(Part(at=lambda: GAUSS, ask=_integrated), Part(ask=_read)))
"""What the paper leaves open: how it integrates, where the centre of mass lies, gravity and damping.

Coarser and finer quadratures of four control points as the paper has them, and what each open assumption
changes of its Figs 4 and 6: the travel of the body's centre, the frequency after the release and the
rotation itself.
"""
