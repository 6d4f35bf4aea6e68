"""Motions of hard cases: the swing of each model against a refined and an independent one.

Steps from 1e-7 to 1e-2 s, and ratios: bodies a million times lighter and heavier, massless and heavy strips,
one strip far stiffer.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.metrics import observed_order
from studies.answers.motion import Motion
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import Design
from studies.cases.problem import named_case
from studies.engine import Answer, Part, Row
from studies.record.digits import Digits
from studies.stability import family

#: Largest error of the rotation that counts as right, over the rotation at the start [1]. A step of a
#: twentieth of the swing's period errs by 0.03 after one swing; an answer off by more shows another motion.
TOLERANCE = 0.05
#: Largest gain of energy over that at the start: of the energy-consistent scheme, and of those that keep
#: energy in the limit of short steps only.
MOST_GAIN, MOST_GAIN_OF_OTHERS = 1e-8, 1e-2

#: The refined spline, the step of its motion [s] for the time scale of Table 1, and finite elements.
REFINED, REFINED_STEP = SplineSettings(control_points=9), 2.5e-6
INDEPENDENT = FeSettings(elements=30)
RECORDS = 400

#: Columns. The paper's measure is for the leapfrog alone.
SWINGING = (family.DEFAULT, family.LOCKING_FREE, family.FE)


def _refined(design: Design, *, start: float, duration: float, step: float = REFINED_STEP) -> Motion:
    """Return the swing that others are held against."""
    return answer_release(design, REFINED, start=start, duration=duration, step=step, records=RECORDS)


def _rotation_error(motion: Motion, reference: Motion) -> float:
    """Return the largest difference of rotation at the motion's records, as far as the reference goes [1].

    Over the rotation at the start. Infinite for a motion without a record or with one that is no number.
    """
    if not len(motion.time) or len(reference.time) < 2 or not np.isfinite(motion.rotation).all():
        return math.inf
    known = motion.time <= reference.time[-1] * (1.0 + 1e-9)
    expected = CubicSpline(reference.time, reference.rotation)(motion.time[known])
    return float(np.abs(motion.rotation[known] - expected).max() / abs(reference.rotation[0]))


def _energy_gain(motion: Motion) -> float:
    """Return the largest gain of the balance of energies over the stored one at the start [1]."""
    stored = motion.kinetic_energy + motion.strain_energy
    balance = stored + motion.gravity_energy - motion.work + motion.dissipated
    return float((balance / balance[0] - 1.0).max())


def _judged(name: str, design: Design, reference: Motion, **asked: Any) -> Row:
    """Return the verdict on the column `name` for one design, with its energy_gain [1].

    asked: start [rad], duration and step [s] of the motion.
    """
    settings, integrator = family.COLUMNS[name], "generalised-alpha" if name == family.FE else None

    def attempt() -> family.Found:
        motion = answer_release(design, settings, records=RECORDS, integrator=integrator, **asked)
        if not len(motion.time):  # statics does not reach the start
            return family.Found.of(motion, 0.0)
        gain = _energy_gain(motion)
        much = gain > (MOST_GAIN_OF_OTHERS if integrator else MOST_GAIN)
        fault = f"the energy grows by {gain:.2g} of itself" if much else ""
        return family.Found.of(motion, _rotation_error(motion, reference), fault=fault, energy_gain=gain)

    return {"model": name, **family.judged(attempt, TOLERANCE, name)}


STEPS = (1e-7, 1e-6, 1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2)
STARTS = (10, 45, 90, 135)
#: One swing of Table 1 from 90 degrees [s], over which the rotation is compared.
SWING = 0.012
#: Steps of a motion: at least, so that energy could drift; at most, so that the finest end in seconds.
FEWEST, MOST = 15, 1200


#: Steps of the table of orders and of its limit [s], and the duration of its motions [s].
ORDER_STEPS = (8e-4, 4e-4, 2e-4, 1e-4, 5e-5, 2.5e-5, 1.25e-5, 6.25e-6, 3.125e-6)
LIMIT_STEP, ORDER_DURATION = 5e-7, 0.004


@cache
def _reference(degrees: float) -> Motion:
    """Return the refined swing from a rotation."""
    return _refined(named_case(), start=math.radians(degrees), duration=SWING)


def _settled(degrees: float) -> Answer:
    """Return how far a coarser and an independent swing are from the reference."""
    given, reference = named_case(), _reference(degrees)
    known: dict[str, Any] = {"start": math.radians(degrees), "duration": SWING}
    coarser = _refined(given, **known, step=5e-6)
    gap = _rotation_error(answer_release(given, INDEPENDENT, records=RECORDS, **known), reference)
    return {
        "references": {
            "case": f"from {degrees} deg",
            "refinement": _rotation_error(coarser, reference),
            "independent": gap,
            "settled": "yes" if gap < TOLERANCE / 5.0 else "no",
        }
    }


def _outcomes_of_step(degrees: float, step: float) -> Answer:
    """Return the outcomes of all models at a step, with the gain of energy."""
    duration = min(max(round(SWING / step), FEWEST), MOST) * step
    known = {"start": math.radians(degrees), "duration": duration, "step": step}
    place = {"case": f"from {degrees} deg, {step:g} s", "x": step, "y": degrees}
    given, reference = named_case(), _reference(degrees)
    return {"outcomes": [{**place, **_judged(name, given, reference, **known)} for name in SWINGING]}


def _order_table() -> pd.DataFrame:
    """Return error and observed order of the default against the step, from 90 degrees, for one spline."""
    problem, default = named_case(), family.COLUMNS[family.DEFAULT]

    def swing(step: float) -> Motion:
        return answer_release(problem, default, duration=ORDER_DURATION, step=step, records=5)

    limit = swing(LIMIT_STEP).rotation
    answers = [swing(step) for step in ORDER_STEPS]
    errors = [float(np.abs(answer.rotation - limit).max()) for answer in answers]
    orders = [math.nan, *(observed_order(a, b) for a, b in pairwise(errors))]
    resolved = ["no" if answer.resolution else "yes" for answer in answers]
    return pd.DataFrame({"step_s": ORDER_STEPS, "error_rad": errors, "order": orders, "resolved": resolved})


STEP_SIZE = family.study(
    Part(at=lambda: STARTS, ask=_settled),
    Part(at=lambda: product(STARTS, STEPS), ask=_outcomes_of_step),
    Part(ask=lambda: {"order": _order_table()}),
)
"""Steps from 1e-7 to 1e-2 s: no gain of energy, second order, and a warning where a step is too long."""

#: Factors on mass and moment of inertia of Table 1's body, and on the flexural rigidity of one strip.
FACTORS = (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)
STIFFER = (1e2, 1e4)
START_DEG = 30.0
#: Steps in a period of the first mode at rest: of the columns, of the reference and of its coarser twin.
STEPS_A_PERIOD, REFINED_STEPS, COARSER_STEPS = 200, 1600, 800
STRIP_INERTIA = "strip_inertia"
KINDS = ("mass and inertia", "mass alone", "inertia alone")


def _ratios() -> Iterator[tuple[str, str, float, Design]]:
    """Yield all designs with a ratio at its end: name, kind (a line of the map), factor (its place there)."""
    given = named_case()
    for kind, factor in product(KINDS, FACTORS):
        design = replace(
            given,
            body_mass=given.body_mass * (1.0 if kind == KINDS[2] else factor),
            body_moment_of_inertia=given.body_moment_of_inertia * (1.0 if kind == KINDS[1] else factor),
        )
        yield f"body: {kind} x {factor:g}", kind, factor, design
    yield "strips 100 times as dense", "strips", 100.0, replace(given, density=100.0 * given.density)
    without = [name for name in given.effects.names if name != STRIP_INERTIA]
    yield "massless strips", "strips", 0.0, replace(given, effects=given.effects.renamed(without))
    cross = family.as_mechanism(given, START_DEG)
    for factor in STIFFER:  # of another material
        second = replace(cross.strips[1], youngs_modulus=factor * given.youngs_modulus)
        stiffer = replace(cross, strips=(cross.strips[0], second))
        yield f"second strip {factor:g} times as stiff", "stiffness", factor, stiffer


def _outcomes_of_ratio(case: str, kind: str, factor: float, design: Design) -> Answer:
    """Return the outcomes of a design, with the gain of energy, and its reference."""
    period = 1.0 / float(answer_modes(design, REFINED, count=1).frequency[0])
    asked: dict[str, Any] = {"start": math.radians(START_DEG), "duration": period}
    reference = _refined(design, step=period / REFINED_STEPS, **asked)
    coarser = _refined(design, step=period / COARSER_STEPS, **asked)
    rows, gap = [], math.inf
    for name in SWINGING:
        verdict = _judged(name, design, reference, step=period / STEPS_A_PERIOD, **asked)
        rows.append({"case": case, "kind": kind, "x": factor, **verdict})
        if name == family.FE and verdict["outcome"] == family.RIGHT:
            gap = verdict["error"]
    if not gap <= TOLERANCE:
        finer: dict[str, Any] = {"integrator": "generalised-alpha", "step": period / REFINED_STEPS}
        gap = _rotation_error(answer_release(design, INDEPENDENT, **finer, **asked), reference)
    refinement = _rotation_error(coarser, reference)
    settled = reference.converged and refinement < TOLERANCE / 2.0 and gap <= TOLERANCE
    known = {"case": case, "period_s": period, "refinement": refinement, "independent": gap}
    return {"outcomes": rows, "references": {**known, "settled": "yes" if settled else "no"}}


RATIOS = family.study(
    Part(at=_ratios, ask=_outcomes_of_ratio),
    digits={"outcomes.error": Digits(relative=0.05, floor=1e-9, rows="outcome == 'right'")},
)
"""Ratios: bodies a million times lighter and heavier, massless and heavy strips, one strip far stiffer."""
