"""Rigid motions that nothing holds: of parts of a scene that no strip ties to the ground.

Such a motion has no stiffness, so that a path is followed with just as many coordinates held, its props. In
equilibrium they bear nothing; where they bear something, there is no equilibrium.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Clamp, Driven, DrivenDisplacement, DrivenRotation, Spring
from spline_model.effects.base import Constraint
from spline_model.effects.boundary import GROUND
from spline_model.errors import InvalidParameter
from spline_model.scene import Body, Scene

Array = NDArray[np.float64]

RANK = 1e-9
"""Singular value, relative, below which drives do not hold a motion."""
BORNE = 1e-8
"""Largest reaction of a prop in equilibrium, in EI/L^2 and EI/L, beside that part of the largest load."""
WAYS = ("along x", "along y", "against turning")
UNITS = ("N", "N", "N m")


class Unheld(InvalidParameter):
    """A rigid motion that nothing holds, and a load along it: there is no equilibrium."""


def props_of(scene: Scene) -> list[Constraint]:
    """Return the props where rigid motions are free, to stand behind all other constraints."""
    parts, props = loose(scene), []  # type: list[list[Body]], list[Constraint]
    rates = _rates(scene, parts)
    rows = [rates[drive.body][axis] for drive in scene.of(Driven) for axis in drive.parts]
    for frame in (body for body in scene.bodies if body.on is not None):
        own, at = rates[frame.name], rates[str(frame.on)]
        x, y = frame.centre if frame.on == GROUND else frame.centre - scene.body(str(frame.on)).centre
        rows += [own[0] - at[0] + y * at[2], own[1] - at[1] - x * at[2]]
    for spring in scene.of(Spring):
        between = rates[spring.body] - rates[spring.other or GROUND]
        rows += list(between[np.array(spring.stiffness) > 0.0])
    for body in (body for part in parts for body in part):
        for axis, row in enumerate(rates[body.name]):
            if _rank([*rows, row]) > _rank(rows):
                rows.append(row)
                props.append(_prop(body.name, axis))
    return props


def require_unborne(system: System, reactions: Array) -> None:
    """Check that props bear nothing: reactions (S, D) of the drives [N, N m].

    Raises Unheld where one bears something.
    """
    drives = system.drives
    if not drives.prop.any():
        return
    largest = float(np.abs(system.loads.value).max(initial=0.0))
    for d, row in enumerate(drives.row.tolist()):
        most = float(np.abs(reactions[:, d]).max(initial=0.0))
        if drives.prop[d] and most > BORNE * (system.scales.unit[row] + largest):
            name, axis = system.layout.coordinate_of(int(drives.coordinate[d]))
            load, way = f"{most:.4g} {UNITS[axis]}", WAYS[axis]
            expected = f"none, or a clamp, a pin or a drive: nothing holds body {name} {way}"
            raise Unheld(f"load on body {name} {way}", load, expected)


def loose(scene: Scene) -> list[list[Body]]:
    """Return the bodies that strips connect with each other but not with the ground, part by part."""
    links = {body.name: {body.name, body.on} for body in scene.bodies if body.on and not body.turns}
    for clamp in scene.of(Clamp):
        links.setdefault(clamp.strip, set()).add(clamp.to)
    groups: list[set[str]] = [{GROUND}, *({body.name} for body in scene.bodies)]
    for link in links.values():
        joined = set().union(*(group for group in groups if group & link))
        groups = [joined, *(group for group in groups if not group & link)]
    parts = [[b for b in scene.bodies if b.name in group] for group in groups if GROUND not in group]
    return sorted(parts, key=lambda part: scene.bodies.index(part[0]))


def _rates(scene: Scene, parts: list[list[Body]]) -> dict[str, Array]:
    """Rates (3, 3 P) of the coordinates of the bodies, and of the ground, as each of P parts moves and turns
    about its first body."""
    rates = {name: np.zeros((3, 3 * len(parts))) for name in (GROUND, *(body.name for body in scene.bodies))}
    for i, part in enumerate(parts):
        size = max(math.dist(each.centre, part[0].centre) for each in part) or 1.0
        for body in part:
            x, y = (body.centre - part[0].centre).tolist()
            turns = (1.0, 0.0, -y / size), (0.0, 1.0, x / size), (0.0, 0.0, 1.0 / size)
            rates[body.name][:, 3 * i : 3 * i + 3] = turns
    return rates


def _rank(rows: list[Array]) -> int:
    sizes = [float(np.linalg.norm(row)) or 1.0 for row in rows]
    return int(np.linalg.matrix_rank(np.array(rows) / np.array(sizes)[:, None], RANK)) if rows else 0


def _prop(body: str, axis: int) -> Constraint:
    if axis == 2:
        return DrivenRotation(body=body, angle=0.0, prop=True)
    return DrivenDisplacement(body=body, displacement=(0.0, None) if axis == 0 else (None, 0.0), prop=True)
