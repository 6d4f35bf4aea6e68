"""An edge from dark to light, compiled: grey-level profiles across it, made linear in light, the place of the
edge on each, and a line through the places.

The place is at first where the area under the profile says, which a symmetric blur of any width does not
shift, and in the last pass where a blurred step of the edge's own width fits best, which has the least noise.
Powers and error functions of each sample would take most of the time that a picture has, so all three are
read from tables: of light and of trust one for each power, between whose nodes is a straight line, and of
the bell curve a series about the nearest node.
"""

import math
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from studies.kinds import Array

Picture = NDArray[np.uint8]

#: Profiles an edge, and where along it: the ends are left to the neighbouring edges.
STATIONS, INSET = 56, 0.08
#: Samples a pixel along a profile; how often the step is fitted to them in the last pass.
DENSITY, FITS = 2.0, 2
#: Least step from dark to light that is an edge [grey levels of 255].
LEAST_STEP = 15.0
#: Bounds of the blur of an edge [px].
LEAST_BLUR, MOST_BLUR = 0.5, 2.5
#: Light of the dark, over that of the white, below which no noise is less.
DARKEST = 0.05
#: Nodes a grey level, and in the light of the white; the light up to which trust is told, beyond it stays.
BY_LEVEL, BY_LIGHT, BRIGHTEST = 8, 1024, 1.5
#: Nodes a standard deviation of the bell curve, and how many of them its table reaches to either side: what
#: lies beyond weighs 1e-8 of the middle.
BY_SPREAD, FAR = 64, 6
_NODES = np.arange(-FAR * BY_SPREAD, FAR * BY_SPREAD + 1) / BY_SPREAD
_BELOW = np.array([0.5 * math.erfc(-x / math.sqrt(2.0)) for x in _NODES])
_BELL = np.exp(-0.5 * _NODES**2) / math.sqrt(2.0 * math.pi)
#: Residual of a station from the line beyond which the station is rejected, in pixels and in standard
#: deviations; its neighbours, half covered perhaps, go with it: so many to either side, over all stations.
OUTLIER_PX, OUTLIER, NEIGHBOURS = 0.15, 3.0, 0.036
#: Distance from the line of levels at which a station is covered by something else, at least and at most
#: [grey levels]: where half of an edge is covered, the scatter is as large as the difference.
LEAST_SPREAD, MOST_SPREAD = 12.0, 40.0


@lru_cache(maxsize=8)
def _of_power(gamma: float) -> tuple[Array, Array]:
    """Return the tables of light by level and of trust by light, of values whose power `gamma` is light;
    noise that is even in values grows with light, and weighs the less there."""
    levels = np.arange(255 * BY_LEVEL + 2) / BY_LEVEL
    light = np.arange(round(BRIGHTEST * BY_LIGHT) + 2) / BY_LIGHT
    return levels**gamma, (light + DARKEST) ** (2.0 / gamma - 2.0)


@njit(cache=True)
def _between(table: Array, at: float) -> float:
    """A table's value at a place of its nodes; beyond the last one on the last straight line."""
    i = min(int(at), table.size - 2)
    return float(table[i] + (at - i) * (table[i + 1] - table[i]))


@njit(cache=True)
def _bell(x: float) -> tuple[float, float]:
    """The share of the bell curve below x and its height there, within 1e-8 of them."""
    x = min(max(x, -1.0 * FAR), 1.0 * FAR)
    i = int((x + FAR) * BY_SPREAD + 0.5)
    node = _NODES[i]
    d, square = x - node, node * node
    # derivatives of the bell curve are itself times Hermite's polynomials
    two, three = 0.5 * (square - 1.0), node * (3.0 - square) * (1.0 / 6.0)
    height = _BELL[i] * (1.0 + d * (d * (two + d * three) - node))
    below = _BELL[i] * d * (1.0 + d * (d * (two * (1.0 / 3.0) + d * 0.25 * three) - 0.5 * node))
    return _BELOW[i] + below, height


@njit(cache=True)
def _whole(blur: float, half: float) -> float:
    """Standard deviation of the bell curve, at most MOST_BLUR wide, whose part in -half ... half has that of
    `blur`."""
    wide = blur
    for _ in range(10):
        a = half / wide
        inside = math.erf(a / math.sqrt(2.0))
        bell = math.exp(-0.5 * a * a) / math.sqrt(2.0 * math.pi)
        before, wide = wide, min(blur / math.sqrt(1.0 - 2.0 * a * bell / inside), MOST_BLUR)
        if abs(wide - before) < 1e-9:
            break
    return wide


