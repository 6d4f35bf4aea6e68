"""Sub-pixel corners of dark squares: a line through each edge, corners where lines meet. Pixel centres are
whole.

One edge is compiled: grey-level profiles across it, made linear in light, the place of the edge on each, and
a line through the places. A lens blurs light and the camera encodes it, by about the power 1/2.2: edges of
encoded values lie too far in the dark. What is left of that by another camera, by clipped light and by ink
that spreads is one offset of all edges (`studies.interactive.tracking.shrinkage`). The place is at first
where the area under the profile says, which a symmetric blur of any width does not shift, and in the last
pass where a blurred step of the edge's own width fits best, which has the least noise.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from studies.interactive.tracking.lines import line, robust_slope, smooth
from studies.interactive.tracking.steps import by_step, light_at, of_power
from studies.kinds import Array

Picture = NDArray[np.uint8]

#: Profiles an edge, and where along it: the ends are left to the neighbouring edges.
STATIONS = 56
INSET = 0.08
#: Samples a pixel along a profile.
DENSITY = 2.0
#: How often the step is fitted in the last pass.
FITS = 2
#: Least step from dark to light that is an edge [grey levels of 255].
LEAST_STEP = 15.0
#: Power of a camera's values that light is: of those that encode it, as nearly all do.
GAMMA = 2.2


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
def _normalised(values: Array, light_of: Array) -> tuple[NDArray[np.bool_], float]:
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
        if not good[s]:
            values[s] = 0.0
            continue
        low, high = light_at(max(dark[s], 0.0), light_of), light_at(max(light[s], 1.0), light_of)
        for p in range(size):
            share = (light_at(values[s, p], light_of) - low) / (high - low)
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
def _edge(
    picture: Picture,
    p: Array,
    q: Array,
    normal: Array,
    u: Array,
    half: float,
    first: bool,
    last: bool,
    light_of: Array,
    trust_of: Array,
) -> tuple[float, float, float, float]:
    """The edge near the line from p to q (2,), looked at in u (S,) of it; see `edges`."""
    count, size = u.size, 2 * round(half * DENSITY) + 1
    level = np.empty((count, size))
    for s in range(count):
        x, y = p[0] + u[s] * (q[0] - p[0]), p[1] + u[s] * (q[1] - p[1])
        for k in range(size):
            r = -half + 2.0 * half * k / (size - 1)
            level[s, k] = _grey(picture, x + r * normal[0], y + r * normal[1])
    good, step = _normalised(level, light_of)
    place = np.empty(count)
    _by_area(level, half, place)
    for s in range(count):
        good[s] = good[s] and abs(place[s]) < 0.9 * half
    if good.sum() < 4:
        return 0.0, 0.0, 0.0, step
    a = b = 0.0
    if first:
        a, b = robust_slope(u, place, good)
    else:
        a = float(np.median(place[good]))
    a, b, share = line(u, place, good, a, b)
    if last and share > 0.0:
        for _ in range(FITS):
            by_step(level, good, half, a + b * u, place, trust_of)
            a, b, share = line(u, place, good, a, b)
    return a, a + b, share, step


@njit(cache=True)
def _edges(
    picture: Picture,
    p: Array,
    q: Array,
    normal: Array,
    half: Array,
    first: bool,
    last: bool,
    light_of: Array,
    trust_of: Array,
    stations: int,
) -> Array:
    """One edge after another; see `edges`."""
    u, found = np.linspace(INSET, 1.0 - INSET, stations), np.empty((len(p), 4))
    for e in range(len(p)):
        found[e] = _edge(picture, p[e], q[e], normal[e], u, half[e], first, last, light_of, trust_of)
    return found


def edges(
    picture: Picture,
    p: Array,
    q: Array,
    normal: Array,
    half: Array,
    gamma: float,
    *,
    first: bool = False,
    last: bool = True,
    stations: int = STATIONS,
) -> Array:
    """Return (E, 4) of the edges near the lines from p to q, each (E, 2): offsets along `normal` at both,
    share of stations, step.

    Args:
        half: half lengths (E,) of the profiles [px].
    """
    found = _edges(picture, p, q, normal, half, first, last, *of_power(gamma), stations)
    return np.asarray(found)


#: Half length of the profiles in successive passes [px], and the share of the side that keeps them inside the
#: black border.
REACHES = (4.5, 3.0, 3.5)
SHARE = 0.095
LEAST_REACH = 1.5
#: Places of the corners after and before those of a square.
AFTER, BEFORE = [1, 2, 3, 0], [3, 0, 1, 2]
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
        corners, share, step = _pass(picture, corners, reach, k == 0, k == last, gamma)
    return Refined(corners=corners, share=share, step=step)


def _pass(
    picture: NDArray[np.uint8], corners: Array, reach: float, first: bool, last: bool, gamma: float
) -> tuple[Array, Array, Array]:
    """One pass over the edges of squares (Q, 4, 2)."""
    end = corners[:, AFTER]
    along = end - corners
    side = np.sqrt(np.sum(along**2, axis=-1))
    half = np.minimum(reach, np.maximum(LEAST_REACH, SHARE * side.min(axis=1)))
    normal = np.stack((along[..., 1], -along[..., 0]), axis=-1) / side[..., None]
    outward = np.sum(normal * ((corners + end) / 2 - corners.mean(axis=1, keepdims=True)), axis=-1)
    normal *= np.sign(outward)[..., None]
    p, q, n = (each.reshape(-1, 2) for each in (corners, end, normal))
    found = edges(picture, p, q, n, half.repeat(4), gamma, first=first, last=last).reshape(-1, 4, 4)
    p, q = corners + found[..., :1] * normal, end + found[..., 1:2] * normal
    crossing = _crossings(p[:, BEFORE], q[:, BEFORE], p, q)
    gap = np.sqrt(np.sum((crossing - corners) ** 2, axis=-1))
    lost = ~(gap <= 2.0 * reach)
    share = np.where(lost | lost[:, AFTER], 0.0, found[..., 2])
    return np.where(lost[..., None], corners, crossing), share, found[..., 3]


def _crossings(p: Array, q: Array, r: Array, s: Array) -> Array:
    """Where the lines p q and r s meet, each (Q, 4, 2)."""
    d, e = q - p, s - r
    cross = d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]
    gap = r - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[..., 0] * e[..., 1] - gap[..., 1] * e[..., 0]) / cross
        return np.asarray(p + t[..., None] * d)
