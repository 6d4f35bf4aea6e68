"""A model made ready for computation: mesh, numbering and exact master-slave reduction, in one compiled call.

Reduced coordinates y: displacement and turn (u_x, u_y, phi) of every free node, strip by strip, then for
every body the displacement d (2,) of its reference point and its turn theta; between them the turns of nodes
at roots that give way. Attached ends of strips follow their bodies as in `places`.

Gravity, natural strains and links, where they are named, are part of the potential here, and loads where they
are asked for. Gravity and natural strains can be applied in part: `share` goes from 0 to 1 on the way from
the shape at rest to the state under both.

One `MeshLine` of scikit-fem carries all strips: the mesh coordinate is the arc length along a strip, from 0
at its ground end, and strips are separate chains of it. Three P1 fields live on it: the displacement u_x, u_y
[m] and the turn phi [rad] of the cross-section, both from the unloaded reference. An end whose root gives way
has a turn phi of its own, and a spring between it and what it is on (`loads`); that of a hinge has no
stiffness.
"""

from collections.abc import Sequence
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from skfem import Basis, ElementLineP1, ElementVector, MeshLine

from .actions import resist
from .arrays import Array, Flags, Indices
from .effects import CURL, Gravity, PreStrain, RootCompliance, StripDamping, StripDrag
from .law import CURL_TABLE, FORCES, MATERIAL, TANGENT, TERMS
from .loads import Loads, Pulls, link_matrices, links_of, pull, pulls_of
from .matrix import Envelope, Symmetric, assemble
from .model import Model
from .places import FREE, Rows, carry, carry_velocity, gather, turned
from .plate import left_in_elements


