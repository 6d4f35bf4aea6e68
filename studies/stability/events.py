"""Sudden events: a drive reversed, a body let go and caught a thousand times, targets that jump."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from spline_model.dynamics import Trajectory, solve_motion
from spline_model.effects import DrivenRotation
from studies.answers.adapters import answer_static
from studies.answers.models import put
from studies.answers.settings import Settings
from studies.cases.problem import Problem, named_case
from studies.engine import Part
from studies.stability.family import CHECK, TOLERANCE, path_distance
from studies.stability.verdict import (
    COLUMNS,
    DEFAULT,
    LOCKING_FREE,
    Found,
    Task,
    as_mechanism,
    outcome_of,
    study,
)

#: Reversals, and releases with as many catches: of the default, and of the locking-free spline.
EVENTS = {DEFAULT: 1000, LOCKING_FREE: 100}
STEP, STEPS_BETWEEN = 5e-5, 20
#: Rotations of the reversals, and at the first release [rad].
REVERSAL, RELEASE = math.radians(5.0), math.radians(60.0)
#: Largest error of the books of energy, and of a driven rotation, that is right [1, rad].
BOOKS = 1e-8

#: Jumps of a target that is followed statically in one increment each [deg], and how often.
JUMPS = (60.0, -60.0, 90.0, 120.0, 180.0)
ROUNDS = 20
#: Newton iterations a jump may take: more is no bounded work.
MOST_ITERATIONS = 200
#: Energies below this are those of a motion at rest [J].
QUIET = 1e-6
#: A jump within a motion lasts this long [s].
INSTANT = 1e-9


def _tasks() -> list[Task]:
    """Return case, model, what is asked, and the tolerance."""
    return [*_motions(), *_jumps()]


def _motions() -> list[Task]:
    found: list[Task] = []
    for model, count in EVENTS.items():
        found.append(("drive reversed again and again", model, partial(_reversals, model, count), BOOKS))
        found.append(("let go and caught again and again", model, partial(_catches, model, count), BOOKS))
        found.append(("target jumps by 60° in a motion", model, partial(_jump_in_motion, model), BOOKS))
    return found


def _jumps() -> list[Task]:
    found: list[Task] = []
    for model, settings in COLUMNS.items():
        for degrees in JUMPS:
            name = f"target jumps from rest to {degrees:g}°"
            found.append((name, model, partial(_jump, settings, degrees), TOLERANCE))
        name = f"target jumps between 60° and -60°, {ROUNDS} times"
        found.append((name, model, partial(_jumping, settings), TOLERANCE))
        for millimetres in ((0.0, 20.0), (20.0, 0.0), (-20.0, 0.0)):
            name = "target jumps by {:g}, {:g} mm".format(*millimetres)
            found.append((name, model, partial(_displaced, settings, millimetres), TOLERANCE))
    return found


def _mechanism_of(model: str) -> Any:
    """Return Table 1 in motion in a column of splines."""
    return put(named_case(), COLUMNS[model], moving=True).modelled


def _reversals(model: str, count: int) -> Found:
    """Drive the body to and fro, reversed `count` times off the grid of steps: books and rotation."""
    between = (STEPS_BETWEEN + 0.37) * STEP
    times = [i * between for i in range(count + 1)]
    factors = [float(i % 2) for i in range(count + 1)]
    corners = tuple(zip(times, factors, strict=True))
    drive = DrivenRotation(body="body", angle=REVERSAL, history=corners)
    run = solve_motion(
        _mechanism_of(model), drive=drive, duration=count * between, step=STEP, records=200, check=False
    )
    place = np.interp(run.time, times, factors) * REVERSAL
    return _booked(run, extra=float(np.abs(run.rotation - place).max()))


def _catches(model: str, count: int) -> Found:
    """Let the body go and catch it again, `count` times each: books of energy, none of which comes back."""
    mechanism = _mechanism_of(model)
    held = DrivenRotation(body="body", angle=0.0)
    span = STEPS_BETWEEN * STEP
    run = solve_motion(mechanism, start=RELEASE, duration=span, step=STEP, records=1, check=False)
    energy = run.kinetic_energy[0] + run.strain_energy[0]
    worst = 0.0
    for number in range(2 * count - 1):
        drive = None if number % 2 else held
        run = solve_motion(mechanism, drive=drive, duration=span, step=STEP, records=1, after=run)
        books = run.kinetic_energy + run.strain_energy - run.work + run.dissipated
        worst = max(worst, float(np.abs(books / energy - 1.0).max()))
        if run.message:
            break
    return Found(
        error=worst,
        reached=not run.message,
        reason=run.message,
        fault="a catch gave energy back" if (np.diff(run.dissipated) < -BOOKS * energy).any() else "",
        counters={"newton_iterations": run.counters["newton_iterations"]},
    )


def _jump_in_motion(model: str) -> Found:
    """Let a drive's target jump by 60 degrees within a nanosecond of a motion: followed, or refused."""
    history = ((1e-3, 0.0), (1e-3 + INSTANT, 1.0))
    drive = DrivenRotation(body="body", angle=math.radians(60.0), history=history)
    run = solve_motion(_mechanism_of(model), drive=drive, duration=2e-3, step=STEP, check=False)
    return _booked(run, extra=0.0)


