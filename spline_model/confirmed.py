"""Lack of resolution is not physics: critical points and early ends of a path against those of a finer one.

A limit point, a bifurcation or the end of a path is a property of the design only if more control points have
it at the same place. Otherwise the path is not resolved: it is cut where both disagree, with a message.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design, StripDesign
from spline_model.sections import STATIONS
from spline_model.solution import CriticalPoint, Status, largest, named
from spline_model.static_answers import StaticSolution
from spline_model.strip.compiled import kernel

Array = NDArray[np.float64]
Grid = tuple[int, int]
"""Segments of a strip and control points of each."""
Outcome = Callable[[Grid], StaticSolution]
"""The answer of a discretisation; each is solved once."""

MORE = 3
"""Control points that a segment gets more for the estimate. With two more the estimated error of
the torque was 0.3 to 3.7 times the true one on 1800 paths, with three 0.7 to 1.3 times."""
SAME_PLACE = 0.05
"""Relative difference of loads or rotations up to which two critical points are the same one."""
RESOLVED = 0.03
"""Difference of two states, in the largest displacement, turn and torque, up to which they are kept."""
SAME_STATE = 1e-9
"""Difference of load factors and rotations of states that are the same increment."""
ROUND_OFF = 1e-9
"""Displacement [m], turn [rad] and torque [N m] that no state is judged by."""
TURN = 1e-2
"""Rotation up to which critical points are held against it, not against their own [rad]."""
LEAST = 1e-6
"""Smallest relative difference that is printed."""
NOTHING = 1e-9
"""Displacement in lengths, turn [rad], torque in stiffness times 1 rad, and force in moment over length,
below which there is none but round-off."""
NO_STIFFNESS = 1e-3
"""Part of its largest entry on a path below which one on the diagonal of a body's stiffness is held against
that part: it may pass through zero."""
SAME_END = 1e-3
"""Difference of load factors, and of rotations [rad], at which paths stop that stop at the same thing."""


def finer(segments: int, points: int) -> Grid:
    """Return the discretisation for checks: a few more control points in each segment."""
    return segments, points + MORE


def spread(one: Sequence[CriticalPoint], other: Sequence[CriticalPoint]) -> float:
    """Return the largest relative difference [1] of the places of critical points; inf if they do not
    match."""
    if [point.kind for point in one] != [point.kind for point in other]:
        return math.inf
    apart = 0.0
    for mine, its in zip(one, other, strict=True):
        for name in ("preload", "load_factor", "rotation"):
            a, b = (0.0 if math.isnan(getattr(p, name)) else getattr(p, name) for p in (mine, its))
            least = TURN if name == "rotation" else ROUND_OFF
            apart = max(apart, abs(a - b) / max(abs(a), abs(b), least))
    return apart


def ends_alike(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths met the same critical points and ended at the same one, or both reached their end."""
    met_alike = spread(one.critical_points, other.critical_points) <= SAME_PLACE
    stopped_alike = one.status is other.status and at_limit(one) == at_limit(other)
    somewhere = one.settled or bool(one.critical_points)
    return met_alike and stopped_alike and somewhere and one.settled is other.settled


def at_limit(path: StaticSolution) -> bool:
    """Whether a path stopped at a limit point, which lies beyond its last state."""
    points = path.critical_points
    return path.status is not Status.CONVERGED and bool(points) and points[-1].inertia > path.inertia[-1]


def confirmed(outcome: Outcome, grid: Grid, *, searched: bool = False) -> StaticSolution:
    """Return the answer of a discretisation; critical points and early ends only if a finer one has them too.

    searched: whether it is the last one of a search, so that to leave the number open is no remedy.
    """
    answer = outcome(grid)
    if answer.status is Status.CONVERGED and not answer.critical_points:
        return answer
    more = finer(*grid)
    better = outcome(more)
    if ends_alike(answer, better) and (answer.status is Status.CONVERGED or at_limit(answer)):
        apart = spread(answer.critical_points, better.critical_points)
        told = f"{named(*more)} have it within {max(apart, LEAST):.0e}"
        return replace(answer, message=f"{answer.message} ({told})" if answer.message else "")
    advice = ("" if searched else "leave the number open, or ") + f"take segments = {2 * grid[0]}"
    return _cut(answer, better, grid, advice)


