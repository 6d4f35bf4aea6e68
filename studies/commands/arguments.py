"""The arguments that commands share: a design and its effects, a model, its settings, a path, the output."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from studies.answers.settings import MODELS, Settings, settings_of_model
from studies.cases import keys
from studies.cases.design import Design, read_design
from studies.cases.document import nearest
from studies.cases.problem import FOLDER, Problem, read_case
from studies.commands.parser import (
    Argument,
    degrees,
    names_of,
    not_negative,
    positive,
    ruled,
    whole_number,
)
from studies.errors import BadInput

Some = TypeVar("Some", bound=Design)


def _case_file(text: str) -> str:
    """Return the file of a case: of one by its name that comes with the suite, or the path as it is given."""
    own = FOLDER / f"{text}.toml"
    if Path(text).is_file() or text.endswith(".toml") or (Path(text).exists() and not own.is_file()):
        return text
    if not own.is_file():
        near = nearest(text, sorted(path.stem for path in FOLDER.glob("*.toml")))
        raise argparse.ArgumentTypeError(f"got {text}, expected {near}, or a file that ends in .toml")
    return str(own)


CASE = Argument(
    "case",
    metavar="CASE",
    type=_case_file,
    help="the design: a file, or the name of one that comes with the suite, such as cross_axis_pivot",
)
EFFECTS = Argument(
    "--effects",
    metavar="LIST",
    help="changes of the scene's effects, as in --effects=+gravity,-strip_inertia; names alone are all "
    "(default: the case's)",
)
CONTROL_POINTS = Argument(
    "--control-points",
    type=int,
    metavar="N",
    help="control points a strip (spline; default: as many as the accuracy takes, 6 of a motion)",
)
BASIS = Argument("--basis", choices=("bezier", "bspline"), help="of the curve (spline; default bezier)")
MEASURE = Argument(
    "--measure",
    choices=("material", "spatial", "printed"),
    help="of curvature and strain: spatial as in the paper, printed with its forces "
    "(spline; default material)",
)
STRETCH = Argument(
    "--stretch",
    choices=("mixed", "consistent", "inextensible"),
    help="form of the axial strain: consistent as the paper, which locks (spline; default mixed)",
)
#: The options of either discretisation; given for the other model one is refused rather than ignored.
SPLINE = (
    CONTROL_POINTS,
    Argument(
        "--axial-modes", type=int, metavar="M", help="axial-force modes a strip (spline; default N - 2)"
    ),
    BASIS,
    MEASURE,
    STRETCH,
    Argument(
        "--gauss-points",
        type=int,
        metavar="G",
        help="quadrature points of a knot span (spline; default: degree + 3)",
    ),
    Argument(
        "--slide-stiffness",
        type=not_negative,
        metavar="S",
        help="of the strains that the axial modes do not see, in EI/L^2 (spline; default: the model's)",
    ),
)
ELEMENTS = Argument("--elements", type=int, metavar="N", help="elements a strip (fe, fe-shear; default 20)")


def _asked(**model: Any) -> tuple[Argument, ...]:
    """Return the arguments of a design, its models and their settings."""
    what = "spline (default), corotational or shear-deformable FE"
    model["help"] = what + model.pop("several", "")
    return CASE, EFFECTS, Argument("--model", **model), *SPLINE, ELEMENTS


#: A design, a model and its settings: what `chosen_design` and `chosen_settings` read.
MODEL = _asked(choices=MODELS, default="spline")
#: The same of one model or several: what `all_settings` reads.
SEVERAL_MODELS = _asked(
    type=names_of(MODELS),
    default=("spline",),
    metavar="LIST",
    several=": spline, fe, fe-shear, or several with commas",
)

ROTATION = Argument("--rotation-deg", dest="rotation", type=ruled(keys.ROTATION, degrees), metavar="X")
INCREMENTS = Argument(
    "--increments",
    type=ruled(keys.INCREMENTS, int),
    metavar="K",
    help="increments of the path (default: the case's)",
)
ACCURACY = Argument("--accuracy", type=positive, metavar="A")
COUNT = Argument("--count", type=whole_number(1), metavar="C", help="number of modes, default 10", default=10)
HELD = Argument("--held", action="store_true", help="hold the rotation of the body")
REPEAT = Argument(
    "--repeat",
    type=whole_number(1),
    default=1,
    metavar="R",
    help="wall_s is the median of R solves, default 1",
)
DURATION = Argument(
    "--duration", type=positive, metavar="T", help="of the motion, in s (default: four swings of the design)"
)
STEP = Argument("--step", type=positive, metavar="S", help="of the integrator, in s (default: its own)")
INTEGRATOR = Argument(
    "--integrator",
    metavar="NAME",
    help="spline: energy (default), generalised-alpha, explicit, leapfrog; "
    "fe: central-difference (default), generalised-alpha",
)

JSON = Argument(
    "--json",
    metavar="FILE|-",
    help="write the answer as JSON to FILE or the output stream (default: a table to read)",
)
CSV = Argument(
    "--csv",
    metavar="FILE|-",
    help="write a row a state as CSV to FILE or the output stream (default: a table to read)",
)
OUT = Argument("--out", type=Path, metavar="FOLDER")
NAMES = Argument("names", nargs="+", metavar="NAME", help="studies, groups, or all; `list` names them")
RESULTS = Argument(
    "--results",
    type=Path,
    default=Path(__file__).parents[2] / "results",
    metavar="FOLDER",
    help="where tables and figures are, default results/",
)


def chosen_design(arguments: argparse.Namespace) -> Design:
    """Return the design of the case with the effects that are asked for."""
    return read_design(arguments.case, changes=arguments.effects)


def driven(design: Some, arguments: argparse.Namespace) -> Some:
    """Return the design with the path that the options of the command ask for."""
    given = {name: vars(arguments).get(name) for name in ("rotation", "increments")}
    return replace(design, **{name: each for name, each in given.items() if each is not None})


def turned_design(arguments: argparse.Namespace, why: str) -> Design:
    """Return the pivot or mechanism of the case with its path; BadInput without a rotation, for `why`."""
    design = driven(read_design(arguments.case), arguments)
    if not design.rotation:
        got = "none" if design.rotation is None else "0"
        raise BadInput(f"{arguments.case}: drive.rotation_deg: got {got}, expected a {why}")
    return design


def turned_pivot(arguments: argparse.Namespace, why: str) -> Problem:
    """Return the pivot of the case with its path; BadInput without a rotation, for `why`."""
    problem = driven(read_case(arguments.case), arguments)
    if problem.rotation == 0.0:
        raise BadInput(f"{arguments.case}: drive.rotation_deg: got 0, expected a {why}")
    return problem


def chosen_settings(arguments: argparse.Namespace) -> Settings:
    """Return the settings of the chosen model; an option of the other model is an error."""
    return _settings(arguments, (arguments.model,))[0]


def all_settings(arguments: argparse.Namespace) -> list[Settings]:
    """Return the settings of every chosen model; an option that none of them has is an error."""
    return _settings(arguments, arguments.model)


def _settings(arguments: argparse.Namespace, models: Sequence[str]) -> list[Settings]:
    points, elements = tuple(map(filled, SPLINE)), (filled(ELEMENTS),)
    if "spline" not in models:
        refuse(arguments, points, elements)
    elif set(models) == {"spline"}:
        refuse(arguments, elements, points)
    found = []
    for model in models:
        own = points if model == "spline" else elements
        given = {name: value for name in own if (value := getattr(arguments, name)) is not None}
        found.append(settings_of_model(model, **given))
    return found


def refuse(arguments: argparse.Namespace, unusable: tuple[str, ...], usable: tuple[str, ...]) -> None:
    """Raise BadInput if an option was given that the chosen model cannot use.

    Args:
        arguments: of the command.
        unusable, usable: options of the other model and of this one.
    """
    for name in unusable:
        if getattr(arguments, name) is not None:
            expected = ", ".join(map(option, usable))
            model = arguments.model if isinstance(arguments.model, str) else ",".join(arguments.model)
            raise BadInput(f"{option(name)}: got it with --model {model}, expected only {expected}")


def filled(argument: Argument) -> str:
    """Return the attribute that an option fills."""
    return argument.names[0].removeprefix("--").replace("-", "_")


def option(name: str) -> str:
    """Return the option that fills the attribute `name`."""
    return "--" + name.replace("_", "-")
