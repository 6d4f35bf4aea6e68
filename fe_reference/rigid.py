"""What bodies do to the nodes they carry and to their weight, and back: compiled, exact in any turn."""

import math

import numpy as np
from numpy.typing import NDArray

from .kernel import kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@kernel()
def carry(bodies: Array, attached: Indices, carrier: Indices, offsets: Array, u: Array) -> None:
    """Move the attached nodes with their bodies (B, 3) (displacement x, y and turn): exact rigid motion."""
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        # R - 1 written with sines: no cancellation at small turns
        sine, less = math.sin(bodies[b, 2]), 2.0 * math.sin(0.5 * bodies[b, 2]) ** 2
        u[i, 0] = bodies[b, 0] - less * offsets[k, 0] - sine * offsets[k, 1]
        u[i, 1] = bodies[b, 1] + sine * offsets[k, 0] - less * offsets[k, 1]
        u[i, 2] = bodies[b, 2]


@kernel()
def carry_velocity(
    bodies: Array, bodies_v: Array, attached: Indices, carrier: Indices, offsets: Array, v: Array
) -> None:
    """Write the velocities of the attached nodes."""
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        c, s = math.cos(bodies[b, 2]), math.sin(bodies[b, 2])
        v[i, 0] = bodies_v[b, 0] - bodies_v[b, 2] * (s * offsets[k, 0] + c * offsets[k, 1])
        v[i, 1] = bodies_v[b, 1] + bodies_v[b, 2] * (c * offsets[k, 0] - s * offsets[k, 1])
        v[i, 2] = bodies_v[b, 2]


@kernel()
def body_forces(
    bodies: Array, attached: Indices, carrier: Indices, offsets: Array, force: Array, out: Array
) -> None:
    """Write forces and moments about the bodies' points (B, 3) that the forces on attached nodes make up."""
    for b in range(len(out)):
        out[b, 0] = out[b, 1] = out[b, 2] = 0.0
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        c, s = math.cos(bodies[b, 2]), math.sin(bodies[b, 2])
        arm_x, arm_y = c * offsets[k, 0] - s * offsets[k, 1], s * offsets[k, 0] + c * offsets[k, 1]
        out[b, 0] += force[i, 0]
        out[b, 1] += force[i, 1]
        out[b, 2] += force[i, 2] + arm_x * force[i, 1] - arm_y * force[i, 0]


@kernel()
def put_weight(
    share: float, weight: Array, body_weight: Array, bodies: Array, force: Array, resultants: Array
) -> None:
    """Take a share of the weight of nodes (nodes, 3) and bodies (B, 4) from the forces that resist.

    A row of a body is force x, y [N] and the offset of its point from the body's [m].
    """
    for i in range(len(weight)):
        force[i, 0] -= share * weight[i, 0]
        force[i, 1] -= share * weight[i, 1]
    for b in range(len(body_weight)):
        w_x, w_y, x, y = body_weight[b, 0], body_weight[b, 1], body_weight[b, 2], body_weight[b, 3]
        c, s = math.cos(bodies[b, 2]), math.sin(bodies[b, 2])
        resultants[b, 0] -= share * w_x
        resultants[b, 1] -= share * w_y
        resultants[b, 2] -= share * ((c * x - s * y) * w_y - (s * x + c * y) * w_x)


@kernel()
def gravity_energy(weight: Array, body_weight: Array, bodies: Array, u: Array) -> float:
    """Return the energy of the full weight, zero in the shape at rest [J]."""
    energy = 0.0
    for i in range(len(weight)):
        energy -= weight[i, 0] * u[i, 0] + weight[i, 1] * u[i, 1]
    for b in range(len(body_weight)):
        x, y = body_weight[b, 2], body_weight[b, 3]
        sine, less = math.sin(bodies[b, 2]), 2.0 * math.sin(0.5 * bodies[b, 2]) ** 2
        energy -= body_weight[b, 0] * (bodies[b, 0] - less * x - sine * y)
        energy -= body_weight[b, 1] * (bodies[b, 1] + sine * x - less * y)
    return energy
