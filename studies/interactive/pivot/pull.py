"""A body in an elastic hand, or under a load: where strips, spring and load balance."""

import math
from dataclasses import dataclass

import numpy as np

from spline_model.held import HeldPivot, HeldState
from studies.kinds import Array

#: Most steps of the centre in the balance, the longest over the strips' length, how often one is halved, and
#: the force that is none, over EI / L^2.
MOST_PULLS, LONGEST_PULL, HALVINGS, BALANCED = 40, 0.1, 12, 1e-7


@dataclass(frozen=True, eq=False)
class Pull:
    """A spring of some stiffness [N/m] from the body's centre to `pose` (3,), and a dead `load` (3,) on it.

    The turn, where the body `turns` freely, is measured by the way of a point at `length` [m].
    """

    pose: Array
    stiffness: float
    length: float
    turns: bool
    load: Array

    def balanced(self, held: HeldPivot, state: HeldState, least: float) -> tuple[HeldState | None, int]:
        """Return the state in which no force is out of balance, sought from the held `state` on, None where
        none is found, and the iterations; `least`: the size of forces [N]."""
        work = 0
        for _ in range(MOST_PULLS):
            force, tangent = self._force(state)
            far = self.stiffness * math.dist(self.pose[:2], state.pose[:2])
            if np.linalg.norm(force) <= BALANCED * (least + far):
                return state, work
            values, ways = np.linalg.eigh(tangent)
            step = -ways @ ((ways.T @ force) / np.abs(values))
            step *= min(1.0, LONGEST_PULL * self.length / max(float(np.linalg.norm(step)), 1e-300))
            state, used = self._lower(held, state, step)
            work += used
            if used == 0:
                break
        return None, work

    def _lower(self, held: HeldPivot, state: HeldState, step: Array) -> tuple[HeldState, int]:
        """Return the state after a step of the pose, or the part of it that lowers the energy, or the force;
        and the iterations, 0 where no part does."""
        known, before = held.unknowns, self._energy(state)
        least = np.linalg.norm(self._force(state)[0])
        for halved in range(HALVINGS):
            x, y, turn = 0.5**halved * np.append(step, np.zeros(3 - len(step)))
            pose = state.pose + np.array([x, y, turn / self.length])
            found = held.hold(float(pose[0]), float(pose[1]), float(pose[2]))
            lower = found.solved and self._energy(found) < before
            if lower or (found.solved and np.linalg.norm(self._force(found)[0]) < least):
                return found, max(1, found.iterations)
            held.restore(known)
        return state, 0

    def _force(self, state: HeldState) -> tuple[Array, Array]:
        """Return the force that is out of balance, (2,) or (3,) where the body turns, and its derivative."""
        unit, spring = np.array([1.0, 1.0, 1.0 / self.length]), self.stiffness * np.array([1.0, 1.0, 0.0])
        count = 3 if self.turns else 2
        force = (state.force - self.load + spring * (state.pose - self.pose)) * unit
        tangent = (state.tangent + np.diag(spring)) * np.outer(unit, unit)
        return force[:count], tangent[:count, :count]

    def _energy(self, state: HeldState) -> float:
        """Return the energy of strips, spring and load [J]."""
        away = state.pose[:2] - self.pose[:2]
        stored = state.bending_energy + state.axial_energy + 0.5 * self.stiffness * float(away @ away)
        return stored - float(self.load[:2] @ away)