@njit(cache=True)
def _by_step(
    level: Array, good: NDArray[np.bool_], half: float, near: Array, place: Array, trust_of: Array
) -> None:
    """Places (S,) of the good ones by the blurred step that fits best, in one step of Gauss and Newton from
    those of a line, near (S,); of a profile that has none it is not good."""
    count, size = level.shape
    spacing = 2.0 * half / (size - 1)
    total = first = second = 1e-9
    for p in range(size - 1):
        slope = 0.0
        for s in range(count):
            if good[s]:
                slope += level[s, p + 1] - level[s, p]
        slope, at = max(slope, 0.0), -half + (p + 0.5) * spacing
        total, first, second = total + slope, first + slope * at, second + slope * at * at
    blur = _whole(math.sqrt(max(second / total - (first / total) ** 2, LEAST_BLUR**2)), half)
    sharp, end = 1.0 / blur, half - 0.5 * spacing  # the levels were taken there
    for s in range(count):
        if not good[s]:
            continue
        low, high = _bell((-end - near[s]) * sharp)[0], _bell((end - near[s]) * sharp)[0]
        share = 1.0 / max(high - low, 0.1)
        top = bottom = 0.0
        for p in range(size):
            x = (-half + p * spacing - near[s]) * sharp
            if abs(x) >= FAR:
                continue
            below, height = _bell(x)
            weight, step = height * sharp, (below - low) * share
            trust = _between(trust_of, min(max(step, 0.0), BRIGHTEST) * BY_LIGHT)
            top += trust * weight * (level[s, p] - step)
            bottom += trust * weight * weight
        if bottom > 0.0:
            place[s] = near[s] - top / bottom
        else:  # the line leaves the profile: there is no edge on it
            good[s] = False


@njit(cache=True)
def _least_squares(x: Array, y: Array, kept: NDArray[np.bool_]) -> tuple[float, float]:
    """The line y = a + b x through those that are kept, by sums alone: arrays of them would take longer."""
    total = mean_x = mean_y = top = bottom = 0.0
    for i in range(x.size):
        if kept[i]:
            total, mean_x, mean_y = total + 1.0, mean_x + x[i], mean_y + y[i]
    mean_x, mean_y = mean_x / total, mean_y / total
    for i in range(x.size):
        if kept[i]:
            top, bottom = top + (x[i] - mean_x) * (y[i] - mean_y), bottom + (x[i] - mean_x) ** 2
    return mean_y - top / bottom * mean_x, top / bottom


@njit(cache=True)
def _robust_slope(u: Array, place: Array, good: NDArray[np.bool_]) -> tuple[float, float]:
    """The repeated-median line place = a + b u, which bears with nearly half of the stations covered.

    Source: Siegel, Robust regression using repeated medians, Biometrika 69 (1982) 242.
    """
    known = np.flatnonzero(good)
    slopes, pairs = np.empty(known.size), np.empty(known.size - 1)
    for i in range(known.size):
        count = 0
        for j in range(known.size):
            if j != i:
                pairs[count] = (place[known[j]] - place[known[i]]) / (u[known[j]] - u[known[i]])
                count += 1
        slopes[i] = np.median(pairs)
    slope = float(np.median(slopes))
    return float(np.median(place[known] - slope * u[known])), slope


@njit(cache=True)
def _line(
    u: Array,
    place: Array,
    good: NDArray[np.bool_],
    a: float,
    b: float,
    least: float,
    beside: int,
    most: float = np.inf,
) -> tuple[float, float, NDArray[np.bool_]]:
    """Least-squares line through the good stations near a + b u, within `least` to `most` by their scatter,
    and not `beside` one that is farther; a, b and which (S,) were kept, none where they are too few."""
    kept = good.copy()
    for k in range(3):
        gap = np.abs(place - a - b * u)
        if kept.sum() < 4:
            return a, b, np.zeros_like(kept)
        now = good & (gap <= min(most, max(least, OUTLIER * 1.48 * float(np.median(gap[kept])))))
        far = ~now
        for i in range(u.size):
            if far[i]:
                now[max(0, i - beside) : i + beside + 1] = False
        if now.sum() < 4:
            return a, b, np.zeros_like(kept)
        if k > 0 and (now == kept).all():  # whose line is the same
            break
        kept = now
        a, b = _least_squares(u, place, kept)
    return a, b, kept


@njit(cache=True)
def _smooth(u: Array, level: Array) -> NDArray[np.bool_]:
    """Replace the levels (S,) along an edge by a straight line through those that agree; which they are."""
    every = np.ones(u.size, dtype=np.bool_)
    a, b, kept = _line(u, level, every, float(np.median(level)), 0.0, LEAST_SPREAD, 0, MOST_SPREAD)
    level[:] = a + b * u
    return kept


