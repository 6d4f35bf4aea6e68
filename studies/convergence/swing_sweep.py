"""Sweeps of swings and of linear modes over refinement and amplitude: one row each."""

import dataclasses
import math
from functools import cache, partial
from itertools import product
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.metrics import extrapolate, quasi_static_frequency
from studies.answers.motion import Motion
from studies.answers.reference import rotation_error
from studies.answers.response import Response
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from studies.engine import Answer, Part
from studies.paper import formulations
from studies.paper.formulations import FE, SETTINGS

COUNTS = tuple(formulations.STEPS)
#: Beyond this count the consistent form, whose axial waves are faster, needs shorter steps; nor does it lock.
MOST_CONSISTENT = 7
#: Stretch forms with their counts.
FORMS = [("mixed", n) for n in COUNTS] + [("consistent", n) for n in COUNTS if n <= MOST_CONSISTENT]
AMPLITUDES = (2, 5, 10, 20, 30, 45, 60, 75, 90)

#: Linear modes shown, and the meshes whose limit they are held against.
MODES = 5
MODE_MESHES = (5, 10, 20, 40, 80)

#: Options of the backbone's swings; at this step [s] the rotation is off by less than 2e-5 rad.
BACKBONE: dict[str, dict[str, Any]] = {FE: {}, "n = 6": {"integrator": "leapfrog", "step": 2e-6}}


def _of_control_points(stretch: str, n: int) -> Answer:
    """Return the row of a stretch form and count: the swing's frequency, its shift, what statics implies.

    Columns: stretch, control_points, status, frequency_Hz, shift (of the frequency, against the limit of the
    finite elements), shift_from_statics (of the quasi-static frequency against that of the finest elements),
    error_rotation_rad (largest over the motion).
    """
    settings = SplineSettings(control_points=n, stretch=stretch)
    motion = formulations.resolved(settings)
    # its static path has the slide stiffness that the pivot had in motion
    slid = dataclasses.replace(settings, slide_stiffness=motion.settings["slide_stiffness"])
    implied = _static_frequency(answer_static(named_case(), slid))
    row = {"stretch": stretch, "control_points": n} | _outcome(motion)
    return {"control_points": row | {"shift_from_statics": implied / _finest_static_frequency() - 1.0}}


def _modes() -> Answer:
    """Return one row a model, count and linear mode at rest, against the limit of the finite elements.

    Columns: model, count, mode, frequency_Hz, limit_Hz, error (relative), uncertainty (of the limit).
    """
    ask: Any = partial(answer_modes, named_case(), count=MODES)
    meshes = {n: ask(FeSettings(elements=n)).frequency for n in MODE_MESHES}
    splines = {n: ask(SplineSettings(control_points=n)).frequency for n in COUNTS}
    # consistent masses and cubic elements: the frequencies are of order four
    limit = extrapolate([meshes[n] for n in MODE_MESHES[-3:]], order=4.0)
    rows = [
        {
            "model": model,
            "count": count,
            "mode": mode + 1,
            "frequency_Hz": value,
            "limit_Hz": exact,
            "error": value / exact - 1.0,
            "uncertainty": unsure / exact,
        }
        for model, answers in (("fe", meshes), ("spline", splines))
        for count, frequency in answers.items()
        for mode, (value, exact, unsure) in enumerate(
            zip(frequency[:MODES], limit.value, limit.uncertainty, strict=False)
        )
    ]
    return {"modes": rows}


def _of_amplitude(name: str, amplitude: float) -> Answer:
    """Return the row of a model and amplitude: the frequency of the swing, and that of its static path.

    Columns: formulation, amplitude_rad, status, frequency_Hz, frequency_from_statics_Hz, first_mode_Hz.
    """
    problem = dataclasses.replace(named_case(), rotation=float(amplitude))
    motion = formulations.released(SETTINGS[name], start=float(amplitude), **BACKBONE[name])
    row = {
        "formulation": name,
        "amplitude_rad": amplitude,
        "status": motion.status,
        "frequency_Hz": motion.frequency if motion.converged else math.nan,
        "frequency_from_statics_Hz": _static_frequency(answer_static(problem, SETTINGS[name])),
        "first_mode_Hz": answer_modes(named_case(), SETTINGS[name], count=1).frequency[0],
    }
    return {"backbone": row}


def _reference() -> Answer:
    """Return the frequency in the limit of the finite elements and its uncertainty."""
    limit = formulations.refined_swing()
    known = {"frequency_Hz": limit.frequency, "uncertainty": limit.uncertainty["frequency"]}
    return {"reference": {"quantity": "frequency", **known}}


@cache
def _finest_static_frequency() -> float:
    return _static_frequency(answer_static(named_case(), FeSettings(elements=160)))


def _static_frequency(answer: Response) -> float:
    """Return the frequency of the swing that a static path implies, with the case's body [Hz]."""
    problem = named_case()
    return quasi_static_frequency(
        answer.rotation,
        answer.centre,
        answer.strain_energy,
        mass=problem.body_mass,
        moment_of_inertia=problem.body_moment_of_inertia,
    )


def _outcome(motion: Motion) -> dict[str, Any]:
    """Return status, frequency, shift and error of a motion against the limit of the elements."""
    limit = formulations.refined_swing()
    found = motion.frequency if motion.converged else math.nan
    return {
        "status": motion.status,
        "frequency_Hz": found,
        "shift": found / limit.frequency - 1.0,
        "error_rotation_rad": rotation_error(motion, limit, limit.time) if motion.converged else math.nan,
    }


#: What is asked, for the tables control_points, modes, backbone and reference.
PARTS = (
    Part(at=lambda: FORMS, ask=_of_control_points),
    Part(ask=_modes),
    Part(at=lambda: product(BACKBONE, np.radians(AMPLITUDES)), ask=_of_amplitude),
    Part(ask=_reference),
)
