"""From the states of a reduced path to the unknowns of the scene, multipliers included."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.reduced.arrays import Answer
from spline_model.reduced.model import Reduced
from spline_model.solution import Later
from spline_model.strip.compiled import kernel
from spline_model.strip.element import GRADIENT, POINTS, SHEAR
from spline_model.strip.ends import place_points
from spline_model.strip.points import evaluate_residual

Array = NDArray[np.float64]


@kernel()
def _place_all(y, poses, shape, strips, local, out, points, forces):
    """Control points (S, G, 2 n) and, from the gradient, what the clamps do to the strips (S, G, 2, 3).

    A clamp's force is what its two control points ask for, its moment what the inner one asks for
    across its direction.
    """
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    for row in range(y.shape[0]):
        for s in range(strips.roots.size):
            at = poses + s * (own + modes)
            state = y[row]
            place_points(s, state[at : at + own], state, strips, local)
            evaluate_residual(s, state[at + own : at + own + modes], n, shape, strips, local, out)
            p, g = local.nodal[s, POINTS], local.nodal[s, GRADIENT]
            for i in range(2 * n):
                points[row, s, i] = p[i]
            for end in range(2):
                inner = 2 * n - 8 + 2 * end
                outer = 2 * n - 2 - 2 * end
                forces[row, s, end, 0] = g[inner] + g[outer]
                forces[row, s, end, 1] = g[inner + 1] + g[outer + 1]
                forces[row, s, end, 2] = (p[inner] - p[outer]) * g[inner + 1] - (
                    p[inner + 1] - p[outer + 1]
                ) * g[inner]


def by_state(model: Reduced, factors: Array, answer: Answer) -> dict[str, Any]:
    """What a ``Path`` has by state, in the scene's unknowns and in SI units; factors (S,)."""
    bodies = answer.y[:, : 3 * len(model.system.scene.bodies)].copy()
    bodies[:, 0::3] *= model.length
    bodies[:, 1::3] *= model.length
    return {
        "load_factor": factors,
        "poses": bodies,
        "reactions": answer.reaction * (model.energy / model.drive_length),
        "unknowns": Later(partial(unknowns_of, model, answer.y, answer.reaction)),
        "stiffness": answer.stiffness * model.energy,
        "energies": _energies(model, answer) * model.energy,
        "done": answer.done * model.energy,
        "inertia": answer.inertia,
        "moment_defect": answer.defect,
    }


def unknowns_of(model: Reduced, y: Array, reaction: Array) -> Array:
    """The scene's unknowns (S, N) at states y (S, Y) with reactions on the drives (S, D)."""
    strips, shape, n = model.strips, model.shape, len(model.shape.order)
    points = np.zeros((len(y), len(strips.roots), 2 * n))
    forces = np.zeros((len(y), len(strips.roots), 2, 3))
    _place_all(y, len(model.bodies.rest), shape, strips, model.local(), np.zeros(5), points, forces)
    return gathered(model, y, points, forces, reaction)


def gathered(model: Reduced, y: Array, points: Array, forces: Array, reaction: Array) -> Array:
    """Unknowns z (..., N) from y (..., Y), control points and clamp forces as of ``_place_all``, and
    reactions (..., D) of the drives."""
    system, shape = model.system, model.shape
    scene, layout, n = system.scene, system.layout, len(shape.order)
    many = y.shape[:-1]
    z = np.zeros((*many, layout.size), dtype=points.dtype)
    for i, body in enumerate(scene.bodies):
        z[..., layout.body(body.name)] = y[..., 3 * i : 3 * i + 3] * [model.length, model.length, 1.0]
    unit = model.energy / model.length * np.array([1.0, 1.0, model.length])
    for s, strip in enumerate(scene.strips):
        in_order = np.empty((*many, n, 2), dtype=points.dtype)
        in_order[..., shape.order, :] = points[..., s, :].reshape(*many, n, 2)
        on_curve = in_order[..., : strip.basis.control_points, :].reshape(*many, -1)
        z[..., layout.strip(strip.name)] = on_curve * model.length
        force = y[..., model.places(s)[1]] @ model.to_modes[s].T * (model.energy / model.length)
        done = 0
        for i, effect in enumerate(scene.of(MixedStretching)):
            if effect.strip == strip.name:
                z[..., layout.axial_modes(i)] = force[..., done : done + effect.modes.count]
                done += effect.modes.count
        for end, place in (("start", 0), ("end", 1)):
            if (strip.name, end) in scene.clamps:
                z[..., scene.clamps[strip.name, end]] = forces[..., s, place, :] * unit
    drives = system.drives
    z[..., drives.row] = reaction * unit[2 * drives.turns]
    return z


def _energies(model: Reduced, answer: Answer) -> Array:
    """Bending and axial energy (S, 2) of states [EI/L], where strips shear (S, 3) apart from the axial one
    what the springs of their tips hold less the part of N: ``effects.Shear``."""
    if not model.shears:
        return answer.energies
    strips, states = model.strips, len(answer.y)
    own = answer.y[:, len(model.bodies.rest) :].reshape(states, len(strips.roots), -1)
    spring, length = strips.numbers[:, SHEAR], strips.speed @ model.shape.weight
    at, first = 2 * model.yields, 2 * len(model.shape.order) - 6
    apart, force = own[..., at : at + 2], own[..., first : first + strips.split]
    held = spring * (apart**2).sum(axis=-1) - (force**2).sum(axis=-1) / (spring * length)
    shear, (bending, axial) = 0.5 * held.sum(axis=1), answer.energies.T
    return np.stack((bending, axial - shear, shear), axis=1)
