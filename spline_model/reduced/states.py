"""From states of a reduced path to the unknowns of the scene, multipliers included, and how these change: the
tangent with nothing condensed, and how control points move."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.effects.plate import STEP
from spline_model.frames import carry, fold, fold_tangent
from spline_model.reduced.arrays import ARMS, AXIAL, BENDING, FORCE, RAW
from spline_model.reduced.assembly import assemble, begin, place_of
from spline_model.reduced.beside import take_product, take_residual
from spline_model.reduced.model import Reduced
from spline_model.strip.compiled import called, copy, kernel, part
from spline_model.strip.element import (
    FORCE_AT,
    GRADIENT,
    LAST,
    MOMENT_AT,
    POINTS,
)
from spline_model.strip.ends import place_points, to_element
from spline_model.strip.points import evaluate_points, evaluate_residual, forces_at

Array = NDArray[Any]


@kernel()
def _place_all(y, arms, bodies, shape, strips, local, out, points, forces):
    """Frames in y, control points (S, G, 2 n) and what the clamps do to the strips (S, G, 2, 3).

    A clamp's force is the sum of the gradient at its two control points; its moment is the gradient at the
    inner one across its direction.
    """
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    for row in range(y.shape[0]):
        carry(y[row], bodies.frames, arms)
        for s in range(strips.roots.size):
            at = bodies.rest.size + s * (own + modes)
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
    """Return the scene's unknowns (S, N) at states y (S, Y) with reactions on the drives (S, D).

    clamped (S, G, 2, 3): what the clamps do to the strips; by default what holds them in equilibrium.
    """
    strips, shape, n = model.strips, model.shape, len(model.shape.order)
    points = np.zeros((len(y), len(strips.roots), 2 * n), dtype=y.dtype)
    forces = np.zeros((len(y), len(strips.roots), 2, 3), dtype=y.dtype)
    out = np.zeros(5, dtype=y.dtype)
    _place_all(y, np.zeros_like(y[0]), model.bodies, shape, strips, model.local(), out, points, forces)
    if clamped is not None:
        forces = clamped
    system = model.system
    scene, layout = system.scene, system.layout
    z = np.zeros((len(y), layout.size), dtype=y.dtype)
    for i, body in enumerate(scene.bodies):
        z[:, layout.body(body.name)] = y[:, 3 * i : 3 * i + 3] * [model.length, model.length, 1.0]
    unit = model.energy / model.length * np.array([1.0, 1.0, model.length])
    for s, strip in enumerate(scene.strips):
        in_order = np.empty((len(y), n, 2), dtype=y.dtype)
        in_order[:, shape.order] = points[:, s].reshape(len(y), n, 2)
        z[:, layout.strip(strip.name)] = in_order.reshape(len(y), -1) * model.length
        force = y[:, model.places(s)[1]] @ model.to_modes[s].T * (model.energy / model.length)
        done = 0
        for i, effect in enumerate(scene.of(MixedStretching)):
            if effect.strip == strip.name:
                z[:, layout.axial_modes(i)] = force[:, done : done + effect.modes.count]
                done += effect.modes.count
        for end, place in (("start", 0), ("end", 1)):
            if (strip.name, end) in scene.clamps:
                z[:, scene.clamps[strip.name, end]] = forces[:, s, place] * unit
    drives = system.drives
    z[:, drives.row] = reaction * unit[2 * drives.turns]
    return z


def body_tangents(model: Reduced, y: Array, load: Array) -> Array:
    """Return the tangents (S, Q, Q) at the bodies with all strips condensed at y (S, Y) and load factors
    (S,), in EI/L.

    nan of a singular strip.
    """
    arrays = model.arrays()
    found, force = np.empty((len(y), *arrays.space.tangent.shape)), np.empty((len(y), len(model.bodies.load)))
    _condense_all(y, load, arrays, found, force)
    followers = model.followers
    for row in range(len(y) * bool(followers.place.size)):
        followers.subtract(y[row], load[row], force[row], found[row])
    return found


@kernel()
def _condense_all(y, load, arrays, tangents, forces):
    for row in range(y.shape[0]):
        singular = np.isinf(assemble(y[row], load[row], arrays))
        for i in range(tangents.shape[1]):
            forces[row, i] = arrays.space.vectors[RAW, i]
            for j in range(i, tangents.shape[1]):
                value = np.nan if singular else arrays.space.tangent[i, j]
                tangents[row, i, j] = tangents[row, j, i] = value


def whole_tangents(model: Reduced, y: Array, load: Array) -> tuple[Array, Array]:
    """Gradient (S, Y) and Hessian (S, Y, Y) of all energy in y (S, Y) at load factors (S,), in EI/L.

    Axial forces are among y; frames are put there, and have no part of it.
    """
    count, size = y.shape
    gradient, hessian = np.zeros((count, size)), np.zeros((count, size, size))
    gather(y, load, model.arrays(), gradient, hessian)
    return gradient, hessian


@kernel()
def gather(y, load, arrays, gradient, hessian):
    """``whole_tangents`` into zeros; energies of the last state in ``space``."""
    bodies, strips, shape, space = arrays.bodies, arrays.strips, arrays.shape, arrays.space
    modes, own, springs = strips.compliance.shape[1], 2 * shape.order.size - 6, bodies.springs.shape[0]
    arms = space.vectors[ARMS]
    for row in range(y.shape[0]):
        g, h = gradient[row], hessian[row]
        begin(y[row], load[row], bodies, space)
        for i in range(bodies.rest.size):
            g[i] = space.vectors[RAW, i]
        for i in range(springs * springs):
            h[i // springs, i % springs] = bodies.springs[i // springs, i % springs]
        for s in range(strips.roots.size):
            at = bodies.rest.size + s * (own + modes)
            _add_strip(s, at, y[row], strips, shape, arrays.local, space.out, g, h)
        fold(g, bodies.frames, arms)
        fold_tangent(h, 0.0, bodies.frames, arms, arms)


def products(model: Reduced, y: Array, load: Array, rate: Array) -> tuple[Array, Array, Array]:
    """Gradient (S, Y) as of ``whole_tangents``, its product with the Hessian along rates (S, Y), in which
    those of frames are put, and energies of bending and stretching (S, 2) [EI/L], at states y (S, Y)."""
    gradient, product = np.zeros((2, *y.shape), dtype=y.dtype)
    energies = np.zeros((len(y), 2), dtype=y.dtype)
    _multiply(y, load, rate, model.arrays(), gradient, product, energies)
    return gradient, product, energies


@kernel()
def _multiply(y, load, rate, arrays, gradient, product, energies):
    space = arrays.space
    for row in range(y.shape[0]):
        take_residual(y[row], load[row], arrays)
        energies[row, 0], energies[row, 1] = space.out[BENDING], space.out[AXIAL]
        copy(space.vectors[RAW, : arrays.bodies.rest.size], gradient[row])
        _add_strips(False, arrays, gradient[row])
        take_product(rate[row], 0.0, arrays)
        copy(space.vectors[FORCE, : arrays.bodies.rest.size], product[row])
        _add_strips(True, arrays, product[row])


@called()
def _add_strips(ends, arrays, total):
    """Put g and gap of all strips in a covector (Y,), and with their ``ends`` add what acts on bodies."""
    strips, local, poses = arrays.strips, arrays.local, arrays.bodies.rest.size
    own, modes = 2 * arrays.shape.order.size - 6, strips.compliance.shape[1]
    last = own + strips.coupled - strips.outer
    for s in range(strips.roots.size):
        g, tip, root, at = local.reduced[s, LAST], strips.tips[s], strips.roots[s], poses + s * (own + modes)
        copy(g[:own], total[at : at + own])
        copy(local.gap[s], total[at + own : at + own + modes])
        for i in range(last, last + (3 * (tip >= 0) + 3 * (root >= 0)) * ends):
            total[place_of(i - last, tip, root, 0)] += g[i]
    if ends:
        fold(total, arrays.bodies.frames, arrays.space.vectors[ARMS])


@part()
def _add_strip(s, at, y, strips, shape, local, out, gradient, hessian):
    """Add strip s, with w and a from y[at] on, to gradient and tangent.

    The axial energy is int (N eps - 1/2 c N^2) J0 du, whose derivatives these are.
    """
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    axial = at + own
    a = y[axial : axial + modes]
    place_points(s, y[at : at + own], y, strips, local)
    evaluate_points(s, a, n, shape, strips, local, out)
    size, h, gap = to_element(s, n, 0, strips, local), local.reduced[s], local.gap[s]
    g, width = h[LAST], h.shape[1]
    for i in range(size):
        row = at + i if i < own else place_of(i - own, strips.tips[s], strips.roots[s], 0)
        gradient[row] += g[i]
        hessian[row, row] += h[i, i]
        for j in range(i + 1, size):
            column = at + j if j < own else place_of(j - own, strips.tips[s], strips.roots[s], 0)
            hessian[row, column] += h[i, j]
            hessian[column, row] += h[i, j]
        for k in range(modes):
            hessian[row, axial + k] += h[width + k, i]
            hessian[axial + k, row] += h[width + k, i]
    for k in range(modes):
        gradient[axial + k] = gap[k]
        out[AXIAL] += a[k] * gap[k]
        hessian[axial + k, axial + k] = -strips.compliance[s, k]


def section_forces(model: Reduced, y: Array) -> tuple[Array, Array]:
    """Return the axial force and moment (S, G, P), in EI/L^2 and EI/L, at states y (S, Y) and the model's
    points."""
    force, moment = np.zeros((2, len(y), *model.strips.speed.shape), dtype=y.dtype)
    _all_forces(y, len(model.bodies.rest), model.strips, model.shape, model.local(), force, moment)
    return force, moment


@kernel()
def _all_forces(y, poses, strips, shape, local, force, moment):
    modes = strips.compliance.shape[1]
    for row in range(y.shape[0]):
        for s in range(strips.roots.size):
            at = poses + s * (2 * shape.order.size - 6 + modes)
            own = at + 2 * shape.order.size - 6
            place_points(s, y[row, at:own], y[row], strips, local)
            forces_at(s, y[row, own : own + modes], strips, shape, local)
            copy(local.lanes[s, FORCE_AT], force[row, s])
            copy(local.lanes[s, MOMENT_AT], moment[row, s])


def coordinates_by(model: Reduced, y: Array) -> Array:
    """Return dq/dy (Q, Y) at a state y (Y,): control points [m] and bodies of the scene by what determines
    them."""
    rows = y + 1j * STEP * np.eye(len(y))
    moved = unknowns_of(_stepped(model), rows, np.zeros((len(y), len(model.bodies.held))))
    return np.asarray(moved.imag[:, : model.system.layout.coordinate_count].T / STEP)


def _stepped(model: Reduced) -> Reduced:
    """The same with strips and frames of complex numbers, for states with a complex step."""
    own = {name: getattr(model.strips, name) + 0j for name in ("along", "numbers", "compliance")}
    rest: Array = model.bodies.rest + 0j
    lever: Array = model.bodies.frames.lever + 0j
    frames = model.bodies.frames
    bodies = model.bodies._replace(rest=rest, frames=frames._replace(lever=lever))
    return replace(model, bodies=bodies, strips=model.strips._replace(**own))
