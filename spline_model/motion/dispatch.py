"""The integrators by name, what each can be asked, their steps, and the run of the one that was chosen."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter, require_count
from spline_model.modes import linear_modes
from spline_model.motion import energy_consistent, explicit, generalised_alpha, quasi_static
from spline_model.motion.records import Records
from spline_model.motion.start import Motion, Start, Steps

Array = NDArray[np.float64]

INTEGRATORS: dict[str, Callable[..., Records]] = {
    "energy": energy_consistent.integrate,
    "generalised-alpha": generalised_alpha.integrate,
    **{name: partial(explicit.integrate, integrator=name) for name in explicit.SCHEMES},
}
QUASI_STATIC = "quasi-static strips"
"""What the energy integrator is called where only the bodies are dynamic."""
OPTIONS = {"generalised-alpha": ("spectral_radius",)}
"""Options of the integrators that have any."""
EXPLICIT_STEPS = {"explicit": 0.5, "leapfrog": 0.9}
"""Default explicit step over the longest stable one, which is that of the highest frequency at start and at
rest: stress stiffens the strips on the way, and near its limit Runge-Kutta takes energy from axial waves."""
STEP = 5e-5
"""Default step of the implicit integrators [s]: some 240 steps a swing of Table 1."""
MOST_MEMORY = 2e9
"""Bytes that the records of one run may take."""


def require_options(integrator: str, options: Mapping[str, float]) -> None:
    """Refuse an option that the integrator does not read."""
    known = OPTIONS.get(integrator, ())
    for name, value in options.items():
        if name not in known:
            reads = f"reads only {', '.join(known)}" if known else "reads no option"
            raise InvalidParameter(name, value, f"none: the integrator {integrator} {reads}")


def integrate(integrator: str, start: Start, run: Steps, options: Mapping[str, float]) -> tuple[str, Records]:
    """Run from a start; returns what ran and its records."""
    if integrator == "energy" and start.motion.massless:
        return QUASI_STATIC, quasi_static.integrate(start, run)
    return integrator, INTEGRATORS[integrator](start, run, **options)


def default_step(integrator: str, start: Start, duration: float) -> float:
    """STEP, or that of EXPLICIT_STEPS where it is shorter; at most the duration [s]."""
    step = min(STEP, duration)
    if integrator in EXPLICIT_STEPS:
        limit = explicit.stability_limit(integrator, start.motion)
        stable = limit / highest_frequency(start.motion, start.z)
        step = min(step, EXPLICIT_STEPS[integrator] * stable)
    return step


def highest_frequency(motion: Motion, z: Array) -> float:
    """Highest circular frequency at a state and at rest [rad/s]."""
    system = motion.system
    return math.sqrt(max(linear_modes(system, state, motion.mass)[0][-1] for state in (z, system.rest)))


def count_steps(duration: float, step: float, records: int | None, width: int) -> tuple[int, int]:
    """Number of steps, a multiple of the steps a record, and these; ``width`` numbers make a record.

    Raises InvalidParameter for a step longer than the duration, and for records that do not fit
    into MOST_MEMORY.
    """
    if step > duration:
        raise InvalidParameter("step", step, f"at most the duration, {duration:g} s")
    if records is not None:
        require_count("records", records, 1)
    steps = max(1, math.ceil(duration / step * (1 - 1e-12)))  # a whole number but for round-off
    every = 1 if records is None else max(1, math.ceil(steps / records))
    memory = 8.0 * width * (steps // every + 1)
    if memory > MOST_MEMORY:
        raise InvalidParameter(
            "duration",
            duration,
            f"records within {MOST_MEMORY / 1e9:g} GB; {steps} steps of {step:g} s take {memory / 1e9:.3g} "
            "GB: keep fewer of them with records, or take a longer step",
        )
    return math.ceil(steps / every) * every, every
