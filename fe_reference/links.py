"""Springs and dampers between the centres of two bodies, or of a body and a point of the ground.

With u the displacement of a centre from rest and theta the turn of its body, a link stretches by

    e = (u_1 - u_2, theta_1 - theta_2),    u = d + (R(theta) - 1) o

in axes of the ground, where d is the displacement of the point that a structure is reduced about and o the
offset of the centre from it. It resists with f = diag(k) e + diag(c) e'. The energy is e.diag(k) e / 2.
"""

import numpy as np

from .arrays import Array, Indices, kernel
from .loading import Spring
from .matrix import Symmetric
from .mesh import swept, turned
from .model import Model

#: Bodies at both ends (K, 2), -1 for ground, offsets of their centres from their points (K, 2, 2) [m],
#: stiffness and damping (K, 3) for x, y and the turn.
Links = tuple[Indices, Array, Array, Array]


def links_of(model: Model, points: Array) -> Links:
    """Return the springs of a model whose bodies are reduced about `points` (B, 2) [m]."""
    springs = model.effects.every(Spring)
    if not springs:
        return np.zeros((0, 2), dtype=np.int64), np.zeros((0, 2, 2)), np.zeros((0, 3)), np.zeros((0, 3))
    others = [-1 if each.other is None else model.body_index(each.other) for each in springs]
    ends = np.column_stack([[model.body_index(each.body) for each in springs], others])
    return (
        ends,
        np.vstack([model.centres - points, np.zeros((1, 2))])[ends],
        np.array([(*each.stiffness, each.rotational_stiffness) for each in springs]),
        np.array([(*each.damping, each.rotational_damping) for each in springs]),
    )


@kernel()
def link_forces(links: Links, bodies: Array, rates: Array, out: Array) -> tuple[float, float]:
    """Add what the links resist with to the resultants (B, 5); return their energy [J] and power lost [W].

    Args:
        bodies, rates (B, 3): displacements and turns, and their rates.
    """
    (ends, offsets, stiffness, damping), energy, loss = links, 0.0, 0.0
    for k in range(len(ends)):
        x = y = turn = x_rate = y_rate = turn_rate = 0.0
        for end in range(2):
            b, sign = ends[k, end], 1.0 - 2.0 * end
            if b >= 0:
                way = swept(bodies[b, 2], offsets[k, end, 0], offsets[k, end, 1])
                arm = turned(bodies[b, 2], offsets[k, end, 0], offsets[k, end, 1])
                x, y = x + sign * (bodies[b, 0] + way[0]), y + sign * (bodies[b, 1] + way[1])
                x_rate += sign * (rates[b, 0] - rates[b, 2] * arm[1])
                y_rate += sign * (rates[b, 1] + rates[b, 2] * arm[0])
                turn, turn_rate = turn + sign * bodies[b, 2], turn_rate + sign * rates[b, 2]
        h, c = stiffness[k], damping[k]
        force_x, force_y = h[0] * x + c[0] * x_rate, h[1] * y + c[1] * y_rate
        moment = h[2] * turn + c[2] * turn_rate
        energy += 0.5 * (h[0] * x * x + h[1] * y * y + h[2] * turn * turn)
        loss += c[0] * x_rate * x_rate + c[1] * y_rate * y_rate + c[2] * turn_rate * turn_rate
        for end in range(2):
            b, sign = ends[k, end], 1.0 - 2.0 * end
            if b >= 0:
                arm = turned(bodies[b, 2], offsets[k, end, 0], offsets[k, end, 1])
                out[b, 0] += sign * force_x
                out[b, 1] += sign * force_y
                out[b, 2] += sign * (moment + arm[0] * force_y - arm[1] * force_x)
                out[b, 4] -= sign * (arm[0] * force_x + arm[1] * force_y)
    return energy, loss


def numbers(links: Links, bodies: Indices) -> Indices:
    """Return the coordinates of links (K, 6) from those of bodies (B, 3), -1 for those of the ground."""
    return np.vstack([bodies, np.full((1, 3), -1)])[links[0]].reshape(-1, 6)


def _slopes(links: Links, turns: Array) -> Array:
    """Return the derivatives of the stretches (K, 3, 6) in the coordinates of both ends."""
    found = np.zeros((len(links[0]), 3, 6))
    for each, pair, arms in zip(found, *links[:2], strict=True):
        for end, sign in enumerate((1.0, -1.0)):
            x, y = turned(np.append(turns, 0.0)[pair[end]], *arms[end])
            each[:, 3 * end : 3 * end + 3] = sign * np.array([[1, 0, -y], [0, 1, x], [0, 0, 1]])
    return found


def add_links(links: Links, turns: Array, constants: Array, whole: Symmetric) -> None:
    """Add the stiffness (K, 3) [N/m, N/m, N m] or damping (K, 3) [N s/m, N m s] of links to a matrix.

    turns: rotations of the bodies (B,) [rad].
    """
    for at, slope, own in zip(whole.pattern.links, _slopes(links, turns), constants, strict=True):
        np.add.at(whole.data, at[at >= 0], (slope.T * own @ slope)[at >= 0])


def between(links: Links, turns: Array, one: Array, other: Array) -> float:
    """Return the second derivative of the energy at fixed forces along two rates of bodies (B, 3) [J]."""
    slopes, still = _slopes(links, turns), np.zeros((1, 3))
    first, second = (
        np.einsum("kij,kj->ki", slopes, np.vstack([rates, still])[links[0]].reshape(-1, 6))
        for rates in (one, other)
    )
    return float(np.sum(first * second * links[2]))


def fastest(links: Links, constants: Array, mass: Array, inertia: Array) -> float:
    """Return an upper bound of the ratios of constants (K, 3) of links to masses and inertias (B,) [1/s^2 or
    1/s].

    It is the sum of the largest ratios of each link alone. At an arm o its end has the mass 1 / (1/m + o^2/J)
    at least.
    """
    (ends, offsets, _, _), total = links, 0.0
    with_ground = np.append(1.0 / mass, 0.0), np.append(1.0 / inertia, 0.0)
    for pair, arms, own in zip(ends, offsets, constants, strict=True):
        light, turning = (each[pair] for each in with_ground)
        total += max(own[0], own[1]) * float(np.sum(light + turning * np.sum(arms**2, axis=1)))
        total += own[2] * float(np.sum(turning))
    return total
