"""Springs and dampers between two places: roots that give way, springs of a scene, dampers of bodies.

A link between the points of two rows stretches by

    e = (u_1 - u_2, theta_1 - theta_2)

in axes of the ground, with u as in `places`. It resists with f = diag(k) e + diag(c) e'. The energy is
e.diag(k) e / 2. At the root of a strip it is between the node and what carries it, for turns alone.
"""

from collections.abc import Sequence

import numpy as np

from .arrays import Array, Indices, kernel
from .effects import BodyDamping, StripDamping
from .loading import Spring
from .matrix import Symmetric
from .model import Model
from .places import swept, turned

#: How many of the links are roots, which come first; rows at both ends (K, 2), offsets of their points
#: (K, 2, 2) [m], stiffness and damping (K, 3) for x, y and the turn.
Links = tuple[int, Indices, Array, Array, Array]
Parts = tuple[float, float, float]


def links_of(model: Model, points: Array, soft: Sequence[tuple[int, int, float]]) -> Links:
    """Return the links of a model whose bodies are reduced about `points` (B, 2) [m].

    soft: of the roots that give way: node, row of what it is on, and stiffness [N m].
    """
    bodies, effects, found = len(model.bodies), model.effects, []
    material, damper = effects.find(StripDamping), effects.find(BodyDamping)
    relaxation = 0.0 if material is None else material.relaxation_time
    for node, row, stiffness in soft:
        if stiffness > 0.0:  # a hinge has none
            turn = np.array([0.0, 0.0, stiffness])
            found.append((node, row, np.zeros((2, 2)), turn, relaxation * turn))
    roots, offsets = len(found), np.vstack([model.centres - points, np.zeros((1, 2))])
    every = [(model.body_index(each.body), each) for each in effects.every(Spring)]
    if damper is not None and (damper.translation or damper.rotation):
        own = Spring(damping=(damper.translation,) * 2, rotational_damping=damper.rotation)
        every += [(body, own) for body in range(bodies)]
    for body, spring in every:
        other = bodies if spring.other is None else model.body_index(spring.other)
        stiff = np.array([*spring.stiffness, spring.rotational_stiffness])
        viscous = np.array([*spring.damping, spring.rotational_damping])
        rows = model.arcs.size + body, model.arcs.size + other
        found.append((*rows, offsets[[body, other]], stiff, viscous))
    first, second, *others = zip(*found, strict=True) if found else ((),) * 5
    ends = np.array([first, second], dtype=np.int64).T.copy()
    shapes = ((-1, 2, 2), (-1, 3), (-1, 3))
    arms, stiff, viscous = (np.reshape(each, shape) for each, shape in zip(others, shapes, strict=True))
    return roots, ends, arms, stiff, viscous


@kernel()
def link_forces(links: Links, u: Array, v: Array, force: Array, curvature: Array) -> Parts:
    """Add the forces of links to forces and curvature at displacements and velocities.

    Args:
        links: rows, offsets, stiffness and damping of K links.
        u, v: displacements (rows, 3) [m, rad] and velocities (rows, 3) [m/s, rad/s].
        force: generalised forces (rows, 3) [N, N m], added to.
        curvature: second derivatives of the energy by turns (rows, 2) [N m], added to.

    Returns:
        Energy of the roots and of all other links [J], and the power that is lost [W].
    """
    (roots, ends, offsets, stiffness, damping), rooted, energy, loss = links, 0.0, 0.0, 0.0
    for k in range(len(ends)):
        x = y = turn = x_rate = y_rate = turn_rate = 0.0
        for end in range(2):
            i, sign = ends[k, end], 1.0 - 2.0 * end
            way = swept(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            arm = turned(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            x, y = x + sign * (u[i, 0] + way[0]), y + sign * (u[i, 1] + way[1])
            x_rate += sign * (v[i, 0] - v[i, 2] * arm[1])
            y_rate += sign * (v[i, 1] + v[i, 2] * arm[0])
            turn, turn_rate = turn + sign * u[i, 2], turn_rate + sign * v[i, 2]
        h, c = stiffness[k], damping[k]
        force_x, force_y = h[0] * x + c[0] * x_rate, h[1] * y + c[1] * y_rate
        moment = h[2] * turn + c[2] * turn_rate
        stored = 0.5 * (h[0] * x * x + h[1] * y * y + h[2] * turn * turn)
        if k < roots:
            rooted += stored
        else:
            energy += stored
        loss += c[0] * x_rate * x_rate + c[1] * y_rate * y_rate + c[2] * turn_rate * turn_rate
        for end in range(2):
            i, sign = ends[k, end], 1.0 - 2.0 * end
            arm = turned(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            force[i, 0] += sign * force_x
            force[i, 1] += sign * force_y
            force[i, 2] += sign * (moment + arm[0] * force_y - arm[1] * force_x)
            curvature[i, 1] -= sign * (arm[0] * force_x + arm[1] * force_y)
    return rooted, energy, loss


def _slopes(links: Links, u: Array) -> Array:
    """Return the derivatives of the stretches (K, 3, 6) by displacements and turns at both ends."""
    found = np.zeros((len(links[1]), 3, 6))
    for each, pair, arms in zip(found, links[1], links[2], strict=True):
        for end, sign in enumerate((1.0, -1.0)):
            x, y = turned(u[pair[end], 2], *arms[end])
            each[:, 3 * end : 3 * end + 3] = sign * np.array([[1, 0, -y], [0, 1, x], [0, 0, 1]])
    return found


def add_links(links: Links, u: Array, constants: Array, whole: Symmetric) -> None:
    """Add the matrix of stiffness [N/m, N m] or damping [N s/m, N m s] of links to a matrix.

    Args:
        links: rows, offsets, stiffness and damping of K links.
        u: displacements of all rows (rows, 3) [m, rad].
        constants: stiffness or damping (K, 3) in x, y and the turn.
        whole: matrix (size, size) that is added to.
    """
    for at, slope, own in zip(whole.pattern.links, _slopes(links, u), constants, strict=True):
        np.add.at(whole.data, at[at >= 0], (slope.T * own @ slope)[at >= 0])


def between(links: Links, u: Array, one: Array, other: Array) -> float:
    """Return the second derivative of the energy at fixed forces along two rates (rows, 3) [J]."""
    first, second = (
        np.einsum("kij,kj->ki", _slopes(links, u), rates[links[1]].reshape(-1, 6)) for rates in (one, other)
    )
    return float(np.sum(first * second * links[3]))


def fastest(links: Links, constants: Array, mass: Array, inertia: Array) -> float:
    """Return what no ratio of constants (K, 3) of links to masses and inertias (rows,) exceeds
    [1/s^2 or 1/s], roots excluded.

    It is the sum of the largest ratios of each link alone. At an arm o its end has the mass 1 / (1/m + o^2/J)
    at least.
    """
    roots, ends, offsets, *_ = links
    pairs, arms, own = (each[roots:] for each in (ends, offsets, constants))
    light, turning = 1.0 / mass[pairs], 1.0 / inertia[pairs]
    along = own[:, :2].max(axis=1, initial=0.0) * np.sum(light + turning * np.sum(arms**2, axis=2), axis=1)
    return float(np.sum(along + own[:, 2] * np.sum(turning, axis=1)))
