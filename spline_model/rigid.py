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
    rows = [_row(scene, parts, drive.body, axis) for drive in scene.of(Driven) for axis in drive.parts]
    for frame in (body for body in scene.bodies if body.on is not None):
        for axis in range(2):
            at = 0.0 if frame.on == GROUND else _row(scene, parts, str(frame.on), axis, frame.centre)
            rows.append(_row(scene, parts, frame.name, axis) - at)
    for spring in scene.of(Spring):
        for axis in range(3):
            if spring.stiffness[axis] > 0.0:
                other = 0.0 if spring.other is None else _row(scene, parts, spring.other, axis)
                rows.append(_row(scene, parts, spring.body, axis) - other)
    for body in (body for part in parts for body in part):
        for axis in range(3):
            row = _row(scene, parts, body.name, axis)
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
    at = {name: name for name in (GROUND, *(body.name for body in scene.bodies))}

    def root(name: str) -> str:
        while at[name] != name:
            name = at[name]
        return name

    ends: dict[str, list[str]] = {}
    for clamp in scene.of(Constraint):
        if isinstance(clamp, Clamp):
            ends.setdefault(clamp.strip, []).append(clamp.to)
    ends |= {body.name: [body.name, body.on] for body in scene.bodies if body.on and not body.turns}
    for first, *others in ends.values():
        for other in others:
            at[root(other)] = root(first)
    parts: dict[str, list[Body]] = {}
    for body in scene.bodies:
        parts.setdefault(root(body.name), []).append(body)
    return [part for name, part in parts.items() if name != root(GROUND)]


def _row(scene: Scene, parts: list[list[Body]], name: str, axis: int, point: Array | None = None) -> Array:
    """Rate of a coordinate of a body, or of a point of it, as each part moves and turns about its first body
    (3 P,)."""
    rates, at = np.zeros((len(parts), 3)), scene.body(name).centre if point is None else point
    for rate, part in zip(rates, parts, strict=True):
        if name in [body.name for body in part]:
            x, y = (at - part[0].centre).tolist()
            size = max((math.dist(each.centre, part[0].centre) for each in part), default=0.0) or 1.0
            rate[:] = ((1.0, 0.0, -y / size), (0.0, 1.0, x / size), (0.0, 0.0, 1.0 / size))[axis]
    return rates.ravel()


def _rank(rows: list[Array]) -> int:
    sizes = [float(np.linalg.norm(row)) or 1.0 for row in rows]
    return int(np.linalg.matrix_rank(np.array(rows) / np.array(sizes)[:, None], RANK)) if rows else 0


def _prop(body: str, axis: int) -> Constraint:
    if axis == 2:
        return DrivenRotation(body=body, angle=0.0, prop=True)
    return DrivenDisplacement(body=body, displacement=(0.0, None) if axis == 0 else (None, 0.0), prop=True)
