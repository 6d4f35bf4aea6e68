"""Edges from dark to light: grey-level profiles across them, made linear in light, the place of the edge on
each, and a line through the places.

The place is at first where the area under the profile says, which a symmetric blur of any width does not
shift, and in the last pass where a blurred step of the edge's own width fits best, which has the least noise.
All edges are computed at once: E edges with S stations of P samples.
"""

import math

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates  # type: ignore[attr-defined]
from scipy.special import ndtr

from studies.kinds import Array

Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]

#: Profiles an edge, and where along it: the ends are left to the neighbouring edges.
STATIONS, INSET = 56, 0.08
#: Samples a pixel along the longest profile.
DENSITY = 2.0
#: Least step from dark to light that is an edge [grey levels of 255].
LEAST_STEP = 15.0
#: Bounds of the blur of an edge [px].
LEAST_BLUR, MOST_BLUR = 0.5, 2.5
#: Light of the dark, over that of the white, below which no noise is less; the light up to which noise grows.
DARKEST, BRIGHTEST = 0.05, 1.5
#: Residual of a station from the line beyond which the station is rejected, in pixels and in standard
#: deviations; its neighbours, half covered perhaps, go with it: so many to either side, over all stations.
OUTLIER_PX, OUTLIER, NEIGHBOURS = 0.15, 3.0, 0.036
#: Distance from the line of levels at which a station is covered by something else, at least and at most
#: [grey levels]: where half of an edge is covered, the scatter is as large as the difference.
LEAST_SPREAD, MOST_SPREAD = 12.0, 40.0
#: Least stations of a line.
FEWEST = 4


