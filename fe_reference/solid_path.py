"""A rigid body on solid strips: equilibrium along a prescribed rotation.

The root faces of the strips are fixed to the ground, the tip faces move with the body in the plane. The
interior of each strip is condensed to the three coordinates of the body. Newton's method for the body and
for the interiors is one loop: the torque from the condensed force is then of second order in the error.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import krogh_interpolate
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded

from .arrays import Array
from .errors import ConvergenceError, InvalidParameter, finite
from .solid import SolidStrip

#: Newton iterations of one state, and its largest last correction in thicknesses, which leaves the square.
ITERATIONS, CORRECTION = 30, 1e-6
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
    """

    rotation: Array
    torque: Array
    centre: Array
    largest_strain: Array


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
    ...     length=0.03, width=8e-3, thickness=1e-3, youngs_modulus=114e9, poisson_ratio=0.34, fineness=1
    ... )
    >>> path = solve_solids(strip, [((0.0, 0.0), (0.03, 0.0))], [0.01], centre=(0.03, 0.0))
    >>> bool(path.torque[0] > 0.0)
    True
    """
    root, tip = (np.asarray(ends, dtype=float) @ [1.0, 1.0j]).T
    axes = (tip - root) / strip.length
    if not np.allclose(np.abs(axes), 1.0, rtol=1e-9):
        raise InvalidParameter("ends", np.asarray(ends).tolist(), "strips of the length of the mesh [m]")
    local = strip.nodes[strip.tip, :2] @ [1.0, 1.0j]
    body = _Body(strip, axes, root[:, None] + np.multiply.outer(axes, local) - complex(*centre))
    at, known = [0.0], [np.zeros(3 + len(axes) * strip.nodes.size)]
    turns, states = [finite("rotations", each, "rad") for each in rotations], []
    for rotation in turns:
        guess = krogh_interpolate(at, np.stack(known), rotation) if len(at) > 2 else known[-1]
        state, moment = body.equilibrium(np.asarray(guess), rotation)
        strains = (np.abs(strip.strained(u)[1]).max() for u in body.strips(state))
        states.append((moment, *state[:2], max(strains)))
        if min(abs(rotation - other) for other in at) > APART:
            at, known = [*at, rotation][-4:], [*known, state][-4:]
    torque, *moved, strain = np.array(states).T
    places = np.transpose(moved) + np.asarray(centre)
    return SolidPath(rotation=np.array(turns), torque=torque, centre=places, largest_strain=strain)


@dataclass(frozen=True, eq=False)
class _Body:
    """The body on its strips, whose directions are `axes` (G,), and the nodes of whose tip faces are `arms`
    from the reference point at rest (G, T) [m]; x + i y.

    A state has displacement and rotation of the body (3,) and displacements of the strips (G, N, 3), in the
    axes of each strip.
    """

    strip: SolidStrip
    axes: Any
    arms: Any

    def strips(self, state: Array) -> Array:
        """Return the displacements of the strips (G, N, 3) of a state, a view."""
        return state[3:].reshape(len(self.axes), -1, 3)

    def equilibrium(self, state: Array, rotation: float) -> tuple[Array, float]:
        """Return state and torque at a rotation, from a guess."""
        strip, coordinates = self.strip, 3 * self.strip.tip
        axes = self.axes[:, None]
        for _ in range(ITERATIONS):
            turned = np.exp(1j * state[2]) * self.arms / axes
            rates = np.stack(np.broadcast_arrays(1.0 / axes, 1j / axes, 1j * turned), axis=2)
            moves = np.zeros((len(axes), strip.nodes.size, 3))
            moves[:, coordinates], moves[:, coordinates + 1] = rates.real, rates.imag
            try:
                parts = list(map(self._condensed, self.strips(state), moves, -turned))
            except LinAlgError:  # the stiffness is not positive
                break
            force, stiffness = (np.sum([each[k] for each in parts], axis=0) for k in range(2))
            change = np.array([0.0, 0.0, rotation - state[2]])
            change[:2] = -np.linalg.solve(stiffness[:2, :2], force[:2] + stiffness[:2, 2] * change[2])
            torque, before, state = float(force[2] + stiffness[2] @ change), state, state.copy()
            state[:3] = *(state[:2] + change[:2]), rotation
            place = (complex(*state[:2]) + (np.exp(1j * rotation) - 1.0) * self.arms) / axes
            for u, each, (_, _, interior) in zip(self.strips(state), place, parts, strict=True):
                u.reshape(-1)[strip.free] -= interior @ [1.0, *change]
                u[strip.tip, 0], u[strip.tip, 1] = each.real, each.imag
            if np.abs(state[3:] - before[3:]).max() < CORRECTION * strip.thickness:
                return state, torque
        raise ConvergenceError(f"solids at {math.degrees(rotation):.4g} deg: not stable; use smaller steps")

    def _condensed(self, u: Array, moves: Array, bend: Any) -> tuple[Array, Array, Array]:
        """Return force (3,) and stiffness (3, 3) of a strip on the pose, and the answers of the interior
        (F, 4): to its residual and to each coordinate of the pose."""
        strip, free = self.strip, self.strip.free
        nodal, band, product = strip.assembled(u, moves)
        factor = cholesky_banded(band, lower=True, overwrite_ab=True, check_finite=False)
        right = np.column_stack([nodal[free], product[free]])
        solved = cho_solve_banded((factor, True), right, check_finite=False)
        force = moves.T @ nodal - product[free].T @ solved[:, 0]
        stiffness = moves.T @ product - product[free].T @ solved[:, 1:]
        tip = nodal.reshape(-1, 3)[strip.tip, :2]
        stiffness[2, 2] += (tip[:, 0] * bend.real + tip[:, 1] * bend.imag).sum()
        return force, stiffness, solved
