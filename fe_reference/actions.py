"""All that acts on the rows, compiled: elements, weights, links, loads, and explicit steps.

Every effect has its own table, of length zero where the scene does not name it. With a relaxation time [s]
the elements are viscous: they resist with material tangent times velocity times it.
"""

from .arrays import Array, Indices, inlined, kernel
from .law import FORCES, MATERIAL, Energies, Given, Written, elements
from .loads import Histories, Links, Pulls, link_forces, load_power, pull, put_factors
from .places import Carried, carry, carry_velocity, gather, turned

#: Elements, carried rows, weights, links, loads and relaxation time of a structure.
Tables = tuple[Given, Carried, Pulls, Links, Pulls, float]
#: Displacements and velocities of all rows.
State = tuple[Array, Array]


@inlined()
def resist(
    tables: Tables, share: float, acts: float, asked: int, state: State, written: Written, curvature: Array
) -> tuple[Energies, float, float, float, float]:
    """Write all that resists at displacements and velocities.

    Args:
        tables: of all that acts; the loads at their factors.
        share: part of the weight and of natural strains that acts [1]. acts: part of the loads.
        asked: FORCES, MATERIAL or TANGENT, as of `law.elements`; viscous strips resist with MATERIAL alone.
        state: displacements (rows, 3) [m, rad] and velocities (rows, 3) [m/s, rad/s].
        written: arrays that `law.elements` writes; in the first is the force (rows, 3) [N, N m].
        curvature: what the carrying of rows adds to the stiffness of turns (rows,) [N m], overwritten.

    Returns:
        Energies of the strips, of springs and of the full weight [J], work of the loads in full since rest
        [J], and the power that dampers take [W].
    """
    (given, carried, weights, links, loads, relaxation), (u, v), loss = tables, state, 0.0
    bending, axial, shear = elements(given, share, asked, u, written)
    force = written[0]
    if asked == MATERIAL and relaxation > 0.0:
        loss += _viscous_forces(relaxation, given[2], written[2], v, force)
    gravity = -pull(weights, share, u, force)
    rooted, spring, lost = link_forces(links, u, v, force)
    work = pull(loads, acts, u, force)
    gather(carried, force, curvature)
    return (bending + rooted, axial, shear), spring, gravity, work, loss + lost


@kernel()
def _viscous_forces(relaxation: float, first: Indices, matrices: Array, v: Array, force: Array) -> float:
    """Add the forces of Kelvin-Voigt strips at velocities v (nodes, 3); return the power they take [W]."""
    power = 0.0
    for e in range(len(first)):
        for i in range(6):
            node, part, total = first[e] + i // 3, i % 3, 0.0
            for j in range(6):
                total += matrices[e, i, j] * v[first[e] + j // 3, j % 3]
            total *= relaxation
            force[node, part] += total
            power += total * v[node, part]
    return power


@kernel()
def couple(coupled: Array, u: Array, v: Array, out: Array) -> None:
    """Write the forces that resist the coupled motions as if the mass were diagonal.

    With the first moment (X, Y) in place and y free, m y'' + X t'' - Y t'^2 = -f and X y'' + J t'' = -g. With
    x free, -Y stands for X and X for Y.

    Args:
        coupled: bodies that are led one way (K, 7), as of `Scheme.couplings`.
        u, v: displacements (rows, 3) [m, rad] and velocities (rows, 3) [m/s, rad/s].
        out: resisting forces (rows, 3) [N, N m], changed.
    """
    for k in range(len(coupled)):
        b, free, mass, inertia = int(coupled[k, 0]), int(coupled[k, 1]), coupled[k, 2], coupled[k, 3]
        x, y = turned(u[b, 2], coupled[k, 4], coupled[k, 5])
        cross, inward = (x, y) if free == 1 else (-y, x)
        push, twist = inward * v[b, 2] ** 2 - out[b, free], -out[b, 2]
        if coupled[k, 6] > 0.0:  # a led turn bears what the free motion exerts
            out[b, free] = -push
            out[b, 2] += cross * push / mass
        else:
            rest = mass * inertia - cross * cross
            out[b, free] = -mass * (inertia * push - cross * twist) / rest
            out[b, 2] = -inertia * (mass * twist - cross * push) / rest


@kernel()
def advance(
    tables: Tables,
    written: Written,
    curvature: Array,
    histories: Histories,
    coupled: Array,
    led: Indices,
    compliance: Array,
    state: State,
    totals: Array,
    time: float,
    step: float,
    steps: int,
) -> None:
    """Make `steps` steps of the central difference scheme in place: v is half a step behind u.

        v += h a(u, v), u += h v

    Args:
        tables, written, curvature: as of `resist`.
        histories: of the loads.
        coupled: bodies that are led one way (K, 7), as of `Scheme.couplings`.
        led: places in the flattened rows of the coordinates that drives lead (H,).
        compliance: inverse mass (rows, 3) [1/kg, 1/(kg m^2)] of free nodes and bodies, else 0.
        state: displacements u (rows, 3) [m, rad] and velocities v (rows, 3) [m/s, rad/s], both changed.
        totals: work of loads and drives, exactly that of the scheme, and energy that dampers dissipate [J],
            added to. Dampers act at the velocities before the step.
        time, step: instant and step h [s].
        steps: number of steps.
    """
    (_, carried, _, links, loads, relaxation), force, (u, v) = tables, written[0], state
    asked = MATERIAL if relaxation > 0.0 else FORCES
    rated = relaxation > 0.0 or len(links[1]) + len(loads[0]) > 0  # what depends on velocities
    for n in range(steps):
        if rated:
            carry_velocity(carried, v)
        put_factors(histories, time + n * step, loads[2])
        _, _, _, _, loss = resist(tables, 1.0, 1.0, asked, state, written, curvature)
        power = load_power(loads, v)
        if len(coupled) > 0:
            couple(coupled, u, v, force)
        for at in led:
            totals[0] += step * force[at // 3, at % 3] * v[at // 3, at % 3]
        for i in range(len(u)):
            for k in range(3):
                v[i, k] -= step * compliance[i, k] * force[i, k]
                u[i, k] += step * v[i, k]
        if len(loads[0]) > 0:
            carry_velocity(carried, v)  # with the arms of the forces
        totals[0] += 0.5 * step * (power + load_power(loads, v))
        totals[1] += step * loss
        carry(carried, u)
