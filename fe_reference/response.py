"""States of equilibrium: rates, torque and stiffness along their path, and the stiffness of a body.

Critical points lie between or beyond the states of a path; they are named in words of design.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .actions import Tables
from .arrays import Array, Flags, kernel
from .control import Control, State, equilibrate
from .law import Written
from .matrix import Singular, Symmetric
from .model import Model
from .structure import Evaluation, Structure, structure_of

Rates = tuple[float, float, float, float]


def respond(control: Control, found: State) -> State:
    """Return an equilibrium with its response: one solve for each drive and for the load.

    What is left of the residual is carried to the drives by the same solve: to first order what they exert
    is that of exact equilibrium, free of the round-off in the last elements' forces.

    Raises:
        Singular: the tangent is singular to round-off.
    """
    factors, tangent, held = found.factors, found.at.tangent, control.held
    if factors is None:
        raise Singular(found.failure)
    moves = np.zeros((len(held), control.structure.size))
    moves[np.arange(len(held)), held] = 1.0
    moves -= factors.solve(tangent.times(moves))
    left = factors.solve(found.at.gradient)
    drive, rate = (found.at.gradient - tangent.times(left))[held], control.slope @ moves
    change, bent, first, second = control.rates(found.y, found.parameter)
    if change is not None and bent is not None:
        rate -= factors.solve(change)
        second += float((change + bent) @ rate)
    torque, stiffness = np.nan, np.nan
    if control.watched is not None:
        k = control.held.tolist().index(control.watched)
        torque = float(drive[k])
        stiffness = _stiffness_between(control.structure, found.at, found.y, moves[k], moves[k], left)
    return replace(
        found,
        rate=rate,
        conjugate=first + float(drive @ control.slope),
        slope=second + float(rate @ tangent.times(rate)),
        drive=drive,
        torque=torque,
        stiffness=stiffness,
    )


def _stiffness_between(
    structure: Structure, at: Evaluation, y: Array, one: Array, other: Array, left: Array
) -> float:
    """Return the second derivative of the potential at y along two rates (size,), by its elements.

    Nodes move far where elements strain little: the tangent times the rate loses the digits by which EA l^2
    exceeds EI. What is `left` to equilibrium (size,) takes the round-off of places out of the forces.
    """
    u, (v, w, rest) = structure.displacement(y), (structure.velocity(rate) for rate in (one, other, left))
    written = (structure.written[0], at.ends, at.matrices, structure.written[3])
    own = float(_between(structure.tables, u, v, w, rest, written))
    return own + at.tangent.apart(one, other) + float(at.curvature @ (v[:, 2] * w[:, 2]))


@kernel()
def _strained(x: float, y: float, rate: Array, i: int) -> tuple[float, Rates]:
    """Return how fast the chord (x, y) of an element turns, and the rest of the rates of its nodes."""
    j = i + 1
    step_x, step_y = rate[j, 0] - rate[i, 0], rate[j, 1] - rate[i, 1]
    w = (x * step_y - y * step_x) / (x * x + y * y)
    return w, (rate[i, 2] - w, step_x + w * y, step_y - w * x, rate[j, 2] - w)


@kernel()
def _between(tables: Tables, u: Array, one: Array, other: Array, left: Array, written: Written) -> float:
    """Return the same of elements and links, and what the forces on carried nodes change with the rest.

    Of what is written forces are scratch.

    With v the turn of an element's chord (x, y), its own change c = rate - v (-y, x, 1) strains it, and of
    the rest it is known that the force (X, Y) turns along. With w and d for the other rate it is

        c.H d + w (X c_y - Y c_x) + v (X d_y - Y d_x) + v w (X x + Y y)        [N m]
    """
    (_, table, first, _), (rows, carrier, _, _, arms) = tables[0], tables[1]
    _, pairs, constants, _ = tables[3]
    (force, ends, matrices, _), total = written, 0.0
    force[:] = 0.0
    for e in range(len(first)):
        i, h = first[e], matrices[e]
        j, less_x, less_y = i + 1, 0.0, 0.0
        for k in range(3):
            less_x += h[3, k] * left[i, k] + h[3, 3 + k] * left[j, k]
            less_y += h[4, k] * left[i, k] + h[4, 3 + k] * left[j, k]
        pull_x, pull_y = ends[e, 0] - less_x, ends[e, 1] - less_y
        x, y = table[e, 0] + (u[j, 0] - u[i, 0]), table[e, 1] + (u[j, 1] - u[i, 1])
        v, c = _strained(x, y, one, i)
        w, d = _strained(x, y, other, i)
        for a in range(4):
            for b in range(4):
                total += c[a] * h[2 + a, 2 + b] * d[b]
        total += w * (pull_x * c[2] - pull_y * c[1]) + v * (pull_x * d[2] - pull_y * d[1])
        total += v * w * (pull_x * x + pull_y * y)
        force[i, 0], force[i, 1] = force[i, 0] + less_x, force[i, 1] + less_y
        force[j, 0], force[j, 1] = force[j, 0] - less_x, force[j, 1] - less_y
    for k in range(len(rows)):
        i, b = rows[k], carrier[k]
        total -= one[b, 2] * other[b, 2] * (arms[k, 0] * force[i, 0] + arms[k, 1] * force[i, 1])
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        for p in range(3):
            total += constants[k, p] * (one[i, p] - one[j, p]) * (other[i, p] - other[j, p])
    return total


def body_stiffness(
    model: Model, states: Array, shares: Array, body: str | None = None, *, driven: str | None = None
) -> Array:
    """Return the stiffness (S, 3, 3) of a body's x, y and turn about its centre at balanced states (S, size).

    It is the change of what must be exerted on the body, forces [N] and a moment [N m], by displacements [m]
    and a turn [rad] in the axes of the ground: each of the three is prescribed in turn, the others held, and
    all other coordinates follow by the consistent tangent, under loads that stay. What is prescribed to the
    body is released, what is prescribed to others holds them.

    Args:
        model: the mesh that the states belong to. shares (S,): of the load that acts there.
        body: its name; None: the only one. driven: name of the body whose turn is led, if there is one.

    Exact for the mesh. nan where the tangent is singular.
    """
    structure = structure_of(model)
    place, held = structure.body_slice(model.body_index(body)), np.zeros(structure.size, dtype=bool)
    held[place] = True
    if driven is not None:
        held[structure.turns[model.body_index(driven)]] = True
    # without a name it is of the body that is asked for
    held[[structure.first_body + at for at in model.prescribed(model.body_index(body))]] = True
    units, nothing = np.zeros((3, structure.size)), np.zeros(structure.size)
    units[:, place] = np.eye(3)
    found = np.full((len(states), 3, 3), np.nan)
    load = structure.loads.factors()
    for k, y in enumerate(np.asarray(states)):
        at = structure.evaluate(y, load=load, acts=float(shares[k]))
        try:
            moves = units - at.tangent.factors(held).solve(at.tangent.times(units))
        except Singular:
            continue
        found[k] = [[_stiffness_between(structure, at, y, a, b, nothing) for b in moves] for a in moves]
    return found


#: Largest motion of a body over that of the nodes in a mode of the strips alone.
STANDS = 0.25
#: Inverse iterations to the critical mode; next to a critical point each gains several digits.
INVERSE_ITERATIONS = 6
#: Stiffness below which it is round-off, in EI/L, and part of an increment within which its zero is placed.
ROUND_OFF, PLACED = 1e-9, 1e-6
#: A limit point is what stopped the path if it lies within this part of it.
NEAR = 1e-3
PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "u", -9: "n"}


@dataclass(frozen=True, kw_only=True)
class CriticalPoint:
    """Where a path loses or regains stability, or a driven body its own stiffness.

    kind: "limit point" of the load factor, or where a driven rotation has no stiffness at fixed loads;
    "turning point" of a drive, where the driven coordinate itself goes back; "bifurcation" otherwise.
    load_factor [1]; rotation of the driven body [rad], nan without one; inertia: negative eigenvalues after
    it; turns (B,) of all bodies [rad]; preload: share of gravity and natural strains that acts there [1];
    text: what happens at which load, "" for the stationary torque of a path without loads, which is not
    unstable.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``, whose path to 0.1 rad has none:

    >>> solve_statics(pivot, rotation=0.1).critical_points
    ()
    """

    kind: str
    load_factor: float
    rotation: float
    inertia: int
    text: str
    turns: Array
    preload: float = 1.0


def critical_point(control: Control, before: State, after: State) -> CriticalPoint:
    """Return the bifurcation between two states beside it.

    It is where the line through the eigenvalues nearest to zero has its zero.
    """
    (first, _), (last, mode) = (
        _critical_mode(state.at.tangent, control.is_held) for state in (before, after)
    )
    part = first / (first - last) if first * last < 0.0 else 0.5
    what = _moves(control, mode) if after.inertia > before.inertia else "the strips are stable again"
    y, parameter = _part_of_the_way(before, after, part)
    return _point(control, "bifurcation", y, parameter, after.inertia, f"bifurcation: {what}")


def _critical_mode(tangent: Symmetric, held: Flags) -> tuple[float, Array]:
    """Return the eigenvalue nearest to zero of the tangent, scaled to units on its diagonal, and its mode.

    The mode (size,) is in the coordinates of the tangent, of any size, and zero at those that are held.
    """
    root = 1.0 / np.sqrt(np.abs(tangent.data[tangent.pattern.diagonal]) + np.finfo(float).tiny)
    factors = tangent.factors(held)
    mode = np.where(held, 0.0, np.cos(np.arange(1.0, len(root) + 1.0) ** 2))  # along no symmetry
    for _ in range(INVERSE_ITERATIONS):
        mode = factors.solve(mode / root) / root
        mode /= np.linalg.norm(mode)
    moved = mode * root
    return float(moved @ tangent.times(moved)), moved


def tipping(control: Control, before: State, after: State, counters: Counter[str]) -> list[CriticalPoint]:
    """Return where the stiffness of a driven turn at fixed loads vanishes between two states, if it does.

    Without loads its torque is stationary there, which is not unstable; released under loads the body tips
    over.
    """
    stiff, soft, least = before.stiffness, after.stiffness, ROUND_OFF * control.structure.moment_unit
    same = before.inertia == after.inertia  # else it may have gone through infinity
    if control.watched is None or not same or stiff * soft >= 0.0:
        return []
    if min(abs(stiff), abs(soft)) <= least:
        return []

    def remaining(part: float) -> float:
        y, parameter = _part_of_the_way(before, after, part)
        found = equilibrate(control, y, parameter, counters)
        if found.factors is None:
            return stiff + part * (soft - stiff)
        return respond(control, found).stiffness

    from scipy.optimize import brentq  # whose import takes longer than a small solve

    part = brentq(remaining, 0.0, 1.0, xtol=PLACED)
    y, parameter = _part_of_the_way(before, after, part)
    loaded = control.load is not None or control.structure.constant_words
    what = "limit point: the body's own stiffness vanishes: released, it tips over" if loaded else ""
    return [_point(control, "limit point", y, parameter, after.inertia, what)]


def limit_point(control: Control, trail: Sequence[State]) -> list[CriticalPoint]:
    """Return the critical point that a path ran into right after the last of its states, if it did.

    Next to a limit the parameter is short of it by the square of the way to it: the rate there grows as the
    rest to the power -1/2, and the coordinates are off by twice the rate times the rest. It goes on there
    along its tangent, at the same load. Next to a bifurcation from which an imperfection too small to be
    followed leads away, the rate grows as the rest to the power -2.
    """
    if len(trail) < 2:
        return []
    last, free = trail[-1], control.structure.measure * ~control.is_held
    at = np.array([state.parameter for state in trail])
    fast = np.array([np.linalg.norm(free * state.rate) for state in trail])
    # powers of the rate that are straight in the parameter, and zero there
    ends = [at[1:] - line[1:] * np.diff(at) / np.diff(line) for line in (fast**-2.0, fast**-0.5)]
    leaves = bool(np.ptp(ends[1]) < np.ptp(ends[0]))  # the states tell its place better than that of a limit
    rest = float(ends[leaves][-1]) - last.parameter
    if not 0.0 < abs(rest) <= NEAR:
        return []
    kind = "bifurcation" if leaves else "turning point" if control.turning else "limit point"
    what = f"{kind}: {_moves(control, last.rate)}"
    y, parameter = last.y + (0.0 if leaves else 2.0 * rest) * last.rate, last.parameter + rest
    return [_point(control, kind, y, parameter, last.inertia + 1, what)]


def _part_of_the_way(before: State, after: State, part: float) -> tuple[Array, float]:
    """Return coordinates and parameter at a part of the way between two states."""
    step = after.parameter - before.parameter
    return before.y + part * (after.y - before.y), before.parameter + part * step


def _point(control: Control, kind: str, y: Array, parameter: float, inertia: int, what: str) -> CriticalPoint:
    """Return the critical point at a state; its text tells what happens there, if that is to be told."""
    turns = y[control.structure.turns] if control.watched is None else y[[control.watched]]
    return CriticalPoint(
        kind=kind,
        load_factor=0.0 if control.settling else control.share(parameter),
        rotation=float(turns[0]) if len(turns) == 1 else np.nan,
        inertia=inertia,
        text=f"{what} at {', '.join(_places(control, y, parameter))}" if what else "",
        turns=y[control.structure.turns],
        preload=parameter if control.settling else 1.0,
    )


def _places(control: Control, y: Array, parameter: float) -> Iterator[str]:
    """Yield what acts there: loads, driven rotation, share of the weight, load factor."""
    if control.settling:
        yield f"{100.0 * parameter:.4g} % of {control.structure.constant_words}"
        yield "load factor 0"
        return
    if control.load is not None:
        vector = control.share(parameter) * control.structure.load_force(y, control.load)[0]
        x_force, y_force, turn = (float(vector[control.structure.axis == k].sum()) for k in range(3))
        sizes = ((math.hypot(x_force, y_force), "N"), (abs(turn), "N m"))
        yield from (_quantity(size, unit) for size, unit in sizes if size > 0.0)
    if control.turning:
        yield f"rotation {np.degrees(y[control.watched]):.4g} deg"
    yield f"load factor {control.share(parameter):.4g}"


def _quantity(size: float, unit: str) -> str:
    """Return a positive size in its unit with the prefix that leaves one to three digits before the point."""
    power = int(np.clip(3 * np.floor(np.log10(size) / 3.0), min(PREFIXES), max(PREFIXES)))
    return f"{size / 10.0**power:.4g} {PREFIXES[power]}{unit}"


def _moves(control: Control, mode: Array) -> str:
    """Return what moves in a mode (size,): the strips alone, or the bodies as well."""
    size = np.abs(np.where(control.is_held, 0.0, mode) * control.structure.measure)
    stand = control.structure.bodies(size).max(initial=0.0) <= STANDS * size.max()
    return "the strips buckle" if stand else "the strips give way with the body"
