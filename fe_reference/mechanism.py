"""Mechanisms of any number of strips and rigid bodies, from designs that name what is joined to what."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from .arrays import Array
from .effects import DEFAULT_EFFECTS, read_effects
from .errors import InvalidParameter, count, finite, pair
from .model import FREE, GROUND, Body, Model, Section, Strip

#: A body is its own design.
BodyDesign = Body


@dataclass(frozen=True, kw_only=True)
class StripDesign(Section):
    """A section, and the two points between which a strip has it.

    Attributes:
        name: what it is called. start, end: of its axis at rest [m].
        root, tip: "ground" or the name of the body that its start and its end are on; None if it is free.
        rise: sagitta of the circular arc it is at rest [m], to the left of start to end; 0: straight.
    """

    name: str
    start: Sequence[float]
    end: Sequence[float]
    root: str | None = "ground"
    tip: str | None
    rise: float = 0.0


def mechanism(
    *,
    strips: Sequence[StripDesign],
    bodies: Sequence[BodyDesign] = (),
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    elements: int = 20,
    element: str = "corotational",
) -> Model:
    """Return the model of a mechanism at rest, free of stress unless it has natural strains.

    Args:
        strips, bodies: the designs. effects, parameters: named effects and their parameters.
        elements: number of elements a strip. element: "corotational" or "reissner".

    Raises:
        InvalidParameter: a value outside its domain, an end on a body that is not there, effects that are
            not known or do not go together.
    """
    names = [body.name for body in bodies]
    if "ground" in names:
        raise InvalidParameter("bodies", "ground", "another name for a body that moves [name]")
    return Model(
        strips=tuple(_strip(design, names, elements) for design in strips),
        bodies=tuple(bodies),
        element=element,
        effects=read_effects(effects, parameters or {}),
    )


def _strip(design: StripDesign, bodies: Sequence[str], elements: int) -> Strip:
    section = Section(**{each.name: getattr(design, each.name) for each in fields(Section)})
    return Strip(
        name=design.name,
        section=section,
        nodes=_axis(design, count("elements", elements)),
        root=_place("root", design.root, bodies),
        tip=_place("tip", design.tip, bodies),
    )


def _place(name: str, there: str | None, bodies: Sequence[str]) -> int:
    """Return the code of an end that is on ground, on a body or free."""
    if there is None:
        return FREE
    if there == "ground":
        return GROUND
    if there not in bodies:
        raise InvalidParameter(name, there, f"one of {', '.join(['ground', *bodies])} [name]")
    return list(bodies).index(there)


def _axis(design: StripDesign, elements: int) -> Array:
    """Return the nodes (P, 2) [m] on the chord or, at equal distances, on the arc over it.

    An arc of rise h over a chord c has the radius (c^2/4 + h^2) / (2 h) and the half angle 2 atan(2 h / c).
    """
    start, end = (np.array(pair(name, getattr(design, name), "m")) for name in ("start", "end"))
    chord, fraction = end - start, np.linspace(0.0, 1.0, elements + 1)
    rise = finite("rise", design.rise, "m")
    if rise == 0.0:
        straight: Array = start + fraction[:, None] * chord
        return straight
    length = float(np.hypot(*chord))
    half = 2.0 * np.arctan2(2.0 * rise, length)
    angle = half * (2.0 * fraction - 1.0)
    # along and across the chord as parts of it; a sine of half the angle keeps flat arcs free of cancellation
    along = 0.5 * (1.0 + np.sin(angle) / np.sin(half))
    across = (np.sin(0.5 * half) ** 2 - np.sin(0.5 * angle) ** 2) / np.sin(half)
    left = np.array([-chord[1], chord[0]])
    nodes: Array = start + along[:, None] * chord + across[:, None] * left
    return nodes
