"""Drawings of a design to scale, in millimetres: at rest, deformed at chosen states, in its modes."""

import math
import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.answers.answer import Answer
from studies.answers.motion import Spectrum
from studies.cases.keys import GROUND
from studies.exchange.vtk import mode_scale
from studies.kinds import Array
from studies.record import style
from studies.record.style import BLACK, BLUE, GREEN, Look

#: Colours of the models as in the figures of the studies: elements black, with shear green, splines blue.
COLOURS = {"spline": BLUE, "fe": BLACK, "fe-shear": GREEN}
NAMES = {"spline": "spline", "fe": "FE, corotational", "fe-shear": "FE, with shear"}
#: Colours of what is at rest, and of bodies.
REST, BODY = "#aaaaaa", "#e0e0e0"
#: Modes in a row, modes that are drawn at most, height of a row [inch], and letters over a mode.
ROW, MOST_MODES, ROW_HEIGHT, TITLE = 3, 12, 2.1, 28


def states_over_rest(
    panel: Axes, answer: Answer, states: Sequence[int], look: Look | None = None
) -> list[Line2D]:
    """Draw states over the shape at rest, later ones stronger; return what a legend says of them."""
    _at_rest(panel, answer, answer.along.rest_shape, answer.along.rest_bodies)
    handles = [Line2D([], [], color=REST, linestyle="--", label="at rest")]
    strengths = np.linspace(0.45, 1.0, len(states)) if len(states) > 1 else [1.0]  # later ones stand out
    for state, strength in zip(states, strengths, strict=True):
        how = _line(answer, look) | {"alpha": strength}
        _deformed(panel, answer, answer.along.shape[state], answer.along.bodies[state, :, :2], **how)
        handles.append(Line2D([], [], label=_named(answer, state), **how))
    return handles


def _line(answer: Answer, look: Look | None) -> dict[str, Any]:
    """Return colour and line as of `Axes.plot`, those of the model without a look."""
    look = look or Look(label="", colour=COLOURS[answer.model])
    return {"color": look.colour, "linestyle": look.line, "linewidth": 1.8}


def modes(several: Sequence[tuple[Spectrum, Look | None]], states: Sequence[int]) -> Figure:
    """Return the drawings of modes, the first `MOST_MODES` of them, over the state that they are about.

    Args:
        several: of each design its answer and look, None for that of its model; the modes of the same number
            stand over one another, with the sign that turns them the same way.
        states: the modes, by their place.
    """
    chosen = list(states)[:MOST_MODES]
    columns = min(ROW, len(chosen))
    rows = math.ceil(len(chosen) / columns)
    figure = style.page(style.PAGE_WIDTH, rows * ROW_HEIGHT + 0.3)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel in panels[len(chosen) :]:
        panel.set_axis_off()
    for place, (panel, state) in enumerate(zip(panels, chosen, strict=False)):
        there = [each for each in several if state < len(each[0].values)]
        for answer, look in there:
            _mode(panel, answer, state, _turned_as(answer, there[0][0], state), look)
        rates = ", ".join(f"{float(each[0].frequency[state]):.5g}" for each in there)
        panel.set_title(textwrap.fill(f"mode {state + 1}: {rates} Hz", TITLE))
        left, bottom = place % columns == 0, place + columns >= len(chosen)
        to_scale(panel, x="x [mm]" if bottom else "", y="y [mm]" if left else "")
    return figure


def _mode(panel: Axes, answer: Spectrum, state: int, sign: float, look: Look | None) -> None:
    """Draw a mode of a design over the state that it is about."""
    scale = sign * mode_scale(answer, state)
    shape = answer.along.shape[state] + scale * answer.mode_shape[state]
    moved = answer.along.bodies[state, :, :2] + scale * answer.mode_bodies[state, :, :2]
    _at_rest(panel, answer, answer.along.shape[state], answer.along.bodies[state, :, :2])
    _deformed(panel, answer, shape, moved, **_line(answer, look))


