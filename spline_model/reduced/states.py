"""From states of a reduced path to the unknowns of the scene, multipliers included, and how these change: the
tangent with nothing condensed, and how control points move."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
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


class _Rows(NamedTuple):
    """Where the unknowns of a scene have what its elements know.

    poses: of the first body; strips (S,) first control points; modes (S, K) axial forces; clamps (S, 2) at
    root and tip, -1 of none; drives (D,); turns (D,): 1 of a torque.
    """

    poses: int
    strips: NDArray[np.int64]
    modes: NDArray[np.int64]
    clamps: NDArray[np.int64]
    drives: NDArray[np.int64]
    turns: NDArray[np.int64]

    @classmethod
    def of(cls, system: System) -> Self:
        """Those of a system."""
        scene, layout = system.scene, system.layout
        modes: dict[str, list[int]] = {strip.name: [] for strip in scene.strips}
        for i, effect in enumerate(scene.of(MixedStretching)):
            rows = layout.axial_modes(i)
            modes[effect.strip] += range(rows.start, rows.stop)
        ends = [[scene.clamps.get((name, end)) for end in ("start", "end")] for name in modes]
        return cls(
            poses=layout.poses.start,
            strips=np.array([layout.strip(name).start for name in modes]),
            modes=np.array(list(modes.values()), dtype=np.int64),
            clamps=np.array([[-1 if rows is None else rows.start for rows in each] for each in ends]),
            drives=system.drives.row,
            turns=system.drives.turns,
        )


def unknowns_of(model: Reduced, y: Array, reaction: Array) -> Array:
    """Return the scene's unknowns (S, N) at states y (S, Y) with reactions on the drives (S, D).

    What the clamps do to the strips is what holds them in equilibrium.
    """
    rows, arrays = model.system.once("rows", _Rows.of), model.arrays()
    z = np.zeros((len(y), model.system.layout.size), dtype=y.dtype)
    poses = 3 * len(model.system.scene.bodies)
    y, reaction, to_modes = (np.ascontiguousarray(each, y.dtype) for each in (y, reaction, model.to_modes))
    _fill_unknowns(y, reaction, poses, rows, to_modes, model.length, model.energy, arrays, z)
    return z


@kernel()
def _fill_unknowns(y, reaction, poses, rows, to_modes, length, energy, arrays, z):
    """Frames in y, and the scene's unknowns.

    A clamp's force is the sum of the gradient at its two control points; its moment is the gradient at the
    inner one across its direction.
    """
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space, force = arrays.local, arrays.space, energy / length
    n, modes = shape.order.size, strips.compliance.shape[1]
    own = 2 * n - 6
    for row in range(y.shape[0]):
        state, into = y[row], z[row]
        carry(state, bodies.frames, space.vectors[ARMS])
        for i in range(poses):
            into[rows.poses + i] = state[i] * (length if i % 3 < 2 else 1.0)
        for s in range(strips.roots.size):
            at = bodies.rest.size + s * (own + modes)
            a = state[at + own : at + own + modes]
            place_points(s, state[at : at + own], state, strips, local)
            evaluate_residual(s, a, n, shape, strips, local, space.out)
            p, g = local.nodal[s, POINTS], local.nodal[s, GRADIENT]
            for i in range(2 * n):
                into[rows.strips[s] + 2 * shape.order[i // 2] + i % 2] = p[i] * length
            for k in range(modes):
                into[rows.modes[s, k]] = 0.0
                for j in range(modes):
                    into[rows.modes[s, k]] += to_modes[s, k, j] * a[j] * force
            for end in range(2):
                inner, outer, clamp = 2 * n - 8 + 2 * end, 2 * n - 2 - 2 * end, rows.clamps[s, end]
                if clamp >= 0:
                    x, y1 = p[inner] - p[outer], p[inner + 1] - p[outer + 1]
                    into[clamp] = (g[inner] + g[outer]) * force
                    into[clamp + 1] = (g[inner + 1] + g[outer + 1]) * force
                    into[clamp + 2] = (x * g[inner + 1] - y1 * g[inner]) * energy
        for d in range(rows.drives.size):
            into[rows.drives[d]] = reaction[row, d] * (energy if rows.turns[d] == 1 else force)


def body_tangents(model: Reduced, y: Array, load: Array) -> Array:
    """Return the tangents (S, Q, Q) at the bodies with all strips condensed at y (S, Y) and load factors
    (S,), in EI/L.

    nan of a singular strip.
    """
    arrays = model.arrays()
    found, force = np.empty((len(y), *arrays.space.tangent.shape)), np.empty((len(y), len(model.bodies.load)))
    _condense_all(np.ascontiguousarray(y), np.array(load), arrays, found, force)
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
    gather(np.ascontiguousarray(y), np.array(load), model.arrays(), gradient, hessian)
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
