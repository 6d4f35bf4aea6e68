"""Pictures for who works in Python: of what a model returned, or of an answer, with the design it is of."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from studies.answers.fields import fields_of, own_fields
from studies.answers.response import Answered
from studies.errors import BadInput
from studies.pictures.page import picture
from studies.pictures.shapes import NAMES
from studies.pictures.shown import Shown
from studies.record import style
from studies.record.files import PICTURES, write_whole


@dataclass(frozen=True)
class Picture:
    """A picture at the width of a page, 160 mm: a notebook shows it; figure is matplotlib's."""

    figure: Figure

    def save(self, path: str | Path) -> None:
        """Write it to a file that ends in .svg, .png or .pdf."""
        kind = Path(path).suffix[1:].lower()
        if kind not in PICTURES:
            raise BadInput(f"{path}: got this ending, expected .svg, .png or .pdf")
        write_whole(Path(path), style.printed(self.figure, kind))

    def _repr_svg_(self) -> str:
        """Return what a notebook shows."""
        return style.printed(self.figure, "svg").decode()


def plot(solution: Any, design: Any, *, name: str = "", yield_strength: float | None = None) -> Picture:
    """Return the picture of a static solution, of a motion or of natural modes, of either model.

    Of a path: the shapes, torque and stiffness, path and shift of the centre, largest stress and energy; of a
    motion rotation and energies in place of torque and stiffness; of modes their shapes.

    Args:
        solution: what `solve_statics`, `solve_mechanism`, `solve_release`, `solve_motion` or
            `natural_frequencies` of `spline_model` or `fe_reference` returned, or an answer of
            `studies.answers.adapters`.
        design: the pivot or mechanism of the model that was solved; of an answer the design of its case.
            Sections of a model's own are taken as rectangles of their area and second moment.
        name: heading; the model's name where none is given.
        yield_strength: drawn across the stress [Pa].

    Raises:
        BadInput: a solution and a design that do not go together, or a path of one state; one line.
    """
    return Picture(picture([_shown(solution, design, name, yield_strength)]))


def overlay(solved: Mapping[str, tuple[Any, Any]], *, yield_strength: float | None = None) -> Picture:
    """Return the picture of two to five paths, motions or modes over one another; arguments as of `plot`.

    Args:
        solved: solution and design by their name.
        yield_strength: drawn across the stress [Pa].
    """
    return Picture(picture([_shown(*pair, name, yield_strength) for name, pair in solved.items()]))


def _shown(solution: Any, design: Any, name: str, yield_strength: float | None) -> Shown:
    made = fields_of if isinstance(solution, Answered) else own_fields
    fields = made(solution, design)
    return Shown(name=name or NAMES[fields.model], fields=fields, yield_strength=yield_strength)
