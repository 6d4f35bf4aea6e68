"""Loads fixed in space: weight, dead forces and moments on bodies, forces at free ends.

A force F at the offset b from the reference point of a body that has moved by d and turned by theta does the
work F.(d + (R(theta) - 1) b); its generalised force on theta is (R b) x F, whose derivative is -(R b).F.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .named import AppliedForce, AppliedMoment, Gravity, History, TipForce

if TYPE_CHECKING:
    from ..structure import Structure

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class DeadLoad:
    """Forces and moments fixed in space.

    Attributes:
        vector (size,): on the coordinates, moments of forces off the reference points left out [N, N m].
        turns (K,): coordinate of the turn of the body that force k acts on.
        force (K, 2): [N]. offset (K, 2): of its point from the body's reference point at rest [m].
    """

    vector: Array
    turns: Indices
    force: Array
    offset: Array

    def _arms(self, y: Array) -> Array:
        c, s = np.cos(y[self.turns]), np.sin(y[self.turns])
        x, z = self.offset.T
        return np.stack([c * x - s * z, s * x + c * z], axis=1)

    def generalised(self, y: Array) -> Array:
        """Return the generalised force at y, (size,) [N, N m]."""
        arms, total = self._arms(y), self.vector.copy()
        np.add.at(total, self.turns, arms[:, 0] * self.force[:, 1] - arms[:, 1] * self.force[:, 0])
        return total

    def work(self, y: Array) -> float:
        """Return the work done by the full load from rest to y [J]."""
        return float(self.vector @ y) + float(np.sum(self.force * (self._arms(y) - self.offset)))

    def curvature(self, y: Array) -> Array:
        """Return what the load takes from the stiffness of the turns, -(R b).F for each force (K,) [N m]."""
        taken: Array = -np.sum(self._arms(y) * self.force, axis=1)
        return taken

    def scaled(self, factor: float) -> "DeadLoad":
        """Return the load times a factor."""
        return DeadLoad(
            vector=factor * self.vector, turns=self.turns, force=factor * self.force, offset=self.offset
        )


def together(loads: Sequence[DeadLoad]) -> DeadLoad | None:
    """Return the sum of loads as one; None if there are none."""
    if not loads:
        return None
    return DeadLoad(
        vector=np.sum([load.vector for load in loads], axis=0),
        turns=np.concatenate([load.turns for load in loads]),
        force=np.concatenate([load.force for load in loads]),
        offset=np.concatenate([load.offset for load in loads]),
    )


def weight(structure: "Structure", gravity: Gravity) -> DeadLoad:
    """Return the weight of the strips, half of every element at each of its nodes, and of the bodies.

    The error of the lumping is of second order in the element length. What hangs on a clamp is not felt.
    """
    g, ends = np.array(gravity.acceleration), structure.attachments
    nodes, vector = structure.nodal_masses(), np.zeros(structure.size)
    vector[: structure.first_body].reshape(-1, 3)[:, :2] = nodes[structure.free_nodes, None] * g
    masses, moments = body_masses(structure, nodes[ends.node])
    for k, (mass, moment) in enumerate(zip(masses, moments, strict=True)):
        at = structure.body_slice(k)
        vector[at.start : at.start + 2] = mass * g
        moments[k] = moment / mass if mass > 0.0 else 0.0
    return DeadLoad(vector=vector, turns=structure.turns, force=masses[:, None] * g, offset=moments)


def body_masses(structure: "Structure", attached: Array) -> tuple[Array, Array]:
    """Return masses (B,) [kg] of bodies with attached masses (K,), and first moments (B, 2) [kg m]."""
    ends, bodies = structure.attachments, structure.model.bodies
    masses = np.array([body.mass for body in bodies])
    centres = np.array([body.centre for body in bodies]).reshape(-1, 2)
    moments = masses[:, None] * (centres - structure.points)
    np.add.at(moments, ends.body, attached[:, None] * ends.offsets)
    np.add.at(masses, ends.body, attached)
    return masses, moments


def applied(structure: "Structure") -> list[tuple[DeadLoad, History]]:
    """Return the named loads of a scene with their histories."""
    effects, loads = structure.model.effects, []
    if (force := effects.find(AppliedForce)) is not None:
        loads.append((at_body(structure, force.body, force=force.force), force.history))
    if (moment := effects.find(AppliedMoment)) is not None:
        loads.append((at_body(structure, moment.body, moment=moment.moment), moment.history))
    if (tip := effects.find(TipForce)) is not None:
        loads.append((at_tip(structure, tip), tip.history))
    return loads


def at_body(
    structure: "Structure",
    name: str | None,
    *,
    force: Sequence[float] = (0.0, 0.0),
    moment: float = 0.0,
) -> DeadLoad:
    """Return a dead force [N] at the centre of a body (None: the only one) and a moment [N m] on it."""
    k = structure.model.body_index(name)
    vector, at = np.zeros(structure.size), structure.body_slice(k)
    vector[at] = *force, moment
    offset = structure.model.bodies[k].centre - structure.points[k]
    off = np.flatnonzero([np.any(offset != 0.0)])
    return DeadLoad(
        vector=vector,
        turns=structure.turns[[k]][off],
        force=np.array([force], dtype=float)[off],
        offset=offset[None][off],
    )


def at_tip(structure: "Structure", tip: TipForce) -> DeadLoad:
    """Return a dead force at the free end of a strip."""
    g = structure.model.strip_index(tip.strip)
    node = (g + 1) * structure.stations - 1
    vector, place = np.zeros(structure.size), 3 * int(np.flatnonzero(structure.free_nodes == node)[0])
    vector[place : place + 2] = tip.force
    none = np.zeros((0, 2))
    return DeadLoad(vector=vector, turns=structure.turns[:0], force=none, offset=none)
