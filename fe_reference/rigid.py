"""What bodies do to the nodes they carry and to their weight, and back: compiled, exact in any turn."""

import math

from .arrays import Array, Indices, kernel

#: Numbers of a body's resultants: forces x, y [N], the moment [N m], and what the carrying of nodes and of
#: the weight adds to the stiffness of its turn [N m].
RESULTANTS = 5

#: Attached nodes (K,), the bodies that carry them, and their offsets (K, 2) from these bodies' points.
Carried = tuple[Indices, Indices, Array]
#: Weight of nodes (nodes, 3) and bodies (B, 4): force x, y [N], and the offset of its point from the body's
#: [m].
Weights = tuple[Array, Array]


@kernel()
def turned(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return R (x, y) with the matrix R of a turn."""
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


@kernel()
def swept(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return (R - 1) (x, y), written with sines: no cancellation at small turns."""
    sine, less = math.sin(angle), 2.0 * math.sin(0.5 * angle) ** 2
    return -less * x - sine * y, sine * x - less * y


@kernel()
def carry(bodies: Array, carried: Carried, u: Array) -> None:
    """Move the attached nodes with their bodies (B, 3) (displacement x, y and turn): exact rigid motion."""
    attached, carrier, offsets = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = swept(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        u[i, 0], u[i, 1], u[i, 2] = bodies[b, 0] + x, bodies[b, 1] + y, bodies[b, 2]


@kernel()
def carry_velocity(bodies: Array, bodies_v: Array, carried: Carried, v: Array) -> None:
    """Write the velocities of the attached nodes."""
    attached, carrier, offsets = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        v[i, 0] = bodies_v[b, 0] - bodies_v[b, 2] * y
        v[i, 1] = bodies_v[b, 1] + bodies_v[b, 2] * x
        v[i, 2] = bodies_v[b, 2]


@kernel()
def body_forces(bodies: Array, carried: Carried, force: Array, out: Array) -> None:
    """Write the resultants (B, 5) of the forces on attached nodes about the bodies' points."""
    attached, carrier, offsets = carried
    for b in range(len(out)):
        for k in range(RESULTANTS):
            out[b, k] = 0.0
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(bodies[b, 2], offsets[k, 0], offsets[k, 1])
        out[b, 0] += force[i, 0]
        out[b, 1] += force[i, 1]
        out[b, 2] += force[i, 2] + x * force[i, 1] - y * force[i, 0]
        out[b, 3] -= x * force[i, 0] + y * force[i, 1]


@kernel()
def put_weight(share: float, weights: Weights, bodies: Array, force: Array, resultants: Array) -> None:
    """Take a share of the weight of nodes and bodies from the forces that resist."""
    weight, body_weight = weights
    for i in range(len(weight)):
        force[i, 0] -= share * weight[i, 0]
        force[i, 1] -= share * weight[i, 1]
    for b in range(len(body_weight)):
        w_x, w_y = share * body_weight[b, 0], share * body_weight[b, 1]
        x, y = turned(bodies[b, 2], body_weight[b, 2], body_weight[b, 3])
        resultants[b, 0] -= w_x
        resultants[b, 1] -= w_y
        resultants[b, 2] -= x * w_y - y * w_x
        resultants[b, 4] += x * w_x + y * w_y


@kernel()
def gravity_energy(weights: Weights, bodies: Array, u: Array) -> float:
    """Return the energy of the full weight, zero in the shape at rest [J]."""
    (weight, body_weight), energy = weights, 0.0
    for i in range(len(weight)):
        energy -= weight[i, 0] * u[i, 0] + weight[i, 1] * u[i, 1]
    for b in range(len(body_weight)):
        x, y = swept(bodies[b, 2], body_weight[b, 2], body_weight[b, 3])
        energy -= body_weight[b, 0] * (bodies[b, 0] + x) + body_weight[b, 1] * (bodies[b, 1] + y)
    return energy
