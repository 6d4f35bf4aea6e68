"""One answer, or several over one another, on a page: curves, and the deformed shapes to scale."""

from collections.abc import Sequence
from typing import Any

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.errors import BadInput
from studies.pictures import shapes
from studies.pictures.contents import charts_of, look
from studies.pictures.shown import LETTERS, Shown
from studies.record import style

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
    """Return the figure of one answer, or of up to five over one another: paths, motions or natural modes.

    Raises:
        BadInput: more than five, kinds that do not go over one another, or less than two states; one line.
    """
    if not shown:
        raise BadInput("picture: got no state, expected a solution with one")
    kinds = sorted({each.fields.analysis for each in shown})
    if len(shown) > len(LETTERS) or len(kinds) > 1:
        raise BadInput(
            f"picture: got {len(shown)} of {', '.join(kinds)}, expected one, or 2 to 5 of one kind"
        )
    for each in shown:
        if len(each.fields.values) < 1 + (each.fields.analysis != "modes"):
            raise BadInput(f"picture: got too few states of {each.name}, expected at least two")
    with style.applied(**style.PRINTED):
        return _modes(shown) if kinds == ["modes"] else _page(shown)


def _modes(shown: Sequence[Shown]) -> Figure:
    looks = [look(place, shown) for place in range(len(shown))]
    drawn = [(each.fields, own["colour"], own["line"]) for each, own in zip(shown, looks, strict=True)]
    figure = shapes.modes(drawn, range(max(len(each.fields.values) for each in shown)))
    _head(figure, shown)
    return figure


def _page(shown: Sequence[Shown]) -> Figure:
    """Return the page: shapes at the upper left, charts beside and below them, names on top."""
    charts = list(charts_of(shown))
    rows = 2 + max(0, -(-(len(charts) - 2) // 2))
    heading = LINE_HEIGHT * (1 + len(shown))
    figure = style.page(style.PAGE_WIDTH, rows * ROW_HEIGHT + heading)
    grid = figure.add_gridspec(rows, 2)
    _shapes(figure, grid[0:2, 0], shown)
    places = [grid[0, 1], grid[1, 1], *(grid[row, column] for row in range(2, rows) for column in (0, 1))]
    for chart, place in zip(charts, places, strict=False):
        chart.draw(figure.add_subplot(place))
    _head(figure, shown)
    return figure


def _head(figure: Figure, shown: Sequence[Shown]) -> None:
    """Say on top what is shown: a name, or a key of several."""
    if len(shown) == 1:
        figure.suptitle(shown[0].name, x=0.01, ha="left")
        return
    key = [_entry(shown, place) for place in range(len(shown))]
    figure.legend(handles=key, loc="outside upper left", ncols=1, handlelength=3.0, fontsize=8.0)


def _entry(shown: Sequence[Shown], place: int) -> Line2D:
    own = look(place, shown)
    return Line2D(
        [], [], color=own["colour"], linestyle=own["line"], label=f"{own['name']}  {shown[place].name}"
    )


def _shapes(figure: Figure, place: Any, shown: Sequence[Shown]) -> None:
    """Draw one design at some of its states, or several where their paths end, in their own colours."""
    panel = figure.add_subplot(place)
    several = len(shown) > 1
    for k, each in enumerate(shown):
        last = len(each.fields.values) - 1
        parts = (1.0,) if several else STATES[each.fields.analysis]
        states = sorted({round(part * last) for part in parts})
        own = look(k, shown)
        handles = shapes.states_over_rest(panel, each.fields, states, colour=own["colour"], line=own["line"])
    shapes.to_scale(panel)
    panel.margins(0.06)
    if several:
        panel.set_title("at rest, and at the end")
    else:
        panel.legend(handles=handles, ncols=3 if len(handles) < 4 else 2, **TIGHT)
