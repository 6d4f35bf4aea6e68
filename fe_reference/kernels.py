"""Compiled inner loops of the explicit integrator: internal forces of all elements, and the steps themselves.

The equations are those of `corotational` and `reissner`, one element after another, written into arrays that
the caller owns; nothing is allocated. A table row of an element holds

    chord x, chord y, length, EA, EI, kGA        (reference values)

and its first node; the second node is the next one.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@njit(cache=True, nogil=True, error_model="numpy")
def corotational_element(
    row: Array, step_x: float, step_y: float, turn_1: float, turn_2: float, out: Array
) -> float:
    """Write force x, force y at the second node and both moments of one element; return its energy."""
    x, y = row[0] + step_x, row[1] + step_y
    length = math.sqrt(x * x + y * y)
    strain = ((row[0] + x) * step_x + (row[1] + y) * step_y) / ((length + row[2]) * row[2])
    turn = math.atan2(row[0] * y - row[1] * x, row[0] * x + row[1] * y)
    first, second = turn_1 - turn, turn_2 - turn
    first -= 2.0 * math.pi * math.floor(first / (2.0 * math.pi) + 0.5)
    second -= 2.0 * math.pi * math.floor(second / (2.0 * math.pi) + 0.5)
    rate = row[4] / row[2]
    axial = row[3] * strain / length
    moment_1, moment_2 = rate * (4.0 * first + 2.0 * second), rate * (2.0 * first + 4.0 * second)
    shear = (moment_1 + moment_2) / (length * length)
    out[0], out[1] = axial * x + shear * y, axial * y - shear * x
    out[2], out[3] = moment_1, moment_2
    energy: float = 0.5 * (row[3] * row[2] * strain * strain + moment_1 * first + moment_2 * second)
    return energy


@njit(cache=True, nogil=True, error_model="numpy")
def reissner_element(
    row: Array, step_x: float, step_y: float, turn_1: float, turn_2: float, out: Array
) -> float:
    """Write the same for the shear-deformable element with its one integration point."""
    half = 0.25 * (turn_1 + turn_2)
    sine, cosine = 2.0 * math.sin(half) * math.cos(half), 1.0 - 2.0 * math.sin(half) ** 2
    c, s = (row[0] * cosine - row[1] * sine) / row[2], (row[1] * cosine + row[0] * sine) / row[2]
    strain = (step_x * c + step_y * s) / row[2] - 2.0 * math.sin(half) ** 2
    sliding = (step_y * c - step_x * s) / row[2] - sine
    curvature = (turn_2 - turn_1) / row[2]
    axial, shear, moment = row[3] * strain, row[5] * sliding, row[4] * curvature
    lever = 0.5 * row[2] * (axial * sliding - shear * (1.0 + strain))
    out[0], out[1] = axial * c - shear * s, axial * s + shear * c
    out[2], out[3] = lever - moment, lever + moment
    energy: float = 0.5 * row[2] * (axial * strain + shear * sliding + moment * curvature)
    return energy


@njit(cache=True, nogil=True, error_model="numpy")
def internal_forces(
    shear: bool, first: Indices, table: Array, u: Array, force: Array, scratch: Array
) -> float:
    """Write the nodal forces (nodes, 3) [N, N m] at u (nodes, 3); return the strain energy [J]."""
    force[:] = 0.0
    energy = 0.0
    for e in range(len(first)):
        i = first[e]
        j = i + 1
        x, y = u[j, 0] - u[i, 0], u[j, 1] - u[i, 1]
        if shear:
            energy += reissner_element(table[e], x, y, u[i, 2], u[j, 2], scratch)
        else:
            energy += corotational_element(table[e], x, y, u[i, 2], u[j, 2], scratch)
        force[i, 0] -= scratch[0]
        force[i, 1] -= scratch[1]
        force[i, 2] += scratch[2]
        force[j, 0] += scratch[0]
        force[j, 1] += scratch[1]
        force[j, 2] += scratch[3]
    return energy


@njit(cache=True, nogil=True, error_model="numpy")
def carry(bodies: Array, attached: Indices, carrier: Indices, offsets: Array, u: Array) -> None:
    """Move the attached nodes with their bodies (B, 3) (displacement x, y and turn): exact rigid motion."""
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        sine, less = math.sin(bodies[b, 2]), 2.0 * math.sin(0.5 * bodies[b, 2]) ** 2
        u[i, 0] = bodies[b, 0] - less * offsets[k, 0] - sine * offsets[k, 1]
        u[i, 1] = bodies[b, 1] + sine * offsets[k, 0] - less * offsets[k, 1]
        u[i, 2] = bodies[b, 2]


@njit(cache=True, nogil=True, error_model="numpy")
def body_forces(
    bodies: Array, attached: Indices, carrier: Indices, offsets: Array, force: Array, out: Array
) -> None:
    """Write forces and moments about the bodies' points (B, 3) that the forces on attached nodes make up."""
    out[:] = 0.0
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        c, s = math.cos(bodies[b, 2]), math.sin(bodies[b, 2])
        arm_x, arm_y = c * offsets[k, 0] - s * offsets[k, 1], s * offsets[k, 0] + c * offsets[k, 1]
        out[b, 0] += force[i, 0]
        out[b, 1] += force[i, 1]
        out[b, 2] += force[i, 2] + arm_x * force[i, 1] - arm_y * force[i, 0]


@njit(cache=True, nogil=True, error_model="numpy")
def move(compliance: Array, force: Array, step: float, v: Array, u: Array) -> None:
    """Advance velocities and places (rows, 3) by one step under `force`: v -= h c f, u += h v."""
    for i in range(len(u)):
        for k in range(3):
            v[i, k] -= step * compliance[i, k] * force[i, k]
            u[i, k] += step * v[i, k]


@njit(cache=True, nogil=True, error_model="numpy")
def advance(
    shear: bool,
    first: Indices,
    table: Array,
    attached: Indices,
    carrier: Indices,
    offsets: Array,
    compliance: Array,
    body_compliance: Array,
    u: Array,
    v: Array,
    bodies: Array,
    bodies_v: Array,
    force: Array,
    resultants: Array,
    scratch: Array,
    step: float,
    steps: int,
) -> None:
    """Make `steps` steps of the central difference scheme in place: v is half a step behind u.

    v += h a(u), u += h v for the free nodes (`compliance` (nodes, 3) is 1/mass there, else 0) and the bodies.
    """
    for _ in range(steps):
        internal_forces(shear, first, table, u, force, scratch)
        body_forces(bodies, attached, carrier, offsets, force, resultants)
        move(compliance, force, step, v, u)
        move(body_compliance, resultants, step, bodies_v, bodies)
        carry(bodies, attached, carrier, offsets, u)
