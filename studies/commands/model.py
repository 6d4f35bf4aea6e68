"""The arguments that choose a design, its effects, a model and its discretisation, shared by all commands."""

import argparse

from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design, read_design
from studies.commands.parser import Parser, add_case, not_negative
from studies.errors import BadInput

MODELS = ("spline", "fe", "fe-shear")

#: Option -> keyword of the settings it fills; given for the other model it is refused rather than ignored.
SPLINE_OPTIONS = (
    "control_points",
    "axial_modes",
    "basis",
    "measure",
    "stretch",
    "gauss_points",
    "slide_stiffness",
)
FE_OPTIONS = ("elements",)


def add_model_arguments(parser: Parser) -> None:
    """Declare the case, the model and the options of either discretisation."""
    add_case(parser, "the design, such as studies/cases/*.toml")
    add_effects_argument(parser)
    parser.add_argument(
        "--model", choices=MODELS, required=True, help="spline, corotational or shear-deformable FE"
    )
    parser.add_argument(
        "--control-points",
        type=int,
        metavar="N",
        help="control points a strip (spline; default: as many as the accuracy takes, 6 of a motion)",
    )
    parser.add_argument(
        "--axial-modes", type=int, metavar="M", help="axial-force modes a strip (spline; default N - 2)"
    )
    parser.add_argument(
        "--basis", choices=("bezier", "bspline"), help="of the curve (spline; default bezier)"
    )
    parser.add_argument(
        "--measure",
        choices=("material", "spatial", "printed"),
        help="of curvature and strain: spatial as in the paper, printed with its forces "
        "(spline; default material)",
    )
    parser.add_argument(
        "--stretch",
        choices=("mixed", "consistent", "inextensible"),
        help="form of the axial strain: consistent as the paper, which locks (spline; default mixed)",
    )
    parser.add_argument(
        "--gauss-points",
        type=int,
        metavar="G",
        help="quadrature points of a knot span (spline; default: degree + 3)",
    )
    parser.add_argument(
        "--slide-stiffness",
        type=not_negative,
        metavar="S",
        help="of the strains that the axial modes do not see, in EI/L^2 (spline; default: the model's)",
    )
    parser.add_argument(
        "--elements", type=int, metavar="N", help="elements a strip (fe, fe-shear; default 20)"
    )


def add_effects_argument(parser: Parser) -> None:
    """Declare the changes of the scene."""
    parser.add_argument(
        "--effects",
        metavar="LIST",
        help="changes of the scene's effects, as in --effects=+gravity,-strip_inertia; names alone are all "
        "(default: the case's)",
    )


def chosen_design(arguments: argparse.Namespace) -> Design:
    """Return the design of the case with the effects that are asked for."""
    return read_design(arguments.case, changes=arguments.effects)


def chosen_settings(arguments: argparse.Namespace) -> Settings:
    """Return the settings of the chosen model; an option of the other model is an error."""
    spline = arguments.model == "spline"
    own, other = (SPLINE_OPTIONS, FE_OPTIONS) if spline else (FE_OPTIONS, SPLINE_OPTIONS)
    refuse(arguments, other, own)
    given = {name: getattr(arguments, name) for name in own if getattr(arguments, name) is not None}
    if spline:
        return SplineSettings(**given)
    return FeSettings(element="reissner" if arguments.model == "fe-shear" else "corotational", **given)


def refuse(arguments: argparse.Namespace, unusable: tuple[str, ...], usable: tuple[str, ...]) -> None:
    """Raise BadInput if an option was given that the chosen model cannot use.

    Args:
        arguments: of the command.
        unusable, usable: options of the other model and of this one.
    """
    for name in unusable:
        if getattr(arguments, name) is not None:
            expected = ", ".join(map(option, usable))
            raise BadInput(f"{option(name)}: got it with --model {arguments.model}, expected only {expected}")


def option(name: str) -> str:
    """Return the option that fills the argument `name`."""
    return "--" + name.replace("_", "-")
