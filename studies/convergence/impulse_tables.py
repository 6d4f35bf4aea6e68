"""Tables of the sequential impulses: error, drift, energy and work against the step, limits and sweeps."""

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from spline_model.dynamics import Trajectory, solve_release
from spline_model.impulses.stepper import contraction, sweep_errors
from spline_model.pivot import Pivot
from spline_model.sequential_impulse import impulse_solver, solve_impulses, stability_limit
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine import Answer, Part
from studies.kinds import Array
from studies.record.progress import measure

SETTINGS = SplineSettings(control_points=6)

#: Group of modes -> settings of a spline whose fastest mode belongs to it: strips that stretch, strips that
#: only bend, and strips whose shape follows the body, so that nothing but the swing is left.
GROUPS: dict[str, SplineSettings] = {
    "axial": SETTINGS,
    "bending": SplineSettings(control_points=5, axial_modes=4, stretch="inextensible", slide_stiffness=0.0),
    "swing": SplineSettings(control_points=4, axial_modes=3, stretch="inextensible", slide_stiffness=0.0),
}

#: Start of every release [rad].
START = math.pi / 2


def _designs() -> dict[str, Problem]:
    """Return Table 1, and the same pivot with strips of a polymer, 10 mm x 0.8 mm, and a small body."""
    given = named_case()
    polymer = replace(
        given,
        area=8e-6,
        second_moment_of_area=1e-2 * 8e-4**3 / 12.0,
        youngs_modulus=2e9,
        density=1100.0,
        body_mass=0.05,
        body_moment_of_inertia=2e-5,
    )
    return {"Table 1": given, "polymer": polymer}


@cache
def _pivot(design: str, settings: SplineSettings = SETTINGS) -> Pivot:
    """Return a design as a spline in motion."""
    found: Pivot = put(_designs()[design], settings, moving=True).modelled
    return found


FORMS = ("printed", "stable")
#: Duration of the motions [s]: one swing and two thirds of Table 1; for the polymer a quarter of one, after
#: which the strips flutter and neighbouring motions part, whatever the integrator.
DURATION = {"Table 1": 0.02, "polymer": 0.08}
#: Steps of the leapfrog that motions are held against [s]: shorter ones change their rotation by 1e-6 rad.
EXACT_STEP = {"Table 1": 1e-6, "polymer": 5e-6}
#: The paper's step [s].
PAPER_STEP = 0.01
#: Steps of the stable form [s]; both durations are multiples of them. The polymer's begin at `SHORTEST`.
STEPS = (1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)
SHORTEST = {"Table 1": 1e-6, "polymer": 5e-6}
#: Steps of the printed form, over its limit from the spectrum at rest.
FRACTIONS = (0.3, 0.5, 0.7, 0.9, 1.1, 1.5, 3.0, 10.0)
#: Records of a motion [1].
RECORDS = 200

#: Rotation of the swing whose stability is tried [rad], steps of a trial [1] and end of the bisection [1].
SMALL, TRIAL, BRACKET = 1e-4, 2000, 2e-4
#: Sweeps over the constraints that the limit is tried with; None for the direct solution.
LIMITED_SWEEPS = (None, 5, 3, 2, 1)

COUNTS = (4, 5, 6)
SWEEPS = 30
#: Pictures timed; at 25 Hz these are four seconds.
PICTURES = 100
STEPS_A_PICTURE = 4


def _steps() -> Iterator[tuple[str, str, float]]:
    """Yield designs, forms and steps."""
    for design in _designs():
        own = stability_limit(_pivot(design))
        yield from ((design, "printed", part * own) for part in FRACTIONS)
        yield from ((design, "stable", step) for step in STEPS if step >= SHORTEST[design])


def _released(design: str, form: str, step: float) -> Answer:
    """Return the motion after the release from 90 degrees, and its times apart.

    Columns: status, error_rotation_rad (largest, against the leapfrog on the same spline), drift
    (largest gap of the clamps over the length), energy_change and energy_gain (at the end, and largest, over
    the start), steps, solves, limited_steps (whose velocity was reduced so that no energy is gained),
    stopped_s; times: step_us (of one step), motion_s.
    """
    run = solve_impulses(
        _pivot(design), start=START, duration=DURATION[design], step=step, form=form, records=RECORDS
    )
    key = {"design": design, "form": form, "step_s": step}
    quality = _quality(run, _exact(design), _designs()[design].length)
    return {"steps": key | quality, "timings": key | _time(design, form, step, run)}


@cache
def _exact(design: str) -> Trajectory:
    return solve_release(
        _pivot(design),
        start=START,
        duration=DURATION[design],
        integrator="leapfrog",
        step=EXACT_STEP[design],
        records=2000,
        check=False,
    )


def _limits() -> Iterator[tuple[str, str, int | None]]:
    """Yield designs, groups of modes and ways of the impulses."""
    for design, group in product(_designs(), GROUPS):
        for count in LIMITED_SWEEPS if group == "axial" else LIMITED_SWEEPS[:1]:
            yield design, group, count


def _limit(design: str, group: str, count: int | None) -> Answer:
    """Return the printed form's measured limit.

    Columns: sweeps (0 for the direct solution), predicted_s = 2 / omega of the highest frequency at rest,
    measured_s, ratio.
    """
    predicted = stability_limit(_pivot(design, GROUPS[group]))
    ratio = _measured_limit(design, GROUPS[group], predicted, count)
    row = {"design": design, "group": group, "sweeps": count or 0, "predicted_s": predicted}
    return {"limits": row | {"measured_s": ratio * predicted, "ratio": ratio}}


