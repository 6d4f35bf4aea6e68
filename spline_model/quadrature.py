"""The Gauss points of a set of strips, flattened into one table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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


def _points_of(source: int, strip: Strip, count: int, layout: Layout, widest: int) -> dict[str, NDArray]:
    basis = strip.basis
    u, weight = basis.gauss_rule(count)
    support = basis.first_of_support(u)
    columns = support[:, None] + np.arange(basis.degree + 1)
    padding = ((0, 0), (0, widest - basis.degree - 1))
    first, second = basis.evaluate(u, 1), basis.evaluate(u, 2)
    tangent, bend = first @ strip.control_points, second @ strip.control_points
    speed = np.hypot(*tangent.T)
    return {
        "source": np.full(len(u), source, dtype=np.int64),
        "u": u,
        "weight": weight,
        "first": layout.strips[strip.name][0] + 2 * support,
        "width": np.full(len(u), basis.degree + 1, dtype=np.int64),
        "d1": np.pad(np.take_along_axis(first, columns, axis=1), padding),
        "d2": np.pad(np.take_along_axis(second, columns, axis=1), padding),
        "speed": speed,
        "curvature": (tangent[:, 0] * bend[:, 1] - tangent[:, 1] * bend[:, 0]) / speed**3,
    }
