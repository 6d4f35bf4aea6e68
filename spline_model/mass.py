"""The constant mass and drag matrices of a scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import BodyDamper, BodyInertia, SectionRotaryInertia, StripDrag, StripInertia
from spline_model.layout import Layout
from spline_model.scene import Scene, Strip

Array = NDArray[np.float64]


def mass_matrix(scene: Scene, layout: Layout) -> Array:
    """M in the coordinates q, shape (Q, Q) [kg, kg m^2]; zero where no inertia acts."""
    mass = np.zeros((layout.coordinate_count, layout.coordinate_count))
    for strip in scene.of(StripInertia):
        _add_strip(
            mass, layout.strip(strip.strip), strip.linear_density * _products(scene.strip(strip.strip))
        )
    for rotary in scene.of(SectionRotaryInertia):
        block = rotary.rotary_density * _slope_products(scene.strip(rotary.strip))
        _add_strip(mass, layout.strip(rotary.strip), block)
    for body in scene.of(BodyInertia):
        at = layout.body(body.body)
        mass[at, at] += np.diag((body.mass, body.mass, body.moment_of_inertia))
    return mass


def drag_matrix(scene: Scene, layout: Layout) -> Array:
    """D of the force - D v, shape (Q, Q) [N s/m, N m s]; (0, 0) where no effect names any."""
    strips, bodies = scene.of(StripDrag), scene.of(BodyDamper)
    if not strips and not bodies:
        return np.zeros((0, 0))
    drag = np.zeros((layout.coordinate_count, layout.coordinate_count))
    for strip in strips:
        block = strip.rate * strip.linear_density * _products(scene.strip(strip.strip))
        _add_strip(drag, layout.strip(strip.strip), block)
    for body in bodies:
        at = layout.body(body.body)
        drag[at, at] += np.diag((body.translation, body.translation, body.rotation))
    return drag


def _add_strip(matrix: Array, at: slice, block: Array) -> None:
    matrix[at, at] += np.kron(block, np.eye(2))


def _products(strip: Strip) -> Array:
    """int N^T N ds0 of one strip, shape (n, n) [m]."""
    u, length = strip.gauss_points()
    values = strip.basis.evaluate(u)
    return np.asarray(values.T @ (length[:, None] * values))


def _slope_products(strip: Strip) -> Array:
    """int (dN/ds0)^T (dN/ds0) ds0 of one strip, shape (n, n) [1/m]."""
    u, length = strip.gauss_points()
    slopes = strip.basis.evaluate(u, 1)
    speed = np.hypot(*(slopes @ strip.control_points).T)
    return np.asarray(slopes.T @ ((length / speed**2)[:, None] * slopes))
