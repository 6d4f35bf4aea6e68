"""From the fast path's answer to the unknowns of the multiplier path, multipliers included."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import AxialModes, gauss_legendre
from spline_model.compile import System
from spline_model.effects import Clamp, DrivenRotation, MixedStretching
from spline_model.effects.base import Constraint
from spline_model.fast.body import Frame
from spline_model.fast.path import Answer
from spline_model.kernels.assemble import assemble

Array = NDArray[np.float64]


def states_of(system: System, frame: Frame, rotations: Array, answer: Answer) -> Array:
    """States z (S, N) of a path; rotations (S,) [rad], the unloaded one first.

    The multipliers follow from the gradient of the energy: the clamp's force is what its two
    control points ask for, its moment what the inner one asks for across the clamp's direction.
    """
    layout, scene = system.layout, system.scene
    states = np.zeros((len(rotations), layout.size))
    centre = answer.y[: len(rotations), :2] * frame.length[0]
    states[:, layout.body(scene.bodies[0].name)] = np.column_stack((centre, rotations))
    modes = frame.compliance.shape[1]
    own = (answer.y.shape[1] - 2) // len(frame.length) - modes
    for s, strip in enumerate(scene.strips):
        at = 2 + s * (own + modes)
        w, a = (
            answer.y[: len(rotations), at : at + own],
            answer.y[: len(rotations), at + own : at + own + modes],
        )
        states[:, layout.strip(strip.name)] = _control_points(frame, s, centre, rotations, w)
        force = a * frame.rigidity[s] / frame.length[s] ** 2
        for i, effect in enumerate(scene.of(MixedStretching)):
            if effect.strip == strip.name:
                states[:, layout.axial_modes(i)] = force @ _in_modes(effect.modes, modes)
    _add_multipliers(system, states, answer.torque[: len(rotations)])
    return states


def _control_points(frame: Frame, s: int, centre: Array, rotations: Array, w: Array) -> Array:
    """Control points (S, 2 n) of one strip in the ground's frame."""
    count, n = len(rotations), (w.shape[1] + 6) // 2
    cos, sin = np.cos(rotations), np.sin(rotations)
    arm = np.column_stack(
        (
            cos * frame.arm[s, 0] - sin * frame.arm[s, 1],
            sin * frame.arm[s, 0] + cos * frame.arm[s, 1],
        )
    )
    turn = np.array([[frame.axis[s, 0], -frame.axis[s, 1]], [frame.axis[s, 1], frame.axis[s, 0]]])
    reach = frame.length[s] / (n - 1)
    points = np.empty((count, n, 2))
    points[:, 0] = frame.root[s]
    points[:, 1] = frame.root[s] + reach * w[:, :1] * frame.axis[s]
    points[:, 2 : n - 2] = frame.root[s] + frame.length[s] * w[:, 1:-1].reshape(count, n - 4, 2) @ turn.T
    points[:, n - 1] = centre + arm
    tip = np.column_stack((cos, sin)) @ turn.T
    points[:, n - 2] = points[:, n - 1] - reach * w[:, -1:] * tip
    return points.reshape(count, 2 * n)


@cache
def _in_modes(modes: AxialModes, count: int) -> Array:
    """Legendre coefficients (count,) -> coefficients of the modes: a matrix (count, modes)."""
    nodes, weights = gauss_legendre(count + modes.count)
    first, values = modes.evaluate((nodes + 1) / 2)
    full = np.zeros((len(nodes), modes.count))
    np.put_along_axis(full, first[:, None] + np.arange(values.shape[1]), values, axis=1)
    gram = full.T @ (weights[:, None] * full)
    return np.asarray(
        np.linalg.solve(gram, full.T @ (weights[:, None] * legendre.legvander(nodes, count - 1))).T
    )


def _add_multipliers(system: System, states: Array, torque: Array) -> None:
    """Fill the multipliers of clamps and drive from the gradient at each state."""
    layout, size = system.layout, system.layout.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    clamps = [(c, layout.rows(i)) for i, c in enumerate(system.scene.of(Constraint)) if isinstance(c, Clamp)]
    drives = [
        layout.rows(i) for i, c in enumerate(system.scene.of(Constraint)) if isinstance(c, DrivenRotation)
    ]
    for z, moment in zip(states, torque, strict=True):
        assemble(z, system.tables, 0.0, gradient, hessian)
        for clamp, rows in clamps:
            start, count = layout.strips[clamp.strip]
            end, inner, sign = (0, 1, 1.0) if clamp.end == "start" else (count - 1, count - 2, -1.0)
            e, i = start + 2 * end, start + 2 * inner
            chord = sign * (z[i : i + 2] - z[e : e + 2])
            pull, push = gradient[i : i + 2], gradient[e : e + 2]
            z[rows] = (*(pull + push), sign * (chord[0] * pull[1] - chord[1] * pull[0]))
        for rows in drives:
            z[rows] = moment
