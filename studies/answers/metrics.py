"""Measures that compare one path with another, and the answers of models; the frequency of a swing."""

import math
from collections.abc import Callable, Iterable, Sequence
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from studies.answers.response import Response
from studies.kinds import Array

#: Part of the largest value of a path below which a value is round-off.
NOTHING = 1e-9
#: A passage leads from so far beyond the rest on one side to as far on the other, as a part of the swing's
#: mean amplitude: a ripple of less does not count.
BAND = 0.4
#: Half swings to both sides that last alike within this are those of a symmetric swing.
ALIKE = 2e-3
#: Turning points to both sides that are as far from zero within this part of their distance are those of a
#: symmetric swing, where a half swing is all there is.
AS_FAR = 2e-2
#: Rounds in which the rest is looked for, and the change of it, over the amplitude, that ends them.
ROUNDS, SETTLED = 30, 1e-9
#: Largest amplitude that is none [rad or m]: motions are solved to 1e-11.
STILL = 1e-10


def cubic(places: Array, values: Array) -> Any:
    """Return the cubic spline through values (S, ...), of any unit, at places (S,) of any unit.

    The import is local, because it takes longer than the solution of a path.
    """
    from scipy.interpolate import CubicSpline

    return CubicSpline(places, values)


def trajectory_error(centre: Array, reference: Array) -> Array:
    """Return |g - g_ref| over |g_ref,end - g_ref,0|, the distance of two paths over the reference's
    displacement.

    Args:
        centre: (S, 2) positions [m]; a path that stopped early has fewer states than the reference.
        reference: (R, 2) positions [m], R >= S, from rest to the end of the path.

    Returns:
        (S,) [1].

    Raises:
        ValueError: the reference ends where it began.
    """
    travel = float(np.linalg.norm(reference[-1] - reference[0]))
    if travel == 0.0:
        raise ValueError("reference path: got no displacement, expected one to relate errors to")
    distance = np.linalg.norm(centre - reference[: len(centre)], axis=1)
    return np.asarray(distance / travel)


def relative_error(values: Array, reference: Array) -> Array:
    """Return (v - v_ref) / |v_ref| state by state; a reference that is none but round-off of its largest
    value, as that of an unloaded state, counts as that value.

    Args:
        values: (S,) of any unit.
        reference: (R,) of the same unit, R >= S.

    Returns:
        (S,) signed [1].
    """
    expected = reference[: len(values)]
    difference = values - expected
    largest = float(np.abs(reference).max(initial=0.0)) or 1.0
    return np.asarray(difference / np.where(np.abs(expected) <= NOTHING * largest, largest, np.abs(expected)))


def observed_order(coarse: float, fine: float, ratio: float = 2.0) -> float:
    """Return log(e_coarse / e_fine) / log(ratio) [1]: the observed order of convergence.

    Args:
        coarse, fine: errors in one unit. ratio: refinement between them [1].

    NaN if either error is zero or not finite.
    """
    if not (0.0 < abs(coarse) < math.inf and 0.0 < abs(fine) < math.inf):
        return math.nan
    return math.log(abs(coarse / fine)) / math.log(ratio)


class _Extrapolated(NamedTuple):
    """A limit of refinement and its uncertainty, of the same shape and unit."""

    value: Array
    uncertainty: Array


def richardson(coarse: Array, fine: Array, *, order: float, ratio: float = 2.0) -> Array:
    """Return the limit of a sequence of known order from its last two members.

    f = f_fine + (f_fine - f_coarse) / (ratio^order - 1), exact when the error is C h^order alone.

    Args:
        coarse, fine: values on two meshes, any shape.
        order: order of the method [1].
        ratio: refinement between the two [1].
    """
    return np.asarray(fine + (fine - coarse) / (ratio**order - 1.0))


