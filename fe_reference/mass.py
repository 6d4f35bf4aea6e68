"""Masses of the strips' elements and of the body, in the reduced coordinates.

Lumped (diagonal) element masses, half of the element at each node:

    mu l / 2 for u_x and u_y [kg],    and for phi [kg m^2]
    mu l^3 / 78   corotational element: the rotary inertia of the scaled diagonal of the consistent matrix
    rho I l / 2   Reissner element: the rotary inertia of the section, which belongs to that theory

The Euler-Bernoulli beam has no rotary inertia, but an explicit scheme needs some at every node. The first
form falls with l^2 per unit length, so that it leaves on refinement: a mode of wave number b is slowed by
(b l)^2 / 78, which is of the order of the error of the lumped masses themselves.

Consistent element masses: cubic bending and linear stretching in the frame of the chord (corotational),
linear fields with rotary inertia (Reissner).

Source of the scaled diagonal: E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Eng. Struct. Dyn. 4 (1976)
245-249.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix

from .structure import Structure

Array = NDArray[np.float64]
MASSES = ("consistent", "lumped")


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidBody:
    """The body with the lumped masses of the nodes attached to it, as one rigid body.

    Attributes:
        mass [kg]; centre of mass of the whole at rest (2,) [m]; moment_of_inertia about that centre [kg m^2].
    """

    mass: float
    centre: Array
    moment_of_inertia: float


def lumped_elements(structure: Structure) -> Array:
    """Return the diagonal masses of the elements (6, E) [kg, kg m^2]."""
    e = structure.elements
    half = 0.5 * e.linear_density * e.length
    physical = structure.model.element == "reissner"
    rotary = 0.5 * e.rotary_density * e.length if physical else e.linear_density * e.length**3 / 78.0
    return np.stack([half, half, rotary, half, half, rotary])


def lumped_nodes(structure: Structure) -> Array:
    """Return the lumped masses of all nodes (nodes, 3) [kg, kg, kg m^2]."""
    dofs, size = structure.basis.element_dofs, structure.basis.N
    masses: Array = np.bincount(dofs.ravel(), lumped_elements(structure).ravel(), size).astype(np.float64)
    return masses.reshape(-1, 3)


def rigid_body(structure: Structure) -> RigidBody:
    """Return the body of the model together with the lumped masses of the attached nodes."""
    body, nodes = structure.model.body, lumped_nodes(structure)[structure.attached]
    masses = np.append(nodes[:, 0], body.mass)
    points = np.vstack([structure.offsets + structure.point, body.centre])
    centre = masses @ points / masses.sum()
    spread = masses @ np.sum((points - centre) ** 2, axis=1)
    inertia = body.moment_of_inertia + nodes[:, 2].sum() + spread
    return RigidBody(mass=float(masses.sum()), centre=centre, moment_of_inertia=float(inertia))


def about_mass_centre(structure: Structure) -> tuple[Structure, RigidBody]:
    """Return the same structure reduced about the centre of mass of the body with its attached lumped masses.

    There the lumped mass matrix is diagonal and constant: no coupling of translation and rotation, hence no
    centrifugal terms in the equations of motion, which are exact.
    """
    body = rigid_body(structure)
    return Structure(structure.model, body.centre), body


def lumped_diagonal(structure: Structure, body: RigidBody) -> Array:
    """Return the lumped masses (size,) of a structure that is reduced about the centre of `body`."""
    free = lumped_nodes(structure).ravel()[structure.free_dofs]
    return np.concatenate([free, [body.mass, body.mass, body.moment_of_inertia]])


def mass_matrix(structure: Structure, y: Array, kind: str) -> csc_matrix:
    """Return the mass matrix (size, size) of strips and body at y, "consistent" or "lumped"."""
    if kind == "lumped":
        masses = np.eye(6)[:, :, None] * lumped_elements(structure)
    elif structure.model.element == "reissner":
        masses = _linear_elements(structure)
    else:
        masses = _cubic_elements(structure, y)
    strips = structure.reduced_matrix(masses, y[-1], 0.0)
    whole: csc_matrix = (strips + _body_block(structure, y[-1])).tocsc()
    return whole


def _body_block(structure: Structure, theta: float) -> csc_matrix:
    """Return the mass of the body alone for the displacement of the reduction's point and the rotation."""
    body = structure.model.body
    c, s = np.cos(theta), np.sin(theta)
    gx, gy = body.centre - structure.point
    slope = np.array([[1.0, 0.0, -s * gx - c * gy], [0.0, 1.0, c * gx - s * gy]])
    block = body.mass * slope.T @ slope
    block[2, 2] += body.moment_of_inertia
    last = np.arange(structure.size - 3, structure.size)
    indices = (np.repeat(last, 3), np.tile(last, 3))
    placed: csc_matrix = coo_matrix((block.ravel(), indices), (structure.size, structure.size)).tocsc()
    return placed


def _linear_elements(structure: Structure) -> Array:
    """Return consistent masses (6, 6, E) of linear u_x, u_y and phi."""
    e = structure.elements
    line = np.stack([e.linear_density, e.linear_density, e.rotary_density]) * e.length / 6.0
    blocks = np.array([[2.0, 1.0], [1.0, 2.0]])
    masses: Array = np.einsum("ab,ie,ij->aibje", blocks, line, np.eye(3)).reshape(6, 6, -1)
    return masses


def _cubic_elements(structure: Structure, y: Array) -> Array:
    """Return consistent masses (6, 6, E) of linear stretching and cubic bending in the frame of the chord."""
    e = structure.elements
    u = structure.element_displacement(y)
    c, s = (chord := e.chord + u[3:5] - u[0:2]) / np.hypot(*chord)
    one, zero = np.ones_like(c), np.zeros_like(c)
    along, across = np.array([0, 3]), np.array([1, 2, 4, 5])
    local = np.zeros((6, 6, len(c)))
    local[np.ix_(along, along)] = np.array([[140.0, 70.0], [70.0, 140.0]])[..., None]
    numbers = np.array(
        [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]], dtype=float
    )
    lever = np.stack([one, e.length, one, e.length])
    local[np.ix_(across, across)] = numbers[..., None] * lever[:, None] * lever[None, :]
    frame = np.array([[c, s, zero], [-s, c, zero], [zero, zero, one]])
    turn = np.zeros((6, 6, len(c)))
    turn[:3, :3] = turn[3:, 3:] = frame
    masses: Array = np.einsum("kie,kle,lje->ije", turn, local, turn) * e.linear_density * e.length / 420.0
    return masses
