"""Frames that bodies carry: points of a body, free to turn, at which strips are hinged or loads act."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import Carried
from spline_model.effects.base import Constraint
from spline_model.scene import Scene

Array = NDArray[np.float64]


class Frames(NamedTuple):
    """C frames with the constraints psi = r_frame - r - R(theta) o = 0 [m, m, rad].

    place (C, 3): of the frame's x, of its body's x and of its first multiplier among the unknowns; lever (C,
    2): o at rest [m].
    """

    place: NDArray[np.int64]
    lever: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Those of a scene, among its unknowns [m]."""
        layout, places, levers = scene.layout, [], []
        for each, (row, _) in zip(scene.of(Constraint), layout.multipliers, strict=True):
            if isinstance(each, Carried):
                places.append((layout.bodies[each.body], layout.bodies[each.by], row))
                levers.append(scene.body(each.body).centre - scene.body(each.by).centre)
        place = np.array(places, dtype=np.int64).reshape(-1, 3)
        return cls(place, np.array(levers, dtype=float).reshape(-1, 2))

    def subtract(self, z: Array, gradient: Array, hessian: Array) -> None:
        """Subtract lambda psi, its gradient and its Hessian; lambda: force of the body on the frame."""
        for (frame, body, row), (x, y) in zip(self.place.tolist(), self.lever.tolist(), strict=True):
            (own, carrier, rows), turn = (slice(at, at + 2) for at in (frame, body, row)), body + 2
            cos, sin = np.cos(z[turn]), np.sin(z[turn])
            arm = np.array((cos * x - sin * y, sin * x + cos * y))
            across, force = np.array((-arm[1], arm[0])), z[rows]
            gradient[rows] -= z[own] - z[carrier] - arm
            gradient[own] -= force
            gradient[carrier] += force
            gradient[turn] += force @ across
            hessian[rows, own] -= np.eye(2)
            hessian[own, rows] -= np.eye(2)
            hessian[rows, carrier] += np.eye(2)
            hessian[carrier, rows] += np.eye(2)
            hessian[rows, turn] += across
            hessian[turn, rows] += across
            hessian[turn, turn] -= force @ arm

    def spread(self, y: Array, pull: Array) -> tuple[Array, Array]:
        """Change of coordinates y (Y,) by those that are left as frames go with their bodies (Y, Y), and what
        turning levers add to the stiffness (Y, Y) under a pull (Y,), the gradient of all on the frames."""
        by, bend = np.eye(len(y)), np.zeros((len(y), len(y)))
        for frame, body, _ in self.place.tolist():
            arm = y[frame : frame + 2] - y[body : body + 2]
            by[frame : frame + 2] = 0.0
            by[frame : frame + 2, body : body + 2] = np.eye(2)
            by[frame : frame + 2, body + 2] = -arm[1], arm[0]
            bend[body + 2, body + 2] -= arm @ pull[frame : frame + 2]
        return by, bend

    @property
    def coordinates(self) -> NDArray[np.int64]:
        """Places of the frames' x and y (2 C,)."""
        return (self.place[:, :1] + np.arange(2)).ravel()

    @property
    def rows(self) -> NDArray[np.int64]:
        """Places of their multipliers (2 C,)."""
        return (self.place[:, 2:] + np.arange(2)).ravel()

    def among(self, begin: int, length: float) -> Frames:
        """The same over a length, among coordinates that begin with the poses at ``begin``."""
        return Frames(self.place - begin, self.lever / length) if self.place.size else self


NO_FRAMES = Frames(np.zeros((0, 3), dtype=np.int64), np.zeros((0, 2)))