def extrapolate(levels: Sequence[Array], *, order: float = 2.0, ratio: float = 2.0) -> _Extrapolated:
    """Return the limit of successively refined answers, with h^order and then h^(2 order) eliminated.

    The uncertainty is the distance to the limit that the same elimination gives without the finest level: an
    upper bound as long as refinement helps, and of the size of round-off where it no longer does.

    Args:
        levels: arrays of one shape, coarse to fine, each refined by `ratio`; the last four are used.
        order: order of the method [1].
        ratio: refinement from one level to the next [1].

    Raises:
        ValueError: fewer than three levels.
    """
    if len(levels) < 3:
        raise ValueError(f"levels: got {len(levels)}, expected at least 3")
    limit = _limit(levels, order, ratio)
    return _Extrapolated(value=limit, uncertainty=np.abs(limit - _limit(levels[:-1], order, ratio)))


def _limit(levels: Sequence[Array], order: float, ratio: float) -> Array:
    """Return the limit of the last two levels, or of the last three where there are as many."""
    once = richardson(levels[-2], levels[-1], order=order, ratio=ratio)
    if len(levels) == 2:
        return once
    before = richardson(levels[-3], levels[-2], order=order, ratio=ratio)
    return richardson(before, once, order=2.0 * order, ratio=ratio)


def quasi_static_frequency(
    rotation: Array, centre: Array, strain_energy: Array, *, mass: float, moment_of_inertia: float
) -> float:
    """Return the frequency of the swing that the static path alone implies [Hz].

    The body moves along its static path with the path's strain energy U as its potential:

        T = 4 integral_0^Theta sqrt((J + m |dg/dtheta|^2) / (2 (U(Theta) - U(theta)))) dtheta

    with theta = Theta sin(phi), which removes the singularity at the end. Neglects the inertia of the strips;
    exact for massless strips of a design whose path is symmetric about rest.

    Args:
        rotation: (S,) from 0 to the amplitude Theta [rad], one sign.
        centre: (S, 2) [m]; strain_energy: (S,) [J], along the static path.
        mass: m of the body [kg]; moment_of_inertia: J about its centre of mass [kg m^2].
    """
    nodes, weights = np.polynomial.legendre.leggauss(40)
    phi = 0.25 * np.pi * (nodes + 1.0)
    turn = np.abs(rotation)
    amplitude = turn[-1]
    angle = amplitude * np.sin(phi)
    energy = cubic(turn, strain_energy)
    rate = cubic(turn, centre)(angle, 1)
    inertia = moment_of_inertia + mass * np.sum(rate**2, axis=1)
    left = 2.0 * (strain_energy[-1] - energy(angle))
    quarter = 0.25 * np.pi * float(weights @ (np.sqrt(inertia / left) * amplitude * np.cos(phi)))
    return 1.0 / (4.0 * quarter)


def differences(answer: Response, other: Response, names: Iterable[str]) -> dict[str, float | None]:
    """Return the largest difference of quantities of `COMPARED` over the states that both reached, over their
    largest value in `other` [1]; None where there is nothing to compare.

    A path that stopped may end between two states of the other: that state is skipped.
    """
    both = min(len(answer.load_factor), len(other.load_factor))
    same = np.abs(answer.load_factor[:both] - other.load_factor[:both]) < NOTHING
    found: dict[str, float | None] = {}
    for name in names:
        mine, theirs = (COMPARED[name](each) for each in (answer, other))
        scale = float(np.abs(theirs).max(initial=0.0))
        apart = np.abs(mine[:both] - theirs[:both])[same]
        found[name] = None if scale == 0.0 else float(apart.max()) / scale
    return found


def _moved(answer: Response) -> Array:
    """Return the displacements of all centres (S, B) [m], as complex numbers."""
    if not answer.bodies:
        return np.zeros((len(answer.load_factor), 0))
    centres = np.stack(list(answer.centres.values()), axis=1)
    moved = centres - centres[0]
    return np.asarray(moved[..., 0] + 1j * moved[..., 1])


#: What is compared, by name: arrays over the states; angles count as they are, in rad.
COMPARED: dict[str, Callable[[Response], Array]] = {
    "path": _moved,
    "torque": attrgetter("torque"),
    "stress": attrgetter("max_stress"),
}