@njit(cache=True)
def _grey(picture: Picture, x: float, y: float) -> float:
    """Grey level at a place, bilinear; beyond the border as on it."""
    height, width = picture.shape
    x, y = min(max(x, 0.0), width - 1.001), min(max(y, 0.0), height - 1.001)
    i, j = int(x), int(y)
    fx, fy = x - i, y - j
    top = picture[j, i] * (1.0 - fx) + picture[j, i + 1] * fx
    bottom = picture[j + 1, i] * (1.0 - fx) + picture[j + 1, i + 1] * fx
    return float(top * (1.0 - fy) + bottom * fy)


@njit(cache=True)
def _normalised(values: Array, u: Array, light_of: Array) -> NDArray[np.bool_]:
    """Profiles (S, P) at u (S,) in place to 0 in the dark and 1 in the light; which (S,) are edges."""
    count, size = values.shape
    dark, light = np.empty(count), np.empty(count)
    good = np.zeros(count, dtype=np.bool_)
    for s in range(count):
        dark[s] = 0.5 * (values[s, 0] + values[s, 1])
        light[s] = 0.5 * (values[s, size - 1] + values[s, size - 2])
    # both levels vary slowly along an edge: their straight lines have less noise than themselves
    clear = _smooth(u, dark) & _smooth(u, light)
    for s in range(count):
        step, rough = light[s] - dark[s], 0.0
        for p in range(size - 1):
            rough += abs(values[s, p + 1] - values[s, p])
        good[s] = clear[s] and step > LEAST_STEP and rough < 4.0 * step
        if not good[s]:
            values[s] = 0.0
            continue
        low = _between(light_of, max(dark[s], 0.0) * BY_LEVEL)
        high = _between(light_of, max(light[s], 1.0) * BY_LEVEL)
        for p in range(size):
            share = (_between(light_of, values[s, p] * BY_LEVEL) - low) / (high - low)
            values[s, p] = min(max(share, -0.3), 1.3)
    return good


@njit(cache=True)
def _profiles(picture: Picture, line: Array, u: Array, half: float) -> Array:
    """Grey levels (S, P) across a line (3, 2), at u (S,) of it."""
    (p, q, normal), size = line, 2 * round(half * DENSITY) + 1
    level = np.empty((u.size, size))
    for s in range(u.size):
        x, y = p[0] + u[s] * (q[0] - p[0]), p[1] + u[s] * (q[1] - p[1])
        for k in range(size):
            r = -half + 2.0 * half * k / (size - 1)
            level[s, k] = _grey(picture, x + r * normal[0], y + r * normal[1])
    return level


@njit(cache=True)
def _edges(
    picture: Picture,
    lines: Array,
    half: Array,
    first: bool,
    last: bool,
    light_of: Array,
    trust_of: Array,
    stations: int,
) -> Array:
    """One edge after another; see `edges`."""
    u, found = np.linspace(INSET, 1.0 - INSET, stations), np.zeros((len(half), 5))
    beside, place = round(NEIGHBOURS * stations), np.empty(stations)
    for e in range(len(half)):
        level = _profiles(picture, lines[:, e], u, half[e])
        good, size = _normalised(level, u, light_of), level.shape[1]
        for s in range(stations):  # by the area under the profile
            area = level[s].sum() - 0.5 * (level[s, 0] + level[s, size - 1])
            place[s] = half[e] - area * 2.0 * half[e] / (size - 1)
            good[s] = good[s] and abs(place[s]) < 0.9 * half[e]
        if good.sum() < 4:
            continue
        a, b = _robust_slope(u, place, good) if first else (float(np.median(place[good])), 0.0)
        a, b, kept = _line(u, place, good, a, b, OUTLIER_PX, beside)
        if last and kept.any():
            for _ in range(FITS):
                _by_step(level, good, half[e], a + b * u, place, trust_of)
                a, b, kept = _line(u, place, good, a, b, OUTLIER_PX, beside)
        found[e, :3] = a, a + b, kept.sum() / stations
        if kept.any():
            found[e, 3:] = (u[kept].mean() - u.mean()) / u.std(), u[kept].std() / u.std()
    return found


def edges(
    picture: Picture,
    lines: Array,
    half: Array,
    gamma: float,
    *,
    first: bool = False,
    last: bool = True,
    stations: int = STATIONS,
) -> Array:
    """Return (E, 5) of the edges near lines: offsets along the normal at both ends, share of good stations,
    their mean place from the middle and their spread, both over the spread of all stations.

    Args:
        lines: both ends and the unit normal (3, E, 2) of each; half: half lengths (E,) of the profiles [px].
        gamma: power of the picture's values that light is.
    """
    return np.asarray(_edges(picture, lines, half, first, last, *_of_power(gamma), stations))
