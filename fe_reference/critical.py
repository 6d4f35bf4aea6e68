"""Critical points between or beyond the states of a path, and what is said of them in words of design."""

import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from .arrays import Array, Flags
from .control import Control, State, equilibrate
from .matrix import Symmetric
from .response import respond
from .solution import CriticalPoint

#: Largest motion of a body over that of the nodes in a mode of the strips alone.
STANDS = 0.25
#: Inverse iterations to the critical mode; next to a critical point each gains several digits.
INVERSE_ITERATIONS = 6
#: Stiffness below which it is round-off, in EI/L, and part of an increment within which its zero is placed.
ROUND_OFF, PLACED = 1e-9, 1e-6
#: A limit point is what stopped the path if it lies within this part of it.
NEAR = 1e-3
PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "u", -9: "n"}


def critical_point(control: Control, before: State, after: State) -> CriticalPoint:
    """Return the bifurcation between two states beside it.

    It is where the line through the eigenvalues nearest to zero has its zero.
    """
    (first, _), (last, mode) = (
        _critical_mode(state.at.tangent, control.is_held) for state in (before, after)
    )
    part = first / (first - last) if first * last < 0.0 else 0.5
    what = _moves(control, mode) if after.inertia > before.inertia else "the strips are stable again"
    y, parameter = _between(before, after, part)
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
        y, parameter = _between(before, after, part)
        found = equilibrate(control, y, parameter, counters)
        if found.factors is None:
            return stiff + part * (soft - stiff)
        return respond(control, found).stiffness

    part = brentq(remaining, 0.0, 1.0, xtol=PLACED)
    y, parameter = _between(before, after, part)
    loaded = control.load is not None or control.structure.constant_words
    what = "limit point: the body's own stiffness vanishes: released, it tips over" if loaded else ""
    return [_point(control, "limit point", y, parameter, after.inertia, what)]


def limit_point(control: Control, last: State) -> list[CriticalPoint]:
    """Return the limit point that a path ran into right after its last state, if it did.

    Next to it the parameter is short of its limit by the square of the way to it. So the square of the rate
    there grows as one over the rest, which is read from the last two states; the coordinates are off by twice
    the rate times that rest. It goes on there along its tangent, at the same load.
    """
    if not last.behind:
        return []
    measure, (before, _, earlier) = control.structure.measure, last.behind[0]
    slow, fast = (float(np.sum((measure * rate)[~control.is_held] ** 2)) for rate in (earlier, last.rate))
    rest = (last.parameter - before) * slow / (fast - slow) if fast > slow else np.inf
    if abs(rest) > NEAR:
        return []
    kind = "turning point" if control.turning else "limit point"
    what = f"{kind}: {_moves(control, last.rate)}"
    y, parameter = last.y + 2.0 * rest * last.rate, last.parameter + rest
    return [_point(control, kind, y, parameter, last.inertia + 1, what)]


def _between(before: State, after: State, part: float) -> tuple[Array, float]:
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
