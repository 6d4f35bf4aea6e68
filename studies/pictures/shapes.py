"""Drawings of a design to scale, in millimetres: at rest, deformed at chosen states, in its modes."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.answers.answer import Answer
from studies.answers.motion import Spectrum
from studies.cases.keys import GROUND
from studies.kinds import Array
from studies.record import style
from studies.record.style import BLACK, BLUE, GREEN, Look

#: Colours of the models as in the figures of the studies: elements black, with shear green, splines blue.
COLOURS = {"spline": BLUE, "fe": BLACK, "fe-shear": GREEN}
NAMES = {"spline": "spline", "fe": "FE, corotational", "fe-shear": "FE, with shear"}
#: Colours of what is at rest, and of bodies.
REST, BODY = "#aaaaaa", "#e0e0e0"
#: Modes in a row, modes that are drawn at most, and height of a row [inch].
ROW, MOST_MODES, ROW_HEIGHT = 3, 12, 2.1


def states_over_rest(panel: Axes, answer: Answer, states: Sequence[int], look: Look) -> list[Line2D]:
    """Draw states over the shape at rest, later ones stronger; return what a legend says of them."""
    _at_rest(panel, answer, answer.along.rest_shape, answer.along.rest_bodies)
    handles = [Line2D([], [], color=REST, linestyle="--", label="at rest")]
    strengths = np.linspace(0.45, 1.0, len(states)) if len(states) > 1 else [1.0]  # later ones stand out
    for state, strength in zip(states, strengths, strict=True):
        how = _line(look) | {"alpha": strength}
        _deformed(panel, answer, answer.along.shape[state], answer.along.bodies[state, :, :2], **how)
        handles.append(Line2D([], [], label=_named(answer, state), **how))
    return handles


def _line(look: Look) -> dict[str, Any]:
    """Return colour and line as of `Axes.plot`."""
    return {"color": look.colour, "linestyle": look.line, "linewidth": 1.8}


def modes(answer: Spectrum, look: Look) -> Figure:
    """Return the drawings of modes, the first `MOST_MODES` of them, over the state that they are about."""
    count = min(MOST_MODES, len(answer.values))
    columns = min(ROW, count)
    rows = math.ceil(count / columns)
    figure = style.page(style.PAGE_WIDTH, rows * ROW_HEIGHT + 0.3)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel in panels[count:]:
        panel.set_axis_off()
    for state, panel in enumerate(panels[:count]):
        still, centres = answer.along.shape[state], answer.along.bodies[state, :, :2]
        scale = answer.scale_of(state)
        moved = still + scale * answer.mode_shape[state], centres + scale * answer.mode_bodies[state, :, :2]
        _at_rest(panel, answer, still, centres)
        _deformed(panel, answer, *moved, **_line(look))
        panel.set_title(f"mode {state + 1}: {answer.frequency[state]:.5g} Hz")
        left, bottom = state % columns == 0, state + columns >= count
        to_scale(panel, x="x [mm]" if bottom else "", y="y [mm]" if left else "")
    return figure


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
