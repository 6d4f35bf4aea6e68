"""One answer, or several over one another, on a page: curves, and the deformed shapes to scale."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.answers.adapters import answer_of
from studies.answers.answer import Answer
from studies.answers.named import named
from studies.answers.quantities import QUANTITIES, Quantity, Scale
from studies.answers.response import TURNED, Response
from studies.errors import BadInput
from studies.kinds import Array
from studies.pictures import shapes
from studies.pictures.shown import LETTERS, Chart, Shown
from studies.record import style
from studies.record.files import PICTURES, write_whole
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, Look

#: Colours and lines of answers over one another.
SEVERAL: tuple[tuple[str, Any], ...] = (
    (BLUE, "-"), (RED, "--"), (GREEN, "-."), (PURPLE, ":"), (BLACK, (0, (5, 1)))
)  # fmt: skip
#: Colours of the parts of the energy.
PARTS = {
    "bending": BLUE,
    "axial": ORANGE,
    "shear": PURPLE,
    "gravity": GREY,
    "spring": GREEN,
    "kinetic": RED,
    "strain": BLUE,
    "dissipated": PURPLE,
}
#: A part of the energy below this share of the largest is not drawn [1].
SHARE = 1e-3

LOAD = Scale(heading="load factor", factor=1.0)
ROTATION = Scale(heading="rotation", unit="°", factor=180.0 / np.pi)
TIME = Scale(heading="time", unit="s", highest=-3)
X, Y = (Scale(heading=f"Δ{axis} of the centre", unit="mm", factor=1e3) for axis in "xy")
ENERGY = Scale(heading="energy", unit="J")
STRESS = Scale(heading="largest stress", unit="Pa", highest=6)
SHIFT = Scale(heading="centre shift", unit="m", highest=-3)

_Values = Callable[[Any], Array | None]


def _looks(shown: Sequence[Shown]) -> list[Look]:
    """Return name, colour and line of the answers that are shown: letters where they are many."""
    if len(shown) == 1:
        return [Look(label="", colour=shapes.COLOURS[shown[0].answer.model])]
    several = zip(LETTERS, SEVERAL, shown, strict=False)
    return [Look(label=letter, colour=colour, line=line) for letter, (colour, line), _ in several]


def _charts_of(shown: Sequence[Shown]) -> Iterator[Chart]:
    """Yield the charts of paths, or of motions, that there is something to draw in."""
    answers: list[Any] = [each.answer for each in shown]
    path = answers[0].analysis == "static"
    turned = path and all(each.turns for each in answers)
    series = ROTATION if turned else LOAD if path else TIME
    along = _turning if turned else attrgetter("values")

    def chart(
        y: Scale, up: _Values, x: Scale = series, over: _Values = along, **more: Any
    ) -> Iterator[Chart]:
        """Yield the chart of a quantity of all that have it; none where none has."""
        drawn = [(look, over(each), up(each)) for look, each in zip(_looks(shown), answers, strict=True)]
        curves = [(look, x, y) for look, x, y in drawn if x is not None and y is not None]
        if curves:
            yield Chart(x=x, y=y, curves=curves, **more)

    energies = chart(Scale(heading="strain energy", unit="J"), attrgetter("strain_energy"))
    if len(answers) == 1:
        energies = _parts_of_energy(answers[0], series, along(answers[0]))
    if not turned:
        yield from chart(ROTATION, _rotation)
    parts = {each.key: each for answer in answers for each in named(answer.design)}
    for each in (*(own for own in QUANTITIES if path), *parts.values()):
        if each.chart and answers[0].analysis in each.analyses:
            yield from chart(replace(each, highest=3), partial(_of_path, each, turned))
    if not path:
        yield from energies
    yield from chart(Y, partial(_travel, axis=1), X, partial(_travel, axis=0), equal=True)
    yield from chart(SHIFT, attrgetter("shift"))
    yields = [each.limit for each in shown if each.limit is not None]
    level = (min(yields), "yield" if len(set(yields)) == 1 else "lowest yield") if yields else None
    yield from chart(STRESS, _stress, level=level)
    if path:
        yield from energies


def _turning(answer: Response) -> Array:
    """Return the rotations (S,) [rad] without the states of the loading, which precede the last first
    rotation."""
    rotation = answer.rotation
    begin = np.flatnonzero(np.abs(rotation - rotation[0]) <= TURNED)[-1]
    return np.where(np.arange(len(rotation)) < begin, np.nan, rotation)


def _stress(answer: Answer) -> Array | None:
    """Return the largest stress (S,) [Pa]; None where an outermost fibre is not known."""
    return None if np.isnan(answer.max_stress).any() else answer.max_stress


def _rotation(answer: Answer) -> Array | None:
    """Return the rotation (S,) of a body that turns by more than round-off."""
    if answer.body is None or float(np.ptp(answer.rotation)) < TURNED:
        return None
    return answer.rotation


def _of_path(quantity: Quantity, turned: bool, answer: Answer) -> Array | None:
    """Return the values of a quantity (S,) that the design has; those of a drive are drawn where it turns."""
    if quantity.group and quantity.key not in (each.key for each in named(answer.design)):
        return None
    return quantity.of(answer) if turned or not quantity.drive else None


def _travel(answer: Answer, axis: int) -> Array | None:
    """Return a coordinate of the driven body's centre from rest [m]; None without bodies."""
    if answer.body is None:
        return None
    rest = answer.along.rest_bodies[[each.name for each in answer.design.bodies].index(answer.body)]
    return np.asarray(answer.centre[:, axis] - rest[axis])


