"""The scikit-fem mesh of the strips, the reference geometry of their elements and the ends on bodies.

One `MeshLine` carries all strips: the mesh coordinate is the arc length along a strip, from 0 at its ground
end, and strips are separate chains of it. Three P1 fields live on it: the displacement u_x, u_y [m] and the
turn phi [rad] of the cross-section, both from the unloaded reference.

An end at the offset b from the reference point of its body follows without penalty or extra unknowns:

    u = d + (R(theta) - 1) b,    phi = theta

with displacement d of that point and turn theta of the body. Forces are reduced by the transpose of the
derivative P of the map; the tangent is P^T K P plus the curvature of the map, -(R b).f on the diagonal entry
of theta, with f the force of the element on the end. An end whose root gives way has a turn phi of its own,
and a spring between it and theta; that of a hinge has no stiffness.
"""

import math
from dataclasses import dataclass

import numpy as np
from skfem import Basis, ElementLineP1, ElementVector, MeshLine

from .arrays import Array, Flags, Indices, kernel
from .bending import TERMS
from .effects import CURL, PreStrain, RootCompliance
from .law import Energies, Given, Written, elements
from .model import Model
from .places import FREE
from .plate import left_by_clamps, left_in_elements

#: Numbers of a body's resultants: forces x, y [N], the moment [N m], and what the carrying of nodes and of
#: the weight adds to the stiffness of its turn [N m].
RESULTANTS = 5

#: Attached nodes (K,), the bodies that carry them, their offsets (K, 2) from these bodies' points, and
#: whether they turn with the bodies.
Carried = tuple[Indices, Indices, Array, Flags]
#: Nodes (R,) with roots that give way, their bodies, -1 for ground, and the stiffness of the roots [N m].
Springs = tuple[Indices, Indices, Array]
#: Weight of nodes (nodes, 3) and bodies (B, 4): force x, y [N], and the offset of its point from the body's
#: [m].
Weights = tuple[Array, Array]
Pair = tuple[Array, Array]
#: What is known of a structure where all its elements are run through.
Tables = tuple[Given, Carried, Weights, Springs]


