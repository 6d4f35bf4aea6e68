"""Fields as an SVG: the design at rest and deformed at chosen states, to scale, in millimetres."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from studies.answers.fields import Fields
from studies.cases.mechanism import GROUND
from studies.exchange.vtk import mode_scale
from studies.kinds import Array
from studies.record import style
from studies.record.style import BLACK, BLUE, GREEN

#: Colours of the models as in the figures of the studies: elements black, with shear green, splines blue.
COLOURS = {"spline": BLUE, "fe": BLACK, "fe-shear": GREEN}
NAMES = {"spline": "spline", "fe": "FE, corotational", "fe-shear": "FE, with shear"}
#: Colours of what is at rest, and of bodies.
REST, BODY = "#aaaaaa", "#e0e0e0"
#: Size of a panel [inch], and panels in a row.
SIZE, ROW = 4.6, 3
#: Modes that are drawn at most.
MOST_MODES = 6


def svg(fields: Fields, states: list[int]) -> dict[str, bytes]:
    """Return `<analysis>.svg`: the same bytes for the same fields.

    A path or a motion is one drawing of the chosen states over the shape at rest; modes are a drawing each,
    over the state that they are about.
    """
    with style.applied():
        return {f"{fields.analysis}.svg": style.vector(drawing(fields, states))}


def drawing(fields: Fields, states: list[int]) -> Figure:
    """Return the figure of `svg`."""
    if fields.mode_shape is None:
        figure = style.page(SIZE, SIZE + 0.9)
        panel = figure.subplots()
        _rest(panel, fields, fields.rest_shape, fields.rest_bodies)
        for state, strength in zip(states, _strengths(len(states)), strict=True):
            _deformed(panel, fields, fields.shape[state], fields.bodies[state, :, :2], strength)
        _frame(panel, f"{NAMES[fields.model]}: {_title(fields)}")
        figure.legend(handles=_legend(fields, states), loc="outside lower center", ncols=3)
        return figure
    chosen = states[:MOST_MODES]
    columns = min(ROW, len(chosen))
    rows = math.ceil(len(chosen) / columns)
    figure = style.page(0.75 * SIZE * columns, 0.8 * SIZE * rows)
    panels = np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).ravel()
    for panel in panels[len(chosen) :]:
        panel.set_axis_off()
    for panel, state in zip(panels, chosen, strict=False):
        scale = mode_scale(fields, state)
        shape = fields.shape[state] + scale * fields.mode_shape[state]
        moved = fields.bodies[state, :, :2] + scale * np.asarray(fields.mode_bodies)[state, :, :2]
        _rest(panel, fields, fields.shape[state], fields.bodies[state, :, :2])
        _deformed(panel, fields, shape, moved, 1.0)
        frequency = float(np.asarray(fields.frequency)[state])
        _frame(panel, f"{NAMES[fields.model]}: mode {fields.values[state]:.0f}, {frequency:.5g} Hz")
    return figure


def _strengths(count: int) -> list[float]:
    """Return the opacities of `count` states: later ones stand out."""
    return np.linspace(0.45, 1.0, count).tolist() if count > 1 else [1.0]


def _title(fields: Fields) -> str:
    return {"static": "static path", "release": "motion after the release"}[fields.analysis]


def _rest(panel: Axes, fields: Fields, shape: Array, bodies: Array) -> None:
    """Draw ground and the shape that the others are held against."""
    _bodies(panel, fields, shape, bodies, colour=REST, width=2.0, style="--")
    for strip in shape:
        panel.plot(*(1e3 * strip.T), color=REST, linestyle="--", linewidth=1.0)
    size = 0.03 * float(np.ptp(np.concatenate([*shape, bodies]), axis=0).max())
    for part, strip in zip(fields.parts, shape, strict=True):
        for on, point, inner in ((part.root, strip[0], strip[1]), (part.tip, strip[-1], strip[-2])):
            if on == GROUND:
                _clamp(panel, point, point - inner, size)


def _deformed(panel: Axes, fields: Fields, shape: Array, bodies: Array, strength: float) -> None:
    """Draw strips and bodies of a state."""
    _bodies(panel, fields, shape, bodies, colour=BODY, width=6.0, style="-")
    for strip in shape:
        panel.plot(*(1e3 * strip.T), color=COLOURS[fields.model], alpha=strength, linewidth=1.8)
    panel.plot(*(1e3 * bodies.T), color="#444444", alpha=strength, linestyle="", marker="o", markersize=3.5)


def _bodies(panel: Axes, fields: Fields, shape: Array, bodies: Array, **look: Any) -> None:
    """Draw every body as the lines from its centre to the ends of strips it carries."""
    looks = {"color": look["colour"], "linewidth": look["width"], "linestyle": look["style"], "zorder": 1.0}
    names = [block.name for block in fields.blocks]
    for part, strip in zip(fields.parts, shape, strict=True):
        for on, point in ((part.root, strip[0]), (part.tip, strip[-1])):
            if on in names:
                line = np.array([bodies[names.index(on)], point])
                panel.plot(*(1e3 * line.T), solid_capstyle="round", **looks)


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


def _frame(panel: Axes, title: str) -> None:
    panel.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title=title)
    panel.set_adjustable("datalim")


def _legend(fields: Fields, states: list[int]) -> list[Line2D]:
    """Return rest, every state by what runs and by the rotation of the driven body."""
    handles = [Line2D([], [], color=REST, linestyle="--", label="at rest")]
    for state, strength in zip(states, _strengths(len(states)), strict=True):
        handles.append(
            Line2D([], [], color=COLOURS[fields.model], alpha=strength, linewidth=1.8,
                   label=_named(fields, state))
        )  # fmt: skip
    return handles


def _named(fields: Fields, state: int) -> str:
    """Return what a state is called: the rotation of the driven body, its time, or its load factor."""
    value = fields.values[state]
    if fields.series == "load_factor" and fields.torque is None:
        return f"load factor {value:.3g}"
    if not fields.blocks:
        return f"{1e3 * value:.4g} ms"
    turn = f"{math.degrees(fields.bodies[state, fields.driven, 2]):.4g}°"
    return turn if fields.series == "load_factor" else f"{1e3 * value:.4g} ms, {turn}"
