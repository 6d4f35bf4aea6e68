"""Sub-pixel corners of dark squares: a line through each edge, corners where lines meet. Pixel centres are
whole.

One edge is compiled: grey-level profiles across it, made linear in light, the place of the edge on each, and
a line through the places. A lens blurs light and the camera encodes it, by about the power 1/2.2: edges of
encoded values lie too far in the dark. What is left of that by another camera, by clipped light and by ink
that spreads is one offset of all edges (`studies.interactive.tracking.shrinkage`). The place is at first
where the area under the profile says, which a symmetric blur of any width does not shift, and in the last
pass where a blurred step of the edge's own width fits best, which has the least noise.
"""

import math
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from studies.kinds import Array

Picture = NDArray[np.uint8]

#: Profiles an edge, and where along it: the ends are left to the neighbouring edges.
STATIONS = 56
INSET = 0.08
#: Samples a pixel along a profile.
DENSITY = 2.0
#: Bounds of the blur of an edge [px], and how often the step is fitted in the last pass.
LEAST_BLUR, MOST_BLUR = 0.5, 2.5
FITS = 2
#: Least step from dark to light that is an edge [grey levels of 255].
LEAST_STEP = 15.0
#: Residual of a station from the line beyond which it is left out, in pixels and in standard deviations; its
#: neighbours, half covered perhaps, go with it.
OUTLIER_PX, OUTLIER = 0.15, 3.0
NEIGHBOURS = 2
#: Power of a camera's values that light is: of those that encode it, as nearly all do.
GAMMA = 2.2
#: Light of the dark, over that of the white, below which no noise is less.
DARKEST = 0.05
#: Least distance from the line of levels at which a station is covered by something else [grey levels].
LEAST_SPREAD = 12.0


@njit(cache=True)
def grey(picture: Picture, x: float, y: float) -> float:
    """Grey level at a place, bilinear; beyond the border as on it."""
    height, width = picture.shape
    x, y = min(max(x, 0.0), width - 1.001), min(max(y, 0.0), height - 1.001)
    i, j = int(x), int(y)
    fx, fy = x - i, y - j
    top = picture[j, i] * (1.0 - fx) + picture[j, i + 1] * fx
    bottom = picture[j + 1, i] * (1.0 - fx) + picture[j + 1, i + 1] * fx
    return float(top * (1.0 - fy) + bottom * fy)


