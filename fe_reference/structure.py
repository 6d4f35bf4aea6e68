"""A model made ready for computation: mesh, numbering and exact master-slave reduction, in one compiled call.

Reduced coordinates y: displacement and turn (u_x, u_y, phi) of every free node, strip by strip, then for
every body the displacement d (2,) of its reference point and its turn theta. Attached ends of strips follow
their bodies as in `mesh`.

Gravity and natural strains, where they are named, are part of the potential here. They can be applied in
part: `share` goes from 0 to 1 on the way from the shape at rest to the state under both.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array, Flags, Indices, kernel
from .bending import CURL
from .effects import Gravity, PreStrain
from .law import FORCES, TANGENT, Energies, Given, Written, elements
from .matrix import Envelope, Symmetric
from .mesh import (
    RESULTANTS,
    Carried,
    Elements,
    Weights,
    body_forces,
    carry,
    carry_velocity,
    gravity_energy,
    strip_basis,
)
from .model import FREE, Model

#: What is known of a structure where all its elements are run through: elements, carried nodes, weights.
Tables = tuple[Given, Carried, Weights]


@dataclass(frozen=True, kw_only=True, eq=False)
class Evaluation:
    """What the potential is at a state.

    Attributes:
        gradient (size,): [N, N m]. tangent: its derivative, zero if it was not asked for.
        strain (3,): bending, axial and shear energy [J]. gravity: energy of the full weight [J].
        ends (E, 5): force x, y [N] at the second node of the elements, moments [N m] at both, and the largest
            turn of an end from its element [rad].
        matrices (E, 6, 6): tangents of the elements, none if they were not asked for. curvature (B, 2): what
            the carrying of nodes and of the weight adds to the stiffness of the turns [N m].
    """

    gradient: Array
    tangent: Symmetric
    strain: tuple[float, float, float]
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
        self._attach()
        self._number()
        self.length = float(model.lengths.max())
        rigidity = max(strip.flexural_rigidity for strip in model.strips)
        self.force_unit, self.moment_unit = rigidity / self.length**2, rigidity / self.length
        self.scale = np.full(self.size, self.force_unit)
        self.scale[2::3] = self.moment_unit
        #: what changes of the coordinates are multiplied with to count in strip lengths and rad
        self.measure = np.full(self.size, 1.0 / self.length)
        self.measure[2::3] = 1.0
        first = np.ascontiguousarray(self.basis.mesh.t[0], dtype=np.int64)
        self.given = (
            self.shear,
            self.elements.table(model.effects.find(PreStrain) or PreStrain()),
            first,
            CURL,
        )
        self.tables = (self.given, self.carried, self._weight())
        nodes = self.strips * self.stations
        self.work = (np.zeros((nodes, 3)), np.zeros((4, 4)))

    def _attach(self) -> None:
        """Find the attached nodes (K,), their bodies and their offsets (K, 2) from these bodies' points [m].

        Also which of them the elements' ends are (E, 2), -1 for none.
        """
        shape, ends = (self.strips, self.stations - 1, 2), self.model.ends
        end, strip = np.nonzero(ends.T >= 0)
        node, body = strip * self.stations + end * (self.stations - 1), ends[strip, end]
        self.carried = (node, body, self.model.rest.reshape(-1, 2)[node] - self.points[body])
        self.attached = np.full(shape, -1)
        self.attached[strip, end * (self.stations - 2), end] = np.arange(len(node))

    def _number(self) -> None:
        """Number the reduced coordinates; -1 marks what is clamped."""
        free, (attached, carrier, _) = np.ones((self.strips, self.stations), dtype=bool), self.carried
        free[:, [0, -1]] = self.model.ends == FREE
        self.free_nodes = np.flatnonzero(free)
        self.first_body = 3 * len(self.free_nodes)
        self.size = self.first_body + 3 * len(self.points)
        self.turns = np.arange(self.first_body + 2, self.size, 3)
        numbers = np.full((free.size, 3), -1, dtype=np.int64)
        numbers[self.free_nodes] = np.arange(self.first_body).reshape(-1, 3)
        bodies = np.arange(self.first_body, self.size).reshape(-1, 3)
        numbers[attached] = bodies[carrier]
        self.numbers = numbers.ravel()[self.basis.element_dofs].T

    @cached_property
    def pattern(self) -> Envelope:
        """Where the entries of matrices in the reduced coordinates lie."""
        bodies = np.arange(self.first_body, self.size).reshape(-1, 3)
        return Envelope(self.numbers, bodies, self.size)

    def _weight(self) -> tuple[Array, Array]:
        """Return the weight of nodes (nodes, 3) and bodies (B, 4) as in `rigid`, empty if not named.

        Half of every element is at each of its nodes: an error of second order in the element length. What
        hangs on a clamp is not felt.
        """
        gravity = self.model.effects.find(Gravity)
        if gravity is None:
            return np.zeros((0, 3)), np.zeros((0, 4))
        g, masses, (attached, carrier, offsets) = (
            np.array(gravity.acceleration),
            self.nodal_masses(),
            self.carried,
        )
        nodes, bodies = np.zeros((len(masses), 3)), np.zeros((len(self.points), 4))
        nodes[self.free_nodes, :2] = masses[self.free_nodes, None] * g
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
        operations between them. Short elements have large entries, their neighbours have not. An element
        with roots has small entries too, but the error of the stiff section that is inside.
        """
        terms = Symmetric(tangent.pattern, np.abs(tangent.data)).times(1.0 / self.measure)
        e = self.elements
        rooted = e.roots.any(axis=1)
        if rooted.any():
            rigidity = np.maximum(e.axial_rigidity, e.shear_rigidity) if self.shear else e.axial_rigidity
            inside = (rigidity * self.length / e.length)[rooted]
            places = self.numbers[rooted]
            known = places >= 0
            forces = np.broadcast_to(inside[:, None], places.shape)[known]
            np.add.at(terms, places[known], forces * self.scale[places[known]] / self.force_unit)
        return np.asarray(4.0 * np.finfo(float).eps * terms)

    def body_slice(self, body: int) -> slice:
        """Return where the coordinates of a body lie."""
        return slice(self.first_body + 3 * body, self.first_body + 3 * body + 3)

    def flags(self, chosen: Sequence[int] | Indices) -> Flags:
        """Return which of the coordinates are chosen (size,)."""
        return np.isin(np.arange(self.size), chosen)

    def gathered(self, nodes: Array, bodies: Array) -> Array:
        """Return in the order of the coordinates (size,) what nodes (nodes, 3) and bodies (B, 3) have."""
        return np.concatenate([nodes[self.free_nodes].ravel(), bodies.ravel()])

    def nodal_masses(self) -> Array:
        """Return the mass of the strips that falls to each node, half of every element (nodes,) [kg]."""
        half = 0.5 * self.elements.linear_density * self.elements.length
        masses: Array = np.bincount(self.basis.mesh.t.ravel(), np.tile(half, 2)).astype(float)
        return masses

    def displacement(self, y: Array) -> Array:
        """Return displacement and turn of all nodes, (nodes, 3) [m, rad]."""
        full = np.zeros((self.strips * self.stations, 3))
        full[self.free_nodes] = y[: self.first_body].reshape(-1, 3)
        carry(y[self.first_body :].reshape(-1, 3), self.carried, full)
        return full

    def velocity(self, y: Array, v: Array) -> Array:
        """Return the rates of displacement and turn of all nodes, (nodes, 3) [m/s, rad/s]."""
        full = np.zeros((self.strips * self.stations, 3))
        bodies, rates = (part[self.first_body :].reshape(-1, 3) for part in (y, v))
        full[self.free_nodes] = v[: self.first_body].reshape(-1, 3)
        carry_velocity(bodies, rates, self.carried, full)
        return full

    def evaluate(self, y: Array, share: float = 1.0, asked: int = TANGENT) -> Evaluation:
        """Return gradient, tangent and energies at y under a share of weight and natural strains."""
        many = len(self.numbers)
        matrices = np.empty((many if asked != FORCES else 0, 6, 6))
        tangent, gradient, ends = self.pattern.zero(), np.empty(self.size), np.empty((many, 5))
        u, bodies = self.displacement(y), y[self.first_body :].reshape(-1, 3)
        resultants, (force, scratch) = np.empty((len(bodies), RESULTANTS)), self.work
        written, out = (force, ends, matrices, scratch), (gradient, resultants)
        strain, gravity = _evaluate(self.tables, share, asked, u, bodies, self.free_nodes, written, out)
        if asked != FORCES:
            tangent = self.reduced_matrix(matrices, y)
        if asked == TANGENT:
            tangent.data[self.pattern.diagonal[self.turns]] += resultants[:, 3:].sum(axis=1)
        return Evaluation(
            gradient=gradient,
            tangent=tangent,
            strain=strain,
            gravity=gravity,
            ends=ends,
            matrices=matrices,
            curvature=resultants[:, 3:],
        )

    def reduced_matrix(self, matrices: Array, y: Array) -> Symmetric:
        """Assemble element matrices (E, 6, 6) into the reduced coordinates as P^T K P."""
        return self.pattern.assembled(matrices, self.attached.reshape(-1, 2), self.carried, y[self.turns])

    def body_places(self, y: Array) -> Array:
        """Return places of the bodies (S, B, 3) [m, rad] for coordinates (S, size) about their points."""
        places = y[:, self.first_body :].reshape(len(y), -1, 3).copy()
        places[..., :2] += self.points
        return places

    def element_matrices(self, y: Array, asked: int) -> Array:
        """Return the tangents of the elements, or the part that is asked for, (E, 6, 6)."""
        many, (force, scratch) = len(self.numbers), self.work
        matrices = np.empty((many, 6, 6))
        written = (force, np.empty((many, 5)), matrices, scratch)
        elements(self.given, 1.0, asked, self.displacement(y), written)
        return matrices

    def share_rates(self, y: Array) -> tuple[Array, float, float]:
        """Return what the share changes at fixed y: the gradient (size,), and the potential, once and twice.

        The gradient is linear in the share and the potential a parabola, of which the derivative at the full
        share is returned; its bend is that of the energy of natural strains. Nearly so only where roots of
        shear-deformable elements give way.
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


@kernel()
def _evaluate(
    tables: Tables,
    share: float,
    asked: int,
    u: Array,
    bodies: Array,
    free_nodes: Indices,
    written: Written,
    out: tuple[Array, Array],
) -> tuple[Energies, float]:
    """Write gradient and resultants `out`; return energies of the strips and of the full weight."""
    (given, carried, weights), (gradient, resultants), force = tables, out, written[0]
    strain = elements(given, share, asked, u, written)
    body_forces(share, bodies, carried, weights, force, resultants)
    at = 0
    for i in free_nodes:
        for k in range(3):
            gradient[at] = force[i, k]
            at += 1
    for b in range(len(bodies)):
        for k in range(3):
            gradient[at] = resultants[b, k]
            at += 1
    return strain, gravity_energy(weights, bodies, u)
