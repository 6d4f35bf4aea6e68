"""Sudden events, and a long run: drives reversed, bodies re-clamped, targets that jump, a million steps."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np

from spline_model.dynamics import solve_motion
from spline_model.effects import DrivenRotation
from spline_model.motion.records import Trajectory
from studies.answers.adapters import answer_static
from studies.answers.models import put
from studies.answers.settings import Settings
from studies.cases.problem import named_case
from studies.engine import Answer, Part
from studies.stability import verdict
from studies.stability.verdict import DEFAULT, LOCKING_FREE, Found, judged, study

#: Reversals, and releases with as many catches: of the default, and of the locking-free spline.
EVENTS = {DEFAULT: 1000, LOCKING_FREE: 100}
STEP, STEPS_BETWEEN = 5e-5, 20
#: Rotations of the reversals, and at the first release [rad].
REVERSAL, RELEASE = math.radians(5.0), math.radians(60.0)
#: Largest error of the books of energy, and of a driven rotation, that is right [1, rad].
BOOKS = 1e-8
#: Energies below this are those of a motion at rest [J].
QUIET = 1e-6
#: A jump within a motion lasts this long [s].
INSTANT = 1e-9

#: Jumps of a target that is followed statically in one increment [deg].
JUMPS = (60.0, -60.0, 90.0, 120.0, 180.0)


def _tasks() -> Iterator[tuple[str, str, partial[Found], float]]:
    """Yield case, model, what is asked, and the tolerance."""
    for model, count in EVENTS.items():
        yield "drive reversed again and again", model, partial(_reversals, model, count), BOOKS
        yield "released and re-clamped again and again", model, partial(_catches, model, count), BOOKS
        yield "target jumps by 60° in a motion", model, partial(_jump_in_motion, model), BOOKS
    for model, settings in verdict.COLUMNS.items():
        jumps = {f"from rest to {degrees:g}°": partial(_jump, settings, degrees) for degrees in JUMPS}
        yield from ((f"target jumps {how}", model, jump, verdict.TOLERANCE) for how, jump in jumps.items())


@cache
def _table_1(model: str) -> Any:
    """Return Table 1 in motion in a column of splines."""
    return put(named_case(), verdict.COLUMNS[model], moving=True).modelled


def _moved(model: str, **how: Any) -> Trajectory:
    """Return a motion of it."""
    return solve_motion(_table_1(model), check=False, **how)


def _said(run: Trajectory, error: float, fault: str = "") -> Found:
    """Return an error with how the motion ended; its own check of its steps is not asked."""
    return Found(error=error, reached=not run.message, reason=run.message, fault=fault)


def _reversals(model: str, count: int) -> Found:
    """Drive the body to and fro, reversed `count` times off the grid of steps: books and rotation."""
    between = (STEPS_BETWEEN + 0.37) * STEP
    times = [i * between for i in range(count + 1)]
    factors = [float(i % 2) for i in range(count + 1)]
    drive = DrivenRotation(body="body", angle=REVERSAL, history=tuple(zip(times, factors, strict=True)))
    run = _moved(model, drive=drive, duration=count * between, step=STEP, records=200)
    place = np.interp(run.time, times, factors) * REVERSAL
    return _said(run, max(_books(run), float(np.abs(run.rotation - place).max())))


def _catches(model: str, count: int) -> Found:
    """Release and re-clamp the body, `count` times each: books of energy, none of which comes back."""
    held = DrivenRotation(body="body", angle=0.0)
    how: dict[str, Any] = {"duration": STEPS_BETWEEN * STEP, "step": STEP, "records": 1}
    run = _moved(model, start=RELEASE, **how)
    energy = run.kinetic_energy[0] + run.strain_energy[0]
    worst = 0.0
    for number in range(2 * count - 1):
        run = _moved(model, drive=None if number % 2 else held, after=run, **how)
        books = run.kinetic_energy + run.strain_energy - run.work + run.dissipated
        worst = max(worst, float(np.abs(books / energy - 1.0).max()))
        if run.message:
            break
    back = (np.diff(run.dissipated) < -BOOKS * energy).any()
    return _said(run, worst, fault="a catch gave energy back" if back else "")


def _jump_in_motion(model: str) -> Found:
    """Let a drive's target jump by 60 degrees within a nanosecond of a motion: followed, or refused."""
    history = ((1e-3, 0.0), (1e-3 + INSTANT, 1.0))
    drive = DrivenRotation(body="body", angle=math.radians(60.0), history=history)
    run = _moved(model, drive=drive, duration=2e-3, step=STEP)
    return _said(run, _books(run))


def _books(run: Trajectory) -> float:
    """Return the error of the books of energy over the largest of its parts [1]."""
    stored = run.kinetic_energy + run.strain_energy
    books = stored - run.work + run.dissipated
    scale = max(QUIET, *(float(np.abs(part).max()) for part in (stored, run.work, run.dissipated)))
    return float(np.abs(books - books[0]).max()) / scale


def _jump(settings: Settings, degrees: float) -> Found:
    """Follow a target that jumps from rest in one increment; against the torque of a refined path."""
    design = replace(named_case(), rotation=math.radians(degrees), increments=1)
    many = answer_static(replace(design, increments=36), verdict.CHECK)
    path = answer_static(design, settings)
    error = abs(float(path.torque[-1] / many.torque[-1]) - 1.0)
    return Found.of(path, error if path.converged else 0.0)


EVENTS_STUDY = study(
    Part(
        at=_tasks,
        ask=lambda case, model, attempt, tolerance: {
            "outcomes": {"case": case, "model": model, **judged(attempt, tolerance, model)}
        },
    ),
)
"""Sudden events: a drive reversed, a body released and re-clamped a thousand times, targets that jump."""

LONG_STEP, START_DEG = 5e-5, 30.0
#: Steps of a piece, and pieces of each column: a million steps of the default, a tenth of it of the others.
PIECE = 10_000
PIECES = {DEFAULT: 100, LOCKING_FREE: 10}
#: Largest change of energy that is right [1], and factor by which the constraint residual of the last tenth
#: may exceed that of the first.
DRIFT, GROWTH = 1e-6, 3.0


def _long_run(model: str, count: int) -> Answer:
    """Return the outcome of a column over so many pieces, or up to the one that stops early: energy within
    the tolerance, a constraint residual that does not grow."""
    begin: dict[str, Any] = {"start": math.radians(START_DEG)}
    first, change, residuals = 0.0, 0.0, []
    for _ in range(count):
        piece = _moved(model, duration=PIECE * LONG_STEP, step=LONG_STEP, records=100, **begin)
        energy = piece.kinetic_energy + piece.strain_energy
        first = first or float(energy[0])
        change = max(change, float(np.abs(energy / first - 1.0).max()))
        residuals.append(float(piece.constraint_residual.max()))
        if piece.message:
            break
        begin = {"after": piece}
    tenth = max(1, len(residuals) // 10)
    growth = max(residuals[-tenth:]) / max(residuals[:tenth])
    fault = f"the constraint residual grows {growth:.2g} times" if growth > GROWTH else ""
    row = {"case": f"{len(residuals) * PIECE} steps", "model": model}
    return {"outcomes": row | judged(lambda: _said(piece, change, fault), DRIFT, model)}


LONG_RUN = study(Part(at=PIECES.items, ask=_long_run))
"""A million steps of free swing without damping: energy and constraints."""