def _parts_of_energy(answer: Answer, x: Scale, along: Any) -> Iterator[Chart]:
    """Yield the chart of the energy by its parts, if there is any."""
    largest = max(float(np.abs(part).max()) for part in answer.energies.values())
    parts = {name: part for name, part in answer.energies.items() if np.abs(part).max() > SHARE * largest}
    curves = [(Look(label=name, colour=PARTS[name]), along, part) for name, part in parts.items()]
    if curves:
        yield Chart(x=x, y=ENERGY, curves=curves)


#: States that a drawing shows of a path and of a motion, parts of the series.
STATES = {"static": (0.5, 1.0), "release": (0.0, 0.5, 1.0)}
#: Height of a row of charts, and of a line of the heading [inch].
ROW_HEIGHT, LINE_HEIGHT = 1.75, 0.17
#: A legend over half a page.
TIGHT: Any = {
    "loc": "lower center",
    "bbox_to_anchor": (0.5, 1.0),
    "borderaxespad": 0.2,
    "handlelength": 1.5,
    "columnspacing": 1.0,
    "handletextpad": 0.4,
}


def picture(shown: Sequence[Shown]) -> Figure:
    """Return the figure of one answer, or of up to five paths or motions over one another.

    Raises:
        BadInput: more than five, several modes or kinds, or less than two states; one line.
    """
    if not shown:
        raise BadInput("picture: got no state, expected a solution with one")
    kinds = sorted({each.answer.analysis for each in shown})
    if len(shown) > len(LETTERS) or len(kinds) > 1 or (len(shown) > 1 and kinds == ["modes"]):
        expected = "one, or 2 to 5 paths or motions"
        raise BadInput(f"picture: got {len(shown)} of {', '.join(kinds)}, expected {expected}")
    for each in shown:
        if len(each.answer.values) < 1 + (each.answer.analysis != "modes"):
            raise BadInput(f"picture: got too few states of {each.name}, expected at least two")
    with style.applied(**style.PRINTED):
        answer: Any = shown[0].answer
        figure = shapes.modes(answer, *_looks(shown)) if kinds == ["modes"] else _page(shown)
        _head(figure, shown)
    return figure


