"""The ends of the strips, and the bodies that carry them: free ends are bodies without mass."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import BodyGravity, Clamp
from spline_model.effects.base import Constraint
from spline_model.reduced.arrays import Bodies
from spline_model.strip.element import GROUNDED
from spline_model.tables import steady_loads

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class End:
    """An end of a strip: its body or GROUNDED, point there [m], direction at rest, row of its clamp or -1."""

    body: int
    point: tuple[float, float]
    direction: float
    row: int


Ends = dict[tuple[str, str], End]
"""Ends by (strip, \"start\" or \"end\")."""


def ends_of(system: System) -> Ends:
    """Both ends of all strips by (strip, end); a free end is a body of its own, behind the scene's."""
    scene, free = system.scene, len(system.scene.bodies)
    ends: Ends = {}
    bodies = {body.name: (i, body.centre.tolist()) for i, body in enumerate(scene.bodies)}
    clamps: dict[tuple[str, str], tuple[str, int]] = {
        (c.strip, c.end): (c.to, system.layout.rows(i).start)
        for i, c in enumerate(scene.of(Constraint))
        if isinstance(c, Clamp)
    }
    for strip in scene.strips:
        points = strip.control_points.tolist()
        for end, at, inner, sign in (("start", 0, 1, 1.0), ("end", -1, -2, -1.0)):
            (x, y), (there_x, there_y) = points[at], points[inner]
            direction = math.atan2(sign * (there_y - y), sign * (there_x - x))
            if (strip.name, end) not in clamps:
                ends[strip.name, end] = End(body=free, point=(0.0, 0.0), direction=direction, row=-1)
                free += 1
                continue
            to, row = clamps[strip.name, end]
            body, (left, low) = bodies.get(to, (GROUNDED, (0.0, 0.0)))
            ends[strip.name, end] = End(body=body, point=(x - left, y - low), direction=direction, row=row)
    return ends


def bodies_of(system: System, ends: Ends, outer: int) -> Bodies | None:
    """The bodies and what acts on them; None where a load acts on a clamped end."""
    scene, layout, loads, drives = system.scene, system.layout, system.loads, system.drives
    length, force = system.scales.length, system.scales.energy / system.scales.length
    rest = [v for body in scene.bodies for v in (*(at / length for at in body.centre.tolist()), 0.0)]
    places = {
        layout.bodies[body.name] + k: 3 * i + k for i, body in enumerate(scene.bodies) for k in range(3)
    }
    for strip in scene.strips:
        start, count = layout.strips[strip.name]
        for end, at in (("start", start), ("end", start + 2 * count - 2)):
            if ends[strip.name, end].row < 0:
                for k in range(2):
                    places[at + k] = len(rest) + k
                point = strip.control_points[0 if end == "start" else -1]
                rest += [*(point / length), 0.0]
    load, weight = np.zeros(len(rest) + outer), np.zeros(len(rest) + outer)
    for coordinate, value in zip(loads.coordinate.tolist(), loads.value.tolist(), strict=True):
        if coordinate not in places:
            return None
        load[places[coordinate]] += value
    for coordinate, value in steady_loads(scene, layout):
        if coordinate not in places:
            return None
        weight[places[coordinate]] += value
    for gravity in scene.of(BodyGravity):
        at = places[layout.bodies[gravity.body]]
        weight[at : at + 2] += gravity.mass * np.asarray(gravity.acceleration)
    for part in (load, weight):
        part[: len(rest)] /= force
        part[2 : len(rest) : 3] /= length
    held, turns = [places[c] for c in drives.coordinate.tolist()], drives.turns.tolist()
    if len(set(held)) != len(held):
        return None
    return Bodies(
        rest=np.array(rest),
        load=load,
        weight=weight,
        free=np.array([i for i in range(len(rest) + outer) if i not in held], dtype=np.int64),
        held=np.array(held, dtype=np.int64),
        driven=turns.index(1) if 1 in turns else -1,
    )
