"""The Gauss points of a set of strips, flattened into one table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, SplineBasis
from spline_model.layout import Layout
from spline_model.scene import Strip

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Points:
    """One row a Gauss point; ``source`` (P,) says which of the listed strips it is on.

    first (P,) index in z of the support's first x; width (P,); d1, d2 (P, S); u, weight
    (P,); speed (P,) |C0'| [m]; curvature (P,) d(theta)/ds0 at rest [1/m].
    """

    source: NDArray[np.int64]
    u: Array
    weight: Array
    first: NDArray[np.int64]
    width: NDArray[np.int64]
    d1: Array
    d2: Array
    speed: Array
    curvature: Array

    def spread(self, values: Sequence[float]) -> Array:
        """One value a listed strip -> one value a point."""
        return np.array(values, dtype=float)[self.source]


def strip_points(strips: Sequence[tuple[Strip, int]], layout: Layout) -> Points:
    """Points of the listed (strip, Gauss points a knot span) in one table; empty for none."""
    widest = max((strip.basis.degree + 1 for strip, _ in strips), default=0)
    parts = [_points_of(i, strip, count, layout, widest) for i, (strip, count) in enumerate(strips)]
    empty = {
        "source": np.zeros(0, dtype=np.int64),
        "u": np.zeros(0),
        "weight": np.zeros(0),
        "first": np.zeros(0, dtype=np.int64),
        "width": np.zeros(0, dtype=np.int64),
        "d1": np.zeros((0, widest)),
        "d2": np.zeros((0, widest)),
        "speed": np.zeros(0),
        "curvature": np.zeros(0),
    }
    return Points(
        **{key: np.concatenate([none, *(part[key] for part in parts)]) for key, none in empty.items()}
    )


@lru_cache(maxsize=256)
def _tables(
    basis: SplineBasis, count: int
) -> tuple[Array, Array, NDArray[np.int64], Array, Array, Array, Array]:
    """u, weight, first of the support (P,), its d1, d2 (P, degree + 1), and of all functions (P, n); kept."""
    u, weight = basis.gauss_rule(count)
    support = basis.first_of_support(u)
    columns = support[:, None] + np.arange(basis.degree + 1)
    first, second = basis.evaluate(u, 1), basis.evaluate(u, 2)
    d1, d2 = (np.take_along_axis(values, columns, axis=1) for values in (first, second))
    kept = (u, weight, support, d1, d2, first, second)
    for array in kept:
        array.setflags(write=False)
    return kept


@lru_cache(maxsize=256)
def modes_at(modes: AxialModes, basis: SplineBasis, count: int) -> tuple[NDArray[np.int64], Array]:
    """First mode of the support and the values at the Gauss points, as ``modes.evaluate``; kept."""
    kept = modes.evaluate(basis.gauss_rule(count)[0])
    for array in kept:
        array.setflags(write=False)
    return kept


def _points_of(source: int, strip: Strip, count: int, layout: Layout, widest: int) -> dict[str, NDArray]:
    basis = strip.basis
    u, weight, support, d1, d2, _, _ = _tables(basis, count)
    speed, curvature = rest_of(strip, count)
    return {
        "source": np.full(len(u), source, dtype=np.int64),
        "u": u,
        "weight": weight,
        "first": layout.strips[strip.name][0] + 2 * support,
        "width": np.full(len(u), basis.degree + 1, dtype=np.int64),
        "d1": _widened(d1, widest),
        "d2": _widened(d2, widest),
        "speed": speed,
        "curvature": curvature,
    }


@lru_cache(maxsize=256)
def rest_of(strip: Strip, count: int) -> tuple[Array, Array]:
    """Speed and curvature (P,) at rest; kept, as several tables of a scene ask for them."""
    first, second = _tables(strip.basis, count)[-2:]
    tangent, bend = first @ strip.control_points, second @ strip.control_points
    speed = np.hypot(tangent[:, 0], tangent[:, 1])
    return speed, (tangent[:, 0] * bend[:, 1] - tangent[:, 1] * bend[:, 0]) / speed**3


def _widened(values: Array, width: int) -> Array:
    """Rows with zeros behind, as wide as the widest support of the scene."""
    if values.shape[1] == width:
        return values
    return np.pad(values, ((0, 0), (0, width - values.shape[1])))
