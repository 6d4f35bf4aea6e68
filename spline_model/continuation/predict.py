"""The predictor of a path: Hermite's polynomial through the last states and their rates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

KNOWN_STATES = 3
"""States that the predictor looks back on."""


def hermite_extrapolation(known: Sequence[tuple[float, Array, Array]], at: float) -> Array:
    """The polynomial through (place, value, slope) triples, evaluated at a place, values (N,).

    Newton's divided differences with every node doubled: degree 2 k - 1 for k triples. Three
    of them halve the Newton iterations of a smooth path against two.
    """
    nodes = [place for place, _, _ in known for _ in range(2)]
    table = [value for _, value, _ in known for _ in range(2)]
    result, weight = table[0], 1.0
    for order in range(1, len(nodes)):
        weight = weight * (at - nodes[order - 1])
        table = [
            known[i // 2][2]
            if nodes[i + order] == nodes[i]
            else (table[i + 1] - table[i]) / (nodes[i + order] - nodes[i])
            for i in range(len(nodes) - order)
        ]
        result = result + weight * table[0]
    return np.asarray(result)