class Evaluation(NamedTuple):
    """What the potential is at a state.

    Attributes:
        gradient (size,): [N, N m]. tangent: its derivative, zero if it was not asked for.
        strain (3,): bending, axial and shear energy [J]. spring: energy of springs between bodies [J].
        gravity: energy of the full weight [J]. work: of the loads in full since rest, of those with a
        potential [J].
        ends (E, 5): force x, y [N] at the second node of the elements, moments [N m] at both, and the largest
            turn of an end from its element [rad].
        matrices (E + K, 8, 8): tangents of the elements and of the K links, none if they were not asked for.
        curvature (rows,): what the carrying of rows adds to the stiffness of turns [N m].
    """

    gradient: Array
    tangent: Symmetric
    strain: tuple[float, float, float]
    spring: float
    gravity: float
    work: float
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
        self.shear = model.element == "reissner"
        self.points: Array = model.centres if points is None else np.reshape(np.asarray(points), (-1, 2))
        self.strips, self.stations = model.arcs.shape
        #: rows of the nodes, from which on come those of the bodies and of the ground
        self.nodes = model.arcs.size
        damping, drag = model.find(StripDamping), model.find(StripDrag)
        #: relaxation time of the strips [s], and rate of their drag [1/s]
        self.relaxation, self.drag = damping.relaxation_time if damping else 0.0, drag.rate if drag else 0.0
        self.basis, self.elements = _strip_basis(model), Elements(model)
        self._number()
        self.length = float(model.lengths.max())
        rigidity = max(strip.flexural_rigidity for strip in model.strips)
        self.force_unit, self.moment_unit = rigidity / self.length**2, rigidity / self.length
        #: which component each coordinate is: x, y or turn
        self.axis = self.coordinates % 3
        self.scale = np.where(self.axis == 2, self.moment_unit, self.force_unit)
        #: what changes of the coordinates are multiplied with to count in strip lengths and rad
        self.measure = np.where(self.axis == 2, 1.0, 1.0 / self.length)
        first = np.ascontiguousarray(self.basis.mesh.t[0], dtype=np.int64)
        self.given = self.shear, self.elements.table, first, CURL_TABLE
        self.damped = bool(self.relaxation or self.links[3].any())
        acting = self._weight(), self.links, self.loads.pulls
        self.tables = (self.given, self.carried, *acting, self.relaxation)
        rows, many = len(self.numbers), len(first)
        viscous = np.zeros((many if self.relaxation else 0, 8, 8))
        #: what a motion writes: forces, ends, matrices and scratch of the elements, and curvature
        self.written = (np.zeros((rows, 3)), np.zeros((many, 5)), viscous, np.zeros((4, 4)))
        self.curvature, self._still = np.zeros(rows), np.zeros((rows, 3))

    def _number(self) -> None:
        """Number rows and reduced coordinates; -1 marks a coordinate that is clamped, a row not carried."""
        grid, ends = np.arange(self.nodes).reshape(self.strips, -1), self.model.ends
        stiffness, at_ends = _root_stiffness(self.model), grid[:, [0, -1]]
        strip, end = np.nonzero(ends >= 0)
        node, carrier, soft = at_ends[strip, end], ends[strip, end], np.isfinite(stiffness)
        points = Rows(self.nodes, self.points)
        carriers = np.where(ends[soft] >= 0, self.nodes + ends[soft], points.ground)
        roots = list(zip(at_ends[soft], carriers, stiffness[soft], strict=True))
        drag = self.drag * self.nodal_masses()
        self.links = links_of(self.model, roots, self.relaxation, drag, points)
        self.loads = Loads.of(self.model, points)
        #: rows of the bodies' centres
        self.centres = np.array(list(map(points.of, range(len(self.points)), self.model.centres)), dtype=int)
        beyond = np.arange(len(points.carriers))
        rows = np.append(node, points.ground + 1 + beyond)
        bodies = np.append(self.nodes + carrier, np.array(points.carriers, dtype=np.int64))
        offsets = np.vstack([self.model.rest.reshape(-1, 2)[node] - self.points[carrier], *points.offsets])
        rigid = np.append(np.isinf(stiffness[strip, end]), beyond >= 0)
        self.carried = (rows, bodies, offsets, rigid, offsets.copy())
        free = np.setdiff1d(grid, at_ends[ends != FREE])
        nodal = np.append(3 * free[:, None] + np.arange(3), 3 * at_ends[soft] + 2)
        #: where in rows the coordinates are
        self.coordinates = np.append(nodal, np.arange(3 * self.nodes, 3 * points.ground))
        self.first_body, self.size = len(nodal), len(self.coordinates)
        self.turns = np.arange(self.first_body + 2, self.size, 3)
        self.numbers = np.full((points.ground + 1 + len(beyond), 3), -1, dtype=np.int64)
        self.numbers[rows] = self.turns[bodies - self.nodes, None] + np.arange(-2, 1)
        self.numbers.reshape(-1)[self.coordinates] = np.arange(self.size)
        #: which of the carried rows a row is, and the row that it goes with, else its own
        self.places, self.carriers = np.full(len(self.numbers), -1), np.arange(len(self.numbers))
        self.places[rows], self.carriers[rows] = np.arange(len(rows)), bodies
        #: pairs of rows with a matrix between them: of elements, links, and of bodies with the ground
        fixed = np.full(len(self.centres), points.ground)
        self.pairs = np.vstack([self.basis.mesh.t.T, self.links[1], np.stack([self.centres, fixed], axis=1)])
        #: which of the carried rows they are
        self.ends = self.places[self.pairs]

    @cached_property
    def pattern(self) -> Envelope:
        """Where the entries of matrices in the reduced coordinates lie."""
        turns = np.where(self.ends >= 0, self.numbers[self.carriers[self.pairs], 2], -1)
        return Envelope(np.hstack([self.numbers[self.pairs].reshape(-1, 6), turns]), self.size)

    def bodies(self, y: Array) -> Array:
        """Return the part of the bodies (..., B, 3) of coordinates [m, rad] or velocities (..., size)."""
        return y[..., self.first_body :].reshape(*y.shape[:-1], -1, 3)

    def _weight(self) -> Pulls:
        """Return the weight of nodes, free or on bodies, and of bodies, none if it is not named.

        Half of every element is at each of its nodes: an error of second order in the element length. What
        hangs on a clamp is not felt.
        """
        gravity = self.model.find(Gravity)
        if gravity is None:
            return pulls_of([], [])
        masses = np.append(self.nodal_masses(), [body.mass for body in self.model.bodies])
        rows, table = np.append(np.arange(self.nodes), self.centres), np.zeros((len(masses), 4))
        table[:, :2] = masses[:, None] * gravity.acceleration
        free = self.numbers[rows, 0] >= 0
        return pulls_of(rows[free], table[free])

    @cached_property
    def constant_words(self) -> str:
        """What of weight and natural strains acts, in words; "" where the shape at rest is in equilibrium."""
        acting = {"the weight": Gravity, "the natural strains": PreStrain}
        return " and ".join(word for word, kind in acting.items() if self.model.find(kind))

    def round_off(self, tangent: Symmetric) -> Array:
        """Return the residual [N, N m] of every coordinate below which round-off decides (size,).

        Displacements of order L and turns of order 1 carry an error of one unit in the last place, and a
        residual what this is worth by the entries of its row of the tangent. The factor 4 covers the few
        operations between them. Short elements have large entries, their neighbours have not.
        """
        terms = Symmetric(tangent.pattern, np.abs(tangent.data)).times(1.0 / self.measure)
        return np.asarray(4.0 * np.finfo(float).eps * terms)

    def of_bodies(self, rows: Array) -> Array:
        """Return what of values of rows (rows, ...) is of the bodies (B, ...), of any unit."""
        return rows[self.nodes : self.nodes + len(self.points)]

    def body_slice(self, body: int) -> slice:
        """Return where the coordinates of a body lie."""
        return slice(self.first_body + 3 * body, self.first_body + 3 * body + 3)

    def extent(self, change: Array) -> float:
        """Return the largest component of a change of the coordinates (size,), in strip lengths and rad."""
        return float(np.abs(self.measure * change).max(initial=0.0))

    def flags(self, chosen: Sequence[int] | Indices) -> Flags:
        """Return which of the coordinates are chosen (size,)."""
        return np.isin(np.arange(self.size), chosen)

    def gathered(self, rows: Array) -> Array:
        """Return the values of rows (rows, 3), of any unit, in the order of the coordinates (size,)."""
        return rows.ravel()[self.coordinates]

    def spread(self, y: Array) -> Array:
        """Return coordinates [m, rad] or velocities (size,) in rows (rows, 3), 0 where they follow."""
        full = np.zeros(3 * len(self.numbers))
        full[self.coordinates] = y
        return full.reshape(-1, 3)

    def nodal_masses(self) -> Array:
        """Return the mass of the strips that falls to each node, half of every element (nodes,) [kg]."""
        half = 0.5 * self.elements.linear_density * self.elements.length
        masses: Array = np.bincount(self.basis.mesh.t.ravel(), np.tile(half, 2)).astype(float)
        return masses

    def displacement(self, y: Array) -> Array:
        """Return displacement and turn of all rows, (rows, 3) [m, rad]."""
        full = self.spread(y)
        carry(self.carried, full)
        return full

    def velocity(self, v: Array) -> Array:
        """Return the rates of displacement and turn of all rows, (rows, 3) [m/s, rad/s].

        The arms are those of the displacements that were evaluated last.
        """
        full = self.spread(v)
        carry_velocity(self.carried, full)
        return full

    def load_force(self, y: Array, load: Array, dead: bool = False) -> tuple[Array, float]:
        """Return generalised force and work [J] of loads times factors (K,), or of the dead ones."""
        force, (_, table, factors, _) = np.zeros((len(self.numbers), 3)), self.loads.pulls
        factors[:] = load * (1.0 - table[:, 3]) if dead else load
        work = pull(self.loads.pulls, -1.0, self.displacement(y), force)
        gather(self.carried, force, np.empty(len(force)))
        return self.gathered(force), work

    def evaluate(
        self, y: Array, share: float = 1.0, asked: int = TANGENT, load: Array | None = None, acts: float = 1.0
    ) -> Evaluation:
        """Return gradient, tangent and energies at y under a share of weight and natural strains.

        load (K,): factors of the loads, of which the share `acts` is in the gradient and in the tangent.
        """
        many, tangent = len(self.elements.length), self.pattern.zero()
        matrices, ends = np.zeros((many if asked != FORCES else 0, 8, 8)), np.empty((many, 5))
        u, (force, _, _, scratch) = self.displacement(y), self.written
        written, curvature = (force, ends, matrices, scratch), np.empty(len(u))
        self.loads.pulls[2][:] = 0.0 if load is None else load
        found = resist(self.tables, share, acts, asked, (u, self._still), written, curvature)
        strain, spring, gravity, work, _ = found
        if asked == TANGENT:
            if len(self.links[1]):
                matrices = np.concatenate([matrices, link_matrices(self.links[2])])
            tangent = self.reduced_matrix(matrices)
            tangent.data[self.pattern.diagonal[self.turns]] += self.of_bodies(curvature)
            if load is not None and self.loads.follows:
                tangent.left, tangent.right = self._following(acts, u)
        gradient = self.gathered(force)
        return Evaluation(gradient, tangent, strain, spring, gravity, work, ends, matrices, curvature)

    def _following(self, acts: float, u: Array) -> tuple[Array, Array]:
        """Return vectors (R, size), whose products a share of the loads that follow adds to the tangent."""
        rows, table, factors, _ = self.loads.pulls
        left, right = np.zeros((2, len(self.loads.following), self.size))
        for r, k in enumerate(self.loads.following):
            row, place = rows[k], self.places[rows[k]]
            x, y = turned(u[row, 2], *(acts * factors[k] * table[k, :2]))
            left[r, self.numbers[row, :2]] = y, -x
            if place >= 0:  # the turn of the force less that of its arm, which is in the curvature
                left[r, self.numbers[row, 2]] = -float(self.carried[4][place] @ (x, y))
            right[r, self.numbers[row, 2]] = 1.0
        return left, right

    def reduced_matrix(self, matrices: Array) -> Symmetric:
        """Return matrices (M, 8, 8) [N/m, N, N m] of the first pairs assembled as P^T K P (size, size).

        The arms are those of the displacements that were evaluated last.

        Args:
            matrices: of stiffness, damping or mass. See `assemble`.
        """
        whole = self.pattern.zero()
        assemble(matrices, self.ends, self.carried, self.pattern.places, whole.data)
        return whole

    def damping_matrix(self, y: Array) -> Symmetric:
        """Return the derivative of the damping force in the velocities (size, size) [N s/m, N m s]."""
        strips = self.relaxation * self.evaluate(y, asked=MATERIAL).matrices
        return self.reduced_matrix(np.concatenate([strips, link_matrices(self.links[3])]))

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