def _sweeps() -> Iterator[tuple[str, str, float]]:
    """Yield forms, impulses that are swept, and steps."""
    own = stability_limit(_pivot("Table 1"))
    for form, impulses in product(FORMS, ("constraints", "strips")):
        for step in [0.5 * own] if form == "printed" else [0.5 * own, *STEPS[2:]]:
            yield form, impulses, step


def _swept(form: str, impulses: str, step: float) -> Answer:
    """Return the error of the velocity after each sweep, and the factor a sweep leaves.

    Both for the first linear system of a step from the released state of Table 1, n = 6, against its direct
    solution. Columns: form, impulses, step_s, sweep, error; contraction.
    """
    chosen = _pivot("Table 1")
    direct = impulse_solver(chosen, form=form)
    found = sweep_errors(
        direct, impulse_solver(chosen, form=form, impulses=impulses), direct.start(START), step, SWEEPS
    )
    key = {"form": form, "impulses": impulses, "step_s": step}
    return {
        "sweeps": [key | {"sweep": k, "error": e} for k, e in enumerate(found, start=1)],
        "contraction": key | {"contraction": contraction(found)},
    }


def _pictures() -> Iterator[tuple[str, int, float]]:
    """Yield designs, control points and steps."""
    for design, n in product(_designs(), COUNTS):
        for step in (PAPER_STEP, 1e-3, 2e-4) if design == "Table 1" else (PAPER_STEP,):
            yield design, n, step


def _timed_pictures(design: str, n: int, step: float) -> Answer:
    """Return the work of the four stable steps of a picture after a release, and their times apart.

    Columns: solves_median, solves_95, solves_most; times: cpu_median_ms, cpu_95_ms, of the
    processor, since other programs' share of a core is not the solver's.
    """
    solves, seconds = _watched(design, n, step)
    key = {"design": design, "control_points": n, "step_s": step}
    counts = {
        "pictures": len(solves),
        "solves_median": np.median(solves),
        "solves_95": np.percentile(solves, 95),
        "solves_most": np.max(solves),
    }
    median, high = 1e3 * np.percentile(seconds, (50, 95))
    return {
        "pictures": key | counts,
        "timings_of_pictures": key | {"cpu_median_ms": median, "cpu_95_ms": high},
    }


def _quality(run: Trajectory, exact: Trajectory, length: float) -> dict[str, Any]:
    fine = run.status.value == "converged"
    energy = run.kinetic_energy + run.strain_energy
    error = np.abs(run.rotation - _at(exact, run.time)).max()
    return {
        "status": run.status.value,
        "error_rotation_rad": error if fine else math.nan,
        "drift": run.constraint_residual.max() / length if fine else math.nan,
        "energy_change": energy[-1] / energy[0] - 1.0 if fine else math.nan,
        "energy_gain": energy.max() / energy[0] - 1.0 if fine else math.nan,
        "steps": run.counters["steps"],
        "solves": run.counters["solves"],
        "limited_steps": run.counters["limited_steps"],
        "stopped_s": math.nan if fine else run.time[-1],
    }


def _at(run: Trajectory, instants: Array) -> Array:
    return np.asarray(CubicSpline(run.time, run.rotation)(instants))


def _time(design: str, form: str, step: float, run: Trajectory) -> dict[str, Any]:
    """Time of one step, from as many as the motion has but no more than a few hundred, and of all."""
    if run.status.value != "converged":
        return {"step_us": math.nan, "motion_s": math.nan}
    count = round(DURATION[design] / step)
    timed = min(count, 200)
    solver = impulse_solver(_pivot(design), form=form)
    state = solver.start(START)
    seconds = min(measure(lambda: solver.step(state, step, count=timed), repeat=5).seconds)
    return {"step_us": 1e6 * seconds / timed, "motion_s": seconds / timed * count}


def _measured_limit(design: str, settings: SplineSettings, predicted: float, sweeps: int | None) -> float:
    """Largest step at which a small swing stays bounded, over the predicted one, by bisection."""
    options: dict[str, Any] = {} if sweeps is None else {"impulses": "constraints", "sweeps": sweeps}

    def stable(part: float) -> bool:
        run = solve_impulses(
            _pivot(design, settings),
            start=SMALL,
            duration=TRIAL * part * predicted,
            step=part * predicted,
            form="printed",
            records=1,
            **options,
        )
        return bool(run.status.value == "converged")

    low, high = 0.0, 1.5
    while high - low > BRACKET:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return 0.5 * (low + high)


def _watched(design: str, n: int, step: float) -> tuple[list[int], list[float]]:
    """Return linear systems and seconds of each picture."""
    solver = impulse_solver(_pivot(design, SplineSettings(control_points=n)))
    state = solver.start(START)
    solver.step(state, step, count=STEPS_A_PICTURE)
    solves, seconds = [], []
    for _ in range(PICTURES):
        begin = time.thread_time()
        outcome = solver.step(state, step, count=STEPS_A_PICTURE)
        seconds.append(time.thread_time() - begin)
        solves.append(outcome.counters["solves"])
        if not outcome.complete:
            break
        state = outcome.state
    return solves, seconds


#: What is asked of them, for the tables steps, timings, limits, sweeps, contraction, pictures and
#: timings_of_pictures.
PARTS = (
    Part(at=_steps, ask=_released, alone=True),
    Part(at=_limits, ask=_limit),
    Part(at=_sweeps, ask=_swept),
    Part(at=_pictures, ask=_timed_pictures, alone=True),
)