def _page(shown: Sequence[Shown]) -> Figure:
    """Return the page without its names: shapes at the upper left, charts beside and below them."""
    charts = list(_charts_of(shown))
    rows = 2 + max(0, -(-(len(charts) - 2) // 2))
    heading = LINE_HEIGHT * (1 + len(shown))
    figure = style.page(style.PAGE_WIDTH, rows * ROW_HEIGHT + heading)
    grid = figure.add_gridspec(rows, 2)
    _shapes(figure, grid[0:2, 0], shown)
    places = [grid[0, 1], grid[1, 1], *(grid[row, column] for row in range(2, rows) for column in (0, 1))]
    for chart, place in zip(charts, places, strict=False):
        panel = figure.add_subplot(place)
        chart.draw(panel)
        if len(chart.curves) > 1 and len(shown) == 1:  # the key on top names those of several answers
            panel.legend(ncols=len(chart.curves), **TIGHT)
    return figure


def _head(figure: Figure, shown: Sequence[Shown]) -> None:
    """Say on top what is shown: a name, or a key of several."""
    if len(shown) == 1:
        figure.suptitle(shown[0].name, x=0.01, ha="left")
        return
    named = zip(_looks(shown), shown, strict=True)
    looks = [replace(look, label=f"{look.label}  {each.name}") for look, each in named]
    handles = [Line2D([], [], **look.keywords()) for look in looks]
    figure.legend(handles=handles, loc="outside upper left", ncols=1, handlelength=3.0, fontsize=8.0)


def _shapes(figure: Figure, place: Any, shown: Sequence[Shown]) -> None:
    """Draw one design at some of its states, or several where their paths end, in their own colours."""
    panel = figure.add_subplot(place)
    several = len(shown) > 1
    for look, each in zip(_looks(shown), shown, strict=True):
        last = len(each.answer.values) - 1
        parts = (1.0,) if several else STATES[each.answer.analysis]
        states = sorted({round(part * last) for part in parts})
        handles = shapes.states_over_rest(panel, each.answer, states, look)
    shapes.to_scale(panel)
    panel.margins(0.06)
    if several:
        panel.set_title("at rest, and at the end")
    else:
        panel.legend(handles=handles, ncols=3 if len(handles) < 4 else 2, **TIGHT)


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

    def _repr_png_(self) -> bytes:
        """Return what a notebook shows."""
        return style.printed(self.figure, "png")


def plot(
    solution: Any, design: Any = None, *, name: str = "", yield_strength: float | None = None
) -> Picture:
    """Return the picture of a static solution, of a motion or of natural modes, of either model.

    A path: the shapes, torque and stiffness, trajectory and centre shift, largest stress and energy. A
    motion: rotation and energies in place of torque and stiffness. Modes: their shapes.

    Parameters
    ----------
    solution
        Result of `solve_statics`, `solve_statics`, `solve_motion`, `solve_motion` or
        `natural_frequencies` of `spline_model` or `fe_reference`, or an answer of
        ``studies.answers.adapters``.
    design : default None
        The pivot or mechanism of the model that was solved; None for an answer, which has its own.
        Sections have a stress where their width and thickness are known.
    name : str
        Heading; default the name of the model.
    yield_strength : float, Pa, default None
        Drawn across the stress; None for that of the case, if it has one.

    Returns
    -------
    Picture
        160 mm wide; `save` writes it to a file.

    Raises
    ------
    BadInput
        A solution and a design that do not belong together, or a path of one state; one line.

    Examples
    --------
    >>> from spline_model import cross_axis_pivot, solve_statics
    >>> pivot = cross_axis_pivot(
    ...     length=0.08, inclination=0.785, crossing_ratio=0.5, width=0.01, thickness=5e-4,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0, body_mass=0.1,
    ...     body_moment_of_inertia=2e-5, control_points=6,
    ... )
    >>> picture = plot(solve_statics(pivot, rotation=0.2, increments=4), pivot)
    >>> print(f"{picture.figure.get_figwidth():.1f} inches")
    6.3 inches
    """
    return overlay({name: (solution, design)}, yield_strength=yield_strength)


def overlay(solved: Mapping[str, Any], *, yield_strength: float | None = None) -> Picture:
    """Return the picture of up to five paths or motions in common axes.

    Parameters
    ----------
    solved : mapping
        Solution and design, or an answer, by name, as for `plot`.
    yield_strength : float, Pa, default None
        Drawn across the stress.

    Returns
    -------
    Picture

    Raises
    ------
    BadInput
        As in `plot`.

    Examples
    --------
    With ``pivot`` and ``solve_statics`` of the example of `plot`:

    >>> paths = {f"{end} rad": solve_statics(pivot, rotation=end, increments=4) for end in (0.1, 0.2)}
    >>> type(overlay({name: (path, pivot) for name, path in paths.items()})).__name__
    'Picture'
    """
    shown = []
    for name, each in solved.items():
        solution, design = each if isinstance(each, tuple) else (each, None)
        answer = solution if isinstance(solution, Answer) else answer_of(solution, design)
        name = name or shapes.NAMES[answer.model]
        shown.append(Shown(name=name, answer=answer, yield_strength=yield_strength))
    return Picture(picture(shown))
