"""Forces that turn with their bodies: they have no potential, and their tangent is not symmetric."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import AppliedLoad
from spline_model.effects.boundary import FOLLOWER
from spline_model.scene import Scene
from spline_model.tables import LoadTable

Array = NDArray[np.float64]


class Followers(NamedTuple):
    """P forces [N] that rotate with bodies.

    place (P,): of their x among the unknowns, followed by y and theta; growing, steady (P, 2): force at load
    factor 1, and at any load factor [N].
    """

    place: NDArray[np.int64]
    growing: Array
    steady: Array

    @classmethod
    def of(cls, scene: Scene, loads: LoadTable) -> Self:
        """Return those of all loads of a scene that grow, and its steady ones, among its unknowns [N]."""
        own = loads.rows(loads.turns == FOLLOWER)
        full = [each for each in scene.of(AppliedLoad) if each.follower and each.steady]
        places = [*own.coordinate[::2], *(scene.layout.bodies[each.body] for each in full)]
        force = np.concatenate((own.value.reshape(-1, 2), np.reshape([each.force for each in full], (-1, 2))))
        grows = np.arange(len(places))[:, None] < len(own.value) // 2
        return cls(np.array(places, dtype=np.int64), force * grows, force * ~grows)

    def turned(self, z: Array, load_factor: float) -> Array:
        """Return the forces (P, 2) [N] at unknowns z (N,) and a load factor [1]."""
        (x, y), turn = (load_factor * self.growing + self.steady).T, z[self.place + 2]
        cos, sin = np.cos(turn), np.sin(turn)
        return np.stack((cos * x - sin * y, sin * x + cos * y), axis=-1)

    def subtract(self, z: Array, load_factor: float, gradient: Array, hessian: Array) -> None:
        """Subtract the forces [N] from the gradient (N,), and their derivatives from its hessian (N, N).

        z (N,): unknowns [m, rad, N]; load_factor [1].
        """
        if not self.place.size:
            return
        force, at = self.turned(z, load_factor), self.place
        for k, across in enumerate((-force[:, 1], force[:, 0])):
            np.subtract.at(gradient, at + k, force[:, k])
            np.subtract.at(hessian, (at + k, at + 2), across)

    def push(self, z: Array) -> Array:
        """Return the derivative (N,) [N] of the forces in the load factor at z (N,)."""
        found = np.zeros(len(z))
        for k, part in enumerate(self._replace(steady=0.0 * self.steady).turned(z, 1.0).T):
            np.add.at(found, self.place + k, part)
        return found

    def among(self, begin: int, force: float) -> Followers:
        """Return the same divided by ``force`` [N], among coordinates whose poses begin at ``begin``."""
        if not self.place.size:
            return self
        return Followers(self.place - begin, self.growing / force, self.steady / force)


NO_FOLLOWERS = Followers(np.zeros(0, dtype=np.int64), np.zeros((0, 2)), np.zeros((0, 2)))
