"""Drive a pivot or a mechanism through a rotation with one of the models and report its path.

    python -m studies solve studies/cases/cross_axis_pivot.toml --model spline --control-points 8
    python -m studies solve studies/cases/cross_axis_pivot.toml --model fe --elements 40 --json -
    python -m studies solve studies/cases/four_bar_of_flexures.toml --model spline --effects=-gravity

Of a pivot coordinates have their origin at A1, the ground clamp of strip 1; rotation is counter-clockwise.
Control points of the spline are added until the estimated error of path, torque, stiffness, stress and
section forces is below --accuracy, 1e-4 unless said otherwise; --control-points alone are just that number,
and with --accuracy the first that are tried. Loads come on before the rotation, unless the case says
order = "together"; load is their share. The arrays of the JSON run over the increments, the state of load
factor 0 first, and effects are those that were assembled. Critical points that were passed, and what the
model remarks on the path, stand below the table. A mechanism without a rotation follows the loads of its
scene. Exit code 0: converged; 2: bad input; 3: not converged, and then the converged part of the path is
reported with where and why it stopped.
"""

import argparse
import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studies.answers.adapters import answer_mechanism, answer_static
from studies.answers.assembly import MechanismResponse
from studies.answers.response import Response
from studies.cases.design import Design, flexural_scale
from studies.cases.keys import INCREMENTS, ROTATION
from studies.cases.mechanism import Mechanism
from studies.cases.problem import Problem
from studies.commands.answer import (
    add_json_argument,
    deliver,
    described,
    ending,
    estimated,
    number,
    passed,
    places,
    remarks,
    require_target,
)
from studies.commands.columns import (
    ENERGY_FLOOR,
    FORCE_FLOOR,
    STRAIN_FLOOR,
    Column,
    angle,
    plain,
    quantity,
    table,
)
from studies.commands.model import add_model_arguments, chosen_design, chosen_settings
from studies.commands.parser import Parser, degrees, positive, whole_number
from studies.errors import BadInput
from studies.record.progress import Bar

#: Effects whose share a table shows beside the rotation.
LOADS = {"applied_force", "applied_moment", "tip_force", "driven_displacement"}


def share(answer: Response | MechanismResponse) -> Column:
    """Return the column of the share of the loads that acts."""
    return plain("load", (f"{factor:.3f}" for factor in answer.load_factor))


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_model_arguments(parser)
    parser.add_argument(
        "--rotation-deg", type=degrees, metavar="X", help="end of the path, in deg (default: the case's)"
    )
    parser.add_argument(
        "--increments", type=int, metavar="K", help="increments of the path (default: the case's)"
    )
    parser.add_argument(
        "--repeat",
        type=whole_number(1),
        default=1,
        metavar="R",
        help="wall_s is the median of R solves, default 1",
    )
    parser.add_argument(
        "--accuracy",
        type=positive,
        metavar="A",
        help="wanted relative error of path, torque, stiffness, stress and section forces: raises the "
        "control points (spline; default 1e-4, or none with --control-points)",
    )
    add_json_argument(parser)


def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    design = _driven(chosen_design(arguments), arguments)
    settings = chosen_settings(arguments)
    if arguments.accuracy is not None and settings.model != "spline":
        expected = "--elements: `python -m studies converge` refines the reference"
        raise BadInput(f"--accuracy: got it with --model {settings.model}, expected {expected}")
    require_target(arguments)
    with Bar(f"solve {settings.model}") as bar:
        how = {"repeat": arguments.repeat, "accuracy": arguments.accuracy}
        if isinstance(design, Problem):
            pivot = answer_static(design, settings, progress=bar, **how)
            document, lines = as_document(pivot), _readable(design, pivot)
            failure = None if pivot.converged else _stopped(design, pivot)
        else:
            answer = answer_mechanism(design, settings, progress=bar, **how)
            document, lines = mechanism_document(answer), _mechanism_table(design, answer)
            failure = None if answer.converged else answer.message
    return deliver(arguments, document, lines, failure=failure)