@kernel()
def turned(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return the vector R (x, y), in its own unit, with the matrix R of a rotation by `angle` [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


@kernel()
def swept(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return (R - 1) (x, y), in its own unit, of a rotation by `angle` [rad], without cancellation at small
    angles."""
    sine, less = math.sin(angle), 2.0 * math.sin(0.5 * angle) ** 2
    return -less * x - sine * y, sine * x - less * y


@kernel()
def carry(bodies: Array, carried: Carried, u: Array) -> None:
    """Write the displacements u (nodes, 3) [m, m, rad] of attached nodes, moved rigidly with their bodies (B,
    3)."""
    attached, carrier, offsets, rigid = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = swept(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        u[i, 0], u[i, 1] = bodies[b, 0] + x, bodies[b, 1] + y
        if rigid[k]:
            u[i, 2] = bodies[b, 2]


@kernel()
def carry_velocity(bodies: Array, bodies_v: Array, carried: Carried, v: Array) -> None:
    """Write the velocities v (nodes, 3) [m/s, rad/s] of attached nodes, moved rigidly with their bodies (B,
    3)."""
    attached, carrier, offsets, rigid = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        v[i, 0] = bodies_v[b, 0] - bodies_v[b, 2] * y
        v[i, 1] = bodies_v[b, 1] + bodies_v[b, 2] * x
        if rigid[k]:
            v[i, 2] = bodies_v[b, 2]


@kernel()
def body_forces(
    share: float, bodies: Array, carried: Carried, weights: Weights, force: Array, out: Array
) -> None:
    """Write the resultants (B, 5) of the forces on attached nodes about the bodies' points.

    A share of the weight of nodes and bodies is taken from the forces that resist.
    """
    attached, carrier, offsets, rigid = carried
    for b in range(len(out)):
        for k in range(RESULTANTS):
            out[b, k] = 0.0
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        out[b, 0] += force[i, 0]
        out[b, 1] += force[i, 1]
        out[b, 2] += x * force[i, 1] - y * force[i, 0]
        if rigid[k]:
            out[b, 2] += force[i, 2]
        out[b, 3] -= x * force[i, 0] + y * force[i, 1]
    _put_weight(share, weights, bodies, force, out)


@kernel()
def _put_weight(share: float, weights: Weights, bodies: Array, force: Array, resultants: Array) -> None:
    """Take a share of the weight of nodes and bodies from the forces that resist."""
    weight, body_weight = weights
    for i in range(len(weight)):
        force[i, 0] -= share * weight[i, 0]
        force[i, 1] -= share * weight[i, 1]
    for b in range(len(body_weight)):
        w_x, w_y = share * body_weight[b, 0], share * body_weight[b, 1]
        x, y = turned(bodies[b, 2], body_weight[b, 2], body_weight[b, 3])
        resultants[b, 0] -= w_x
        resultants[b, 1] -= w_y
        resultants[b, 2] -= x * w_y - y * w_x
        resultants[b, 4] += x * w_x + y * w_y


@kernel()
def gravity_energy(weights: Weights, bodies: Array, u: Array) -> float:
    """Return the energy of the full weight, zero in the shape at rest [J]."""
    (weight, body_weight), energy = weights, 0.0
    for i in range(len(weight)):
        energy -= weight[i, 0] * u[i, 0] + weight[i, 1] * u[i, 1]
    for b in range(len(body_weight)):
        x, y = swept(bodies[b, 2], body_weight[b, 2], body_weight[b, 3])
        energy -= body_weight[b, 0] * (bodies[b, 0] + x) + body_weight[b, 1] * (bodies[b, 1] + y)
    return energy


@kernel()
def spring_forces(
    springs: Springs, relaxation: float, bodies: Pair, nodes: Pair, force: Array, out: Array
) -> tuple[float, float]:
    """Add the moments of roots between nodes and bodies; return their energy [J] and the power lost [W].

    Args:
        relaxation: time of the material [s]. bodies (B, 3), nodes (N, 3): displacements, and their rates.
    """
    (node, body, stiffness), (d, d_rate), (u, v), energy, loss = springs, bodies, nodes, 0.0, 0.0
    for k in range(len(node)):
        i, b = node[k], body[k]
        turn, rate = u[i, 2], relaxation * v[i, 2]
        if b >= 0:
            turn, rate = turn - d[b, 2], rate - relaxation * d_rate[b, 2]
        moment = stiffness[k] * (turn + rate)
        force[i, 2] += moment
        if b >= 0:
            out[b, 2] -= moment
        energy += 0.5 * stiffness[k] * turn * turn
        if relaxation > 0.0:
            loss += stiffness[k] * rate * rate / relaxation
    return energy, loss


@kernel()
def potential(
    tables: Tables, share: float, asked: int, u: Array, bodies: Array, written: Written, resultants: Array
) -> tuple[Energies, float]:
    """Write forces and resultants (B, 3) [N, N m]; return energies of the strips and of the full weight [J].

    share: of the weight that acts [1]. u (nodes, 3), bodies (B, 3): displacements [m, m, rad].
    """
    (given, carried, weights, springs), force = tables, written[0]
    bending, axial, shear = elements(given, share, asked, u, written)
    body_forces(share, bodies, carried, weights, force, resultants)
    bending += spring_forces(springs, 0.0, (bodies, bodies), (u, u), force, resultants)[0]
    return (bending, axial, shear), gravity_energy(weights, bodies, u)


#: One-point rule: what the shear-deformable element is free of locking by.
MIDPOINT = (np.array([[0.5]]), np.array([1.0]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements:
    """Reference geometry and rigidities of the E elements, arrays over the elements.

    Attributes:
        chord: reference chord x2 - x1, (2, E) [m].
        length: reference length (E,) [m].
        axial_rigidity, flexural_rigidity, shear_rigidity: EA [N], EI [N m^2], kGA [N], (E,). Of tapered
        strips their compliances are the means over the element: end force and end moment lengthen and turn
        it exactly; all else errs by the second order of its length.
        linear_density, rotary_density: rho A [kg/m], rho I [kg m], (E,), means over the element.
        plate (E, 2 + 2 TERMS): nu^2 of sections that do not curl freely, else 0; the reach [m] of anticlastic
        bending; the coefficients of what clamps leave of the curl at two points, as in `bending`.
    """

    chord: Array
    length: Array
    axial_rigidity: Array
    flexural_rigidity: Array
    shear_rigidity: Array
    linear_density: Array
    rotary_density: Array
    plate: Array

    @classmethod
    def of(cls, model: Model) -> "Elements":
        """Return those of all elements of a model, strip by strip."""
        chord = np.diff(model.rest, axis=1).reshape(-1, 2).T
        rigid = ("axial_rigidity", "flexural_rigidity", "shear_rigidity", "linear_density", "rotary_density")
        own = {name: np.repeat([getattr(s, name) for s in model.strips], model.elements) for name in rigid}
        if any(strip.tapered for strip in model.strips):
            for name, growth in zip(rigid, _tapers(model), strict=True):
                own[name] = own[name] * growth
        return cls(
            chord=chord,
            length=np.hypot(*chord),
            plate=np.vstack([_plate(model, k) for k in range(len(model.strips))]),
            **own,
        )

    def table(self, natural: PreStrain) -> Array:
        """Return the rows of `law`, (E, 10 + 2 TERMS)."""
        own = [np.full_like(self.length, part) for part in (natural.strain, natural.curvature)]
        rigidities = [self.axial_rigidity, self.flexural_rigidity, self.shear_rigidity]
        known = np.transpose([*self.chord, self.length, *rigidities, *own])
        flat = self.flexural_rigidity[:, None] / (1.0 - self.plate[:, :1])
        return np.hstack([known, flat, self.plate[:, 1:]])


def _tapers(model: Model) -> tuple[Array, ...]:
    """Return EA, EI, kGA, rho A and rho I of the elements over those at the start of their strips (E,)."""
    x, weight = np.polynomial.legendre.leggauss(5)
    places = (np.arange(model.elements)[:, None] + 0.5 * (x + 1.0)) / model.elements
    area, moment = np.hstack([strip.growth(places) for strip in model.strips])
    soft, flexible = (2.0 / (1.0 / each @ weight) for each in (area, moment))
    return soft, flexible, soft, 0.5 * area @ weight, 0.5 * moment @ weight


def strip_basis(model: Model) -> Basis:
    """Return the scikit-fem basis of (u_x, u_y, phi) on all strips; nodes are numbered strip by strip."""
    nodes = np.arange(model.arcs.size).reshape(model.arcs.shape)
    mesh = MeshLine(model.arcs.reshape(1, -1), np.array([nodes[:, :-1].ravel(), nodes[:, 1:].ravel()]))
    return Basis(mesh, ElementVector(ElementLineP1(), 3), quadrature=MIDPOINT)


def nodal_terms(model: Model) -> Array:
    """Return the factors by which clamps reduce the curl of sections at the nodes (G, P, TERMS) [1], as in
    `bending`."""
    if "clamped_width" in model.effects:
        return np.array([left_by_clamps(*_clamped(model, k)) for k in range(len(model.strips))])
    rows = np.zeros((*model.arcs.shape, TERMS))
    rows[..., 0] = [[strip.poisson_ratio**2] for strip in model.strips]
    return rows


def _clamped(model: Model, k: int) -> tuple[float, float, Array, bool]:
    """Return width over length and Poisson's ratio of a strip, the parts of its length at the nodes, and
    whether it flattens."""
    strip, length, flattens = model.strips[k], float(model.lengths[k]), "anticlastic" in model.effects
    return (strip.width or 0.0) / length, strip.poisson_ratio, model.arcs[k] / length, flattens


def _plate(model: Model, k: int) -> Array:
    """Return what the sections of a strip curl in its elements (E, 2 + 2 TERMS)."""
    strip, rows = model.strips[k], np.zeros((model.elements, 2 + 2 * TERMS))
    if strip.width is None or strip.thickness is None or not set(CURL) & set(model.effects.names):
        return rows
    nu = strip.poisson_ratio
    rows[:, [0, 2, 2 + TERMS]] = nu**2
    if "clamped_width" in model.effects:
        left = left_in_elements(*_clamped(model, k), 1 if model.element == "reissner" else 2)
        rows[:, 2:] = np.broadcast_to(left, (model.elements, 2, TERMS)).reshape(model.elements, -1)
    if "anticlastic" in model.effects:
        rows[:, 1] = np.sqrt(3.0 * (1.0 - nu**2)) * strip.width**2 / strip.thickness
    return rows


def root_stiffness(model: Model) -> Array:
    """Return the stiffness of the roots of the strips (G, 2) [N m]: of hinges 0, inf where none gives way."""
    rows, effect = np.full((len(model.strips), 2), np.inf), model.effects.find(RootCompliance)
    for strip, ends, row in zip(model.strips, model.ends, rows, strict=True):
        if effect is not None and effect.root and strip.thickness is not None:
            row[ends != FREE] = strip.flexural_rigidity / (effect.root * strip.thickness)
        row[[*strip.hinges]] = 0.0
    return rows
