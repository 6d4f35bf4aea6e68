"""Drive a pivot through a rotation with one of the models and report its path.

    python -m studies solve studies/cases/cross_axis_pivot.toml --model spline --control-points 8
    python -m studies solve studies/cases/cross_axis_pivot.toml --model fe --elements 40 --json -

Coordinates have their origin at A1, the ground clamp of strip 1; rotation is counter-clockwise. The arrays of
the JSON run over the increments, the unloaded state first. Exit code 0: converged; 2: bad input; 3: not
converged, and then the converged part of the path is reported with where and why it stopped.
"""

import argparse
import dataclasses
import math
from collections.abc import Iterator
from typing import Any

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.cases.keys import INCREMENTS, ROTATION
from studies.cases.problem import Problem, read_case
from studies.commands.answer import add_json_argument, deliver, described, ending, require_target
from studies.commands.model import add_model_arguments, chosen_settings
from studies.commands.parser import Parser, degrees, whole_number
from studies.errors import BadInput
from studies.record.progress import Bar


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_model_arguments(parser)
    parser.add_argument(
        "--rotation-deg", type=degrees, metavar="X", help="end of the path (default: the case's)"
    )
    parser.add_argument(
        "--increments", type=int, metavar="K", help="increments of the path (default: the case's)"
    )
    parser.add_argument(
        "--repeat", type=whole_number(1), default=1, metavar="R", help="wall_s is the median of R solves"
    )
    add_json_argument(parser)


def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    problem = _driven(read_case(arguments.case), arguments)
    settings = chosen_settings(arguments)
    require_target(arguments)
    with Bar(f"solve {settings.model}") as bar:
        answer = answer_static(problem, settings, repeat=arguments.repeat, progress=bar)
    failure = None if answer.converged else answer.message
    return deliver(arguments, as_document(answer), _readable(answer), failure=failure)


def as_document(answer: Response) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        "status": answer.status,
        "message": answer.message,
        "model": answer.model,
        "settings": answer.settings,
        "rotation_rad": answer.rotation.tolist(),
        "com_x_m": answer.centre[:, 0].tolist(),
        "com_y_m": answer.centre[:, 1].tolist(),
        "torque_Nm": answer.torque.tolist(),
        "stiffness_Nm_per_rad": answer.stiffness.tolist(),
        "strain_energy_J": answer.strain_energy.tolist(),
        "max_stress_Pa": answer.max_stress.tolist(),
        "counters": answer.counters,
        "wall_s": answer.wall_s,
    }


def _driven(problem: Problem, arguments: argparse.Namespace) -> Problem:
    """Return the problem with the path that the options ask for."""
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
    return dataclasses.replace(problem, **changes)


def _readable(answer: Response) -> Iterator[str]:
    """Yield the lines of a short table."""
    yield described(answer.model, answer.settings)
    yield f"{'rotation':>9} {'x':>11} {'y':>11} {'torque':>12} {'stiffness':>12} {'energy':>11} {'stress':>9}"
    yield f"{'deg':>9} {'mm':>11} {'mm':>11} {'N m':>12} {'N m/rad':>12} {'J':>11} {'MPa':>9}"
    rows = zip(
        answer.rotation,
        answer.centre * 1e3,
        answer.torque,
        answer.stiffness,
        answer.strain_energy,
        answer.max_stress / 1e6,
        strict=True,
    )
    for rotation, (x, y), torque, stiffness, energy, stress in rows:
        place = f"{math.degrees(rotation):9.3f} {x:11.5f} {y:11.5f}"
        yield f"{place} {torque:12.4f} {stiffness:12.4f} {energy:11.4f} {stress:9.1f}"
    yield ending(answer.status, answer.counters, answer.wall_s)
