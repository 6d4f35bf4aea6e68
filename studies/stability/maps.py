"""What families show: maps of where each model is right, refuses, is wrong or cannot be asked, and counts."""

import textwrap
from collections.abc import Iterable, Sequence
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


def outcome_map(
    outcomes: pd.DataFrame,
    *,
    title: str,
    panels_by: str = "model",
    order: Sequence[str] = ORDER,
    **axes: Any,
) -> Figure:
    """Draw one panel a model, or another column of the table: a mark a case at (x, y), by its outcome.

    Args:
        outcomes: columns x, y, outcome and `panels_by`.
        title: of the figure.
        panels_by: column whose values have a panel each; order: of the panels.
        axes: properties of the panels, as of `Axes.set`.
    """
    models = [model for model in order if (outcomes[panels_by] == model).any()]
    figure, panels, across = _grid(len(models))
    ylabel = axes.pop("ylabel", "")
    for place, (panel, model) in enumerate(zip(panels, models, strict=True)):
        mine = outcomes[outcomes[panels_by] == model]
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


def listed(outcomes: pd.DataFrame, cases: Iterable[str], *, title: str) -> Figure:
    """Draw a family without axes: a line a case in the order of `cases`, a mark a model."""
    names = list(dict.fromkeys(cases))
    place = {name: len(names) - 1 - i for i, name in enumerate(names)}
    models = [model for model in ORDER if (outcomes["model"] == model).any()]
    across = {model: i for i, model in enumerate(models)}
    figure = page(0.95 * len(models) + 3.2, 1.3 + 0.2 * len(names))
    panel = figure.subplots()
    _marked(panel, outcomes, outcomes["model"].map(across), outcomes["case"].map(place), markersize=6.0)
    panel.set_xticks(range(len(models)), labels=[_broken(model) for model in models], fontsize=7.5)
    panel.set_yticks(list(place.values()), labels=list(place), fontsize=7.5)
    panel.set(xlim=(-0.6, len(models) - 0.4), ylim=(-0.7, len(names) - 0.3))
    figure.legend(loc="outside lower center", ncols=len(LOOKS))
    figure.suptitle(title)
    return figure


def _broken(model: str) -> str:
    """Return the model's name in two lines, to stand below a column."""
    return model.replace(", ", ",\n")
