"""From states of a reduced path to the unknowns of the scene, multipliers included, and how these change: the
tangent with nothing condensed, and how control points move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.reduced.arrays import AXIAL
from spline_model.reduced.assembly import assemble, place_of
from spline_model.reduced.model import Reduced
from spline_model.strip.compiled import called, kernel
from spline_model.strip.element import GRADIENT, LAST, POINTS
from spline_model.strip.ends import place_points, to_element
from spline_model.strip.points import evaluate_points, evaluate_residual

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


def unknowns_of(model: Reduced, y: Array, reaction: Array, clamped: Array | None = None) -> Array:
    """The scene's unknowns (S, N) at states y (S, Y) with reactions on the drives (S, D).

    clamped (S, G, 2, 3): what the clamps do to the strips; by default what holds them in equilibrium.
    """
    strips, shape, n = model.strips, model.shape, len(model.shape.order)
    points = np.zeros((len(y), len(strips.roots), 2 * n))
    forces = np.zeros((len(y), len(strips.roots), 2, 3))
    _place_all(y, len(model.bodies.rest), shape, strips, model.local(), np.zeros(5), points, forces)
    return gathered(model, y, points, forces if clamped is None else clamped, reaction)


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


def body_tangents(model: Reduced, y: Array) -> Array:
    """Tangents (S, Q, Q) at the bodies with all strips condensed at y (S, Y), in EI/L; nan of a singular
    strip."""
    arrays = model.arrays()
    found = np.empty((len(y), *arrays.space.tangent.shape))
    _condense_all(y, arrays, found)
    return found


@kernel()
def _condense_all(y, arrays, tangents):
    for row in range(y.shape[0]):
        singular = np.isinf(assemble(y[row], 0.0, arrays))
        for i in range(tangents.shape[1]):
            for j in range(i, tangents.shape[1]):
                value = np.nan if singular else arrays.space.tangent[i, j]
                tangents[row, i, j] = tangents[row, j, i] = value


def whole_tangents(model: Reduced, y: Array) -> tuple[Array, Array]:
    """Gradient (S, Y) and Hessian (S, Y, Y) of the strips' energy in y (S, Y), in EI/L, axial forces among y.

    Dead loads on the strips are in it; weight of, and loads on, the bodies are not.
    """
    count, size = y.shape
    gradient, hessian = np.zeros((count, size)), np.zeros((count, size, size))
    poses, local = len(model.bodies.rest), model.local()
    _assemble(y, poses, model.strips, model.shape, local, np.zeros(5), gradient, hessian)
    return gradient, hessian


@kernel()
def _assemble(y, poses, strips, shape, local, out, gradient, hessian):
    """Add all strips of all states."""
    modes = strips.compliance.shape[1]
    own = 2 * shape.order.size - 6
    for row in range(y.shape[0]):
        for s in range(strips.roots.size):
            at = poses + s * (own + modes)
            add_strip(s, at, at, at + own, y[row], strips, shape, local, out, gradient[row], hessian[row])


@called()
def add_strip(s, at, first, axial, y, strips, shape, local, out, gradient, hessian):
    """Add strip s, with w and a from y[at] on, to gradient and tangent, where these are at first and axial.

    The axial energy is int (N eps - 1/2 c N^2) J0 du, whose derivatives these are.
    """
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    a = y[at + own : at + own + modes]
    place_points(s, y[at : at + own], y, strips, local)
    evaluate_points(s, a, n, shape, strips, local, out)
    size, h, gap = to_element(s, n, 0, strips, local), local.reduced[s], local.gap[s]
    g, width = h[LAST], h.shape[1]
    for i in range(size):
        row = first + i if i < own else place_of(i - own, strips.tips[s], strips.roots[s], 0)
        gradient[row] += g[i]
        hessian[row, row] += h[i, i]
        for j in range(i + 1, size):
            column = first + j if j < own else place_of(j - own, strips.tips[s], strips.roots[s], 0)
            hessian[row, column] += h[i, j]
            hessian[column, row] += h[i, j]
        for k in range(modes):
            hessian[row, axial + k] += h[width + k, i]
            hessian[axial + k, row] += h[width + k, i]
    for k in range(modes):
        gradient[axial + k] = gap[k]
        out[AXIAL] += a[k] * gap[k]
        hessian[axial + k, axial + k] = -strips.compliance[s, k]


def coordinates_by(model: Reduced, y: Array) -> Array:
    """dq/dy (Q, Y) at a state y (Y,): control points [m] and bodies of the scene by what determines them."""
    strips, scene, layout = model.strips, model.system.scene, model.system.layout
    by = np.zeros((layout.coordinate_count, model.size))
    for i, body in enumerate(scene.bodies):
        by[layout.body(body.name), 3 * i : 3 * i + 3] = np.diag((model.length, model.length, 1.0))
    for s, strip in enumerate(scene.strips):
        w, n = model.places(s)[0], strip.basis.control_points
        mine = np.zeros((n, 2, model.size))
        mine[2 : n - 2].reshape(2 * n - 8, model.size)[:, w.stop + 6 - 2 * n : w.stop - 2] = np.eye(2 * n - 8)
        reach = y[w.stop - 2 : w.stop]
        for end, (bodies, frames, outer, inner) in enumerate(
            ((strips.roots, strips.root, 0, 1), (strips.tips, strips.tip, n - 1, n - 2))
        ):
            body, (px, py, turn) = bodies[s], frames[s]
            angle = y[3 * body + 2] if body >= 0 else 0.0
            cos, sin = np.cos(angle), np.sin(angle)
            arm = np.array([cos * px - sin * py, sin * px + cos * py])
            stick = strips.reach[s, end] * np.array([np.cos(angle + turn), np.sin(angle + turn)])
            stick *= 1.0 - 2.0 * end
            mine[inner, :, w.stop - 2 + end] = stick
            if body >= 0:
                for point, lever in ((outer, arm), (inner, arm + reach[end] * stick)):
                    mine[point, :, 3 * body : 3 * body + 2] += np.eye(2)
                    mine[point, :, 3 * body + 2] += -lever[1], lever[0]
        by[layout.strip(strip.name)] = model.length * mine.reshape(2 * n, -1)
    return by
