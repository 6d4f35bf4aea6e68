"""All that resists a motion: the gradient of the potential, dampers and loads, compiled.

Every effect has its own table, of length zero where the scene does not name it:

    relaxation (E,)      relaxation time of the elements [s]: material tangent times velocity times it
    drag (nodes,)        drag coefficient of the nodes [N s/m]
    grip (B, 4)          dampers of the bodies: translation, rotation, and the offset of the centre
"""

from dataclasses import dataclass, field

import numpy as np

from .arrays import Array, Indices, inlined, kernel
from .effects import BodyDamping, StripDamping, StripDrag
from .law import FORCES, MATERIAL, Written, elements
from .links import Links, add_links, fastest, link_forces
from .loads import Histories, applied, load_forces, load_power, load_tables, put_loads
from .mass import body_blocks, couple
from .matrix import Symmetric
from .mesh import (
    RESULTANTS,
    Pair,
    Tables,
    body_forces,
    carry,
    carry_velocity,
    gravity_energy,
    spring_forces,
    turned,
)
from .structure import Structure

#: What acts in a motion, and the displacements and velocities of nodes and of bodies that it acts at.
Acting = tuple[Tables, tuple[Array, Array, Array], Links, Histories, Written, Pair]
State = tuple[Array, Array, Array, Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Instant:
    """A motion at an instant, and what resists it there.

    Attributes:
        time [s]. y, v, a (size,): coordinates, velocities, accelerations.
        force (size,): what resists [N, N m]. strain, gravity: energies [J].
        load_power, loss_power: of the loads, and lost in dampers [W].
    """

    time: float
    y: Array
    v: Array
    force: Array
    strain: float
    gravity: float
    load_power: float
    loss_power: float
    a: Array = field(default_factory=lambda: np.zeros(0))


class Actions:
    """The tables of one structure, and the arrays that the compiled loops write.

    Attributes:
        dissipative: relaxation (E,), drag (nodes,), grip (B, 4). histories: tables of the loads.
        written: as of `law.elements`. resultants: of the bodies (B, 5), and the forces (K, 3) of the loads.
        acting: all of it, for `_act`. coupled: bodies that are led one way, as in `mass`.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        effects, many = structure.model.effects, len(structure.numbers)
        damping, drag = effects.find(StripDamping), effects.find(StripDrag)
        relaxation = np.full(0 if damping is None else many, damping.relaxation_time if damping else 0.0)
        self.drag_rate = 0.0 if drag is None else drag.rate
        dragged = np.zeros(0) if drag is None else drag.rate * structure.nodal_masses()
        self.dissipative = (relaxation, dragged, self._grip())
        self.damped = any(len(table) for table in self.dissipative) or bool(structure.links[3].any())
        pulls = [pull for pull in applied(structure) if pull.row[:3].any()]
        self.named = self.damped or bool(pulls)
        self.histories, (force, scratch) = load_tables(pulls), structure.work
        self.written = (force, np.zeros((many, 5)), np.zeros((len(relaxation), 6, 6)), scratch)
        self.resultants = (np.zeros((len(structure.points), RESULTANTS)), np.zeros((len(pulls), 3)))
        tables = (structure.tables, self.dissipative, structure.links, self.histories)
        self.acting: Acting = (*tables, self.written, self.resultants)
        self.coupled = np.zeros((0, 7))

    def _grip(self) -> Array:
        model, points = self.structure.model, self.structure.points
        damping = model.effects.find(BodyDamping)
        if damping is None:
            return np.zeros((0, 4))
        offsets = [body.centre - point for body, point in zip(model.bodies, points, strict=True)]
        rows = [[damping.translation, damping.rotation, *offset] for offset in offsets]
        return np.array(rows).reshape(-1, 4)

    def resist(self, y: Array, v: Array, time: float) -> Instant:
        """Return what resists at coordinates y, velocities v and an instant [s]."""
        s, u = self.structure, self.structure.displacement(y)
        bodies, rates = s.bodies(y), s.bodies(v)
        strain, power, loss = _act(self.acting, (u, s.velocity(y, v), bodies, rates), time)
        couple(self.coupled, bodies, rates, self.resultants[0])
        force = s.gathered(self.written[0], self.resultants[0][:, :3])
        gravity = float(gravity_energy(s.tables[2], bodies, u))
        return Instant(
            time=time,
            y=y,
            v=v,
            force=force,
            strain=strain,
            gravity=gravity,
            load_power=power,
            loss_power=loss,
        )

    def damping_matrix(self, y: Array) -> Symmetric:
        """Return the derivative of the damping force in the velocities (size, size) [N s/m, N m s]."""
        s, (relaxation, drag, grip) = self.structure, self.dissipative
        local = np.zeros((len(s.numbers), 8, 8))
        if len(relaxation):
            local += relaxation[:, None, None] * s.evaluate(y, asked=MATERIAL).matrices
        if len(drag):
            half = 0.5 * self.drag_rate * s.elements.linear_density * s.elements.length
            local[:, [0, 1, 3, 4], [0, 1, 3, 4]] += half[:, None]
        whole = s.reduced_matrix(local, y)
        s.add_springs(whole, relaxation[0] if len(relaxation) else 0.0)
        if len(grip):
            body_blocks(s, y, grip[:, :2], whole)
        add_links(s.links, y[s.turns], s.links[3], whole)
        return whole

    def fastest_decay(self, material: float, mass: Array, inertia: Array) -> float:
        """Return a rate [1/s] that no ratio of damping to mass exceeds.

        Args:
            material: squared frequency of the strips' strains alone [1/s^2]. mass, inertia (B,): of bodies.
        """
        (relaxation, _, grip), rate = self.dissipative, self.drag_rate
        if len(relaxation):
            rate += float(relaxation[0]) * material
        if len(grip):
            turning = grip[:, 1] + grip[:, 0] * np.sum(grip[:, 2:] ** 2, axis=1)
            rate += float(np.max(grip[:, 0] / mass + turning / inertia))
        links = self.structure.links
        return rate + fastest(links, links[3], mass, inertia)


@kernel()
def _viscous_forces(relaxation: Array, first: Indices, matrices: Array, v: Array, force: Array) -> float:
    """Add the forces of Kelvin-Voigt strips at velocities v (nodes, 3); return the power they take [W]."""
    power = 0.0
    for e in range(len(relaxation)):
        for i in range(6):
            node, part, total = first[e] + i // 3, i % 3, 0.0
            for j in range(6):
                total += matrices[e, i, j] * v[first[e] + j // 3, j % 3]
            total *= relaxation[e]
            force[node, part] += total
            power += total * v[node, part]
    return power


@kernel()
def _drag_forces(drag: Array, v: Array, force: Array) -> float:
    """Add the drag of the nodes; return the power it takes [W]."""
    power = 0.0
    for i in range(len(drag)):
        for k in range(2):
            force[i, k] += drag[i] * v[i, k]
            power += drag[i] * v[i, k] * v[i, k]
    return power


@kernel()
def _grip_forces(grip: Array, bodies: Array, bodies_v: Array, out: Array) -> float:
    """Add the dampers of the bodies to their resultants (B, 3); return the power they take [W]."""
    power = 0.0
    for b in range(len(grip)):
        x, y = turned(bodies[b, 2], grip[b, 2], grip[b, 3])
        v_x, v_y = bodies_v[b, 0] - bodies_v[b, 2] * y, bodies_v[b, 1] + bodies_v[b, 2] * x
        moment = grip[b, 1] * bodies_v[b, 2]
        out[b, 0] += grip[b, 0] * v_x
        out[b, 1] += grip[b, 0] * v_y
        out[b, 2] += moment + grip[b, 0] * (x * v_y - y * v_x)
        power += grip[b, 0] * (v_x * v_x + v_y * v_y) + moment * bodies_v[b, 2]
    return power


@inlined()
def _act(acting: Acting, state: State, time: float) -> tuple[float, float, float]:
    """Write all that resists on nodes and bodies; return strain energy, power of the loads, power lost."""
    (given, carried, weights, springs), (relaxation, drag, grip), links, histories, written, sums = acting
    resultants, pulls = sums
    u, v, bodies, bodies_v = state
    (_, _, first, _), (force, _, matrices, _), targets, loss = given, written, histories[0], 0.0
    strain = elements(given, 1.0, MATERIAL if len(relaxation) else FORCES, u, written)
    if len(relaxation) or len(drag):
        loss += _viscous_forces(relaxation, first, matrices, v, force) + _drag_forces(drag, v, force)
    body_forces(1.0, bodies, carried, weights, force, resultants)
    time_of = relaxation[0] if len(relaxation) else 0.0
    slip, lost = spring_forces(springs, time_of, (bodies, bodies_v), (u, v), force, resultants)
    loss += lost + _grip_forces(grip, bodies, bodies_v, resultants)
    if len(links[0]) > 0:
        stored, lost = link_forces(links, bodies, bodies_v, resultants)
        slip, loss = slip + stored, loss + lost
    load_forces(histories, time, u, bodies, pulls)
    put_loads(targets, pulls, force, resultants)
    return strain[0] + strain[1] + strain[2] + slip, load_power(targets, pulls, v, bodies_v), loss


@kernel()
def _move(compliance: Array, force: Array, step: float, v: Array, u: Array) -> None:
    """Advance velocities and places (rows, 3) by one step under `force`: v -= h c f, u += h v."""
    for i in range(len(u)):
        for k in range(3):
            v[i, k] -= step * compliance[i, k] * force[i, k]
            u[i, k] += step * v[i, k]


@kernel()
def advance(
    acting: Acting,
    coupled: Array,
    compliance: Pair,
    state: State,
    totals: Array,
    time: float,
    step: float,
    steps: int,
) -> None:
    """Make `steps` steps of the central difference scheme in place: v is half a step behind u.

    v += h a(u, v), u += h v for the free nodes (`compliance`: 1/mass (nodes, 3) there, else 0) and the
    bodies, whose rows of zero are led; dampers act at the velocities before the step. `totals` gathers the
    work of loads and drives, exactly that of the scheme, and the energy that the dampers dissipate [J].
    """
    (_, carried, _, _), dissipative, _, histories, written, (resultants, pulls) = acting
    u, v, bodies, bodies_v = state
    viscous = len(dissipative[0]) > 0 or len(dissipative[1]) > 0
    for n in range(steps):
        if viscous:
            carry_velocity(bodies, bodies_v, carried, v)
        _, power, loss = _act(acting, state, time + n * step)
        if len(coupled) > 0:
            couple(coupled, bodies, bodies_v, resultants)
        for b in range(len(bodies)):
            for k in range(3):
                if compliance[1][b, k] == 0.0:
                    totals[0] += step * resultants[b, k] * bodies_v[b, k]
        _move(compliance[0], written[0], step, v, u)
        _move(compliance[1], resultants, step, bodies_v, bodies)
        totals[0] += 0.5 * step * (power + load_power(histories[0], pulls, v, bodies_v))
        totals[1] += step * loss
        carry(bodies, carried, u)