def _median(values: Array, known: Mask) -> Array:
    """Return the upper median (...) of the known ones of values (..., N), 0 where none is known."""
    size = values.shape[-1]
    ordered = np.sort(np.where(known, values, np.inf), axis=-1).reshape(-1, size)
    middle = np.minimum(np.count_nonzero(known, axis=-1) // 2, size - 1)
    found = ordered[np.arange(len(ordered)), middle.ravel()].reshape(middle.shape)
    return np.asarray(np.nan_to_num(found, posinf=0.0))


def _robust(u: Array, place: Array, good: Mask) -> Array:
    """Return the repeated-median lines (E, 2) place = a + b u, which bear with nearly half of the stations
    covered.

    Source: Siegel, Robust regression using repeated medians, Biometrika 69 (1982) 242.
    """
    pairs = good[:, :, None] & good[:, None] & ~np.eye(len(u), dtype=bool)
    rise = place[:, None] - place[:, :, None]
    slopes = _median(rise / np.where(np.eye(len(u)) > 0.0, 1.0, u - u[:, None]), pairs)
    slope = _median(slopes, good)
    return np.column_stack((_median(place - slope[:, None] * u, good), slope))


def _lines(
    u: Array, place: Array, good: Mask, line: Array, least: float, most: float = np.inf, beside: int = 0
) -> tuple[Array, Mask]:
    """Return the least-squares lines (E, 2) through the good stations (E, S) near `line` (E, 2), within
    `least` to `most` by their scatter, and not `beside` one that is farther, and which (E, S) are kept, none
    where they are too few."""
    powers, kept = np.column_stack((np.ones_like(u), u, u**2)), good
    for k in range(3):
        gap = np.abs(place - line[:, :1] - line[:, 1:] * u)
        limit = np.clip(OUTLIER * 1.48 * _median(gap, kept), least, most)
        now = good & (gap <= limit[:, None])
        now = cv2.erode(now.astype(np.uint8), np.ones((1, 2 * beside + 1), dtype=np.uint8)) > 0
        now = now & (np.count_nonzero(now, axis=1) >= FEWEST)[:, None]
        if k > 0 and (now == kept).all():  # whose lines are the same
            break
        kept, weight = now, now.astype(float)
        (count, by_u, by_square), (level, turn) = (weight @ powers).T, (weight * place @ powers[:, :2]).T
        some = count > 0.0
        slope = (count * turn - by_u * level) / np.where(some, count * by_square - by_u**2, 1.0)
        fitted = np.column_stack(((level - slope * by_u) / np.where(some, count, 1.0), slope))
        line = np.where(some[:, None], fitted, line)
    return line, kept


def _normalised(values: Array, u: Array, gamma: float) -> tuple[Array, Mask]:
    """Return profiles (E, S, P) of light, from 0 in the dark to 1, and which (E, S) are edges."""
    # both levels vary slowly along an edge: their straight lines have less noise than themselves
    level = np.concatenate((values[..., :2].mean(axis=-1), values[..., -2:].mean(axis=-1)))
    start = np.column_stack((np.median(level, axis=1), np.zeros(len(level))))
    line, clear = _lines(u, level, np.ones(level.shape, dtype=bool), start, LEAST_SPREAD, MOST_SPREAD)
    (dark, light), good = np.split(line[:, :1] + line[:, 1:] * u, 2), np.logical_and(*np.split(clear, 2))
    rough = np.abs(np.diff(values, axis=-1)).sum(axis=-1)
    good = good & (light - dark > LEAST_STEP) & (rough < 4.0 * (light - dark))
    low, high = np.maximum(dark, 0.0) ** gamma, np.maximum(light, 1.0) ** gamma
    step = np.where(good, high - low, 1.0)
    return np.clip((values**gamma - low[..., None]) / step[..., None], -0.3, 1.3), good


def _by_step(share: Array, good: Mask, half: Array, near: Array, gamma: float) -> Array:
    """Return the places (E, S) by the blurred step that fits best, in one step of Gauss and Newton from
    those of lines, near (E, S), infinite where a profile has none."""
    r = half[:, None] * np.linspace(-1.0, 1.0, share.shape[-1])
    spacing = r[:, 1] - r[:, 0]
    slope, at = np.diff(np.sum(share * good[..., None], axis=1)), r[:, :-1] + spacing[:, None] / 2
    slope = np.maximum(slope, 0.0)
    total = slope.sum(axis=1) + 1e-9
    mean = np.sum(slope * at, axis=1) / total
    blur = np.sqrt(np.maximum(np.sum(slope * at**2, axis=1) / total - mean**2, LEAST_BLUR**2))
    wide = blur
    for _ in range(10):  # the part of the bell curve within the profile is narrower than all of it
        a = half / wide
        inside = 1.0 - 2.0 * a * _bell(a) / (2.0 * ndtr(a) - 1.0)
        wide = np.minimum(blur / np.sqrt(np.maximum(inside, 1e-9)), MOST_BLUR)
    wide, end = wide[:, None], (half - spacing / 2.0)[:, None]  # the levels were taken there
    x = (r[:, None] - near[..., None]) / wide[..., None]
    low, high = ndtr((-end - near) / wide), ndtr((end - near) / wide)
    step = (ndtr(x) - low[..., None]) / np.maximum(high - low, 0.1)[..., None]
    # noise that is even in values grows with light, and weighs less there
    trust = (np.clip(step, 0.0, BRIGHTEST) + DARKEST) ** (2.0 / gamma - 2.0)
    weight = _bell(x) / wide[..., None]
    top, bottom = np.sum(trust * weight * (share - step), axis=-1), np.sum(trust * weight**2, axis=-1)
    return np.where(bottom > 1e-12, near - top / np.maximum(bottom, 1e-12), np.inf)


def _bell(x: Array) -> Array:
    """Return the height of the bell curve."""
    return np.asarray(np.exp(-0.5 * x**2) / math.sqrt(2.0 * math.pi))


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
    u, (p, q, normal) = np.linspace(INSET, 1.0 - INSET, stations), lines
    count = 2 * round(DENSITY * float(half.max())) + 1
    r = half[:, None] * np.linspace(-1.0, 1.0, count)
    along = p[:, None] + u[:, None] * (q - p)[:, None]
    x, y = np.moveaxis(along[:, :, None] + r[:, None, :, None] * normal[:, None, None], -1, 0)
    share, good = _normalised(map_coordinates(picture, (y, x), float, order=1, mode="nearest"), u, gamma)
    area = share.sum(axis=-1) - share[..., [0, -1]].mean(axis=-1)
    place = half[:, None] * (1.0 - 2.0 / (count - 1) * area)
    good = good & (np.abs(place) < 0.9 * half[:, None])
    start = np.column_stack((_median(place, good), np.zeros(len(place))))
    start = _robust(u, place, good) if first else start
    beside = round(NEIGHBOURS * stations)
    line, kept = _lines(u, place, good, start, OUTLIER_PX, beside=beside)
    if last:
        place = _by_step(share, good, half, line[:, :1] + line[:, 1:] * u, gamma)
        good = np.any(kept, axis=1, keepdims=True) & good & np.isfinite(place)
        line, kept = _lines(u, np.where(good, place, 0.0), good, line, OUTLIER_PX, beside=beside)
    some = np.count_nonzero(kept, axis=1)
    away = (u - u.mean()) / u.std()
    middle = np.sum(kept * away, axis=1) / np.maximum(some, 1)
    spread = np.sqrt(np.maximum(np.sum(kept * away**2, axis=1) / np.maximum(some, 1) - middle**2, 0.0))
    found = np.column_stack((line[:, 0], line.sum(axis=1), some / stations, middle, spread))
    return np.where(np.any(kept, axis=1, keepdims=True), found, 0.0)