def _cut(answer: StaticSolution, better: StaticSolution, grid: Grid, advice: str) -> StaticSolution:
    """The part of a path that is resolved, and what is not, with an advice."""
    more = finer(*grid)
    kept = _agreeing(answer, better)
    both = zip(answer.critical_points, better.critical_points, strict=False)
    known = len(list(takewhile(lambda pair: spread(pair[:1], pair[1:]) <= SAME_PLACE, both)))
    doubt, other = answer.critical_points[known:], better.critical_points[known:]
    if doubt and not at_limit(answer):
        there = _place(other[0].load_factor, other[0].rotation) if other else "no state"
        what = f"a {doubt[0].kind} at {_place(doubt[0].load_factor, doubt[0].rotation)}"
        what += f" is at {there} with {more[1]}"
    else:
        here = _end(answer) if at_limit(answer) else answer.message
        what = f"{here}; with {more[1]} {_end(better)}"
    whole = kept == len(answer.work) and answer.status is Status.CONVERGED
    message = f"not resolved with {named(*grid)}: {what}; {advice}"
    return replace(
        answer.rows(slice(kept)),
        status=Status.CONVERGED if whole else Status.NOT_CONVERGED,
        message=message,
        critical_points=answer.critical_points[:known],
    )


def _place(load_factor: float, rotation: float) -> str:
    turn = f" ({math.degrees(rotation):.5g} deg)" if math.isfinite(rotation) and rotation else ""
    return f"load factor {load_factor:.6g}{turn}"


def _end(path: StaticSolution) -> str:
    """Where a path ends, in words."""
    if not path.settled:
        return "its weight finds no equilibrium"
    if path.status is Status.CONVERGED:
        return "it reaches its end"
    return f"it stops at {_place(path.load_factor[-1], path.rotation[-1] if path.driven else math.nan)}"


def moved(path: StaticSolution) -> Array:
    """Return displacements x + iy of the bodies, or of the strips' ends where there are none (S, B) [m]."""
    places = np.stack(list(path.bodies.values()), axis=1) if path.bodies else path.shape[:, :, -1]
    change = places - places[0]
    return np.asarray(change[..., 0] + 1j * change[..., 1])


def turned(path: StaticSolution) -> Array:
    """Return rotations of the bodies that are not driven (S, B) [rad]."""
    if not set(path.bodies) - {path.driven}:
        return np.zeros((len(path.load_factor), 0))
    return np.stack([at[:, 2] for name, at in path.bodies.items() if name != path.driven], axis=1)


def parameters(path: StaticSolution) -> Array:
    """Return load factors [1] and driven rotations [rad] of the states (2, S)."""
    return np.stack((path.load_factor, path.rotation if path.driven else path.load_factor))


def _agreeing(one: StaticSolution, other: StaticSolution) -> int:
    """How many states from the first on two paths have in common; all of paths that have no increments."""
    count = min(len(one.work), len(other.work))
    apart = np.abs(parameters(one)[:, :count] - parameters(other)[:, :count]).max(axis=0)
    same = int(np.argmax(np.append(apart > SAME_STATE, True)))
    if same <= 1 < count and np.isin(one.load_factor[1:], other.load_factor[1:]).sum() == 0:
        return len(one.work)  # by arc length, or stopped in the first increment
    wrong = np.zeros(same)
    for quantity in (moved, turned, lambda path: path.torque[:, None]):
        mine, right = quantity(one)[:same], quantity(other)[:same]
        scale = float(np.abs(right).max(initial=0.0))
        if scale > ROUND_OFF:
            wrong = np.maximum(wrong, np.abs(mine - right).max(axis=1, initial=0.0) / scale)
    return max(1, int(np.argmax(np.append(wrong > RESOLVED, True))))


def distances(design: Design, answer: StaticSolution, better: StaticSolution) -> dict[str, float]:
    """Return errors of an answer against a better one by the names of ``ErrorEstimate``, each over the
    largest magnitude on its path but the stiffness of the body; nan of what there is none of.

    Places over the largest displacement, turns over the largest turn, section forces over the largest force
    and the largest moment. What is none but round-off is held against its unit: strip length, rad, EI/L.
    Paths by arc length have no states in common but their ends, which are compared then.
    """
    length = max(strip.length for strip in design.strips)
    moment = max(strip.flexural_rigidity / strip.length for strip in design.strips)
    stress = max(strip.flexural_rigidity / strip.length / _modulus(strip) for strip in design.strips)
    rows = slice(None) if in_step(answer, better) else slice(-1, None)

    def error(of: Callable[[StaticSolution], Array], unit: float) -> float:
        mine, right = of(answer)[rows], of(better)[rows]
        return float(relative(mine[None], right[None], np.array([unit]))[0])

    forces = error(lambda path: np.stack((path.axial_force, path.shear_force), axis=1), moment / length)
    stiffest = max(strip.axial_rigidity / strip.length for strip in design.strips)
    least = np.finfo(float).eps * stiffest * np.array([1.0, 1.0, length**2])
    pushed, turned_by = (partial(_exerted, turns=turns) for turns in (False, True))
    return {
        "trajectory": largest((error(moved, length), error(turned, 1.0))),
        "torque": error(lambda path: path.torque, moment),
        "stiffness": error(lambda path: path.stiffness, moment),
        "body_stiffness": _by_state(answer.own_stiffness[rows], better.own_stiffness[rows], least),
        "energy": error(lambda path: path.energies.sum(axis=1), moment),
        "section_forces": largest((error(lambda path: path.bending_moment, moment), forces)),
        "stress": error(lambda path: _stress(design, path), stress),
        "reactions": largest((error(pushed, moment / length), error(turned_by, moment))),
    }


