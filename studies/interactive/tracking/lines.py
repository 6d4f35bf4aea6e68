"""Straight lines along an edge, through levels or places of which some are covered by something else."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from studies.kinds import Array

#: Residual of a station from the line beyond which it is left out, in pixels and in standard deviations; its
#: neighbours, half covered perhaps, go with it: so many to either side, over all stations.
OUTLIER_PX, OUTLIER = 0.15, 3.0
NEIGHBOURS = 0.036
#: Least distance from the line of levels at which a station is covered by something else [grey levels].
LEAST_SPREAD = 12.0


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
def smooth(level: Array) -> NDArray[np.bool_]:
    """Replace the levels (S,) along an edge by a straight line through those that agree; returns which
    did."""
    count = level.size
    at = np.linspace(-(count - 1) / 2.0, (count - 1) / 2.0, count)
    mean, slope = float(np.median(level)), 0.0
    kept = np.ones(count, dtype=np.bool_)
    for k in range(3):
        gap = np.abs(level - mean - slope * at)
        width = max(LEAST_SPREAD, OUTLIER * 1.48 * float(np.median(gap)))
        now = gap <= width
        same = k > 0 and (now == kept).all()  # whose line is the same
        kept = now
        if same or kept.sum() < 4:
            break
        mean, slope = _least_squares(at, level, kept)
    level[:] = mean + slope * at
    return kept


@njit(cache=True)
def robust_slope(u: Array, place: Array, good: NDArray[np.bool_]) -> tuple[float, float]:
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
    kept, beside = good.copy(), round(NEIGHBOURS * u.size)
    for k in range(3):
        gap = np.abs(place - a - b * u)
        if kept.sum() < 4:
            return a, b, 0.0
        width = max(OUTLIER_PX, OUTLIER * 1.48 * float(np.median(gap[kept])))
        now = good & (gap <= width)
        far = ~now
        for i in range(u.size):
            if far[i]:
                now[max(0, i - beside) : i + beside + 1] = False
        if now.sum() < 4:
            return a, b, 0.0
        if k > 0 and (now == kept).all():
            break
        kept = now
        a, b = _least_squares(u, place, kept)
    return a, b, float(kept.sum()) / u.size
