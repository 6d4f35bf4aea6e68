"""A whole path in the rotation of one body, compiled: predict, correct, check, halve."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import LARGEST_CORRECTION, SLOWEST_SPEED
from spline_model.continuation.resolution import LARGEST_DEFECT
from spline_model.fast.body import assemble, turn_into
from spline_model.fast.condense import recover, recover_rate
from spline_model.fast.doubt import defect, inertia, jumped, strip_defect
from spline_model.strip.compiled import copy, kernel, part

ITERATIONS, EVALUATIONS, HALVED = range(3)
KNOWN = 3
MOST_ITERATIONS = 15
SMALLEST_STEP = 2.0**-10


class Answer(NamedTuple):
    """S states: y (S, Y), torque, stiffness (S,), energies (S, 2), inertia, defect (S,), counters (3,).

    y is x, y of the centre over the first strip's length, then w and a of each strip.
    """

    y: NDArray[np.float64]
    torque: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    energies: NDArray[np.float64]
    inertia: NDArray[np.int64]
    defect: NDArray[np.float64]
    counters: NDArray[np.int64]


@kernel()
def newton(y, theta, frame, grid, locals_, space, out, tolerance, counters):
    """Solve at theta in place; True if the residual came below tolerance."""
    strips, modes = frame.length.size, frame.compliance.shape[1]
    own = (y.size - 2) // strips - modes
    body, before = space.body, np.inf
    cos_t, sin_t = math.cos(theta), math.sin(theta)
    for _ in range(MOST_ITERATIONS + 1):
        norm = assemble(y, theta, frame, grid, locals_, space, out)
        counters[EVALUATIONS] += 1
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            return True
        if not norm < 1e12:
            return False
        before = norm
        determinant = body[0, 0] * body[1, 1] - body[0, 1] ** 2
        if determinant == 0.0:
            return False
        dx = (body[0, 1] * body[1, 3] - body[1, 1] * body[0, 3]) / determinant
        dy = (body[0, 1] * body[0, 3] - body[0, 0] * body[1, 3]) / determinant
        y[0] += dx / frame.length[0]
        y[1] += dy / frame.length[0]
        for s in range(strips):
            at = 2 + s * (own + modes)
            turn_into(frame, s, cos_t, sin_t, dx, dy, 0.0, space.change)
            dw, da = space.rate[at : at + own], space.rate[at + own : at + own + modes]
            recover(locals_[s], frame.compliance[s], own, space.change, dw, da)
            for i in range(own + modes):
                y[at + i] += space.rate[at + i]
        counters[ITERATIONS] += 1
    return False


@part()
def tangent(y, theta, frame, grid, locals_, space):
    """Rate dy/dtheta in space.rate at a state that was just assembled.

    Returns torque, stiffness and the energy of the strips' moment defect, twice.
    """
    strips, modes = frame.length.size, frame.compliance.shape[1]
    own = (y.size - 2) // strips - modes
    body = space.body
    cos_t, sin_t = math.cos(theta), math.sin(theta)
    determinant = body[0, 0] * body[1, 1] - body[0, 1] ** 2
    dx = (body[0, 1] * body[1, 2] - body[1, 1] * body[0, 2]) / determinant
    dy = (body[0, 1] * body[0, 2] - body[0, 0] * body[1, 2]) / determinant
    space.rate[0], space.rate[1] = dx / frame.length[0], dy / frame.length[0]
    wrong = 0.0
    for s in range(strips):
        at = 2 + s * (own + modes)
        turn_into(frame, s, cos_t, sin_t, dx, dy, 1.0, space.change)
        dw, da = space.rate[at : at + own], space.rate[at + own : at + own + modes]
        local = locals_[s]
        recover_rate(local, frame.compliance[s], own, space.change, dw, da)
        wrong += frame.rigidity[s] / frame.length[s] * strip_defect(local, grid.d0, grid.weight)
    # the remaining residual is carried to equilibrium by the tangent
    torque = body[2, 3] + dx * body[0, 3] + dy * body[1, 3]
    return torque, body[2, 2] + dx * body[0, 2] + dy * body[1, 2], wrong


@part()
def predict(theta, known, space):
    """Hermite's polynomial through the last ``known`` states and rates, at theta, in space.predicted."""
    at, predicted = space.known_at, space.predicted
    predicted[:] = 0.0
    for i in range(known):
        lagrange, slope = 1.0, 0.0
        for j in range(known):
            if j != i:
                lagrange *= (theta - at[j]) / (at[i] - at[j])
                slope += 1.0 / (at[i] - at[j])
        square = lagrange * lagrange
        by_value, by_rate = (1.0 - 2.0 * (theta - at[i]) * slope) * square, (theta - at[i]) * square
        for k in range(predicted.size):
            predicted[k] += by_value * space.known_y[i, k] + by_rate * space.known_rate[i, k]


