"""Where the two markers sit on the mechanism, and what their relative pose says of the body."""

import math
from dataclasses import dataclass

import numpy as np

from spline_model.pivot import Pivot
from studies.interactive.pivot.design import wrapped
from studies.kinds import Array

#: Distance of each marker's centre from the clamped plate it is glued to [m], as on the printed sheet.
STANDOFF = 0.045
#: Side of the black square [m], as printed.
SIDE = 0.06


def turned(angle: float, vector: Array) -> Array:
    """Return `vector` (2,) turned by `angle` [rad]."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def inverse(pose: Array) -> Array:
    """Return the pose (3,) of the first frame seen from the second, `pose` being that of the second in the
    first."""
    return np.array([*turned(-pose[2], -pose[:2]), -pose[2]])


@dataclass(frozen=True, kw_only=True, eq=False)
class Placing:
    """Rest places of the markers' centres in the pivot's frame (origin A1), both upright.

    Attributes:
        ground: of marker 0 (2,) [m]; rest: pose (3,) of marker 1 in marker 0's frame when the pivot is at
            rest.
        centre: of the body at rest (2,) [m].
    """

    ground: Array
    rest: Array
    centre: Array

    @classmethod
    def of(cls, pivot: Pivot) -> "Placing":
        """Return the printed sheet's placing for a design."""
        ground_plate, body_plate = (
            pivot.clamp_points[:, 0].mean(axis=0),
            pivot.clamp_points[:, 1].mean(axis=0),
        )
        ground = ground_plate - np.array([0.0, STANDOFF])
        moving = body_plate + np.array([0.0, STANDOFF])
        return cls(ground=ground, rest=np.array([*(moving - ground), 0.0]), centre=pivot.centre)

    def with_rest(self, marker: Array) -> "Placing":
        """Return the placing of markers that stand at `marker` (3,) when the pivot is at rest."""
        return Placing(ground=self.ground, rest=np.array(marker, dtype=float), centre=self.centre)

    def body(self, marker: Array, near: float = 0.0) -> Array:
        """Return the body's pose (3,) for marker 1 at `marker` in marker 0's frame, its turn counted on
        from `near`."""
        angle = near + wrapped(marker[2] - self.rest[2] - near)
        arm = self.centre - self.ground - self.rest[:2]
        return np.array([*(self.ground + marker[:2] + turned(angle, arm)), angle])

    def marker(self, body: Array) -> Array:
        """Return the pose (3,) of marker 1 in marker 0's frame for the body's pose."""
        arm = self.centre - self.ground - self.rest[:2]
        return np.array([*(body[:2] - self.ground - turned(body[2], arm)), body[2] + self.rest[2]])

    def spread(self, sd: Array) -> Array:
        """Return the standard deviations of the body's pose from those of the marker's, (3,) each."""
        arm = float(np.hypot(*(self.centre - self.ground - self.rest[:2])))
        return np.array([math.hypot(sd[0], arm * sd[2]), math.hypot(sd[1], arm * sd[2]), sd[2]])

    def looks_swapped(self, marker: Array) -> bool:
        """Return whether the markers fit the mechanism much better the other way round."""

        def strangeness(pose: Array) -> float:
            """How far the body would be from any place that bending takes it to, over the rest distance."""
            gap = self.body(pose)[:2] - self.centre
            return float(np.hypot(*gap) / np.hypot(*self.rest[:2]))

        return strangeness(marker) > 0.8 and strangeness(inverse(marker)) < 0.5 * strangeness(marker)
