"""Compiled inner loops of the effects beside bending and stretching, and the explicit steps with them.

Every effect has its own table, of length zero where the scene does not name it:

    natural (E, 2)       natural strain and curvature of the elements
    weight (nodes, 3)    weight at the nodes, and body_weight (B, 3) at the bodies' points
    relaxation (E,)      relaxation time of the elements [s]
    drag (nodes,)        drag coefficient of the nodes [N s/m]
    grip (B, 4)          dampers of the bodies: translation, rotation, and the offset of the centre
    targets (K,)         where the loads act: a body (0 and up), or the node i as -1 - i
    loads (K, 5)         force x, y, moment, and the offset of the point from the body's point
    begins (K + 1,)      where the histories of the loads lie in instants and factors (H,)
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ..kernels import body_forces, carry, internal_forces, move

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@njit(cache=True, nogil=True, error_model="numpy")
def natural_forces(
    shear: bool, first: Indices, table: Array, natural: Array, u: Array, force: Array
) -> float:
    """Add the forces of natural strains to the nodal forces; return what they add to the energy [J]."""
    energy = 0.0
    for e in range(len(natural)):
        i, row = first[e], table[e]
        j = i + 1
        axial, moment = row[3] * natural[e, 0], row[4] * natural[e, 1]
        x, y = row[0] + u[j, 0] - u[i, 0], row[1] + u[j, 1] - u[i, 1]
        length = math.sqrt(x * x + y * y)
        c, s, lever = x / length, y / length, 0.0
        strain = length / row[2] - 1.0
        if shear:
            turn = 0.5 * (u[i, 2] + u[j, 2])
            cosine, sine = math.cos(turn), math.sin(turn)
            c, s = (row[0] * cosine - row[1] * sine) / row[2], (row[1] * cosine + row[0] * sine) / row[2]
            strain = (x * c + y * s) / row[2] - 1.0
            lever = 0.5 * axial * (y * c - x * s)
        force[i, 0] += axial * c
        force[i, 1] += axial * s
        force[i, 2] += moment - lever
        force[j, 0] -= axial * c
        force[j, 1] -= axial * s
        force[j, 2] -= moment + lever
        energy += row[2] * axial * (0.5 * natural[e, 0] - strain)
        energy += moment * (0.5 * row[2] * natural[e, 1] - (u[j, 2] - u[i, 2]))
    return energy


@njit(cache=True, nogil=True, error_model="numpy")
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


@njit(cache=True, nogil=True, error_model="numpy")
def viscous_corotational(
    row: Array, time: float, x: float, y: float, v_x: float, v_y: float, w_1: float, w_2: float, out: Array
) -> float:
    """Write force x, force y at the second node and both moments of one element; return the power it takes.

    Args:
        row: of the element table. time: relaxation time. x, y: chord. v_x, v_y: its rate. w_1, w_2: spins.
    """
    length = math.sqrt(x * x + y * y)
    c, s = x / length, y / length
    strain_rate, spin = (v_x * c + v_y * s) / row[2], (v_y * c - v_x * s) / length
    rate_1, rate_2 = w_1 - spin, w_2 - spin
    axial, rate = time * row[3] * strain_rate, time * row[4] / row[2]
    out[2], out[3] = rate * (4.0 * rate_1 + 2.0 * rate_2), rate * (2.0 * rate_1 + 4.0 * rate_2)
    cross = (out[2] + out[3]) / length
    out[0], out[1] = axial * c + cross * s, axial * s - cross * c
    power: float = row[2] * axial * strain_rate + out[2] * rate_1 + out[3] * rate_2
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def viscous_reissner(
    row: Array,
    time: float,
    turn: float,
    x: float,
    y: float,
    v_x: float,
    v_y: float,
    w_1: float,
    w_2: float,
    out: Array,
) -> float:
    """Write the same for the shear-deformable element, whose midpoint has turned by `turn`."""
    spin, cosine, sine = 0.5 * (w_1 + w_2), math.cos(turn), math.sin(turn)
    c, s = (row[0] * cosine - row[1] * sine) / row[2], (row[1] * cosine + row[0] * sine) / row[2]
    along, across = (x * c + y * s) / row[2], (y * c - x * s) / row[2]
    strain_rate = (v_x * c + v_y * s) / row[2] + spin * across
    slide_rate = (v_y * c - v_x * s) / row[2] - spin * along
    bend_rate = (w_2 - w_1) / row[2]
    axial, cross, moment = time * row[3] * strain_rate, time * row[5] * slide_rate, time * row[4] * bend_rate
    lever = 0.5 * row[2] * (axial * across - cross * along)
    out[0], out[1] = axial * c - cross * s, axial * s + cross * c
    out[2], out[3] = lever - moment, lever + moment
    power: float = row[2] * (axial * strain_rate + cross * slide_rate + moment * bend_rate)
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def viscous_forces(
    shear: bool, first: Indices, table: Array, relaxation: Array, u: Array, v: Array, force: Array, out: Array
) -> float:
    """Add the forces of Kelvin-Voigt strips at velocities v (nodes, 3); return the power they take [W]."""
    power = 0.0
    for e in range(len(relaxation)):
        i, row = first[e], table[e]
        j = i + 1
        x, y = row[0] + u[j, 0] - u[i, 0], row[1] + u[j, 1] - u[i, 1]
        v_x, v_y, w_1, w_2 = v[j, 0] - v[i, 0], v[j, 1] - v[i, 1], v[i, 2], v[j, 2]
        if shear:
            turn = 0.5 * (u[i, 2] + u[j, 2])
            power += viscous_reissner(row, relaxation[e], turn, x, y, v_x, v_y, w_1, w_2, out)
        else:
            power += viscous_corotational(row, relaxation[e], x, y, v_x, v_y, w_1, w_2, out)
        force[i, 0] -= out[0]
        force[i, 1] -= out[1]
        force[i, 2] += out[2]
        force[j, 0] += out[0]
        force[j, 1] += out[1]
        force[j, 2] += out[3]
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def drag_forces(drag: Array, v: Array, force: Array) -> float:
    """Add the drag of the nodes; return the power it takes [W]."""
    power = 0.0
    for i in range(len(drag)):
        for k in range(2):
            force[i, k] += drag[i] * v[i, k]
            power += drag[i] * v[i, k] * v[i, k]
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def grip_forces(grip: Array, bodies: Array, bodies_v: Array, out: Array) -> float:
    """Add the dampers of the bodies to their resultants (B, 3); return the power they take [W]."""
    power = 0.0
    for b in range(len(grip)):
        c, s = math.cos(bodies[b, 2]), math.sin(bodies[b, 2])
        arm_x, arm_y = c * grip[b, 2] - s * grip[b, 3], s * grip[b, 2] + c * grip[b, 3]
        v_x, v_y = bodies_v[b, 0] - bodies_v[b, 2] * arm_y, bodies_v[b, 1] + bodies_v[b, 2] * arm_x
        moment = grip[b, 1] * bodies_v[b, 2]
        out[b, 0] += grip[b, 0] * v_x
        out[b, 1] += grip[b, 0] * v_y
        out[b, 2] += moment + grip[b, 0] * (arm_x * v_y - arm_y * v_x)
        power += grip[b, 0] * (v_x * v_x + v_y * v_y) + moment * bodies_v[b, 2]
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def factor_at(instants: Array, factors: Array, begin: int, end: int, time: float) -> float:
    """Return the factor of a piecewise linear history at an instant; constant before and after it."""
    factor: float = factors[begin]
    for k in range(begin + 1, end):
        part = (time - instants[k - 1]) / (instants[k] - instants[k - 1])
        factor += min(max(part, 0.0), 1.0) * (factors[k] - factors[k - 1])
    return factor


@njit(cache=True, nogil=True, error_model="numpy")
def load_forces(
    targets: Indices,
    loads: Array,
    begins: Indices,
    instants: Array,
    factors: Array,
    time: float,
    bodies: Array,
    pulls: Array,
) -> None:
    """Write the generalised forces (K, 3) of the loads at an instant."""
    for k in range(len(targets)):
        factor = factor_at(instants, factors, begins[k], begins[k + 1], time)
        moment = loads[k, 2]
        if targets[k] >= 0:
            c, s = math.cos(bodies[targets[k], 2]), math.sin(bodies[targets[k], 2])
            arm_x, arm_y = c * loads[k, 3] - s * loads[k, 4], s * loads[k, 3] + c * loads[k, 4]
            moment += arm_x * loads[k, 1] - arm_y * loads[k, 0]
        pulls[k, 0], pulls[k, 1], pulls[k, 2] = factor * loads[k, 0], factor * loads[k, 1], factor * moment


@njit(cache=True, nogil=True, error_model="numpy")
def load_power(targets: Indices, pulls: Array, v: Array, bodies_v: Array) -> float:
    """Return the power of the loads [W]."""
    power = 0.0
    for k in range(len(targets)):
        rate = bodies_v[targets[k]] if targets[k] >= 0 else v[-1 - targets[k]]
        power += pulls[k, 0] * rate[0] + pulls[k, 1] * rate[1] + pulls[k, 2] * rate[2]
    return power


@njit(cache=True, nogil=True, error_model="numpy")
def put_loads(targets: Indices, pulls: Array, force: Array, resultants: Array) -> None:
    """Take the loads from the forces that resist."""
    for k in range(len(targets)):
        for i in range(3):
            if targets[k] >= 0:
                resultants[targets[k], i] -= pulls[k, i]
            else:
                force[-1 - targets[k], i] -= pulls[k, i]


@njit(cache=True, nogil=True, error_model="numpy")
def put_weight(weight: Array, force: Array) -> None:
    """Take a weight (rows, 3) from the forces that resist, if there is one."""
    if len(weight):
        force -= weight


@njit(cache=True, nogil=True, error_model="numpy")
def advance_scene(
    given: tuple[bool, Indices, Array, Indices, Indices, Array],
    conservative: tuple[Array, Array, Array],
    dissipative: tuple[Array, Array, Array],
    histories: tuple[Indices, Array, Indices, Array, Array],
    compliance: Array,
    body_compliance: Array,
    u: Array,
    v: Array,
    bodies: Array,
    bodies_v: Array,
    work: tuple[Array, Array, Array],
    pulls: Array,
    totals: Array,
    time: float,
    step: float,
    steps: int,
) -> None:
    """Make `steps` steps as `kernels.advance` does, with all effects; dampers act at mid-step velocities.

    `totals` gathers the work of the loads, exactly that of the scheme, and what the dampers take [J].
    """
    shear, first, table, attached, carrier, offsets = given
    natural, weight, body_weight = conservative
    relaxation, drag, grip = dissipative
    targets, loads, begins, instants, factors = histories
    force, resultants, scratch = work
    viscous = len(relaxation) > 0 or len(drag) > 0
    for n in range(steps):
        internal_forces(shear, first, table, u, force, scratch)
        natural_forces(shear, first, table, natural, u, force)
        put_weight(weight, force)
        if viscous:
            carry_velocity(bodies, bodies_v, attached, carrier, offsets, v)
            totals[1] += step * viscous_forces(shear, first, table, relaxation, u, v, force, scratch)
            totals[1] += step * drag_forces(drag, v, force)
        body_forces(bodies, attached, carrier, offsets, force, resultants)
        put_weight(body_weight, resultants)
        totals[1] += step * grip_forces(grip, bodies, bodies_v, resultants)
        load_forces(targets, loads, begins, instants, factors, time + n * step, bodies, pulls)
        put_loads(targets, pulls, force, resultants)
        totals[0] += 0.5 * step * load_power(targets, pulls, v, bodies_v)
        move(compliance, force, step, v, u)
        move(body_compliance, resultants, step, bodies_v, bodies)
        totals[0] += 0.5 * step * load_power(targets, pulls, v, bodies_v)
        carry(bodies, attached, carrier, offsets, u)
