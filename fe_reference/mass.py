"""Masses of the strips' elements and of the bodies, in the reduced coordinates.

Lumped (diagonal) element masses, half of the element at each node:

    mu l / 2 for u_x and u_y [kg],    and for phi [kg m^2]
    mu l^3 / 78   corotational element: the rotary inertia of the scaled diagonal of the consistent matrix
    rho I l / 2   Reissner element: the rotary inertia of the section, which belongs to that theory

The Euler-Bernoulli beam has no rotary inertia, but an explicit scheme needs some at every node. The first
form falls with l^2 per unit length, so that it leaves on refinement: a mode of wave number b is slowed by
(b l)^2 / 78, which is of the order of the error of the lumped masses themselves. A scene that names the
rotary inertia of the sections has rho I l / 2 in its place, with either element.

Consistent element masses: cubic bending and linear stretching in the frame of the chord (corotational),
linear fields with rotary inertia (Reissner). The rotary inertia of the sections, if it is named, is added to
the first with the slopes of the same cubics.

Strips without inertia and bodies without inertia have none of this, and none of the attached masses.

Source of the scaled diagonal: E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Eng. Struct. Dyn. 4 (1976)
245-249.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Array
from .matrix import Symmetric
from .places import turned
from .structure import Structure

MASSES = ("consistent", "lumped")


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidBodies:
    """The bodies with the lumped masses of the nodes attached to them, each as one rigid body.

    Attributes:
        mass (B,) [kg]; centre of mass of the whole at rest (B, 2) [m]; moment_of_inertia (B,) about the point
        that its structure is reduced about [kg m^2].
    """

    mass: Array
    centre: Array
    moment_of_inertia: Array

    def diagonal(self, structure: Structure) -> Array:
        """Return the lumped masses (size,) [kg, kg m^2] of a structure reduced about these centres."""
        carried = np.stack([self.mass, self.mass, self.moment_of_inertia], axis=1)
        return structure.gathered(np.vstack([_lumped_nodes(structure), carried]))


def lumped_elements(structure: Structure) -> Array:
    """Return the diagonal masses of the elements (6, E) [kg, kg m^2]."""
    e, effects = structure.elements, structure.model.effects
    if "strip_inertia" not in effects:
        return np.zeros((6, len(e.length)))
    half, rotary = 0.5 * e.linear_density * e.length, 0.5 * _rotary(structure) * e.length
    if not rotary.any():
        rotary = e.linear_density * e.length**3 / 78.0
    return np.stack([half, half, rotary, half, half, rotary])


def _rotary(structure: Structure) -> Array:
    """Return the rotary inertia of the sections per length (E,) [kg m], zero where it is neglected."""
    named = structure.shear or "section_rotary_inertia" in structure.model.effects
    return named * structure.elements.rotary_density


def _lumped_nodes(structure: Structure) -> Array:
    """Return the lumped masses of all nodes (nodes, 3) [kg, kg, kg m^2]."""
    dofs, size = structure.basis.element_dofs, structure.basis.N
    masses: Array = np.bincount(dofs.ravel(), lumped_elements(structure).ravel(), size).astype(np.float64)
    return masses.reshape(-1, 3)


def _own_inertia(structure: Structure) -> Array:
    """Return mass [kg] and moment of inertia [kg m^2] of the bodies alone, (B, 2)."""
    bodies = structure.model.bodies if "body_inertia" in structure.model.effects else ()
    own = np.zeros((len(structure.model.bodies), 2))
    own[: len(bodies)] = np.reshape([(body.mass, body.moment_of_inertia) for body in bodies], (-1, 2))
    return own


def about_mass_centre(structure: Structure, led: Sequence[int] = ()) -> tuple[Structure, RigidBodies]:
    """Return the same structure reduced about the centres of mass of the bodies with their attached masses.

    There the lumped mass matrix is diagonal and constant: no coupling of translation and rotation, hence no
    centrifugal terms in the equations of motion, which are exact. Bodies whose centre is `led` are reduced
    about that: at a constant velocity of it their moment of inertia about it is all that is left.
    """
    (rows, carriers, _, rigid, _), own = structure.carried, _own_inertia(structure)
    ends, centres = rows < structure.nodes, structure.model.centres
    attached, carrier = rows[ends], np.append(carriers[ends] - structure.nodes, np.arange(len(own)))
    nodes, rest = _lumped_nodes(structure)[attached], structure.model.rest.reshape(-1, 2)
    masses, turning = np.append(nodes[:, 0], own[:, 0]), np.append(nodes[:, 2] * rigid[ends], own[:, 1])
    places = np.vstack([rest[attached], centres])

    def summed(values: Array) -> Array:
        return np.bincount(carrier, values, len(own)).astype(np.float64)

    total, centre = summed(masses), centres.copy()
    moments = np.stack([summed(masses * part) for part in places.T], axis=1)
    np.divide(moments, total[:, None], out=centre, where=total[:, None] > 0.0)
    points = centre.copy()
    points[[*led]] = centres[[*led]]
    spread = masses * np.sum((places - points[carrier]) ** 2, axis=1)
    bodies = RigidBodies(mass=total, centre=centre, moment_of_inertia=summed(spread + turning))
    return Structure(structure.model, points), bodies


def carried_over(before: Structure, y: Array, v: Array, after: Structure) -> tuple[Array, Array]:
    """Return coordinates and velocities of one structure in another with other points of the bodies.

    Args:
        before, after: reduced about the former points of the bodies and about the others.
        y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
    """
    y, v = y.copy(), v.copy()
    offsets = after.points - before.points
    for place, rate, offset in zip(before.bodies(y), before.bodies(v), offsets, strict=True):
        x_arm, y_arm = turned(place[2], *offset)
        way = np.expm1(1j * place[2]) * complex(*offset)
        place[:2] += way.real, way.imag
        rate[:2] += -rate[2] * y_arm, rate[2] * x_arm
    return y, v


def mass_matrix(structure: Structure, y: Array, kind: str) -> Symmetric:
    """Return the mass matrix (size, size) [kg, kg m, kg m^2] of strips and bodies at y, "consistent" or
    "lumped"."""
    many, own = len(structure.elements.length), _own_inertia(structure)
    blocks = np.zeros((len(structure.pairs), 8, 8))
    structure.displacement(y)  # for the arms
    if kind == "lumped" or "strip_inertia" not in structure.model.effects:
        blocks[:many, range(6), range(6)] = lumped_elements(structure).T
    else:
        blocks[:many, :6, :6] = _consistent_elements(structure, y)
    blocks[len(blocks) - len(own) :, range(3), range(3)] = own[:, [0, 0, 1]]
    return structure.reduced_matrix(blocks)


def _consistent_elements(structure: Structure, y: Array) -> Array:
    """Return consistent masses (E, 6, 6) of linear stretching and, in the frame of the chord, cubic bending;
    of shear-deformable elements those of linear fields."""
    e, (places, weights) = structure.elements, np.polynomial.legendre.leggauss(4)
    x, l_0, one = 0.5 * (places[:, None] + 1.0), e.length, np.ones_like(e.length)
    line = np.stack([(1.0 - x) * one, x * one])
    fields = np.zeros((3, 6, len(x), len(l_0)))  # along, across and turn
    fields[0, [0, 3]] = line
    if structure.shear:
        fields[1, [1, 4]] = fields[2, [2, 5]] = line
    else:
        cubics = (1.0 - 3.0 * x**2 + 2.0 * x**3) * one, (x - 2.0 * x**2 + x**3) * l_0
        fields[1, [1, 2, 4, 5]] = *cubics, (3.0 * x**2 - 2.0 * x**3) * one, (x**3 - x**2) * l_0
        slopes = 6.0 * (x**2 - x) / l_0, (1.0 - 4.0 * x + 3.0 * x**2) * one
        fields[2, [1, 2, 4, 5]] = *slopes, 6.0 * (x - x**2) / l_0, (3.0 * x**2 - 2.0 * x) * one
    density = np.stack([e.linear_density, e.linear_density, _rotary(structure)]) * 0.5 * l_0
    local = np.einsum("kiqe,kjqe,ke,q->ije", fields, fields, density, weights)
    nodes = structure.displacement(y)[structure.basis.mesh.t, :2]
    c, s = (chord := e.chord + (nodes[1] - nodes[0]).T) / np.hypot(*chord)
    turn = np.zeros_like(local)
    turn[:3, :3] = turn[3:, 3:] = [[c, s, 0.0 * c], [-s, c, 0.0 * c], [0.0 * c, 0.0 * c, one]]
    masses: Array = np.einsum("kie,kle,lje->eij", turn, local, turn)
    return masses