def _booked(run: Trajectory, *, extra: float) -> Found:
    """Return the error of the books of energy over the largest of its parts, or `extra` if that is larger."""
    stored = run.kinetic_energy + run.strain_energy
    books = stored - run.work + run.dissipated
    parts = (stored, run.work, run.dissipated)
    scale = max(QUIET, *(float(np.abs(part).max()) for part in parts))
    return Found(
        error=max(float(np.abs(books - books[0]).max()) / scale, extra),
        reached=not run.message,
        reason=run.message,
        counters=run.counters,
    )


def _jump(settings: Settings, degrees: float) -> Found:
    """Follow a target that jumps from rest in one increment; against the refined path of many."""
    design = replace(named_case(), rotation=math.radians(degrees), increments=1)
    many = answer_static(replace(design, increments=36), CHECK)
    ends = {name: getattr(many, name)[[0, -1]] for name in ("load_factor", "torque")}
    reference = replace(many, **ends, bodies={name: poses[[0, -1]] for name, poses in many.bodies.items()})
    path = answer_static(design, settings)
    return _bounded(Found.of(path, path_distance(path, reference)), 1)


def _jumping(settings: Settings) -> Found:
    """Follow a target that jumps to and fro; the torque is the same every time."""
    design: Problem = replace(named_case(), rotation=math.radians(60.0), increments=1)
    once = answer_static(design, settings)
    targets = [design.rotation * (-1) ** k for k in range(ROUNDS)]
    path = put(design, settings).static_path(rotation=targets, raise_on_failure=False)
    expected = once.torque[-1] * np.sign(path.rotation[1:])
    error = float(np.abs(path.torque[1:] / expected - 1.0).max()) if len(path.torque) > 1 else math.inf
    return _bounded(
        Found(
            error=error,
            reached=path.status.value == "converged",
            reason=path.message,
            counters=path.counters,
        ),
        ROUNDS,
    )


def _displaced(settings: Settings, millimetres: tuple[float, float]) -> Found:
    """Follow a body whose centre's target jumps in one increment, free to rotate: its energy and rotation."""
    given = as_mechanism(named_case(), 0.0)
    target = {"displacement": tuple(1e-3 * part for part in millimetres)}
    effects = replace(
        given.effects,
        names=(*given.effects.names, "driven_displacement"),
        tables={**given.effects.tables, "driven_displacement": target},
    )
    design = replace(given, rotation=None, increments=1, effects=effects)
    reference = answer_static(replace(design, increments=40), CHECK)
    answer = answer_static(design, settings)
    energy = abs(answer.strain_energy[-1] / reference.strain_energy[-1] - 1.0)
    turn = abs(answer.bodies["body"][-1, 2] - reference.bodies["body"][-1, 2])
    error = float(max(energy, turn)) if answer.converged else 0.0
    return _bounded(Found.of(answer, error), 1)


def _bounded(answer: Found, jumps: int) -> Found:
    """Return the answer, with a fault where it took more work than so many jumps may."""
    work = answer.counters.get("newton_iterations", answer.counters.get("iterations", 0))
    if work > MOST_ITERATIONS * jumps:
        return replace(answer, fault=f"{work} Newton iterations for {jumps} jumps")
    return answer


STUDY = study(Part(at=_tasks, ask=outcome_of))
