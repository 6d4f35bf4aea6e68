"""The tangent of a reduced mechanism with nothing condensed, and how its control points move."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.reduced.assembly import place_of
from spline_model.reduced.model import Reduced
from spline_model.strip.compiled import kernel
from spline_model.strip.element import place_points, to_element
from spline_model.strip.laws import MATERIAL
from spline_model.strip.points import visit_points

Array = NDArray[np.float64]


def whole_tangents(model: Reduced, y: Array) -> tuple[Array, Array]:
    """Gradient (S, Y) and Hessian (S, Y, Y) of the strips' energy in y (S, Y), in EI/L, axial forces among y.

    Dead loads on the strips are in it; weight of, and loads on, the bodies are not.
    """
    count, size = y.shape
    gradient, hessian = np.zeros((count, size)), np.zeros((count, size, size))
    place = np.zeros(2 * len(model.shape.order), dtype=np.int64)
    poses, local = len(model.bodies.rest), model.local()
    _assemble(y, poses, model.strips, model.shape, local, place, np.zeros(5), gradient, hessian)
    return gradient, hessian


@kernel()
def _assemble(y, poses, strips, shape, local, place, out, gradient, hessian):
    """Add all strips of all states."""
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    for row in range(y.shape[0]):
        state, force, matrix = y[row], gradient[row], hessian[row]
        for s in range(strips.roots.size):
            at = poses + s * (own + modes)
            axial = at + own
            tip, root = strips.tips[s] >= 0, strips.roots[s] >= 0
            place_points(s, state[at:axial], state, strips, local)
            visit_points(s, state[axial : axial + modes], n, shape, strips, local, out)
            g, h, b = local.g[s], local.h[s], local.b[s]
            to_element(
                n,
                0,
                tip,
                root,
                local.map[s],
                local.gradient[s],
                local.hessian[s],
                local.coupling[s],
                g,
                h,
                b,
                local.square,
                local.lines,
                local.line,
            )
            size = own + 3 * tip + 3 * root
            for i in range(size):
                place[i] = at + i if i < own else place_of(i - own, strips.tips[s], strips.roots[s], 0)
            for i in range(size):
                force[place[i]] += g[i]
                for j in range(i, size):
                    matrix[place[i], place[j]] += h[i, j]
                    if i != j:
                        matrix[place[j], place[i]] += h[i, j]
                for k in range(modes):
                    matrix[place[i], axial + k] += b[k, i]
                    matrix[axial + k, place[i]] += b[k, i]
            for k in range(modes):
                force[axial + k] = local.gap[s, k]
                if strips.measure == MATERIAL:
                    matrix[axial + k, axial + k] = -strips.compliance[s, k]
                else:
                    for j in range(modes):
                        matrix[axial + k, axial + j] = -local.gram[s, k, j]


def coordinates_by(model: Reduced, y: Array) -> Array:
    """dq/dy (Q, Y) at a state y (Y,): control points [m] and bodies of the scene by what determines them."""
    strips, scene, layout = model.strips, model.system.scene, model.system.layout
    n = len(model.shape.order)
    by = np.zeros((layout.coordinate_count, model.size))
    for i, body in enumerate(scene.bodies):
        by[layout.body(body.name), 3 * i : 3 * i + 3] = np.diag((model.length, model.length, 1.0))
    for s, strip in enumerate(scene.strips):
        w = model.places(s)[0]
        mine = np.zeros((n, 2, model.size))
        mine[2 : n - 2].reshape(2 * n - 8, model.size)[:, w.start : w.stop - 2] = np.eye(2 * n - 8)
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