def as_document(answer: Response) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        "status": answer.status,
        "message": answer.message,
        "critical_points": passed(answer.critical_points),
        "resolution": answer.resolution,
        "model": answer.model,
        "settings": answer.settings,
        "effects": list(answer.effects),
        "load_factor": answer.load_factor.tolist(),
        "rotation_rad": answer.rotation.tolist(),
        "com_x_m": answer.centre[:, 0].tolist(),
        "com_y_m": answer.centre[:, 1].tolist(),
        "torque_Nm": answer.torque.tolist(),
        "stiffness_Nm_per_rad": answer.stiffness.tolist(),
        "strain_energy_J": answer.strain_energy.tolist(),
        "max_stress_Pa": answer.max_stress.tolist(),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "counters": answer.counters,
        "wall_s": answer.wall_s,
    }


def mechanism_document(answer: MechanismResponse) -> dict[str, Any]:
    """Return the answer of any mechanism as the JSON object of the command."""
    return {
        "status": answer.status,
        "message": answer.message,
        "critical_points": passed(answer.critical_points),
        "resolution": answer.resolution,
        "model": answer.model,
        "settings": answer.settings,
        "effects": list(answer.effects),
        "load_factor": answer.load_factor.tolist(),
        "bodies": places(answer.bodies),
        "torque_Nm": [number(value) for value in answer.torque],
        "stiffness_Nm_per_rad": [number(value) for value in answer.stiffness],
        "strain_energy_J": answer.strain_energy.tolist(),
        "gravity_energy_J": answer.gravity_energy.tolist(),
        "work_J": answer.work.tolist(),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "counters": answer.counters,
        "wall_s": answer.wall_s,
    }


def _stopped(problem: Problem, answer: Response) -> str:
    """Return how far a path came, why it stopped, and what mends a discretisation that is too coarse."""
    last = math.degrees(answer.rotation[-1]) if len(answer.rotation) else 0.0
    given = answer.resolution and not answer.estimate
    mend = "; without --control-points their number is chosen" if given else ""
    return f"reached {last:.3f} of {math.degrees(problem.rotation):.3f} deg: {answer.message}{mend}"


def _driven(design: Design, arguments: argparse.Namespace) -> Design:
    """Return the design with the path that the options ask for."""
    changes: dict[str, Any] = {}
    try:
        option = "--rotation-deg"
        if arguments.rotation_deg is not None:
            changes["rotation"] = ROTATION.parse(arguments.rotation_deg)
        option = "--increments"
        if arguments.increments is not None:
            changes["increments"] = INCREMENTS.parse(arguments.increments)
    except ValueError as error:
        raise BadInput(f"{option}: {error}") from None
    return dataclasses.replace(design, **changes)


def _readable(problem: Problem, answer: Response) -> Iterator[str]:
    """Yield the lines of a short table."""
    yield described(answer.model, answer.settings, answer.effects)
    scale = flexural_scale(problem)
    yield from table(
        [
            *([share(answer)] if LOADS & set(answer.effects) else []),
            angle(answer.rotation),
            *quantity("m", highest=-3, x=answer.centre[:, 0], y=answer.centre[:, 1]),
            *quantity("N m", floor=FORCE_FLOOR * scale, torque=answer.torque),
            *quantity("N m/rad", floor=FORCE_FLOOR * scale, stiffness=answer.stiffness),
            *quantity("J", floor=ENERGY_FLOOR * scale, energy=answer.strain_energy),
            *quantity(
                "Pa",
                floor=STRAIN_FLOOR * problem.youngs_modulus,
                highest=6,
                digits=6,
                stress=answer.max_stress,
            ),
        ]
    )
    yield from estimated(answer.estimate)
    yield from remarks(answer)
    yield ending(answer.status, answer.counters, answer.wall_s)


def _mechanism_table(mechanism: Mechanism, answer: MechanismResponse) -> Iterator[str]:
    """Yield the lines of a short table: torque and energy, and the place of every body."""
    yield described(answer.model, answer.settings, answer.effects)
    scale = flexural_scale(mechanism)
    columns = [share(answer)]
    if np.isfinite(answer.torque).any():
        columns += quantity("N m", floor=FORCE_FLOOR * scale, torque=answer.torque)
    columns += quantity("J", floor=ENERGY_FLOOR * scale, energy=answer.strain_energy)
    for name, place in answer.bodies.items():
        columns += quantity("m", highest=-3, group=name, x=place[:, 0], y=place[:, 1])
        columns.append(angle(place[:, 2], group=name))
    yield from table(columns)
    yield from estimated(answer.estimate)
    yield from remarks(answer)
    yield ending(answer.status, answer.counters, answer.wall_s)
