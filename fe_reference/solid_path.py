"""A rigid body on solid strips: equilibrium along a prescribed rotation.

The root faces of the strips are fixed to the ground, the tip faces move with the body in the plane. The
interior of each strip is condensed to the three coordinates of the body. Newton's method for the body and
for the interiors is one loop: the torque from the condensed force is then of second order in the error.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded

from .arrays import Array
from .errors import ConvergenceError, InvalidParameter, finite
from .solid import SolidStrip

#: Newton iterations of one state, and the largest correction of a solved state in thicknesses.
ITERATIONS, CORRECTION = 30, 1e-9
#: Rotations that are closer than this are one node of the polynomial that predicts a state [rad].
APART = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidPath:
    """States of a body on solid strips, one for each rotation.

    Attributes
    ----------
    rotation : (S,) rad
    torque : (S,) N m
        Driving torque, counter-clockwise positive.
    centre : (S, 2) m
        Place of the body point that is at `centre` at rest.
    largest_strain : (S,)
        Largest component of Green's strain at the points of all strips.
    unknowns : int
        Free displacements of one strip.
    iterations : int
        Newton iterations of the whole path.
    """

    rotation: Array
    torque: Array
    centre: Array
    largest_strain: Array
    unknowns: int
    iterations: int


def solve_solids(
    strip: SolidStrip,
    ends: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    rotations: Sequence[float],
    *,
    centre: tuple[float, float],
) -> SolidPath:
    """Rotate a rigid body on equal strips, its translation free.

    Parameters
    ----------
    strip : SolidStrip
        The mesh of each strip.
    ends : sequence of pairs of points, m
        Root and tip of every strip at rest; their distance is the length of the strip.
    rotations : (S,) rad
        Rotations of the states in order. Small first steps (1, 2.5, 5, 9 degrees) help Newton's method.
        A rotation may occur twice.
    centre : (2,) m
        Point of the body whose path is reported.

    Returns
    -------
    SolidPath

    Raises
    ------
    ConvergenceError
        A state that Newton's method does not reach, or one that is unstable.
    InvalidParameter
        A rotation that is not finite, or strips that do not have the length of the mesh.

    References
    ----------
    Bonet and Wood (2008), as in ``fe_reference.solid``.

    Examples
    --------
    >>> strip = SolidStrip(
    ...     length=0.03, width=8e-3, thickness=1e-3, youngs_modulus=114e9, poisson_ratio=0.34, mesh=(6, 1, 1)
    ... )
    >>> path = solve_solids(strip, [((0.0, 0.0), (0.03, 0.0))], [0.01], centre=(0.03, 0.0))
    >>> bool(path.torque[0] > 0.0)
    True
    """
    body = _Body(strip=strip, ends=np.asarray(ends, dtype=float), centre=np.asarray(centre, dtype=float))
    states: list[tuple[Array, Array]] = []
    torques, strains, taken = [], [], 0
    known = [(np.zeros(3), np.zeros((len(body.ends), *strip.nodes.shape)))]
    at = [0.0]
    for given in rotations:
        rotation = finite("rotations", given, "rad")
        pose, u = _predicted(at, known, rotation)
        pose, u, torque, used = body.equilibrium(pose, u, rotation)
        taken += used
        states.append((pose, u))
        torques.append(torque)
        strains.append(body.largest_strain(u))
        if min(abs(rotation - other) for other in at) > APART:
            at, known = [*at, rotation][-4:], [*known, (pose, u)][-4:]
    return SolidPath(
        rotation=np.asarray(rotations, dtype=float),
        torque=np.array(torques),
        centre=np.array([body.centre + pose[:2] for pose, _ in states]),
        largest_strain=np.array(strains),
        unknowns=strip.unknowns,
        iterations=taken,
    )


def _predicted(
    at: Sequence[float], known: Sequence[tuple[Array, Array]], rotation: float
) -> tuple[Array, Array]:
    """Return pose and displacements by the polynomial through the last states, or the last of few states."""
    if len(at) < 3:
        return known[-1]
    weights = [
        math.prod((rotation - other) / (own - other) for k, other in enumerate(at) if k != i)
        for i, own in enumerate(at)
    ]
    pose, u = (sum(w * state[k] for w, state in zip(weights, known, strict=True)) for k in range(2))
    return np.asarray(pose), np.asarray(u)


def _failed(rotation: float, why: str) -> str:
    return f"solids at {math.degrees(rotation):.4g} deg: {why}; use smaller steps"


@dataclass(frozen=True, kw_only=True, eq=False)
class _Body:
    """The body, its strips' ends (G, 2, 2) and its reference point (2,) [m]."""

    strip: SolidStrip
    ends: Array
    centre: Array

    @cached_property
    def axes(self) -> Array:
        """Direction of the strips and their normals as rows (G, 2, 2)."""
        along = (self.ends[:, 1] - self.ends[:, 0]) / self.strip.length
        if not np.allclose(np.hypot(*along.T), 1.0, rtol=1e-9):
            raise InvalidParameter("ends", self.ends.tolist(), "strips of the length of the mesh [m]")
        return np.stack([along, np.stack([-along[:, 1], along[:, 0]], axis=1)], axis=1)

    @cached_property
    def arms(self) -> Array:
        """Nodes of the tip faces from the reference point at rest (G, T, 2) [m]."""
        local = self.strip.nodes[self.strip.tip, :2]
        return self.ends[:, None, 0] + local @ self.axes - self.centre

    def tips(self, pose: Array) -> tuple[Array, Array, Array]:
        """Return displacements of the tip faces in the axes of the strips (G, T, 2), their derivatives by the
        pose (G, T, 2, 3) and second derivatives by the rotation (G, T, 2)."""
        cos, sin = math.cos(pose[2]), math.sin(pose[2])
        turn, slope = np.array([[cos, -sin], [sin, cos]]), np.array([[-sin, -cos], [cos, -sin]])
        into = self.axes.swapaxes(1, 2)
        shift = pose[:2] + self.arms @ turn.T - self.arms
        rates = np.zeros((*self.arms.shape, 3))
        rates[..., :2], rates[..., 2] = np.eye(2), self.arms @ slope.T
        local = np.einsum("gtik,gij->gtjk", rates, into)
        return shift @ into, local, (-self.arms @ turn.T) @ into

    def equilibrium(self, pose: Array, u: Array, rotation: float) -> tuple[Array, Array, float, int]:
        """Return pose, displacements (G, N, 3), torque and iterations at a rotation, from a guess."""
        turn = rotation - pose[2]
        for iteration in range(1, ITERATIONS + 1):
            force, stiffness, solved = np.zeros(3), np.zeros((3, 3)), []
            _, rates, bend = self.tips(pose)
            for g in range(len(self.ends)):
                own, matrix, found = self._condensed(u[g], rates[g], bend[g], rotation)
                force, stiffness = force + own, stiffness + matrix
                solved.append(found)
            change = np.array([0.0, 0.0, turn])
            change[:2] = -np.linalg.solve(stiffness[:2, :2], force[:2] + stiffness[:2, 2] * turn)
            torque = float(force[2] + stiffness[2] @ change)
            pose = pose + change
            place, _, _ = self.tips(pose)
            moved = []
            for g, found in enumerate(solved):
                step = np.zeros(u[g].size)
                step[self.strip.free] = -found[:, 0] - found[:, 1:] @ change
                step = step.reshape(-1, 3)
                step[self.strip.tip, :2] = rates[g] @ change
                each = self.strip.moved(u[g], step)
                each[self.strip.tip, :2] = place[g]
                moved.append(each)
            largest = float(np.abs(np.stack(moved) - u).max()) / self.strip.thickness
            u, turn = np.stack(moved), 0.0
            if largest < CORRECTION:
                return pose, u, torque, iteration
        raise ConvergenceError(_failed(rotation, f"no equilibrium in {ITERATIONS} iterations"))

    def _condensed(self, u: Array, rates: Array, bend: Array, rotation: float) -> tuple[Array, Array, Array]:
        """Return force (3,) and stiffness (3, 3) of a strip on the pose, and the answers of the interior
        (F, 4): to its residual and to each coordinate of the pose."""
        strip = self.strip
        moves = np.zeros((u.size, 3))
        places = 3 * strip.tip
        for axis in range(2):
            moves[places + axis] = rates[:, axis]
        nodal, band, product = strip.assembled(u, moves)
        free = strip.free
        try:
            factor = cholesky_banded(band, lower=True, overwrite_ab=True, check_finite=False)
        except LinAlgError:
            raise ConvergenceError(_failed(rotation, "the stiffness is not positive")) from None
        right = np.column_stack([nodal[free], product[free]])
        solved = cho_solve_banded((factor, True), right, check_finite=False)
        force = moves.T @ nodal - product[free].T @ solved[:, 0]
        stiffness = moves.T @ product - product[free].T @ solved[:, 1:]
        stiffness[2, 2] += (nodal.reshape(-1, 3)[strip.tip, :2] * bend).sum()
        return force, stiffness, solved

    def largest_strain(self, u: Array) -> float:
        """Return the largest component of Green's strain at the points of all strips."""
        gradient, _ = self.strip.gradients
        most = 0.0
        for each in u:
            own = each.reshape(-1)[self.strip.elements].reshape(len(gradient), -1, 3)
            slope = np.einsum("eqnj,eni->eqij", gradient, own, optimize=True)
            strain = 0.5 * (slope + slope.swapaxes(2, 3) + slope.swapaxes(2, 3) @ slope)
            most = max(most, float(np.abs(strain).max()))
        return most