@part()
def accepted(y, known, space, frame, out, own, modes):
    """Whether a solved state is the continuation of the last one, with end tangents forward and no fold."""
    if not out[2] > SLOWEST_SPEED:
        return False
    step = correction = 0.0
    last = space.known_y[known - 1]
    for k in range(2):
        step += (space.predicted[k] - last[k]) ** 2
        correction += (y[k] - space.predicted[k]) ** 2
    for s in range(frame.length.size):
        at = 2 + s * (own + modes)
        if not (y[at] > 0.0 and y[at + own - 1] > 0.0):
            return False
        for k in range(at, at + own):
            step += (space.predicted[k] - last[k]) ** 2
            correction += (y[k] - space.predicted[k]) ** 2
    return correction <= LARGEST_CORRECTION**2 * step


@kernel()
def follow(start, targets, frame, grid, locals_, space, tolerance, answer):
    """Follow the path from rest (theta = 0) through the target rotations; returns the states converged.

    answer is filled from row 0, the state at rest, on.
    """
    modes = frame.compliance.shape[1]
    own = (start.size - 2) // frame.length.size - modes
    out, y, counters = space.out, space.y, answer.counters
    copy(start, y)
    if not newton(y, 0.0, frame, grid, locals_, space, out, tolerance, counters):
        return 0
    known, theta = 0, 0.0
    torque = stiffness = energy = wrong = 0.0
    for row in range(targets.size + 1):
        target = targets[row - 1] if row > 0 else 0.0
        begin, step = theta, target - theta
        if known > 1 and step * (theta - space.known_at[known - 2]) < 0.0:  # the path turns back
            keep_last(known, space)
            known = 1
        whole = step
        while True:
            last, here, sound = row == 0, theta, True
            if row > 0:
                last = abs(target - theta) <= abs(step) * (1 + 1e-9)
                here = target if last else theta + step
                if known > 1 and abs(here - theta) > 2 * abs(theta - space.known_at[known - 2]):
                    keep_last(known, space)
                    known = 1
                predict(here, known, space)
                copy(space.predicted, y)
                solved = newton(y, here, frame, grid, locals_, space, out, tolerance, counters)
                sound = solved and accepted(y, known, space, frame, out, own, modes)
            if sound:
                before, rate, gained = torque, stiffness, out[0] + out[1] - energy
                torque, stiffness, wrong = tangent(y, here, frame, grid, locals_, space)
                wrong = defect(wrong, out[0], frame)
                sound = row == 0 or not (
                    wrong > LARGEST_DEFECT
                    or jumped(here - theta, before, torque, rate, stiffness, gained, energy, frame)
                )
                if not sound:
                    torque, stiffness = before, rate
            if not sound:
                counters[HALVED] += 1
                step *= 0.5
                if abs(step) < SMALLEST_STEP * abs(whole):
                    return row
                continue
            theta, energy = here, out[0] + out[1]
            known = remember(theta, y, known, space)
            if last:
                break
            done = abs(theta - begin) / abs(step)
            if abs(step) < abs(whole) and round(done) % 2 == 0:
                step *= 2.0
        copy(y, answer.y[row])
        answer.torque[row], answer.stiffness[row] = torque, stiffness
        answer.energies[row, 0], answer.energies[row, 1] = out[0], out[1]
        answer.inertia[row], answer.defect[row] = inertia(space.body, out), wrong
    return targets.size + 1


@part()
def remember(theta, y, known, space):
    """Append a state and its rate to the known ones, dropping the oldest; returns their number."""
    if known > 0 and theta == space.known_at[known - 1]:
        known -= 1
    if known == KNOWN:
        for i in range(KNOWN - 1):
            space.known_at[i] = space.known_at[i + 1]
            copy(space.known_y[i + 1], space.known_y[i])
            copy(space.known_rate[i + 1], space.known_rate[i])
        known -= 1
    space.known_at[known] = theta
    copy(y, space.known_y[known])
    copy(space.rate, space.known_rate[known])
    return known + 1


@part()
def keep_last(known, space):
    """Forget all known states but the last."""
    space.known_at[0] = space.known_at[known - 1]
    copy(space.known_y[known - 1], space.known_y[0])
    copy(space.known_rate[known - 1], space.known_rate[0])
