"""A released body on its strips in reduced coordinates: constants of the compiled time steps.

    r = (x, y, theta of the body; for each strip P1x, P2, ..., P_(n-3), l)

with the strip's control points over L in its ground clamp's frame and l the distance of
P_(n-2) from the tip, so that both clamps hold by construction. The mass matrix of a strip is
constant in its control points and the same along both axes, B; its inner points i follow
from its two end points p = (n - 2, n - 1),

    p_i'' = -k B_ii^-1 g_i - W p_p'',   W = B_ii^-1 B_ip,   (B_pp - B_pi W) p_p'' = -k (g_p - W^T g_i),

with k = EI / (mu L^4); P1y is held by the clamp, hence two sets of inner points.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.fast.frame import Frame, Grid
from spline_model.fast.strip_force import axial_matrix

Array = NDArray[np.float64]


class Swing(NamedTuple):
    """S strips of n control points under one body.

    axial (S, G, G): see ``axial_matrix``; mass (S,) [kg] of a strip; rate (S,) EI/(mu L^4)
    [1/s^2]; body (2,) mass and moment of inertia [kg, kg m^2]; along (S, n, n) and across
    (S, n, n) hold (B_ii^-1, W) in the rows of the inner points; ends (S, 2, 3) are
    (aa, ab, bb) of B_pp - B_pi W along and across the clamp.
    """

    frame: Frame
    grid: Grid
    axial: NDArray[np.float64]
    mass: NDArray[np.float64]
    rate: NDArray[np.float64]
    body: NDArray[np.float64]
    along: NDArray[np.float64]
    across: NDArray[np.float64]
    ends: NDArray[np.float64]


class SwingSpace(NamedTuple):
    """Working arrays of one run: x, y, force_x, force_y (S, n) of the strips' points; tips (S, 11)."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    force_x: NDArray[np.float64]
    force_y: NDArray[np.float64]
    at_points: NDArray[np.float64]
    stretch: NDArray[np.float64]
    tips: NDArray[np.float64]
    ahead: NDArray[np.float64]
    mean: NDArray[np.float64]


def swing_of(frame: Frame, grid: Grid, masses: list[Array], body: Array) -> Swing:
    """Constants from the strips' mass matrices (n, n) [kg], one for each component, and the body's (2,)."""
    total = np.array([matrix.sum() for matrix in masses])
    n = grid.d1.shape[1]
    along = [_reduce(matrix / matrix.sum(), np.arange(1, n - 2)) for matrix in masses]
    across = [_reduce(matrix / matrix.sum(), np.arange(2, n - 2)) for matrix in masses]
    return Swing(
        frame=frame,
        grid=grid,
        axial=np.array([axial_matrix(grid, c) for c in frame.compliance]),
        mass=total,
        rate=frame.rigidity / (total * frame.length**3),
        body=body,
        along=np.array([inner for inner, _ in along]),
        across=np.array([inner for inner, _ in across]),
        ends=np.array([[x, y] for (_, x), (_, y) in zip(along, across, strict=True)]),
    )


def _reduce(matrix: Array, inner: NDArray[np.int64]) -> tuple[Array, Array]:
    """(B_ii^-1, W) in the inner rows of (n, n), and the three entries of the end points' reduced mass."""
    ends = np.array([len(matrix) - 2, len(matrix) - 1])
    inverse = np.linalg.inv(matrix[np.ix_(inner, inner)])
    follow = inverse @ matrix[np.ix_(inner, ends)]
    reduced = matrix[np.ix_(ends, ends)] - matrix[np.ix_(ends, inner)] @ follow
    rows = np.zeros_like(matrix)
    rows[np.ix_(inner, inner)] = inverse
    rows[np.ix_(inner, ends)] = follow
    return rows, reduced[[0, 0, 1], [0, 1, 1]]


def swing_space(swing: Swing) -> SwingSpace:
    """Working arrays for a swing."""
    strips, points, n = len(swing.mass), len(swing.grid.weight), swing.grid.d1.shape[1]
    size = 3 + strips * (2 * n - 6)
    return SwingSpace(
        x=np.zeros((strips, n)),
        y=np.zeros((strips, n)),
        force_x=np.zeros((strips, n)),
        force_y=np.zeros((strips, n)),
        at_points=np.zeros((4, points)),
        stretch=np.zeros(points),
        tips=np.zeros((strips, 11)),
        ahead=np.zeros(size),
        mean=np.zeros(size),
    )
