"""A state of equilibrium of the reduced mechanism: Newton's method, rates, stiffness, work."""

from __future__ import annotations

import math

import numpy as np

from spline_model.frames import fold
from spline_model.newton import FLOOR, LAST, ROUND_OFF
from spline_model.reduced.arrays import (
    ARMS,
    CHANGE,
    FORCE,
    MOVE,
    NEGATIVE,
    RATE,
    RAW,
    REACTION,
    REACTION_RATE,
    SPARE,
)
from spline_model.reduced.assembly import assemble, factorise, move_strips, solve_free
from spline_model.strip.compiled import called, kernel
from spline_model.strip.condense import SINGULAR

ITERATIONS, EVALUATIONS, HALVED, CONFIRMED = range(4)
"""Places of the counters; CONFIRMED: evaluations without a tangent."""
MOST_ITERATIONS = 15
NEARLY = 0.1
"""Residual over the tolerance from which the last correction is enough: it squares the residual, but
stiffness is that of the state before it."""
CLOSE = 0.01
"""The same without a last correction."""


@called()
def _solve_bodies(bodies, space):
    """The bodies' change, MOVE, by which their residual FORCE vanishes; held coordinates do not move."""
    free, x, move = bodies.free, space.vectors[CHANGE], space.vectors[MOVE]
    for i in range(bodies.load.size):
        move[i] = 0.0
    for i in range(free.size):
        x[i] = -space.vectors[FORCE, free[i]]
    solve_free(space.factors, x)
    for i in range(free.size):
        move[free[i]] = x[i]


@called()
def carry(row, bodies, space):
    """The same, and what the drives then bear into a row of the vectors."""
    _solve_bodies(bodies, space)
    for d in range(bodies.held.size):
        total = space.vectors[FORCE, bodies.held[d]]
        for i in range(bodies.load.size):
            total += entry(space.tangent, bodies.held[d], i) * space.vectors[MOVE, i]
        space.vectors[row, d] = total


@called()
def _correction(bodies, strips, arrays):
    """The correction of a state just assembled, poses in MOVE and w and a in SPARE; its size but for a's."""
    space, move, change, largest = arrays.space, arrays.space.vectors[MOVE], arrays.space.states[SPARE], 0.0
    own, modes, poses = 2 * arrays.shape.order.size - 6, strips.compliance.shape[1], bodies.rest.size
    _solve_bodies(bodies, space)
    move_strips(1.0, arrays, change)
    for i in range(poses):
        largest = max(largest, abs(move[i]))
    for s in range(strips.roots.size):
        at = poses + s * (own + modes)
        for i in range(at, at + own):
            largest = max(largest, abs(change[i]))
    return largest


@called()
def newton(y, load, early, arrays, tolerance, counters):
    """Solve in place at the held coordinates in y; the negative eigenvalues, or -1 where it fails, and the
    last residual, behind which there is one correction more: NEARLY none, or ``early`` one whose square is.

    Where corrections no longer shrink, they are round-off: see ``spline_model.newton``.
    """
    bodies, space, before, worse = arrays.bodies, arrays.space, np.inf, np.inf
    free, poses, change = bodies.free, bodies.rest.size, space.states[SPARE]
    raw, move = space.vectors[RAW], space.vectors[MOVE]
    small = math.sqrt(CLOSE * tolerance) if early else NEARLY * tolerance
    for trial in range(MOST_ITERATIONS + 1):
        norm = assemble(y, load, arrays)
        counters[EVALUATIONS] += 1
        for i in range(free.size):
            norm = max(norm, abs(raw[free[i]]))
        if not norm < 1e12:
            return -1, norm
        negative = factorise(bodies.free, space.tangent, space.factors, bodies.load.size - poses)
        if negative == SINGULAR:
            return -1, norm
        size = _correction(bodies, arrays.strips, arrays)
        done = norm <= small and size <= LAST
        floored = norm <= FLOOR and norm > 0.5 * worse
        done = done or (size > 0.5 * before and (size <= ROUND_OFF or floored))
        if not done and trial == MOST_ITERATIONS:
            return -1, norm
        before, worse = size, norm
        for i in range(poses):
            y[i] += move[i]
        for i in range(poses, y.size):
            y[i] += change[i]
        if done:  # with a last correction, whose own residual is of second order
            return max(0, negative + int(space.out[NEGATIVE])), norm
        counters[ITERATIONS] += 1
    return -1, worse


@called()
def entry(matrix, i, j):
    """Return the entry of a symmetric matrix of which the upper triangle is filled."""
    return matrix[i, j] if i <= j else matrix[j, i]


@called()
def tangent(held_rate, load_rate, arrays):
    """Rates in the factor at a state that was just solved, reactions and their rates, in ``space``.

    The residual that is left is carried to equilibrium by the tangent.
    """
    bodies, space = arrays.bodies, arrays.space
    free, held, matrix, vectors = bodies.free, bodies.held, space.tangent, space.vectors
    x, move, rate = vectors[CHANGE], vectors[MOVE], space.states[RATE]
    carry(REACTION, bodies, space)
    for i in range(bodies.load.size):
        move[i] = load_rate * bodies.load[i]
    if bodies.frames.place.size > 0:
        fold(move, bodies.frames, vectors[ARMS])
    for d in range(held.size):
        vectors[REACTION_RATE, d] = -move[held[d]]
    for i in range(free.size):
        total = move[free[i]]
        for d in range(held.size):
            total -= entry(matrix, free[i], held[d]) * held_rate[d]
        x[i] = total
    solve_free(space.factors, x)
    for i in range(free.size):
        move[free[i]] = x[i]
    for d in range(held.size):
        move[held[d]] = held_rate[d]
    for d in range(held.size):
        for i in range(bodies.load.size):
            vectors[REACTION_RATE, d] += entry(matrix, held[d], i) * move[i]
    move_strips(0.0, arrays, rate)
    for i in range(bodies.rest.size):
        rate[i] = move[i]


@called()
def stiffness_of(bodies, space):
    """Return the derivative of the driven rotation's torque in it, all else held or in equilibrium at fixed
    loads."""
    free, x = bodies.free, space.vectors[CHANGE]
    row = bodies.held[bodies.driven]
    for i in range(free.size):
        x[i] = -entry(space.tangent, free[i], row)
    solve_free(space.factors, x)
    total = space.tangent[row, row]
    for i in range(free.size):
        total += entry(space.tangent, row, free[i]) * x[i]
    return total


@called()
def conjugate(held_rate, load_rate, bodies, y, space):
    """Return the first and second derivative of the potential in the factor: reactions on drives less moved
    loads."""
    slope = bend = 0.0
    for d in range(bodies.held.size):
        slope += space.vectors[REACTION, d] * held_rate[d]
        bend += space.vectors[REACTION_RATE, d] * held_rate[d]
    if load_rate != 0.0:
        for i in range(bodies.rest.size):
            slope -= load_rate * bodies.load[i] * (y[i] - bodies.rest[i])
            bend -= load_rate * bodies.load[i] * space.states[RATE, i]
    return slope, bend


@kernel()
def bear(y, arrays):
    """What holds the bodies at y, and its tangent, in ``space``."""
    assemble(y, 0.0, arrays)