class Frequency(NamedTuple):
    """Frequency of a free vibration.

    Attributes:
        value: [Hz]; NaN with the reason.
        reason: why there is none.
        rest: value that the quantity vibrates about, in its own unit.
    """

    value: float
    reason: str = ""
    rest: float = math.nan


def swing_frequency(time: Array, value: Array) -> Frequency:
    """Return the mean frequency of the swing of `value` (T,) over the instants `time` (T,) [s].

    A swing that is symmetric about zero is counted by its half swings from the first to the last passage
    through zero, f = (N - 1) / (2 (t_N - t_1)) with N passages. Any other has its mean over whole swings as
    its rest, and is counted by whole swings between passages through it in either direction. A passage on
    which ripples cross the rest several times is at the mean of their instants. Interpolation between records
    is linear, exact to third order in their distance.

    NaN, with the reason, with fewer than three passages, which are not a whole swing; two are enough for a
    swing that turns as far to both sides of zero.
    """
    if not len(time) or float(np.ptp(value)) <= STILL:
        return Frequency(value=math.nan, reason="nothing swings")
    instants = passages(time, value, 0.0)
    if len(instants) >= 2 and _symmetric(value, instants):
        return Frequency(value=(len(instants) - 1) / (2.0 * float(instants[-1] - instants[0])), rest=0.0)
    rest = _rest(time, value)
    instants = passages(time, value, rest)
    if len(instants) < 3:
        count = f"{len(instants)} passage{'s' if len(instants) != 1 else ''}"
        lasted = f"{float(time[-1] - time[0]):.3g} s"
        return Frequency(value=math.nan, reason=f"{count} through the rest in {lasted}: not a whole swing")
    last = len(instants) - 1
    whole = [(first, first + (last - first) // 2 * 2) for first in (0, 1) if last - first >= 2]
    swings = sum(b - a for a, b in whole) // 2
    return Frequency(value=swings / sum(float(instants[b] - instants[a]) for a, b in whole), rest=rest)


def passages(time: Array, value: Array, rest: float) -> Array:
    """Return the instants (N,) [s] at which `value` (T,) passes the rest from one side of the band to the
    other.

    time (T,) [s]; rest: in the unit of `value`.
    """
    apart = value - rest
    band = BAND * math.sqrt(2.0) * float(np.std(value))
    outside = np.flatnonzero(np.abs(apart) > band)
    changes = np.flatnonzero(np.diff(np.sign(apart[outside])))
    crossings = np.flatnonzero(np.signbit(apart[:-1]) != np.signbit(apart[1:]))
    exact = time[crossings] - apart[crossings] * np.diff(time)[crossings] / np.diff(apart)[crossings]
    begin = np.searchsorted(crossings, outside[changes])
    end = np.searchsorted(crossings, outside[changes + 1])
    return np.array([exact[a:b].mean() for a, b in zip(begin, end, strict=True)])


def _symmetric(value: Array, instants: Array) -> bool:
    """Whether half swings to one side of zero last as long as those to the other, or reach as far."""
    if len(instants) == 2:
        return bool(abs(value.max() + value.min()) <= AS_FAR * np.ptp(value))
    halves = np.diff(instants)
    return bool(abs(halves[::2].mean() - halves[1::2].mean()) <= ALIKE * halves.mean())


def _rest(time: Array, value: Array) -> float:
    """Return the mean of the whole swings about itself; that of the record where there is none."""
    rest = float(np.mean(value))
    for _ in range(ROUNDS):
        instants = passages(time, value, rest)
        last = (len(instants) - 1) // 2 * 2
        if last < 2:
            return rest
        inside = (time > instants[0]) & (time < instants[last])
        at = np.concatenate(([instants[0]], time[inside], [instants[last]]))
        mean = float(np.trapezoid(np.interp(at, time, value), at) / (at[-1] - at[0]))
        if abs(mean - rest) <= SETTLED * float(np.ptp(value)):
            return mean
        rest = mean
    return rest
