"""Sweeps of swings and of linear modes over refinement, step and amplitude: one row each."""

import dataclasses
import math
from functools import cache
from typing import Any

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.metrics import extrapolate, quasi_static_frequency
from studies.answers.motion import Motion
from studies.answers.reference import SWING_MESHES, sampled
from studies.answers.response import Response
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from studies.paper import formulations
from studies.paper.formulations import CASE, FE, SETTINGS

COUNTS = tuple(formulations.STEPS)
#: Beyond this count the consistent form, whose axial waves are faster, needs shorter steps; nor does it lock.
MOST_CONSISTENT = 7
#: Stretch forms with their counts.
FORMS = [("mixed", n) for n in COUNTS] + [("consistent", n) for n in COUNTS if n <= MOST_CONSISTENT]
ELEMENTS = (5, 10, *SWING_MESHES[:1], 20, *SWING_MESHES[1:])
STEPS = (2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4)
INTEGRATORS = {"energy": "energy-consistent", "generalised-alpha": "generalised-α"}
AMPLITUDES = (2, 5, 10, 20, 30, 45, 60, 75, 90)

#: Linear modes shown, and the meshes whose limit they are held against.
MODES = 5
MODE_MESHES = (5, 10, 20, 40, 80)

#: Options of the backbone's swings; at this step [s] the rotation is off by less than 2e-4 rad.
BACKBONE: dict[str, dict[str, Any]] = {FE: {}, "n = 6": {"integrator": "explicit", "step": 3e-6}}


def of_control_points(stretch: str, n: int) -> dict[str, Any]:
    """Return the row of a stretch form and count: the swing's frequency, its shift, what statics implies.

    Columns: stretch, control_points, status, frequency_Hz, shift (of the frequency, against the limit of the
    finite elements), shift_from_statics (of the quasi-static frequency against that of the finest elements),
    error_rotation_rad (largest over the motion).
    """
    settings = SplineSettings(control_points=n, stretch=stretch)
    motion = formulations.resolved(settings)
    implied = _static_frequency(answer_static(named_case(CASE), _as_in(motion, settings)))
    row = {"stretch": stretch, "control_points": n} | _outcome(motion)
    return row | {"shift_from_statics": implied / _finest_static_frequency() - 1.0}


def of_elements(count: int) -> dict[str, Any]:
    """Return the row of a mesh of the explicit finite elements; columns as of `of_control_points`."""
    levels = {int(level.settings["elements"]): level for level in formulations.refined_swing().levels}
    motion = levels[count] if count in levels else formulations.released(FeSettings(elements=count))
    return {"elements": count} | _outcome(motion)


def of_step(integrator: str, step: float) -> dict[str, Any]:
    """Return the row of an implicit integrator and step, against the resolved motion of the same spline.

    Columns: integrator, step_s, status, frequency_Hz, shift, error_rotation_rad, energy_error.
    """
    settings = SplineSettings(control_points=6)
    motion = formulations.released(settings, integrator=integrator, step=step)
    row = {"integrator": integrator, "step_s": step} | _outcome(motion, formulations.resolved(settings))
    return row | {"energy_error": motion.energy_error}


def modes() -> list[dict[str, Any]]:
    """Return one row a model, count and linear mode at rest, against the limit of the finite elements.

    Columns: model, count, mode, frequency_Hz, limit_Hz, error (relative), uncertainty (of the limit).
    """
    problem = named_case(CASE)
    meshes = {n: answer_modes(problem, FeSettings(elements=n), count=MODES).frequency for n in MODE_MESHES}
    splines = {
        n: answer_modes(problem, SplineSettings(control_points=n), count=MODES).frequency for n in COUNTS
    }
    # consistent masses and cubic elements: the frequencies are of order four
    limit = extrapolate([meshes[n] for n in MODE_MESHES[-3:]], order=4.0)
    rows = []
    for model, answers in (("fe", meshes), ("spline", splines)):
        for count, frequency in answers.items():
            for mode in range(min(MODES, len(frequency))):
                rows.append(
                    {
                        "model": model,
                        "count": count,
                        "mode": mode + 1,
                        "frequency_Hz": frequency[mode],
                        "limit_Hz": limit.value[mode],
                        "error": frequency[mode] / limit.value[mode] - 1.0,
                        "uncertainty": limit.uncertainty[mode] / limit.value[mode],
                    }
                )
    return rows


def of_amplitude(name: str, amplitude: float) -> dict[str, Any]:
    """Return the row of a model and amplitude: the frequency of the swing, and that of its static path.

    Columns: formulation, amplitude_rad, status, frequency_Hz, frequency_from_statics_Hz, first_mode_Hz.
    """
    problem = dataclasses.replace(named_case(CASE), rotation=float(amplitude))
    motion = formulations.released(SETTINGS[name], start=float(amplitude), **BACKBONE[name])
    return {
        "formulation": name,
        "amplitude_rad": amplitude,
        "status": motion.status,
        "frequency_Hz": motion.frequency if motion.converged else math.nan,
        "frequency_from_statics_Hz": _static_frequency(answer_static(problem, SETTINGS[name])),
        "first_mode_Hz": answer_modes(named_case(CASE), SETTINGS[name], count=1).frequency[0],
    }


@cache
def _finest_static_frequency() -> float:
    return _static_frequency(answer_static(named_case(CASE), FeSettings(elements=160)))


def _static_frequency(answer: Response) -> float:
    """Return the frequency of the swing that a static path implies, with the case's body [Hz]."""
    problem = named_case(CASE)
    return quasi_static_frequency(
        answer.rotation,
        answer.centre,
        answer.strain_energy,
        mass=problem.body_mass,
        moment_of_inertia=problem.body_moment_of_inertia,
    )


def _as_in(motion: Motion, settings: SplineSettings) -> SplineSettings:
    """Return `settings` with the slide stiffness that the pivot had in motion, for its static path."""
    return dataclasses.replace(settings, slide_stiffness=motion.settings["slide_stiffness"])


def _outcome(motion: Motion, exact: Motion | None = None) -> dict[str, Any]:
    """Return status, frequency, shift and error of a motion against `exact`, or the limit of the elements."""
    limit = formulations.refined_swing()
    frequency = limit.frequency if exact is None else exact.frequency
    rotation = limit.swing.rotation if exact is None else sampled(exact, formulations.INSTANTS).rotation
    found = motion.frequency if motion.converged else math.nan
    return {
        "status": motion.status,
        "frequency_Hz": found,
        "shift": found / frequency - 1.0,
        "error_rotation_rad": formulations.rotation_error(motion, rotation),
    }
