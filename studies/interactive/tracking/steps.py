"""A blurred step of light: levels made linear in light, and where the step fits a profile best.

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


@lru_cache(maxsize=8)
def of_power(gamma: float) -> tuple[Array, Array]:
    """Return the tables of light by level and of trust by light, of values whose power `gamma` is light;
    noise that is even in values grows with light, and weighs the less there."""
    levels = np.arange(255 * BY_LEVEL + 2) / BY_LEVEL
    light = np.arange(round(BRIGHTEST * BY_LIGHT) + 2) / BY_LIGHT
    return levels**gamma, (light + DARKEST) ** (2.0 / gamma - 2.0)


@njit(cache=True)
def light_at(level: float, light_of: Array) -> float:
    """The light of a level; above 255 on the last straight line."""
    at = level * BY_LEVEL
    i = min(int(at), light_of.size - 2)
    return float(light_of[i] + (at - i) * (light_of[i + 1] - light_of[i]))


@njit(cache=True)
def _trust_at(light: float, trust_of: Array) -> float:
    """The weight of a sample of this light, over that of the white."""
    at = min(max(light, 0.0), BRIGHTEST) * BY_LIGHT
    i = int(at)
    return float(trust_of[i] + (at - i) * (trust_of[i + 1] - trust_of[i]))


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
def by_step(
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
            trust = _trust_at(step, trust_of)
            top += trust * weight * (level[s, p] - step)
            bottom += trust * weight * weight
        if bottom > 0.0:
            place[s] = near[s] - top / bottom
        else:  # the line leaves the profile: there is no edge on it
            good[s] = False