@njit(cache=True)
def smooth(level: Array) -> NDArray[np.bool_]:
    """Replace the levels (S,) along an edge by a straight line through those that agree; returns which
    did."""
    count = level.size
    at = np.arange(count) - (count - 1) / 2.0
    mean, slope = float(np.median(level)), 0.0
    kept = np.ones(count, dtype=np.bool_)
    for _ in range(3):
        gap = np.abs(level - mean - slope * at)
        width = max(LEAST_SPREAD, OUTLIER * 1.48 * float(np.median(gap)))
        kept[:] = gap <= width
        x, y = at[kept], level[kept]
        if x.size < 4:
            break
        slope = float(((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum())
        mean = float(y.mean() - slope * x.mean())
    level[:] = mean + slope * at
    return kept


@njit(cache=True)
def normalised(values: Array, gamma: float) -> tuple[NDArray[np.bool_], float]:
    """Profiles (S, P) in place to 0 in the dark and 1 in the light, linear in it; which are edges, and the
    median step of their values."""
    count, size = values.shape
    dark, light = np.empty(count), np.empty(count)
    good = np.zeros(count, dtype=np.bool_)
    for s in range(count):
        dark[s] = 0.5 * (values[s, 0] + values[s, 1])
        light[s] = 0.5 * (values[s, size - 1] + values[s, size - 2])
    # both levels vary slowly along an edge: their straight lines have less noise than themselves
    clear = smooth(dark) & smooth(light)
    for s in range(count):
        step, rough = light[s] - dark[s], 0.0
        for p in range(size - 1):
            rough += abs(values[s, p + 1] - values[s, p])
        good[s] = clear[s] and step > LEAST_STEP and rough < 4.0 * step
        low, high = max(dark[s], 0.0) ** gamma, max(light[s], 1.0) ** gamma
        for p in range(size):
            share = (values[s, p] ** gamma - low) / (high - low) if good[s] else 0.0
            values[s, p] = min(max(share, -0.3), 1.3)
    return good, float(np.median(light - dark))


@njit(cache=True)
def _by_area(level: Array, half: float, place: Array) -> None:
    """Places (S,) of the edge on profiles (S, P) over -half ... half, by the area under them."""
    size = level.shape[1]
    for s in range(level.shape[0]):
        area = level[s].sum() - 0.5 * (level[s, 0] + level[s, size - 1])
        place[s] = half - area * 2.0 * half / (size - 1)


@njit(cache=True)
def _by_step(
    level: Array, good: NDArray[np.bool_], half: float, near: Array, place: Array, gamma: float
) -> None:
    """Places (S,) by the blurred step that fits best, in one step of Gauss and Newton from those of a line,
    near (S,); noise that is even in values grows with light, and weighs the less there."""
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
    variance = second / total - (first / total) ** 2
    blur = min(max(math.sqrt(max(variance, 0.0)), LEAST_BLUR), MOST_BLUR)
    for s in range(count):
        low = 0.5 * math.erfc((half + near[s]) / (math.sqrt(2.0) * blur))
        high = 0.5 * math.erfc((near[s] - half) / (math.sqrt(2.0) * blur))
        top = bottom = 0.0
        for p in range(size):
            x = (-half + p * spacing - near[s]) / blur
            weight = math.exp(-0.5 * x * x) / (math.sqrt(2.0 * math.pi) * blur)
            # the levels were taken at the ends of the profile
            step = (0.5 * math.erfc(-x / math.sqrt(2.0)) - low) / max(high - low, 0.1)
            trust = 1.0 / (max(step, 0.0) + DARKEST) ** (2.0 - 2.0 / gamma)
            top += trust * weight * (level[s, p] - step)
            bottom += trust * weight * weight
        place[s] = near[s] - top / bottom


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
def line(u: Array, place: Array, good: NDArray[np.bool_], a: float, b: float) -> tuple[float, float, float]:
    """Least-squares line through the stations near a + b u; a, b and the share of stations that was kept."""
    kept = good.copy()
    for _ in range(3):
        gap = np.abs(place - a - b * u)
        if kept.sum() < 4:
            return a, b, 0.0
        width = max(OUTLIER_PX, OUTLIER * 1.48 * float(np.median(gap[kept])))
        for i in range(u.size):
            kept[i] = good[i] and gap[i] <= width
        far = ~kept
        for i in range(u.size):
            if far[i]:
                kept[max(0, i - NEIGHBOURS) : i + NEIGHBOURS + 1] = False
        total = kept.sum()
        if total < 4:
            return a, b, 0.0
        mean_u, mean_p = u[kept].mean(), place[kept].mean()
        du = u[kept] - mean_u
        b = float((du * (place[kept] - mean_p)).sum() / (du * du).sum())
        a = float(mean_p - b * mean_u)
    return a, b, float(kept.sum()) / u.size


@njit(cache=True)
def edge(
    picture: Picture,
    p: Array,
    q: Array,
    normal: Array,
    reach: float,
    first: bool,
    last: bool,
    gamma: float,
) -> tuple[float, float, float, float]:
    """The edge near the line from p to q (2,): its offsets along `normal` at both, share of stations,
    step."""
    half = reach
    size = 2 * round(half * DENSITY) + 1
    u = np.linspace(INSET, 1.0 - INSET, STATIONS)
    level = np.empty((STATIONS, size))
    for s in range(STATIONS):
        x, y = p[0] + u[s] * (q[0] - p[0]), p[1] + u[s] * (q[1] - p[1])
        for k in range(size):
            r = -half + 2.0 * half * k / (size - 1)
            level[s, k] = grey(picture, x + r * normal[0], y + r * normal[1])
    good, step = normalised(level, gamma)
    place = np.empty(STATIONS)
    _by_area(level, half, place)
    for s in range(STATIONS):
        good[s] = good[s] and abs(place[s]) < 0.9 * half
    if good.sum() < 4:
        return 0.0, 0.0, 0.0, step
    a = b = 0.0
    if first:
        a, b = _robust_slope(u, place, good)
    else:
        a = float(np.median(place[good]))
    a, b, share = line(u, place, good, a, b)
    if last and share > 0.0:
        for _ in range(FITS):
            _by_step(level, good, half, a + b * u, place, gamma)
            a, b, share = line(u, place, good, a, b)
    return a, a + b, share, step


#: Half length of the profiles in successive passes [px], and the share of the side that keeps them inside the
#: black border.
REACHES = (4.5, 3.0, 3.5)
SHARE = 0.095
LEAST_REACH = 1.5
#: Least share of good stations of an edge.
LEAST_SHARE = 0.3


@dataclass(frozen=True, kw_only=True, eq=False)
class Refined:
    """Q squares: corners (Q, 4, 2) [px]; share (Q, 4) of good stations; step (Q, 4) from dark to light
    [grey levels]."""

    corners: Array
    share: Array
    step: Array


def refine(picture: NDArray[np.uint8], quads: Array, gamma: float = GAMMA) -> Refined:
    """Return the squares near `quads` (Q, 4, 2) [px], corners in their order; a lost edge has share 0.

    Args:
        gamma: power of the picture's values that light is.
    """
    corners = np.array(quads, dtype=float)
    share, step = np.zeros(corners.shape[:2]), np.zeros(corners.shape[:2])
    last = len(REACHES) - 1
    for k, reach in enumerate(REACHES):
        for q in range(len(corners)):
            corners[q], share[q], step[q] = _pass(picture, corners[q], reach, k == 0, k == last, gamma)
    return Refined(corners=corners, share=share, step=step)


def _pass(
    picture: NDArray[np.uint8], corners: Array, reach: float, first: bool, last: bool, gamma: float
) -> tuple[Array, Array, Array]:
    """One pass over the edges of a square (4, 2)."""
    end = np.roll(corners, -1, axis=0)
    along = end - corners
    side = np.hypot(along[:, 0], along[:, 1])
    half = min(reach, max(LEAST_REACH, SHARE * float(side.min())))
    normal = np.column_stack((along[:, 1], -along[:, 0])) / side[:, None]
    outward = np.einsum("ei,ei->e", normal, (corners + end) / 2 - corners.mean(axis=0))
    normal *= np.sign(outward)[:, None]
    found = np.array(
        [edge(picture, corners[e], end[e], normal[e], half, first, last, gamma) for e in range(4)]
    )
    p, q = corners + found[:, :1] * normal, end + found[:, 1:2] * normal
    crossing = _crossings(np.roll(p, 1, axis=0), np.roll(q, 1, axis=0), p, q)
    lost = ~np.isfinite(crossing).all(axis=1) | (np.hypot(*(crossing - corners).T) > 2.0 * reach)
    share = np.where(lost | np.roll(lost, -1), 0.0, found[:, 2])
    return np.where(lost[:, None], corners, crossing), share, found[:, 3]


def _crossings(p: Array, q: Array, r: Array, s: Array) -> Array:
    """Where the lines p q and r s meet, each (E, 2)."""
    d, e = q - p, s - r
    cross = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    gap = r - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[:, 0] * e[:, 1] - gap[:, 1] * e[:, 0]) / cross
        return np.asarray(p + t[:, None] * d)
