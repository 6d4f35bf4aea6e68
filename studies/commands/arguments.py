"""The arguments that commands share: a design and its effects, a model, its settings, a path, the output."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from studies.answers.settings import MODELS, Settings, settings_of_model
from studies.cases import keys
from studies.cases.design import Design, case_file, read_design
from studies.cases.document import present
from studies.commands.parser import STREAM, Argument, as_in_file, names_of, positive, whole_number
from studies.errors import BadInput
from studies.record.files import PICTURES, require_writable_file
from studies.record.source import HOME

Some = TypeVar("Some", bound=Design)


def _writable_file(text: str) -> Path:
    """Parse a file that is to be written, refused before anything is computed where it cannot be."""
    require_writable_file(Path(text))
    return Path(text)


def _file_or_stream(text: str) -> Path:
    """Parse a file that is to be written, or "-" for the output stream."""
    return STREAM if text == str(STREAM) else _writable_file(text)


def _new_folder(text: str) -> Path:
    """Parse a folder that is to be written, refused unless it is new or empty."""
    folder = Path(text)
    if folder.is_file():
        raise BadInput(f"got the file {text}, expected a folder")
    if not folder.is_dir():
        return _writable_file(text)
    if others := sorted(path.name for path in folder.iterdir()):
        raise BadInput(f"got {text} with {others[0]} in it, expected a new or empty folder")
    return folder


def _picture_file(text: str) -> Path:
    """Parse the file of a picture, which must have one of the known endings."""
    if Path(text).suffix[1:].lower() not in PICTURES:
        raise BadInput(f"got {text}, expected a file that ends in .svg, .png or .pdf")
    return _writable_file(text)


CASE = Argument("case CASE", "the design: a file, or one of the suite, as cross_axis_pivot", case_file)
EFFECTS = Argument(
    "--effects LIST",
    "+NAME adds, -NAME removes: --effects=+gravity; names alone are all (default: the case's)",
)
CONTROL_POINTS = Argument(
    "--control-points N", "control points a strip (spline; default: by the accuracy, 6 of a motion)", int
)
SEGMENTS = Argument("--segments M", "curves a strip, of those control points each (spline; default 1)", int)
MEASURE = Argument(
    "--measure",
    "spatial as in the paper, published with its forces; for consistent stretch (spline; default material)",
    present,
    choices=("material", "spatial", "published"),
)
STRETCH = Argument(
    "--stretch",
    "form of the axial strain: consistent as in the paper, which locks (spline; default mixed)",
    choices=("mixed", "consistent", "inextensible"),
)
#: The options of either discretisation; given for the other model one is refused rather than ignored.
SPLINE = CONTROL_POINTS, SEGMENTS, MEASURE, STRETCH
ELEMENTS = Argument("--elements N", "elements a strip (fe, fe-shear; default 20)", int)
_WHAT = "spline (default), corotational or shear-deformable FE"
_ONE = Argument("--model", _WHAT, choices=MODELS, default="spline")
_SEVERAL = Argument(
    "--model LIST", f"{_WHAT}: spline, fe, fe-shear, with commas", names_of(MODELS), default=("spline",)
)
#: Models and their settings, of one model or several; a design, a model and its settings.
MODELS_OF = EFFECTS, _SEVERAL, *SPLINE, ELEMENTS
MODEL = CASE, EFFECTS, _ONE, *SPLINE, ELEMENTS

ROTATION = Argument("--rotation-deg X", read=as_in_file(keys.ROTATION), dest="rotation")
INCREMENTS = Argument(
    "--increments K", "increments of the path (default: the case's)", as_in_file(keys.INCREMENTS, int)
)
ACCURACY = Argument("--accuracy A", read=positive)
COUNT = Argument("--count C", "number of modes, default 10", whole_number(1), default=10)
HELD = Argument("--held", "hold the rotation of the body")
DURATION = Argument("--duration T", "of the motion, in s (default: four periods of the design)", positive)
STEP = Argument("--step S", "of the integrator, in s (default: its own)", positive)
INTEGRATOR = Argument(
    "--integrator NAME", "energy (default), leapfrog; fe: central-difference (default), generalised-alpha"
)

_AS = "write the answer as {} to FILE too, or to the output stream alone (default: a table to read)"
JSON = Argument("--json FILE|-", _AS.format("JSON"), _file_or_stream)
CSV = Argument("--csv FILE|-", _AS.format("CSV, a row a state,"), _file_or_stream)
PLOT = Argument("--plot FILE", "draw the answer, as .svg, .png or .pdf (default: no picture)", _picture_file)
EXPORT = Argument("--export FOLDER", "write all states as VTK and CSV (default: no files)", _new_folder)
OUT = Argument("--out FOLDER", read=Path)
OUT_FILE = Argument("--out FILE", read=_writable_file)
NAMES = Argument("names NAME", "studies, groups, or all; `status` names them", nargs="+")
RESULTS = Argument(
    "--results FOLDER", "tables and figures (default: results/ of the clone)", Path, default=HOME / "results"
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


def chosen_settings(arguments: argparse.Namespace) -> list[Settings]:
    """Return the settings of every chosen model; BadInput for an option that none of them has."""
    models = [arguments.model] if isinstance(arguments.model, str) else arguments.model
    options = {model: SPLINE if model == "spline" else (ELEMENTS,) for model in models}
    usable = dict.fromkeys(each.name for own in options.values() for each in own)
    asked = {each.name: getattr(arguments, each.name) for each in (*SPLINE, ELEMENTS)}
    given = {name: value for name, value in asked.items() if value is not None}
    for name in given.keys() - usable:
        got = f"{option(name)}: got it with --model {','.join(models)}"
        raise BadInput(f"{got}, expected only {', '.join(map(option, usable))}")
    return [
        settings_of_model(model, **{each.name: given[each.name] for each in own if each.name in given})
        for model, own in options.items()
    ]


def option(name: str) -> str:
    """Return the option that fills the attribute `name`."""
    return "--" + name.replace("_", "-")
