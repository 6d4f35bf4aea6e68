"""The strip ends that rigid bodies carry, and the exact master-slave map that moves them.

An end at the offset b from the reference point of its body follows without penalty or extra unknowns:

    u = d + (R(theta) - 1) b,    phi = theta

with displacement d of that point and turn theta of the body. Forces are reduced by the transpose of the
derivative P of the map; the tangent is P^T K P plus the curvature of the map, -(R b).f on the diagonal entry
of theta, with f the force of the element on the end.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2


class Attachments:
    """The K attached ends of a model whose bodies have the reference points (B, 2) [m].

    Attributes:
        body (K,): index of the carrying body. node (K,): the node it carries. element (K,): that there.
        row (K,): 0 if the end is the element's first node, 3 if it is the second.
        offsets (K, 2): from the reference point of the body at rest [m].
    """

    def __init__(self, model: "Model", points: Array) -> None:
        stations = len(model.strips[0].nodes)
        first = [(g, 0, strip.root) for g, strip in enumerate(model.strips) if strip.root >= 0]
        last = [(g, 1, strip.tip) for g, strip in enumerate(model.strips) if strip.tip >= 0]
        strip, end, self.body = np.array([*first, *last], dtype=np.int64).reshape(-1, 3).T
        self.node: Indices = strip * stations + end * (stations - 1)
        self.element: Indices = strip * (stations - 1) + end * (stations - 2)
        self.row: Indices = 3 * end
        rest = np.concatenate([each.nodes for each in model.strips])
        self.offsets: Array = rest[self.node] - points[self.body]
        self.bodies = len(points)

    def arms(self, theta: Array) -> Array:
        """Return the offsets turned with the bodies at theta (B,), (K, 2) [m]."""
        c, s = np.cos(theta)[self.body], np.sin(theta)[self.body]
        x, y = self.offsets.T
        return np.stack([c * x - s * y, s * x + c * y], axis=1)

    def displacement(self, bodies: Array) -> Array:
        """Return displacement and turn (K, 3) of the ends for those of the bodies (B, 3) [m, rad]."""
        place = bodies[self.body]
        s, less = np.sin(place[:, 2]), 2.0 * np.sin(0.5 * place[:, 2]) ** 2
        x, y = self.offsets.T
        # R - 1 written with sines: no cancellation at small turns
        moved: Array = place + np.stack([-less * x - s * y, s * x - less * y, np.zeros_like(x)], axis=1)
        return moved

    def velocity(self, bodies: Array, rates: Array) -> Array:
        """Return the rates (K, 3) of the ends for coordinates and rates of the bodies (B, 3) [m/s, rad/s]."""
        rate, slope = rates[self.body], self.slopes(bodies[:, 2])
        return rate + np.pad(rate[:, 2:] * slope, ((0, 0), (0, 1)))

    def slopes(self, theta: Array) -> Array:
        """Return d u / d theta of the ends, (K, 2) [m]."""
        arms = self.arms(theta)
        return np.stack([-arms[:, 1], arms[:, 0]], axis=1)

    def reduce_forces(self, forces: Array, theta: Array) -> Array:
        """Return element forces (6, E) with the moments at attached ends taken about the bodies' points."""
        local, (row, end) = forces.copy(), (self.row, self.element)
        slope_x, slope_y = self.slopes(theta).T
        local[row + 2, end] += slope_x * local[row, end] + slope_y * local[row + 1, end]
        return local

    def reduce_matrices(self, matrices: Array, theta: Array) -> Array:
        """Return element matrices (6, 6, E) with both sides reduced likewise."""
        local, (row, end) = matrices.copy(), (self.row, self.element)
        slope_x, slope_y = self.slopes(theta).T[:, :, None]
        local[row + 2, :, end] += slope_x * local[row, :, end] + slope_y * local[row + 1, :, end]
        local[:, row + 2, end] += slope_x.T * local[:, row, end] + slope_y.T * local[:, row + 1, end]
        return local

    def curvature(self, forces: Array, theta: Array) -> Array:
        """Return what the map adds to the stiffness of the turns (B,) [N m] under element forces (6, E)."""
        pull = np.stack([forces[self.row, self.element], forces[self.row + 1, self.element]], axis=1)
        added: Array = np.zeros(self.bodies)
        np.subtract.at(added, self.body, np.sum(self.arms(theta) * pull, axis=1))
        return added
