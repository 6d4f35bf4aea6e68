"""A model made ready for computation: mesh, numbering and exact master-slave reduction, in one compiled call.

Reduced coordinates y: displacement and turn (u_x, u_y, phi) of every free node, strip by strip, then for
every body the displacement d (2,) of its reference point and its turn theta; between them the turns of nodes
at roots that give way. Attached ends of strips follow their bodies as in `mesh`.

Gravity and natural strains, where they are named, are part of the potential here. They can be applied in
part: `share` goes from 0 to 1 on the way from the shape at rest to the state under both.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, Flags, Indices
from .bending import CURL
from .effects import Gravity, PreStrain
from .law import FORCES, TANGENT
from .links import add_links, link_forces, links_of, numbers
from .matrix import Envelope, Symmetric, assemble
from .mesh import (
    RESULTANTS,
    Elements,
    carry,
    carry_velocity,
    potential,
    root_stiffness,
    strip_basis,
)
from .model import Model
from .places import FREE


@dataclass(frozen=True, kw_only=True, eq=False)
class Evaluation:
    """What the potential is at a state.

    Attributes:
        gradient (size,): [N, N m]. tangent: its derivative, zero if it was not asked for.
        strain (3,): bending, axial and shear energy [J]. spring: energy of springs between bodies [J].
        gravity: energy of the full weight [J].
        ends (E, 5): force x, y [N] at the second node of the elements, moments [N m] at both, and the largest
            turn of an end from its element [rad].
        matrices (E, 8, 8): tangents of the elements, none if they were not asked for. curvature (B, 2): what
            the carrying of nodes, and of weight and springs, adds to the stiffness of the turns [N m].
    """

    gradient: Array
    tangent: Symmetric
    strain: tuple[float, float, float]
    spring: float
    gravity: float
    ends: Array
    matrices: Array
    curvature: Array


class Structure:
    """Mesh, element law and reduction of a model about its bodies' centres or other points of the bodies.

    Args:
        model: what is made ready.
        points: reference points of the bodies at rest (B, 2) [m]; default: their centres.
    """

    def __init__(self, model: Model, points: ArrayLike | None = None) -> None:
        self.model = model
        self.basis = strip_basis(model)
        self.elements = Elements.of(model)
        self.shear = model.element == "reissner"
        self.points: Array = model.centres if points is None else np.reshape(np.asarray(points), (-1, 2))
        self.strips, self.stations = model.arcs.shape
        self._number()
        self.length = float(model.lengths.max())
        rigidity = max(strip.flexural_rigidity for strip in model.strips)
        self.force_unit, self.moment_unit = rigidity / self.length**2, rigidity / self.length
        #: which component each coordinate is: x, y or turn
        self.axis = np.append(self.nodal, np.arange(self.size - self.first_body)) % 3
        self.scale = np.where(self.axis == 2, self.moment_unit, self.force_unit)
        #: what changes of the coordinates are multiplied with to count in strip lengths and rad
        self.measure = np.where(self.axis == 2, 1.0, 1.0 / self.length)
        first = np.ascontiguousarray(self.basis.mesh.t[0], dtype=np.int64)
        self.given = (
            self.shear,
            self.elements.table(model.effects.find(PreStrain) or PreStrain()),
            first,
            CURL,
        )
        self.links = links_of(model, self.points)
        self.tables = (self.given, self.carried, self._weight(), self.springs)
        nodes = self.strips * self.stations
        self.work = (np.zeros((nodes, 3)), np.zeros((4, 4)))

    def _number(self) -> None:
        """Number the reduced coordinates, of elements (E, 6) and of the bodies at their ends (E, 2).

        -1 marks what is clamped, and an end on no body.
        """
        grid, ends = np.arange(self.strips * self.stations).reshape(self.strips, -1), self.model.ends
        stiffness, at_ends = root_stiffness(self.model), grid[:, [0, -1]]
        end, strip = np.nonzero(ends.T >= 0)
        node, carrier = at_ends[strip, end], ends[strip, end]
        offsets = self.model.rest.reshape(-1, 2)[node] - self.points[carrier]
        self.carried = (node, carrier, offsets, np.isinf(stiffness[strip, end]))
        soft = np.isfinite(stiffness)
        self.springs = (at_ends[soft], np.maximum(ends[soft], -1), stiffness[soft])
        free = np.setdiff1d(grid, at_ends[ends != FREE])
        self.nodal = np.append(3 * free[:, None] + np.arange(3), 3 * self.springs[0] + 2)
        self.first_body = len(self.nodal)
        self.size = self.first_body + 3 * len(self.points)
        self.turns = np.arange(self.first_body + 2, self.size, 3)
        numbers = np.full(3 * grid.size, -1, dtype=np.int64).reshape(-1, 3)
        numbers[node] = self.turns[carrier, None] + np.arange(-2, 1)
        numbers.reshape(-1)[self.nodal] = np.arange(self.first_body)
        self.ends, turns = np.full((2, self.strips, self.stations - 1, 2), -1)
        place = (strip, end * (self.stations - 2), end)
        self.ends[place], turns[place] = np.arange(len(node)), self.turns[carrier]
        self.ends = self.ends.reshape(-1, 2)
        self.numbers = np.hstack([numbers.ravel()[self.basis.element_dofs].T, turns.reshape(-1, 2)])

    @cached_property
    def pattern(self) -> Envelope:
        """Where the entries of matrices in the reduced coordinates lie."""
        every, first = np.arange(self.size), self.first_body
        bodies = every[first:].reshape(-1, 3)
        roots = every[first - len(self.springs[0]) : first]
        springs = np.stack([roots, np.append(self.turns, -1)[self.springs[1]]], axis=1)
        return Envelope(self.numbers, bodies, springs, numbers(self.links, bodies), self.size)

    def bodies(self, y: Array) -> Array:
        """Return what coordinates or velocities (..., size) have of the bodies (..., B, 3)."""
        return y[..., self.first_body :].reshape(*y.shape[:-1], -1, 3)

    def slips(self, y: Array) -> Array:
        """Return how far nodes or rates of them (size,) are turned from roots that give way (R,)."""
        own = y[self.first_body - len(self.springs[0]) : self.first_body]
        return np.asarray(own - np.append(y[self.turns], 0.0)[self.springs[1]])

    def _weight(self) -> tuple[Array, Array]:
        """Return the weight of nodes (nodes, 3) and bodies (B, 4) as in `rigid`, empty if not named.

        Half of every element is at each of its nodes: an error of second order in the element length. What
        hangs on a clamp is not felt.
        """
        gravity = self.model.effects.find(Gravity)
        if gravity is None:
            return np.zeros((0, 3)), np.zeros((0, 4))
        g, masses, (attached, carrier, offsets, _) = (
            np.array(gravity.acceleration),
            self.nodal_masses(),
            self.carried,
        )
        nodes, bodies = np.zeros((len(masses), 3)), np.zeros((len(self.points), 4))
        free = self.nodal[self.nodal % 3 == 0] // 3
        nodes[free, :2] = masses[free, None] * g
        own = np.array([body.mass for body in self.model.bodies])
        total, moments = own.copy(), own[:, None] * (self.model.centres - self.points)
        np.add.at(total, carrier, masses[attached])
        np.add.at(moments, carrier, masses[attached][:, None] * offsets)
        heavy = total > 0.0
        bodies[:, :2] = total[:, None] * g
        bodies[heavy, 2:] = moments[heavy] / total[heavy, None]
        return nodes, bodies

    @cached_property
    def constant_words(self) -> str:
        """What of weight and natural strains acts, in words; "" where the shape at rest is in equilibrium."""
        acting = {"the weight": Gravity, "the natural strains": PreStrain}
        return " and ".join(word for word, kind in acting.items() if self.model.effects.find(kind))

    def round_off(self, tangent: Symmetric) -> Array:
        """Return the residual [N, N m] of every coordinate below which round-off decides (size,).

        Displacements of order L and turns of order 1 carry an error of one unit in the last place, and a
        residual what this is worth by the entries of its row of the tangent. The factor 4 covers the few
        operations between them. Short elements have large entries, their neighbours have not.
        """
        terms = Symmetric(tangent.pattern, np.abs(tangent.data)).times(1.0 / self.measure)
        return np.asarray(4.0 * np.finfo(float).eps * terms)

    def body_slice(self, body: int) -> slice:
        """Return where the coordinates of a body lie."""
        return slice(self.first_body + 3 * body, self.first_body + 3 * body + 3)

    def extent(self, change: Array) -> float:
        """Return the largest component of a change of the coordinates, in strip lengths and rad."""
        return float(np.abs(self.measure * change).max(initial=0.0))

    def flags(self, chosen: Sequence[int] | Indices) -> Flags:
        """Return which of the coordinates are chosen (size,)."""
        return np.isin(np.arange(self.size), chosen)

    def gathered(self, nodes: Array, bodies: Array) -> Array:
        """Return in the order of the coordinates (size,) what nodes (nodes, 3) and bodies (B, 3) have."""
        return np.concatenate([nodes.ravel()[self.nodal], bodies.ravel()])

    def nodal_masses(self) -> Array:
        """Return the mass of the strips that falls to each node, half of every element (nodes,) [kg]."""
        half = 0.5 * self.elements.linear_density * self.elements.length
        masses: Array = np.bincount(self.basis.mesh.t.ravel(), np.tile(half, 2)).astype(float)
        return masses

    def at_nodes(self, y: Array) -> Array:
        """Return what coordinates or velocities (size,) have of the nodes (nodes, 3), 0 where they follow."""
        full = np.zeros(3 * self.strips * self.stations)
        full[self.nodal] = y[: self.first_body]
        return full.reshape(-1, 3)

    def displacement(self, y: Array) -> Array:
        """Return displacement and turn of all nodes, (nodes, 3) [m, rad]."""
        full = self.at_nodes(y)
        carry(self.bodies(y), self.carried, full)
        return full

    def velocity(self, y: Array, v: Array) -> Array:
        """Return the rates of displacement and turn of all nodes, (nodes, 3) [m/s, rad/s]."""
        full = self.at_nodes(v)
        carry_velocity(self.bodies(y), self.bodies(v), self.carried, full)
        return full

    def evaluate(self, y: Array, share: float = 1.0, asked: int = TANGENT) -> Evaluation:
        """Return gradient, tangent and energies at y under a share of weight and natural strains."""
        many, tangent = len(self.numbers), self.pattern.zero()
        matrices, ends = np.zeros((many if asked != FORCES else 0, 8, 8)), np.empty((many, 5))
        u, bodies = self.displacement(y), self.bodies(y)
        resultants, (force, scratch) = np.empty((len(bodies), RESULTANTS)), self.work
        written = (force, ends, matrices, scratch)
        strain, gravity = potential(self.tables, share, asked, u, bodies, written, resultants)
        spring = 0.0
        if len(self.links[0]):
            spring, _ = link_forces(self.links, bodies, np.zeros_like(bodies), resultants)
        if asked != FORCES:
            tangent = self.reduced_matrix(matrices, y)
        if asked == TANGENT:
            tangent.data[self.pattern.diagonal[self.turns]] += resultants[:, 3:].sum(axis=1)
            if len(self.springs[0]):
                self.add_springs(tangent)
            if len(self.links[0]):
                add_links(self.links, y[self.turns], self.links[2], tangent)
        return Evaluation(
            gradient=self.gathered(force, resultants[:, :3]),
            tangent=tangent,
            strain=strain,
            spring=spring,
            gravity=gravity,
            ends=ends,
            matrices=matrices,
            curvature=resultants[:, 3:],
        )

    def add_springs(self, matrix: Symmetric, part: float = 1.0) -> None:
        """Add a part of the stiffness of the roots to a matrix."""
        places, signs = self.pattern.springs, np.array([[part, -part], [-part, part]])
        values = self.springs[2][:, None, None] * signs
        np.add.at(matrix.data, places[places >= 0], values[places >= 0])

    def reduced_matrix(self, matrices: Array, y: Array) -> Symmetric:
        """Assemble element matrices (E, 8, 8) into the reduced coordinates as P^T K P: see `assemble`."""
        whole = self.pattern.zero()
        assemble(matrices, self.ends, self.carried, y[self.turns], self.pattern.places, whole.data)
        return whole

    def body_places(self, y: Array) -> Array:
        """Return places of the bodies (S, B, 3) [m, rad] for coordinates (S, size) about their points."""
        places = self.bodies(y).copy()
        places[..., :2] += self.points
        return places

    def share_rates(self, y: Array) -> tuple[Array, float, float]:
        """Return what the share changes at fixed y: the gradient (size,), and the potential, once and twice.

        The gradient is linear in the share and the potential a parabola, of which the derivative at the full
        share is returned; its bend is that of the energy of natural strains.
        """
        none, half, full = (self.evaluate(y, share, FORCES) for share in (0.0, 0.5, 1.0))
        u_0, u_1, u_2 = (
            sum(at.strain) + share * at.gravity for at, share in ((none, 0.0), (half, 0.5), (full, 1.0))
        )
        bend = 4.0 * (u_0 - 2.0 * u_1 + u_2)
        return full.gradient - none.gradient, u_2 - u_0 + 0.5 * bend, bend


@lru_cache(maxsize=16)
def structure_of(model: Model) -> Structure:
    """Return the structure of a model about the centres of its bodies, built at first use."""
    return Structure(model)
