"""Which charts a picture of answers has, and in which looks."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from studies.kinds import Array
from studies.pictures import shapes
from studies.pictures.charts import Chart, Curve, Quantity
from studies.pictures.shown import LETTERS, TURNED, Shown
from studies.record.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED

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
    "kinetic": RED,
    "strain": BLUE,
    "dissipated": PURPLE,
}
#: A part of the energy below this share of the largest is not drawn [1].
SHARE = 1e-3

LOAD = Quantity(name="load factor", factor=1.0)
ROTATION = Quantity(name="rotation", unit="°", factor=180.0 / np.pi)
TIME = Quantity(name="time", unit="s", highest=-3)
X, Y = (Quantity(name=f"Δ{axis} of the centre", unit="mm", factor=1e3) for axis in "xy")
ENERGY = Quantity(name="energy", unit="J")
STRESS = Quantity(name="largest stress", unit="Pa", highest=6)
SHIFT = Quantity(name="centre shift", unit="m", highest=-3)

Values = Callable[[Shown], Array | None]


def look(place: int, shown: Sequence[Shown]) -> dict[str, Any]:
    """Return name, colour and line of an answer among those that are shown: letters where they are many."""
    if len(shown) == 1:
        return {"name": "", "colour": shapes.COLOURS[shown[0].fields.model], "line": "-"}
    colour, line = SEVERAL[place]
    return {"name": LETTERS[place], "colour": colour, "line": line}


def charts_of(shown: Sequence[Shown]) -> Iterator[Chart]:
    """Yield the charts of paths, or of motions, that there is something to draw in."""
    path = shown[0].fields.analysis == "static"
    turned = path and all(each.turns for each in shown)
    x = ROTATION if turned else LOAD if path else TIME

    def over(each: Shown) -> Array:
        return turning(np.asarray(each.rotation)) if turned else each.fields.values

    first = (
        {
            Quantity(name="torque", unit="N m"): lambda each: each.fields.torque,
            Quantity(name="stiffness", unit="N m/rad"): lambda each: each.fields.stiffness,
        }
        if turned
        else {ROTATION: lambda each: each.rotation}
    )
    for quantity, values in first.items():
        yield from _chart(shown, x, quantity, over, values)
    if not path:
        yield from _energies(shown, x, over)
    yield from _chart(shown, X, Y, partial(_travel, axis=0), partial(_travel, axis=1), equal=True)
    yield from _chart(shown, x, SHIFT, over, lambda each: each.shift)
    yields = [each.yield_strength for each in shown if each.yield_strength is not None]
    level = (min(yields), "yield" if len(set(yields)) == 1 else "lowest yield") if yields else None
    yield from _chart(shown, x, STRESS, over, lambda each: each.fields.max_stress, level=level)
    if path:
        yield from _energies(shown, x, over)


def turning(rotation: Array) -> Array:
    """Return rotations (S,) without those before the last state at the first of them, where loads come on."""
    begin = np.flatnonzero(np.abs(rotation - rotation[0]) <= TURNED)[-1]
    return np.where(np.arange(len(rotation)) < begin, np.nan, rotation)


def _chart(
    shown: Sequence[Shown], x: Quantity, y: Quantity, across: Values, up: Values, **more: Any
) -> Iterator[Chart]:
    """Yield the chart of a quantity of all that have it; none where none has."""
    curves = []
    for place, each in enumerate(shown):
        along, values = across(each), up(each)
        if along is not None and values is not None:
            curves.append(Curve(x=along, y=values, **look(place, shown)))
    if curves:
        yield Chart(x=x, y=y, curves=tuple(curves), **more)


def _travel(shown: Shown, axis: int) -> Array | None:
    """Return a coordinate of the driven body's centre from rest [m]; None without bodies."""
    fields, body = shown.fields, shown.fields.driven
    return fields.bodies[:, body, axis] - fields.rest_bodies[body, axis] if fields.blocks else None


def _energies(shown: Sequence[Shown], x: Quantity, over: Callable[[Shown], Array]) -> Iterator[Chart]:
    """Yield the chart of the energy by its parts, or of several answers that of the strain alone."""
    if len(shown) > 1:
        strain = Quantity(name="strain energy", unit="J")
        yield from _chart(shown, x, strain, over, lambda each: each.fields.strain_energy)
        return
    (only,) = shown
    largest = max(float(np.abs(part).max()) for part in only.fields.energies.values())
    parts = {
        name: part for name, part in only.fields.energies.items() if np.abs(part).max() > SHARE * largest
    }
    curves = tuple(Curve(name=name, x=over(only), y=part, colour=PARTS[name]) for name, part in parts.items())
    if curves:
        yield Chart(x=x, y=ENERGY, curves=curves)