#: One-point rule: what the shear-deformable element is free of locking by.
MIDPOINT = (np.array([[0.5]]), np.array([1.0]))


class Elements:
    """Reference geometry and rigidities of the E elements of a model, strip by strip.

    Attributes:
        chord: reference chord x2 - x1, (2, E) [m]. length: reference length (E,) [m].
        axial_rigidity, flexural_rigidity, shear_rigidity: EA [N], EI [N m^2], kGA [N], (E,). Of tapered
            strips their compliances are the means over the element: end force and end moment lengthen and
            turn it exactly; all else errs by the second order of its length.
        linear_density, rotary_density: rho A [kg/m], rho I [kg m], (E,), means over the element.
        plate (E, 2 + 2 TERMS): nu^2 of sections that do not curl freely, else 0; the reach [m] of anticlastic
            bending; the coefficients of what clamps leave of the curl at two points, as in `law`.
        table (E, 10 + 2 TERMS): rows of `law`, in SI units.
    """

    def __init__(self, model: Model) -> None:
        self.chord = np.diff(model.rest, axis=1).reshape(-1, 2).T
        self.length = np.hypot(*self.chord)
        rigid = ("axial_rigidity", "flexural_rigidity", "shear_rigidity", "linear_density", "rotary_density")
        own = np.repeat(
            [[getattr(strip, name) for strip in model.strips] for name in rigid], model.elements, axis=1
        )
        if any(strip.tapered for strip in model.strips):
            own = own * _tapers(model)
        self.axial_rigidity, self.flexural_rigidity, self.shear_rigidity = own[:3]
        self.linear_density: Array = own[3]
        self.rotary_density: Array = own[4]
        self.plate = np.vstack([_plate(model, k) for k in range(len(model.strips))])
        natural = model.find(PreStrain) or PreStrain()
        known = np.broadcast_arrays(*self.chord, self.length, *own[:3], natural.strain, natural.curvature)
        flat = self.flexural_rigidity[:, None] / (1.0 - self.plate[:, :1])
        self.table = np.hstack([np.transpose(known), flat, self.plate[:, 1:]])