def _turned_as(answer: Spectrum, first: Spectrum, state: int) -> float:
    """Return the sign with which a mode moves the middles of the strips, on the whole, as that of another
    design does: 1 of designs with other strips."""
    mine, theirs = (each.mode_shape[state, :, each.mode_shape.shape[2] // 2] for each in (answer, first))
    return -1.0 if mine.shape == theirs.shape and float((mine * theirs).sum()) < 0.0 else 1.0


def to_scale(panel: Axes, x: str = "x [mm]", y: str = "y [mm]") -> None:
    """Give a panel the same scale along both axes, and their names."""
    panel.set(aspect="equal", xlabel=x, ylabel=y)
    panel.set_adjustable("datalim")


def _at_rest(panel: Axes, answer: Answer, shape: Array, bodies: Array) -> None:
    """Draw ground and the shape that the others are held against: strips (G, P, 2), bodies (B, 2) [m]."""
    _bodies(panel, answer, shape, bodies, color=REST, linewidth=2.0, linestyle="--")
    for strip in shape:
        panel.plot(*(1e3 * strip.T), color=REST, linestyle="--", linewidth=1.0)
    size = 0.03 * float(np.ptp(np.concatenate([*shape, bodies]), axis=0).max())
    for on, strip in _ends(answer, shape):
        if on == GROUND:
            _clamp(panel, strip[0], strip[0] - strip[1], size)


def _deformed(panel: Axes, answer: Answer, shape: Array, bodies: Array, **look: Any) -> None:
    """Draw strips (G, P, 2) and bodies (B, 2) of a state [m], the strips in the look of `Axes.plot`."""
    _bodies(panel, answer, shape, bodies, color=BODY, linewidth=6.0, linestyle="-")
    for strip in shape:
        panel.plot(*(1e3 * strip.T), **look)
    dots: dict[str, Any] = {"color": "#444444", "linestyle": "", "marker": "o", "markersize": 3.5}
    panel.plot(*(1e3 * bodies.T), alpha=look.get("alpha"), **dots)


def _ends(answer: Answer, shape: Array) -> Iterator[tuple[str | None, Array]]:
    """Yield what every end of a strip is on, and the strip's points, that end first."""
    for part, strip in zip(answer.design.strips, shape, strict=True):
        yield part.root, strip
        yield part.tip, strip[::-1]


def _bodies(panel: Axes, answer: Answer, shape: Array, bodies: Array, **look: Any) -> None:
    """Draw every body as the lines from its centre to the ends of strips it carries."""
    names = [block.name for block in answer.design.bodies]
    for on, strip in _ends(answer, shape):
        if on in names:
            line = np.array([bodies[names.index(on)], strip[0]])
            panel.plot(*(1e3 * line.T), solid_capstyle="round", zorder=1.0, **look)


def _clamp(panel: Axes, point: Array, outward: Array, size: float) -> None:
    """Draw the ground at an end: a bar across the strip, hatched on the outer side."""
    out = outward / np.hypot(*outward) * size
    across = np.array([-out[1], out[0]])
    bar = np.array([point - across, point + across])
    panel.plot(*(1e3 * bar.T), color="#444444", linewidth=2.0)
    for part in (-0.8, -0.3, 0.2, 0.7):
        foot = point + part * across
        hatch = np.array([foot, foot + 0.6 * out + 0.3 * across])
        panel.plot(*(1e3 * hatch.T), color="#444444", linewidth=0.8)


def _named(answer: Answer, state: int) -> str:
    """Return what a state is called: the rotation of the driven body, its time, or its load factor."""
    value, path = answer.values[state], answer.analysis == "static"
    if path and not answer.driven:
        return f"load factor {value:.3g}"
    if answer.body is None:
        return f"{1e3 * value:.4g} ms"
    turn = f"{math.degrees(answer.rotation[state]):.4g}°".replace("-", "−")
    return turn if path else f"{1e3 * value:.4g} ms, {turn}"
