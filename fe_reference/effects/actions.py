"""What acts on a motion beside its potential: loads with their histories, and dampers, as compiled tables."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix

from ..compiled import CompiledForces
from ..mass import body_blocks
from ..structure import Structure
from .kernels import (
    carry_velocity,
    drag_forces,
    grip_forces,
    load_forces,
    load_power,
    put_loads,
    viscous_forces,
)
from .loads import DeadLoad, applied, together
from .named import BodyDamping, History, StripDamping, StripDrag

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def start_load(structure: Structure) -> DeadLoad | None:
    """Return the loads as they are at the start of a motion; None if none is named."""
    loads = [
        load.scaled(float(np.interp(0.0, *np.transpose(history)))) for load, history in applied(structure)
    ]
    return together(loads)


@dataclass(frozen=True, kw_only=True, eq=False)
class Resistance:
    """Generalised force of dampers less loads (size,) [N, N m], power of the loads, power lost [W]."""

    force: Array
    load_power: float
    loss_power: float


class Actions:
    """The tables of loads and dampers of one structure; those that are not named have length zero.

    Attributes:
        dissipative: relaxation (E,), drag (nodes,), grip (B, 4). histories: targets, loads, begins, instants,
            factors, as in `kernels`.
    """

    def __init__(self, compiled: CompiledForces) -> None:
        self.compiled, self.structure = compiled, compiled.structure
        self.dissipative = (self._relaxation(), self._drag(), self._grip())
        loads = [(load, history) for load, history in applied(self.structure) if load.vector.any()]
        self.histories = _tables(self.structure, loads)
        self.pulls = np.zeros((len(loads), 3))

    @property
    def named(self) -> bool:
        """Whether there is any."""
        return self.damped or len(self.pulls) > 0

    @property
    def damped(self) -> bool:
        """Whether there are dampers."""
        return any(len(table) for table in self.dissipative)

    def _relaxation(self) -> Array:
        damping = self.structure.model.effects.find(StripDamping)
        elements = 0 if damping is None else len(self.structure.elements.length)
        return np.full(elements, 0.0 if damping is None else damping.relaxation_time)

    def _drag(self) -> Array:
        named = "strip_drag" in self.structure.model.effects
        return self.drag_rate * self.structure.nodal_masses() if named else np.zeros(0)

    @property
    def drag_rate(self) -> float:
        """Rate of the drag of the strips [1/s], zero if it is not named."""
        drag = self.structure.model.effects.find(StripDrag)
        return 0.0 if drag is None else drag.rate

    def _grip(self) -> Array:
        damping = self.structure.model.effects.find(BodyDamping)
        if damping is None:
            return np.zeros((0, 4))
        offsets = [
            b.centre - point
            for b, point in zip(self.structure.model.bodies, self.structure.points, strict=True)
        ]
        return np.array([[damping.translation, damping.rotation, *offset] for offset in offsets]).reshape(
            -1, 4
        )

    def resist(self, y: Array, v: Array, time: float) -> Resistance:
        """Return what loads and dampers exert at coordinates y, velocities v and an instant [s]."""
        s, (relaxation, drag, grip) = self.structure, self.dissipative
        (shear, first, table, attached, carrier, offsets), u = self.compiled.given, s.displacement(y)
        rates, force = np.zeros_like(u), np.zeros_like(u)
        bodies, bodies_v = (part[s.first_body :].reshape(-1, 3) for part in (y, v))
        rates[s.free_nodes] = v[: s.first_body].reshape(-1, 3)
        carry_velocity(bodies, bodies_v, attached, carrier, offsets, rates)
        loss = viscous_forces(shear, first, table, relaxation, u, rates, force, self.compiled.work[2])
        loss += drag_forces(drag, rates, force)
        nodal, resultants = self.compiled.reduced(force, bodies)
        loss += grip_forces(grip, bodies, bodies_v, resultants)
        load_forces(*self.histories, time, bodies, self.pulls)
        put_loads(self.histories[0], self.pulls, nodal, resultants)
        return Resistance(
            force=np.concatenate([nodal[s.free_nodes].ravel(), resultants.ravel()]),
            load_power=load_power(self.histories[0], self.pulls, rates, bodies_v),
            loss_power=loss,
        )

    def damping_matrix(self, y: Array) -> csc_matrix:
        """Return the derivative of the damping force in the velocities (size, size) [N s/m, N m s]."""
        s, (relaxation, drag, grip) = self.structure, self.dissipative
        local = np.zeros((6, 6, len(s.elements.length)))
        if len(relaxation):
            local += relaxation * s.law.material_tangents(s.element_displacement(y))
        if len(drag):
            half = 0.5 * self.drag_rate * s.elements.linear_density * s.elements.length
            local[[0, 1, 3, 4], [0, 1, 3, 4]] += half
        whole = s.reduced_matrix(local, y)
        return whole + body_blocks(s, y, grip[:, :2]) if len(grip) else whole

    def fastest_decay(self, y: Array, lumped: Array, mass: Array, inertia: Array) -> float:
        """Return a rate [1/s] that no ratio of damping to mass exceeds at y.

        Args:
            y: coordinates. lumped (6, E): element masses. mass, inertia (B,): of the bodies.
        """
        (relaxation, drag, grip), s, rate = self.dissipative, self.structure, 0.0
        if len(relaxation):
            root = np.sqrt(lumped).T
            material = s.law.material_tangents(s.element_displacement(y)).transpose(2, 0, 1)
            highest = np.linalg.eigvalsh(material / (root[:, :, None] * root[:, None, :]))[:, -1]
            rate += float(np.max(relaxation * highest))
        if len(drag):
            rate += self.drag_rate
        if len(grip):
            turning = grip[:, 1] + grip[:, 0] * np.sum(grip[:, 2:] ** 2, axis=1)
            rate += float(np.max(grip[:, 0] / mass + turning / inertia))
        return rate


def _tables(
    structure: Structure, loads: Sequence[tuple[DeadLoad, History]]
) -> tuple[Indices, Array, Indices, Array, Array]:
    """Return targets, rows, begins, instants and factors of loads, none zero, each on one body or node."""
    targets, rows, begins = [], np.zeros((len(loads), 5)), [0]
    for row, (load, history) in zip(rows, loads, strict=True):
        at = int(np.flatnonzero(load.vector)[0]) // 3
        bodies = structure.first_body // 3
        targets.append(at - bodies if at >= bodies else -1 - int(structure.free_nodes[at]))
        row[:3] = load.vector[3 * at : 3 * at + 3]
        row[3:] = load.offset.sum(axis=0)
        begins.append(begins[-1] + len(history))
    points = np.array([point for _, history in loads for point in history]).reshape(-1, 2)
    instants, factors = np.ascontiguousarray(points.T)
    return np.array(targets, dtype=np.int64), rows, np.array(begins, dtype=np.int64), instants, factors
