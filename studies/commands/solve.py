"""Drive a pivot through a rotation with one of the models and report its path.

    python -m studies solve studies/cases/cross_axis_pivot.toml --model spline --control-points 8
    python -m studies solve studies/cases/cross_axis_pivot.toml --model fe --elements 40 --json -

Coordinates have their origin at A1, the ground clamp of strip 1; rotation is counter-clockwise. The arrays of
the JSON run over the increments, the unloaded state first. Exit code 0: converged; 2: bad input; 3: not
converged, and then the converged part of the path is reported with where and why it stopped.
"""

import argparse
import dataclasses
import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from studies.answers.adapters import answer_static
from studies.answers.response import Response
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.keys import INCREMENTS, ROTATION
from studies.cases.problem import Problem, read_case
from studies.commands.parser import Parser, degrees, whole_number
from studies.errors import BadInput
from studies.record.files import require_writable_file, write_whole
from studies.record.progress import Bar

NOT_CONVERGED = 3

MODELS = ("spline", "fe", "fe-shear")

#: Option -> keyword of the settings it fills; given for the other model it is refused rather than ignored.
SPLINE_OPTIONS = ("control_points", "axial_modes", "basis", "measure", "stretch", "gauss_points")
FE_OPTIONS = ("elements",)


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument("case", metavar="CASE.toml", help="the design")
    parser.add_argument(
        "--model", choices=MODELS, required=True, help="spline, corotational or shear-deformable FE"
    )
    add_spline_arguments(parser)
    parser.add_argument(
        "--elements", type=int, metavar="N", help="elements a strip (fe, fe-shear; default 20)"
    )
    parser.add_argument(
        "--rotation-deg", type=degrees, metavar="X", help="end of the path (default: the case's)"
    )
    parser.add_argument(
        "--increments", type=int, metavar="K", help="increments of the path (default: the case's)"
    )
    parser.add_argument(
        "--repeat", type=whole_number(1), default=1, metavar="R", help="wall_s is the median of R solves"
    )
    parser.add_argument(
        "--json", metavar="FILE|-", help="write the answer as JSON to FILE or the output stream"
    )


def add_spline_arguments(parser: Parser) -> None:
    """Declare the arguments that set the spline model's discretisation."""
    parser.add_argument("--control-points", type=int, metavar="N", help="control points a strip (default 6)")
    parser.add_argument(
        "--axial-modes", type=int, metavar="M", help="axial-force modes a strip (default N - 2)"
    )
    parser.add_argument("--basis", choices=("bezier", "bspline"), help="default bezier")
    parser.add_argument("--measure", choices=("material", "spatial", "printed"), help="default material")
    parser.add_argument("--stretch", choices=("mixed", "consistent", "inextensible"), help="default mixed")
    parser.add_argument("--gauss-points", type=int, metavar="G", help="quadrature points a strip")


def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    problem = _driven(read_case(arguments.case), arguments)
    settings = _settings(arguments)
    target = None if arguments.json in (None, "-") else Path(arguments.json)
    if target is not None:
        require_writable_file(target)
    with Bar(f"solve {settings.model}") as bar:
        answer = answer_static(problem, settings, repeat=arguments.repeat, progress=bar)
    if arguments.json is None:
        print("\n".join(_readable(answer)))
    else:
        text = json.dumps(as_document(answer), allow_nan=False, indent=1) + "\n"
        if target is None:
            sys.stdout.write(text)
        else:
            write_whole(target, text.encode())
    if not answer.converged:
        print(f"studies: not converged: {answer.message}", file=sys.stderr)
        return NOT_CONVERGED
    return 0


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


def _settings(arguments: argparse.Namespace) -> Settings:
    """Return the settings of the chosen model; an option of the other model is an error."""
    spline = arguments.model == "spline"
    own, other = (SPLINE_OPTIONS, FE_OPTIONS) if spline else (FE_OPTIONS, SPLINE_OPTIONS)
    for name in other:
        if getattr(arguments, name) is not None:
            expected = ", ".join(_option(known) for known in own)
            raise BadInput(
                f"{_option(name)}: got it with --model {arguments.model}, expected only {expected}"
            )
    given = {name: getattr(arguments, name) for name in own if getattr(arguments, name) is not None}
    if spline:
        return SplineSettings(**given)
    return FeSettings(element="reissner" if arguments.model == "fe-shear" else "corotational", **given)


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _readable(answer: Response) -> Iterator[str]:
    """Yield the lines of a short table."""
    settings = ", ".join(f"{name} {value}" for name, value in answer.settings.items() if value is not None)
    yield f"{answer.model}: {settings}"
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
    work = ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in answer.counters.items())
    yield f"{answer.status.replace('_', ' ')}; {work}; solved in {answer.wall_s * 1e3:.3g} ms"