def _tapers(model: Model) -> tuple[Array, ...]:
    """Return EA, EI, kGA, rho A and rho I of the elements over those at the start of their strips (E,)."""
    x, weight = np.polynomial.legendre.leggauss(5)
    places = (np.arange(model.elements)[:, None] + 0.5 * (x + 1.0)) / model.elements
    area, moment = np.hstack([strip.growth(places) for strip in model.strips])
    soft, flexible = (2.0 / (1.0 / each @ weight) for each in (area, moment))
    return soft, flexible, soft, 0.5 * area @ weight, 0.5 * moment @ weight


def _strip_basis(model: Model) -> Basis:
    """Return the scikit-fem basis of (u_x, u_y, phi) on all strips; nodes are numbered strip by strip."""
    nodes = np.arange(model.arcs.size).reshape(model.arcs.shape)
    mesh = MeshLine(model.arcs.reshape(1, -1), np.array([nodes[:, :-1].ravel(), nodes[:, 1:].ravel()]))
    return Basis(mesh, ElementVector(ElementLineP1(), 3), quadrature=MIDPOINT)


def _plate(model: Model, k: int) -> Array:
    """Return what the sections of a strip curl in its elements (E, 2 + 2 TERMS)."""
    strip, rows = model.strips[k], np.zeros((model.elements, 2 + 2 * TERMS))
    if strip.width is None or strip.thickness is None or not set(CURL) & set(model.effects):
        return rows
    nu = strip.poisson_ratio
    rows[:, [0, 2, 2 + TERMS]] = nu**2
    if "clamped_width" in model.effects:
        ends, flattens = model.arcs[k] / model.lengths[k], "anticlastic" in model.effects
        ratio, points = float(strip.width / model.lengths[k]), 1 if model.element == "reissner" else 2
        left = left_in_elements(ratio, nu, ends, flattens, points)
        rows[:, 2:] = np.broadcast_to(left, (model.elements, 2, TERMS)).reshape(model.elements, -1)
    if "anticlastic" in model.effects:
        rows[:, 1] = np.sqrt(3.0 * (1.0 - nu**2)) * strip.width**2 / strip.thickness
    return rows


def _root_stiffness(model: Model) -> Array:
    """Return the stiffness of the roots of the strips (G, 2) [N m]: of hinges 0, inf where none gives way."""
    rows, effect = np.full((len(model.strips), 2), np.inf), model.find(RootCompliance)
    for strip, ends, row in zip(model.strips, model.ends, rows, strict=True):
        if effect is not None and effect.root and strip.thickness is not None:
            row[ends != FREE] = strip.flexural_rigidity / (effect.root * strip.thickness)
        row[[*strip.hinges]] = 0.0
    return rows
