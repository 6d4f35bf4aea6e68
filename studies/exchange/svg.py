"""Fields as an SVG: the design at rest and deformed at chosen states, to scale, in millimetres."""

from matplotlib.figure import Figure

from studies.answers.fields import Fields
from studies.pictures import shapes
from studies.record import style

#: Size of the drawing of a path or a motion [inch].
SIZE = 4.6


def svg(fields: Fields, states: list[int]) -> dict[str, bytes]:
    """Return `<analysis>.svg`: the same bytes for the same fields.

    A path or a motion is one drawing of the chosen states over the shape at rest; modes are a drawing each,
    over the state that they are about.
    """
    with style.applied():
        return {f"{fields.analysis}.svg": style.vector(drawing(fields, states))}


def drawing(fields: Fields, states: list[int]) -> Figure:
    """Return the figure of `svg`."""
    if fields.mode_shape is not None:
        return shapes.modes([(fields, "", "-")], states)
    figure = style.page(SIZE, SIZE + 0.9)
    panel = figure.subplots()
    handles = shapes.states_over_rest(panel, fields, states)
    shapes.to_scale(panel)
    what = {"static": "static path", "release": "motion after the release"}[fields.analysis]
    panel.set_title(f"{shapes.NAMES[fields.model]}: {what}")
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure
