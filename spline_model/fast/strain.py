"""The largest strain of the extreme fibres at a state, along all strips."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import bezier
from spline_model.fast.strip import place_points
from spline_model.strip.compiled import kernel


class Stations(NamedTuple):
    """First and second derivatives of the basis at P stations, d1, d2 (n, P), and axial modes (K, P).

    work (5, P): what a strip's evaluation fills.
    """

    d1: NDArray[np.float64]
    d2: NDArray[np.float64]
    modes: NDArray[np.float64]
    work: NDArray[np.float64]


def stations_of(control_points: int, modes: int, stations: NDArray[np.float64]) -> Stations:
    """Tables at the stations u in [0, 1], with working arrays of their own."""
    d1, d2, axial = _tables(control_points, modes, tuple(stations))
    return Stations(d1=d1, d2=d2, modes=axial, work=np.zeros((5, len(stations))))


@lru_cache(maxsize=16)
def _tables(control_points: int, modes: int, at: tuple[float, ...]) -> list[NDArray[np.float64]]:
    basis, u = bezier(control_points), np.array(at)
    rows = (basis.evaluate(u, 1), basis.evaluate(u, 2), legendre.legvander(2 * u - 1, modes - 1))
    return [np.ascontiguousarray(values.T) for values in rows]


@kernel()
def largest_strain(y, theta, frame, depth, locals_, stations):
    """Largest |N / (EA)| + |M| d / (2 EI) over the strips' stations; depth d of the sections [m].

    Plane sections: M = EI theta' / L, N the mixed form's axial force, slide modes included, as in
    ``sections``.
    """
    strips, modes = frame.length.size, frame.compliance.shape[1]
    own = (y.size - 2) // strips - modes
    x1, y1, x2, y2, force = stations.work
    cos_t, sin_t = math.cos(theta), math.sin(theta)
    largest = 0.0
    for s in range(strips):
        at, length, points = 2 + s * (own + modes), frame.length[s], locals_[s].points
        ax = cos_t * frame.arm[s, 0] - sin_t * frame.arm[s, 1]
        ay = sin_t * frame.arm[s, 0] + cos_t * frame.arm[s, 1]
        c, d = frame.axis[s, 0], frame.axis[s, 1]
        rx = (y[0] * frame.length[0] + ax - frame.root[s, 0]) / length
        ry = (y[1] * frame.length[0] + ay - frame.root[s, 1]) / length
        place_points(y[at : at + own], c * rx + d * ry, c * ry - d * rx, cos_t, sin_t, points)
        for p in range(force.size):
            x1[p] = y1[p] = x2[p] = y2[p] = force[p] = 0.0
        for i in range(1, points.shape[0]):
            d1, d2, px, py = stations.d1[i], stations.d2[i], points[i, 0], points[i, 1]
            for p in range(force.size):
                x1[p] += d1[p] * px
                y1[p] += d1[p] * py
                x2[p] += d2[p] * px
                y2[p] += d2[p] * py
        for k in range(stations.modes.shape[0]):
            mode, a = stations.modes[k], y[at + own + k] * frame.compliance[s, 0]
            for p in range(force.size):
                force[p] += mode[p] * a
        half = 0.5 * depth / length
        for p in range(force.size):
            turning = (x1[p] * y2[p] - y1[p] * x2[p]) / (x1[p] * x1[p] + y1[p] * y1[p])
            largest = max(largest, abs(force[p]) + half * abs(turning))
    return largest
