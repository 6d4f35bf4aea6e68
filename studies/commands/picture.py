"""The option --plot: the picture of an answer in a file."""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studies.answers.response import Answered
from studies.answers.strength import yield_strengths
from studies.cases.design import Design
from studies.commands.parser import Argument
from studies.errors import BadInput
from studies.record.files import PICTURES, require_writable_file, write_whole

if TYPE_CHECKING:
    from studies.pictures.shown import Shown


def picture_file(text: str) -> Path:
    """Parse the file of a picture, which must have one of the known endings and a place to be written to."""
    path = Path(text)
    if path.suffix[1:].lower() not in PICTURES:
        raise argparse.ArgumentTypeError(f"got {text}, expected a file that ends in .svg, .png or .pdf")
    try:
        require_writable_file(path)
    except BadInput as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return path


PLOT = Argument(
    "--plot",
    type=picture_file,
    metavar="FILE",
    help="draw the answer at the width of a page, as .svg, .png or .pdf (default: no picture)",
)


def pictured(arguments: argparse.Namespace, design: Design, *answers: Answered) -> None:
    """Draw what there is of the answers to a design where --plot says, and say where it is."""
    if arguments.plot is None:
        return
    from studies.exchange.solutions import fields_of
    from studies.pictures.shown import Shown

    strength = weakest(design)
    draw(
        arguments,
        [
            Shown(name=called(arguments.case, each), fields=fields_of(each, design), yield_strength=strength)
            for each in answers
            if each.solution is not None
        ],
        arguments.plot,
    )


def draw(arguments: argparse.Namespace, shown: "list[Shown]", target: Path) -> None:
    """Draw answers over one another in a file, and say where they are."""
    from studies.pictures.page import picture  # only who asks for a picture waits for matplotlib
    from studies.record.style import printed

    try:
        write_whole(target, printed(picture(shown), target.suffix[1:].lower()))
    except BadInput as error:
        print(f"studies: {target}: nothing is drawn: {error}", file=sys.stderr)
    else:
        taken = "-" in (arguments.json, getattr(arguments, "csv", None))
        stream = sys.stderr if taken else sys.stdout
        print(f"{target}: the picture", file=stream)


def called(case: str, answer: Any) -> str:
    """Return what a picture calls an answer: its case, its model and how fine that was."""
    settings = answer.settings
    fine = {"control_points": "control points", "elements": "elements"}
    counts = (f", {settings[key]} {word}" for key, word in fine.items() if key in settings)
    return f"{Path(case).stem}: {answer.model}{''.join(counts)}"


def weakest(design: Design) -> float | None:
    """Return the least yield strength of a design's strips [Pa]; None where none is given."""
    return min((each for each in yield_strengths(design) if each is not None), default=None)
