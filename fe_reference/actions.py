"""All that resists a motion: the gradient of the potential, dampers and loads, compiled.

Every effect has its own table, of length zero where the scene does not name it; of the strips' dampers

    relaxation (E,)      relaxation time of the elements [s]: material tangent times velocity times it
    drag (nodes,)        drag coefficient of the nodes [N s/m]
"""

from dataclasses import dataclass, field

import numpy as np

from .arrays import Array, Indices, inlined, kernel
from .effects import StripDamping, StripDrag
from .law import FORCES, MATERIAL, Written, elements
from .loads import Histories, Pulls, add_links, link_forces, load_power, pull, put_factors
from .mass import couple
from .matrix import Symmetric
from .places import carry, carry_velocity, gather
from .structure import Structure, Tables

#: What acts in a motion, with what it is written to.
Acting = tuple[Tables, tuple[Array, Array], Pulls, Histories, Written, Array]
#: Displacements and velocities of all rows that it acts at.
State = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
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
        dissipative: relaxation (E,), drag (nodes,); drag_rate [1/s]. damped: whether there are dampers.
        written: as of `law.elements`.
        acting: all of it, for `_act`. coupled: bodies that are led one way, as in `mass`.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        effects, many = structure.model.effects, len(structure.element_numbers)
        damping, drag = effects.find(StripDamping), effects.find(StripDrag)
        relaxation = np.full(0 if damping is None else many, damping.relaxation_time if damping else 0.0)
        self.drag_rate = 0.0 if drag is None else drag.rate
        dragged = np.zeros(0) if drag is None else drag.rate * structure.nodal_masses()
        self.dissipative = (relaxation, dragged)
        self.damped = any(len(table) for table in self.dissipative) or bool(structure.links[4].any())
        force, scratch, _ = structure.work
        self.written = (force, np.zeros((many, 5)), np.zeros((len(relaxation), 6, 6)), scratch)
        tables = (structure.tables, self.dissipative, structure.loads.pulls, structure.loads.histories)
        self.acting: Acting = (*tables, self.written, np.zeros((len(force), 2)))
        self.coupled = np.zeros((0, 7))

    def resist(self, y: Array, v: Array, time: float) -> Instant:
        """Return the state of the motion with its resisting forces at an instant.

        Args:
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
            time: instant [s], which gives the factors of the loads.
        """
        s, state = self.structure, (self.structure.displacement(y), self.structure.velocity(y, v))
        energies = _act(self.acting, state, time)
        couple(self.coupled, *state, self.written[0])
        return Instant(time, y, v, s.gathered(self.written[0]), *energies)

    def damping_matrix(self, y: Array) -> Symmetric:
        """Return the derivative of the damping force in the velocities (size, size) [N s/m, N m s]."""
        s, (relaxation, drag) = self.structure, self.dissipative
        local, u = np.zeros((len(s.element_numbers), 8, 8)), s.displacement(y)
        if len(relaxation):
            local += relaxation[:, None, None] * s.evaluate(y, asked=MATERIAL).matrices
        if len(drag):
            half = 0.5 * self.drag_rate * s.elements.linear_density * s.elements.length
            local[:, [0, 1, 3, 4], [0, 1, 3, 4]] += half[:, None]
        whole = s.reduced_matrix(local, u)
        add_links(s.links, u, s.links[4], whole)
        return whole


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


@inlined()
def _act(acting: Acting, state: State, time: float) -> tuple[float, float, float, float]:
    """Write all that resists; return strain and gravity energy, power of the loads, power lost."""
    (given, carried, weights, links), (relaxation, drag), loads, histories, written, curvature = acting
    (u, v), (_, _, first, _), (force, _, matrices, _), loss = state, given, written, 0.0
    strain = elements(given, 1.0, MATERIAL if len(relaxation) else FORCES, u, written)
    if len(relaxation) or len(drag):
        loss += _viscous_forces(relaxation, first, matrices, v, force) + _drag_forces(drag, v, force)
    gather(carried, u, force, curvature)
    gravity = -pull(weights, 1.0, u, force, curvature)
    rooted, slip, lost = link_forces(links, u, v, force, curvature)
    put_factors(histories, time, loads[2])
    pull(loads, 1.0, u, force, curvature)
    return strain[0] + strain[1] + strain[2] + rooted + slip, gravity, load_power(loads, v), loss + lost


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
    led: Indices,
    compliance: Array,
    state: State,
    totals: Array,
    time: float,
    step: float,
    steps: int,
) -> None:
    """Make `steps` steps of the central difference scheme in place: v is half a step behind u.

        v += h a(u, v), u += h v

    Args:
        acting: tables of all that acts, and the arrays that are written to.
        coupled: bodies that are led one way (K, 7), as of `mass.couplings`.
        led: places in the flattened rows of the coordinates that drives lead (H,).
        compliance: inverse mass (rows, 3) [1/kg, 1/(kg m^2)] of free nodes and bodies, else 0.
        state: displacements u (rows, 3) [m, rad] and velocities v (rows, 3) [m/s, rad/s], both changed.
        totals: work of loads and drives, exactly that of the scheme, and energy that dampers dissipate [J],
            added to. Dampers act at the velocities before the step.
        time, step: instant and step h [s].
        steps: number of steps.
    """
    (_, carried, _, _), dissipative, loads, _, (force, _, _, _), _ = acting
    u, v = state
    viscous = len(dissipative[0]) > 0 or len(dissipative[1]) > 0
    for n in range(steps):
        if viscous:
            carry_velocity(carried, u, v)
        _, _, power, loss = _act(acting, state, time + n * step)
        if len(coupled) > 0:
            couple(coupled, u, v, force)
        for at in led:
            totals[0] += step * force[at // 3, at % 3] * v[at // 3, at % 3]
        _move(compliance, force, step, v, u)
        totals[0] += 0.5 * step * (power + load_power(loads, v))
        totals[1] += step * loss
        carry(carried, u)
