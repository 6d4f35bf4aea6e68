"""A solved path carried over to more control points and corrected there, state by state.

A curve of degree n - 1 is one of any higher degree too, with other control points: the solved
states start Newton's method so near to the finer ones that no path need be followed.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.fast.body import Frame
from spline_model.fast.path import Answer, newton, tangent
from spline_model.fast.solve import TOLERANCE, arrays, empty_answer, frame_of, grid_of, mode_count
from spline_model.mechanism import Mechanism
from spline_model.strip.compiled import kernel

Array = NDArray[np.float64]


def refined(coarse: Mechanism, rotations: Array, y: Array, finer: Mechanism) -> Answer | None:
    """Solve ``finer``, the same strips with more control points, from states y (S, Y) of ``coarse``.

    rotations (S,) [rad]. Returns the answer at the same rotations, or None where Newton's
    method does not converge from a state.
    """
    design, grid, frame = coarse.design, grid_of(finer.design), frame_of(finer)
    locals_, space = arrays(len(design.strips), grid)
    answer = empty_answer(len(rotations), len(space.y))
    answer.y[:] = carried_over(y, rotations, frame, design.discretisation.control_points, mode_count(design))
    done = correct(rotations, frame, grid, locals_, space, TOLERANCE, answer)
    return answer if done else None


def carried_over(y: Array, rotations: Array, finer: Frame, count: int, modes: int) -> Array:
    """States y (S, Y) of strips with ``count`` control points in the unknowns of the frame ``finer``.

    The speeds at the clamps stay, the control points between are raised in degree, axial
    forces keep their Legendre coefficients; the slide force, which the finer strips do not
    have at that degree, starts from zero.
    """
    strips, more = finer.compliance.shape
    target = count + more - modes
    own, own_finer = 2 * count - 6, 2 * target - 6
    raised = np.empty((len(y), 2 + strips * (own_finer + more)))
    raised[:, :2] = y[:, :2]
    raise_degree = _elevation(count, target)[2:-2]
    for s in range(strips):
        at, to = 2 + s * (own + modes), 2 + s * (own_finer + more)
        inner = raise_degree @ _control_points(y[:, at : at + own], y[:, :2], rotations, finer, s)
        raised[:, to] = y[:, at]
        raised[:, to + 1 : to + own_finer - 1] = inner.reshape(len(y), -1)
        raised[:, to + own_finer - 1] = y[:, at + own - 1]
        forces = raised[:, to + own_finer : to + own_finer + more]
        forces[:] = 0.0
        kept = min(modes, count - 2)
        forces[:, :kept] = y[:, at + own : at + own + kept]
    return raised


def _control_points(w: Array, centre: Array, rotations: Array, frame: Frame, s: int) -> Array:
    """Control points (S, n, 2) of strip s in its clamp's frame over its length, from w (S, W)."""
    n = (w.shape[1] + 6) // 2
    cos, sin = np.cos(rotations), np.sin(rotations)
    (c, d), (ax, ay), length = frame.axis[s], frame.arm[s], frame.length[s]
    x = (centre[:, 0] * frame.length[0] + cos * ax - sin * ay - frame.root[s, 0]) / length
    z = (centre[:, 1] * frame.length[0] + sin * ax + cos * ay - frame.root[s, 1]) / length
    tip = np.column_stack((c * x + d * z, c * z - d * x))
    points = np.zeros((len(w), n, 2))
    points[:, 1, 0] = w[:, 0] / (n - 1)
    points[:, 2 : n - 2] = w[:, 1:-1].reshape(len(w), n - 4, 2)
    points[:, n - 2] = tip - w[:, -1:] / (n - 1) * np.column_stack((cos, sin))
    points[:, n - 1] = tip
    return points


@lru_cache(maxsize=64)
def _elevation(count: int, target: int) -> Array:
    """Matrix (target, count) that gives a Bezier curve more control points.

    Source: Piegl and Tiller, The NURBS Book (1997), Eq 5.36.
    """
    matrix = np.zeros((target, count))
    more = target - count
    for i in range(target):
        for j in range(max(0, i - more), min(count, i + 1)):
            matrix[i, j] = math.comb(count - 1, j) * math.comb(more, i - j) / math.comb(target - 1, i)
    return matrix


@kernel()
def correct(rotations, frame, grid, locals_, space, tolerance, answer):
    """Newton's method from each state in answer.y, in place; fills the answer. False where it fails."""
    out = space.out
    for row in range(rotations.size):
        y = answer.y[row]
        if not newton(y, rotations[row], frame, grid, locals_, space, out, tolerance, answer.counters):
            return False
        torque, stiffness, _ = tangent(y, rotations[row], frame, grid, locals_, space)
        answer.torque[row], answer.stiffness[row] = torque, stiffness
        answer.energies[row, 0], answer.energies[row, 1] = out[0], out[1]
    return True
