"""Solve a design and write its deformed shapes, section forces and reactions for other programs.

    python -m studies export studies/cases/cross_axis_pivot.toml --model spline --out exported
    python -m studies export studies/cases/four_bar_of_flexures.toml --model fe --analysis modes --out modes
    python -m studies export my_pivot.toml --model spline --analysis release --duration 0.01 --out swing

vtk: NAME.pvd, which ParaView opens as one series, with NAME_0000.vtu ... for the states; svg: a drawing of
the design at rest and deformed; csv, parquet: tables NAME_states, NAME_strips, NAME_bodies, NAME_reactions;
json: the same tables in one file. NAME is the analysis: static, release or modes. docs/data.md says what the
files hold; units stand in the names of columns and arrays. The folder must be new or empty, or hold a
former export, which is replaced as a whole: nothing is ever half-written. Exit code 0: done; 2: bad
input; 3: not converged, and then the converged part of a path or a motion is written.
"""

import argparse
import dataclasses
import sys
from pathlib import Path
from typing import Any

import numpy as np

from studies.answers.fields import Fields
from studies.answers.settings import Settings
from studies.cases.design import Design
from studies.cases.keys import INCREMENTS, ROTATION
from studies.commands.answer import NOT_CONVERGED, described
from studies.commands.model import add_model_arguments, chosen_design, chosen_settings, option
from studies.commands.parser import Parser, degrees, degrees_list, names_of, positive, whole_number
from studies.errors import BadInput
from studies.exchange.folder import require_own, write
from studies.exchange.formats import FORMATS, contents, summary
from studies.exchange.solve import NoState, mode_fields, release_fields, static_fields
from studies.record.progress import Bar

#: Options that belong to one analysis, with their defaults; given for another they are refused.
OPTIONS: dict[str, dict[str, Any]] = {
    "static": {"increments": None},
    "release": {"duration": 0.05, "step": None, "integrator": None, "records": 200},
    "modes": {"count": 6, "held": False},
}
#: States that a drawing shows, parts of the series.
DRAWN = (0.5, 1.0)


def add_arguments(parser: Parser) -> None:
    """Declare the arguments of the command."""
    add_model_arguments(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="FOLDER", help="new, empty, or of a former export"
    )
    parser.add_argument(
        "--formats",
        type=names_of(FORMATS),
        default=("vtk", "svg"),
        metavar="LIST",
        help=f"of {', '.join(FORMATS)}, separated by commas, default vtk,svg",
    )
    parser.add_argument(
        "--analysis", choices=list(OPTIONS), default="static", help="what is solved, default static"
    )
    parser.add_argument(
        "--rotation-deg",
        type=degrees,
        metavar="X",
        help="end of the path, start of the motion, or state of the modes, in deg "
        "(default: the case's; of modes 0)",
    )
    parser.add_argument(
        "--draw-deg",
        type=degrees_list,
        metavar="LIST",
        help="draw the states nearest to these rotations, in deg (svg; default: middle and end)",
    )
    _add_own(parser)


def _add_own(parser: Parser) -> None:
    """Declare the options of single analyses."""
    own = parser.add_argument_group("of one analysis")
    own.add_argument("--increments", type=int, metavar="K", help="static: of the path (default: the case's)")
    own.add_argument("--duration", type=positive, metavar="T", help="release: in s, default 0.05")
    own.add_argument("--step", type=positive, metavar="S", help="release: in s (default: the integrator's)")
    own.add_argument("--integrator", metavar="NAME", help="release: as of `release` (default: the model's)")
    own.add_argument(
        "--records", type=whole_number(1), metavar="R", help="release: largest number of states, default 200"
    )
    own.add_argument("--count", type=whole_number(1), metavar="C", help="modes: number of modes, default 6")
    own.add_argument("--held", action="store_true", default=None, help="modes: hold the rotation of the body")


def main(arguments: argparse.Namespace) -> int:
    """Solve and write; return the exit code."""
    design, settings = _asked(arguments), chosen_settings(arguments)
    own = _own_options(arguments)
    require_own(arguments.out)
    try:
        fields = _solved(arguments.analysis, design, settings, own)
    except NoState as error:
        print(f"studies: not converged: {error}", file=sys.stderr)
        return NOT_CONVERGED
    files = contents(fields, arguments.formats, _drawn(fields, arguments.draw_deg))
    write(arguments.out, files, {"case": Path(arguments.case).name, **summary(fields)})
    print(described(fields.model, fields.settings, fields.effects))
    print(f"{arguments.out}: {len(fields.values)} states of {fields.analysis} in {len(files)} files")
    if fields.converged:
        return 0
    print(f"studies: not converged: {fields.message}", file=sys.stderr)
    return NOT_CONVERGED


def _asked(arguments: argparse.Namespace) -> Design:
    """Return the design with the path that the options ask for."""
    design = chosen_design(arguments)
    changes: dict[str, Any] = {}
    try:
        name = "--rotation-deg"
        if arguments.rotation_deg is not None:
            changes["rotation"] = ROTATION.parse(arguments.rotation_deg)
        elif arguments.analysis == "modes":
            changes["rotation"] = 0.0
        name = "--increments"
        if arguments.increments is not None:
            changes["increments"] = INCREMENTS.parse(arguments.increments)
    except ValueError as error:
        raise BadInput(f"{name}: {error}") from None
    return dataclasses.replace(design, **changes)


def _own_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of the analysis; those of another are an error, so are rotations of modes."""
    for analysis, options in OPTIONS.items():
        for name in options:
            if analysis != arguments.analysis and getattr(arguments, name) is not None:
                raise BadInput(
                    f"{option(name)}: got it with --analysis {arguments.analysis}, expected {analysis}"
                )
    if arguments.draw_deg is not None and (arguments.analysis == "modes" or "svg" not in arguments.formats):
        raise BadInput("--draw-deg: got it without a path or motion to draw, expected static or release, svg")
    own = OPTIONS[arguments.analysis]
    given = {name: getattr(arguments, name) for name in own}
    return {name: own[name] if value is None else value for name, value in given.items()}


def _solved(analysis: str, design: Design, settings: Settings, own: dict[str, Any]) -> Fields:
    with Bar(f"export {settings.model}") as bar:
        if analysis == "static":
            return static_fields(design, settings, progress=bar)
        return (
            release_fields(design, settings, **own)
            if analysis == "release"
            else mode_fields(design, settings, **own)
        )


def _drawn(fields: Fields, degrees: tuple[float, ...] | None) -> list[int]:
    """Return the numbers of the states that a drawing shows, each once, in order."""
    last = len(fields.values) - 1
    if fields.mode_shape is not None:
        return list(range(last + 1))
    if degrees is None:
        return sorted({round(part * last) for part in DRAWN})
    if not fields.blocks:
        raise BadInput("--draw-deg: got it for a design without bodies, expected none")
    turns = np.degrees(fields.bodies[:, fields.driven, 2])
    return sorted({int(np.abs(turns - angle).argmin()) for angle in degrees})