def _exerted(path: StaticSolution, *, turns: bool) -> Array:
    """Forces [N], or moments [N m] (S, D), that are exerted on bodies, but the torque of the drive."""
    own = [part for part in path.prescribed if part != (path.driven, "rotation")]
    kind = [path.prescribed.index(part) for part in own if (part[1] == "rotation") is turns]
    return np.asarray(path.reactions[:, kind])


def _by_state(stiffness: Array, better: Array, least: Array) -> float:
    """Largest error of entries of a body's stiffness (S, 3, 3) over the root of the product of their diagonal
    entries in that state: they fall by powers of ten along a path. nan where none is above its round-off
    ``least`` (3,)."""
    size = np.abs(np.diagonal(better, axis1=1, axis2=2))
    size = np.sqrt(np.fmax(size, NO_STIFFNESS * np.fmax.reduce(size, axis=0)))
    size[size <= np.sqrt(least)] = math.nan  # a body that turns freely on a hinge, or that nothing holds
    shares = np.abs(stiffness - better) / (size[:, :, None] * size[:, None, :])
    return float(np.fmax.reduce(shares, axis=None))


def in_step(one: StaticSolution, other: StaticSolution) -> bool:
    """Whether two paths have the states of the same load factors and rotations, about so where they end."""
    mine, others = parameters(one), parameters(other)
    if mine.shape != others.shape:
        return False
    apart = np.abs(mine - others)
    return bool(apart[:, :-1].max(initial=0.0) <= SAME_STATE and apart[:, -1].max() <= SAME_END)


def relative(mine: Array, right: Array, unit: Array) -> Array:
    """Return the largest of the differences of D quantities (D, ...) from the right ones over the largest
    right value, or over their units (D,) [1].

    nan is passed over; the result is nan if there are no values.
    """
    if right.size == 0:
        return np.full(len(right), np.nan)
    found = np.empty((2, len(right)))
    _largest(mine.reshape(len(mine), -1).copy(), right.reshape(len(right), -1).copy(), found)
    return np.asarray(found[0] / np.where(found[1] > NOTHING * unit, found[1], unit))


@kernel()
def _largest(mine, right, found):
    """Largest magnitudes of the differences of D quantities and of the right ones (2, D)."""
    for d in range(right.shape[0]):
        apart = size = -1.0
        for i in range(right.shape[1]):
            each, value = abs(mine[d, i] - right[d, i]), abs(right[d, i])
            apart, size = each if each > apart else apart, value if value > size else size
        found[0, d], found[1, d] = apart if apart >= 0.0 else np.nan, size if size >= 0.0 else np.nan


def _modulus(strip: StripDesign) -> float:
    """Section modulus of the rectangle that A and I imply [m^3]."""
    return math.sqrt(strip.area * strip.second_moment_of_area / 3.0)


def _stress(design: Design, path: StaticSolution) -> Array:
    """Largest stress of each strip, |N|/A + |M|/W (S, G) [Pa]."""
    area = np.array([[strip.area] for strip in design.strips])
    modulus = np.array([[_modulus(strip)] for strip in design.strips])
    if tapers := {g: strip.taper for g, strip in enumerate(design.strips) if strip.taper}:
        area, modulus = (np.repeat(each, len(STATIONS), axis=1) for each in (area, modulus))
        for g, taper in tapers.items():
            area[g] *= taper.area(STATIONS)
            modulus[g] *= taper.area(STATIONS) * taper.side("thickness", STATIONS)
    return np.asarray((np.abs(path.axial_force) / area + np.abs(path.bending_moment) / modulus).max(axis=2))
