"""Stiffness of a body against small displacements and turns, about any static state."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.bordered import evaluate
from spline_model.compile import System
from spline_model.effects import DrivenDisplacement, DrivenRotation
from spline_model.effects.base import Constraint
from spline_model.reduced.model import Reduced, from_unknowns, reduced
from spline_model.reduced.whole import whole_tangents

Array = NDArray[np.float64]

SINGULAR = 1e15
"""Condition of the rest, dimensionless, above which it does not follow."""


def body_stiffness(system: System, states: Array, body: str) -> Array:
    """Stiffness (S, 3, 3) of a body's x, y, theta about its centre, at states z (S, N) of static balance.

    Change of the force [N] and moment [N m] on the body by its displacement [m] and turn [rad] in the axes of
    the ground, all loads fixed and all else in equilibrium: K_bb - K_br K_rr^-1 K_rb with the body's
    coordinates b and the rest r of the tangent, multipliers included. What drives the body is let go, what
    drives others holds them. Exact for the discretisation; dead loads act at centres and have no stiffness
    there. nan where a strip that cannot stretch leaves a direction none.
    """
    model = reduced(system, longest=math.inf)
    return _bordered(system, states, body) if model is None else _on_elements(model, states, body)


def _on_elements(model: Reduced, states: Array, body: str) -> Array:
    """From the tangent of the strips' elements, in poses, control points and axial forces."""
    at = 3 * [each.name for each in model.system.scene.bodies].index(body)
    own, y = np.arange(at, at + 3), from_unknowns(model, states)
    free = np.setdiff1d(np.arange(model.size), [*own, *model.bodies.held[model.bodies.held < model.size]])
    hessian = whole_tangents(model, y)[1] * model.energy
    return _condensed(hessian, own, free, np.array([model.length, model.length, 1.0]))


def _bordered(system: System, states: Array, body: str) -> Array:
    """From the bordered tangent, clamps among the constraints: where the elements do not know a scene."""
    layout, unit = system.layout, system.scales.unit
    gradient, hessian = np.empty(layout.size), np.empty((len(states), layout.size, layout.size))
    for z, tangent in zip(states, hessian, strict=True):
        evaluate(system, z, 0.0, gradient, tangent)
    own = np.arange(layout.size)[layout.body(body)]
    let_go = [
        np.arange(layout.size)[layout.rows(i)]
        for i, each in enumerate(system.scene.of(Constraint))
        if isinstance(each, DrivenRotation | DrivenDisplacement) and each.body == body
    ]
    rest = np.setdiff1d(np.arange(layout.size), np.concatenate([own, *let_go]))
    return _condensed(hessian * (unit[:, None] * unit), own, rest, unit[own])


def _condensed(hessian: Array, own: NDArray[np.int64], rest: NDArray[np.int64], unit: Array) -> Array:
    """The Schur complement (S, 3, 3) of the rest on three coordinates, whose units are taken out."""
    found = np.full((len(hessian), 3, 3), np.nan)
    for k, tangent in enumerate(hessian):
        inner = tangent[np.ix_(rest, rest)]
        if np.linalg.cond(inner) < SINGULAR:
            moves = np.linalg.solve(inner, tangent[np.ix_(rest, own)])
            found[k] = tangent[np.ix_(own, own)] - tangent[np.ix_(own, rest)] @ moves
    return found / (unit[:, None] * unit)
