"""What families show: maps of where each model is right, refuses, is wrong or cannot be asked, and counts."""

import textwrap
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.record.style import GREEN, GREY, RED, YELLOW, Look, page
from studies.stability.family import BAD_INPUT, ORDER, REFUSED, RIGHT, WRONG

#: Looks of the outcomes, the same in every map.
LOOKS = {
    RIGHT: Look(label="right", colour=GREEN, line="", marker="o"),
    REFUSED: Look(label="refused, or said to be unresolved", colour=YELLOW, line="", marker="D"),
    WRONG: Look(label="wrong", colour=RED, line="", marker="X"),
    BAD_INPUT: Look(label="cannot be asked", colour=GREY, line="", marker="s"),
}
#: Size of a panel of a map [inch].
WIDTH, HEIGHT, NARROWEST = 2.3, 3.5, 8.0
#: Panels in a row of a map, and the height of each further row [inch]: readable at the width of a page.
IN_ROW, ROW_HEIGHT = 4, 2.7


def outcome_map(outcomes: pd.DataFrame, *, title: str, **axes: Any) -> Figure:
    """Draw one panel a model: a mark a case at (x, y), by its outcome.

    Args:
        outcomes: columns model, x, y and outcome.
        title: of the figure.
        axes: properties of the panels, as of `Axes.set`.
    """
    models = [model for model in ORDER if (outcomes["model"] == model).any()]
    figure, panels, across = _grid(len(models))
    ylabel = axes.pop("ylabel", "")
    for place, (panel, model) in enumerate(zip(panels, models, strict=True)):
        mine = outcomes[outcomes["model"] == model]
        _marked(panel, mine, mine["x"], mine["y"], markersize=5.0, clip_on=False)
        counts = ", ".join(
            f"{count} {name}" for name in LOOKS if (count := int((mine["outcome"] == name).sum()))
        )
        panel.set(**axes)
        panel.minorticks_off()
        panel.tick_params(labelbottom=True)
        panel.set_title(f"{_broken(model)}\n{textwrap.fill(counts, 96 // across)}", fontsize=8.0)
        if place % across == 0:
            panel.set_ylabel(ylabel)
    handles = [
        Line2D([], [], **look.keywords())
        for name, look in LOOKS.items()
        if (outcomes["outcome"] == name).any()
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(LOOKS))
    figure.suptitle(title)
    return figure


def _marked(panel: Axes, rows: pd.DataFrame, x: pd.Series, y: pd.Series, **more: Any) -> None:
    """Draw a mark a row at (x, y), by its outcome."""
    for outcome, look in LOOKS.items():
        some = rows["outcome"] == outcome
        if some.any():  # an empty line that is not clipped has no place for the layout
            panel.plot(x[some], y[some], **look.keywords(), **more)


def _grid(count: int) -> tuple[Figure, list[Axes], int]:
    """Return a figure with `count` panels, in rows of equal length where they do not fit into one, and that
    length."""
    rows = -(-count // IN_ROW)
    across = -(-count // rows)
    figure = page(max(WIDTH * across, NARROWEST), HEIGHT + (rows - 1) * ROW_HEIGHT)
    panels = list(figure.subplots(rows, across, sharex=True, sharey=True, squeeze=False).flat)
    for panel in panels[count:]:
        panel.remove()
    return figure, panels[:count], across


def _broken(model: str) -> str:
    """Return the model's name in two lines, to stand below a column."""
    return model.replace(", ", ",\n")
