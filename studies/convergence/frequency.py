"""Frequency of the swing and of small motion against control points and elements."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.metrics import extrapolate, quasi_static_frequency
from studies.answers.reference import rotation_error
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import named_case
from studies.engine import Answer, Claim, Part, Row, Study, Tables
from studies.paper.formulations import STEPS, refined_swing, resolved
from studies.record.store import Digits

COUNTS = tuple(STEPS)
#: Beyond this count the consistent form, whose axial waves are faster, needs shorter steps; nor does it lock.
MOST_CONSISTENT = 7
#: Stretch forms with their counts.
FORMS = [("mixed", n) for n in COUNTS] + [("consistent", n) for n in COUNTS if n <= MOST_CONSISTENT]

#: Meshes whose limit the first mode at rest is held against.
MODE_MESHES = (20, 40, 80)
#: The part of a shift by which its prediction from statics may be off and still explain it.
EXPLAINED = 0.25
#: What "due to the number of control points" is read as: at most this part of the shift is left with more.
LEFT = 0.05


def _of_control_points(stretch: str, n: int) -> Answer:
    """Return the row of a stretch form and count: the swing's frequency, its shift, what statics implies.

    Columns: stretch, control_points, status, frequency_Hz, shift (of the frequency, against the limit of the
    finite elements), error_rotation_rad (largest over the motion), shift_from_statics (of the quasi-static
    frequency against that of the finest elements).
    """
    settings, limit = SplineSettings(control_points=n, stretch=stretch), refined_swing()
    motion = resolved(settings)
    found = motion.frequency if motion.converged else math.nan
    # its static path has the penalty stiffness that the pivot had in motion
    implied = _static_frequency(replace(settings, penalty_stiffness=motion.settings["penalty_stiffness"]))
    row = {
        "stretch": stretch,
        "control_points": n,
        "status": motion.status,
        "frequency_Hz": found,
        "shift": found / limit.frequency - 1.0,
        "error_rotation_rad": rotation_error(motion, limit, limit.time) if motion.converged else math.nan,
        "shift_from_statics": implied / _static_frequency(FeSettings(elements=160)) - 1.0,
    }
    return {"control_points": row}


def _first_mode() -> Answer:
    """Return the error of the first mode at rest with four control points, against the limit of the finite
    elements, whose consistent masses and cubic shapes are of order four."""
    asked: list[Settings] = [FeSettings(elements=n) for n in MODE_MESHES]
    asked.append(SplineSettings(control_points=4))
    *found, own = (answer_modes(named_case(), each, count=1).frequency for each in asked)
    limit = float(extrapolate(found, order=4.0).value[0])
    return {"first_mode": {"frequency_Hz": own[0], "limit_Hz": limit, "error": own[0] / limit - 1.0}}


@cache
def _static_frequency(settings: Settings) -> float:
    """Return the frequency of the swing that the static path implies [Hz]."""
    problem = named_case()
    answer = answer_static(problem, settings)
    return quasi_static_frequency(
        answer.rotation,
        answer.centre,
        answer.strain_energy,
        mass=problem.body_mass,
        moment_of_inertia=problem.body_moment_of_inertia,
    )


def _shifts_left(tables: Tables) -> Iterator[Row]:
    """Yield, for each stretch form, the shift of four control points, the part of it that the static path
    does not explain, and the part that is left with the most points."""
    for stretch in ("consistent", "mixed"):
        rows = tables["control_points"].query("stretch == @stretch").sort_values("control_points")
        shifts, implied = rows["shift"].to_numpy(float), rows["shift_from_statics"].to_numpy(float)
        yield {
            "stretch": stretch,
            "shift": shifts[0],
            "unexplained": abs(implied[0] / shifts[0] - 1.0),
            "most": int(rows["control_points"].iloc[-1]),
            "left": abs(shifts[-1] / shifts[0]),
        }


def _four(tables: Tables) -> list[Row]:
    """Return what of the shift of four control points locking makes, and what of it the first mode shows."""
    four = tables["control_points"].query("control_points == 4").set_index("stretch")["shift"]
    first = tables["first_mode"]["error"].iloc[0]
    locking = 1.0 - four["mixed"] / four["consistent"]
    return [{"locking": locking, "first_mode": abs(first / four["mixed"])}]


STUDY = Study(
    parts=(
        Part(at=lambda: FORMS, ask=_of_control_points),
        Part(ask=_first_mode),
    ),
    claims=(
        Claim(
            claim="Section 3.2: four control points swing faster because they are stiffer",
            formulation="n = 4, {stretch} stretch",
            quantity="the part of the shift ({shift:+.2%}) that the static path does not explain",
            rows=_shifts_left,
            value="unexplained",
            holds=lambda row: row["shift"] > 0.0 and row["unexplained"] <= EXPLAINED,
        ),
        Claim(
            claim="Section 3.2: the shift is due to the number of control points",
            formulation="{stretch} stretch",
            quantity="the shift at n = {most} over that at n = 4",
            rows=_shifts_left,
            value="left",
            most=LEFT,
        ),
        Claim(
            claim="The shift at four control points is mostly membrane locking",
            formulation="n = 4, consistent stretch",
            quantity="the part of the shift that goes with an independent axial force",
            rows=_four,
            value="locking",
            holds=lambda row: row["locking"] > 0.5,
        ),
        Claim(
            claim="The first mode at rest shows the shift of the swing",
            formulation="n = 4, mixed stretch",
            quantity="the error of the first mode at rest over the shift of the swing",
            rows=_four,
            value="first_mode",
            holds=lambda row: row["first_mode"] > 0.5,
        ),
    ),
    digits={"findings.value": Digits(floor=1e-7)},
)
