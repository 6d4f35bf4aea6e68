"""The constant mass matrix of a scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import BodyInertia, StripInertia
from spline_model.layout import Layout
from spline_model.scene import Scene, Strip

Array = NDArray[np.float64]


def mass_matrix(scene: Scene, layout: Layout) -> Array:
    """M in the coordinates q, shape (Q, Q) [kg, kg m^2]; zero where no inertia acts."""
    mass = np.zeros((layout.coordinate_count, layout.coordinate_count))
    for effect in scene.of(StripInertia):
        block = effect.linear_density * unit_mass(scene.strip(effect.strip))
        at = layout.strip(effect.strip)
        mass[at, at] += np.kron(block, np.eye(2))
    for body in scene.of(BodyInertia):
        at = layout.body(body.body)
        mass[at, at] += np.diag((body.mass, body.mass, body.moment_of_inertia))
    return mass


def unit_mass(strip: Strip) -> Array:
    """int N^T N ds0 of one strip, shape (n, n) [m]; exact for a uniform reference speed."""
    u, weight = strip.basis.gauss_rule(strip.basis.degree + 1)
    values, slope = strip.basis.evaluate(u), strip.basis.evaluate(u, 1)
    speed = np.hypot(*(slope @ strip.control_points).T)
    return np.asarray(values.T @ ((weight * speed)[:, None] * values))
