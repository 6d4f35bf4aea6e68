"""The points of a sweep, drawn chunk by chunk in their order and the same for the same file."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from studies.kinds import Array
from studies.sweep.designs.plan import Axis, Sample

Columns = dict[str, list[Any]]


class Drawer:
    """Draws the points of a sample forwards: `rows(start, stop)` with starts that do not fall.

    A grid, a list and a Sobol sequence are made where they are asked for; a Latin hypercube, whose points
    depend on their number, is drawn whole (8 bytes a point and key).
    """

    def __init__(self, sample: Sample) -> None:
        self._sample = sample
        dimensions = len(sample.axes)
        if sample.method == "sobol":
            self._sobol = qmc.Sobol(d=dimensions, scramble=True, seed=sample.seed)
        elif sample.method == "latin-hypercube":
            self._cube = qmc.LatinHypercube(d=dimensions, seed=sample.seed).random(sample.points)

    def rows(self, start: int, stop: int) -> Columns:
        """Return the points from `start` to before `stop` as columns by key, in the file's units."""
        axes = self._sample.axes
        if self._sample.method in ("grid", "list"):
            number = np.arange(start, stop)
            places = list(_places(self._sample, number))
            return {axis.key: _listed(axis, place) for axis, place in zip(axes, places, strict=True)}
        unit = self._unit(start, stop)
        return {axis.key: _spread(axis, unit[:, i]) for i, axis in enumerate(axes)}

    def _unit(self, start: int, stop: int) -> Array:
        """Return the points within the unit cube, (stop - start, axes)."""
        if self._sample.method == "latin-hypercube":
            return np.asarray(self._cube[start:stop])
        skipped = start - self._sobol.num_generated
        if skipped:
            self._sobol.fast_forward(skipped)
        if start > 0:
            return np.asarray(self._sobol.random(stop - start))
        # one first: scipy warns of a first draw that is no power of two
        return np.concatenate([self._sobol.random(count) for count in (1, stop - 1) if count])


def _places(sample: Sample, number: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
    """Yield the place on each axis: the last axis of a grid runs fastest, a list runs along all at once."""
    if sample.method == "list":
        yield from (number for _ in sample.axes)
        return
    shape = tuple(axis.count for axis in sample.axes)
    yield from np.unravel_index(number, shape)


def _listed(axis: Axis, place: NDArray[np.int64]) -> list[Any]:
    if axis.values is not None:
        return [axis.values[i] for i in place]
    share = place / max(axis.points - 1, 1)
    return _between(axis, share)


def _spread(axis: Axis, share: Array) -> list[Any]:
    """Return the values at shares of [0, 1): of a range, or one of those listed."""
    if axis.values is not None:
        return [axis.values[int(part * len(axis.values))] for part in share]
    return _between(axis, share)


def _between(axis: Axis, share: Array) -> list[Any]:
    if axis.log:
        low, high = math.log(axis.low), math.log(axis.high)
        values = np.exp(low + (high - low) * share)
    else:
        values = axis.low + (axis.high - axis.low) * share
    # the ends are exactly those of the file
    return list(np.clip(np.where(share == 1.0, axis.high, values), axis.low, axis.high).tolist())
