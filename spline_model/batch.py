"""Many designs of a pivot or of any mechanism at once, on the condensed path and on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.accuracy import Search, wanted
from spline_model.batch_paths import Batch, Many
from spline_model.confirmed import finer, relative
from spline_model.errors import require_choice, require_count
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.parameters import Given, one_each, varied
from spline_model.statics import LOADS_FIRST, ORDERS

Array = NDArray[np.float64]


def solve_many(
    mechanism: Mechanism,
    values: Mapping[str, ArrayLike],
    *,
    rotation: ArrayLike,
    body: str | None = None,
    increments: int = 20,
    order: str = LOADS_FIRST,
    accuracy: float | None = None,
    threads: int | None = None,
    section_depth: ArrayLike | None = None,
) -> Batch:
    """Return the static paths of many designs that differ from a mechanism in some numbers.

    Parameters
    ----------
    mechanism : Mechanism
        With the discretisation of all designs.
    values : mapping of arrays (D,), SI units
        Numbers of the mechanism that vary, by the names of ``spline_model.parameters``: "thickness" of all
        strips, "crossing_ratio" of a pivot, "crank.centre_x" of a body, "ground_crank.end_y" of a strip. The
        end of a strip does not move with its body. An array of one number is for all designs.
    rotation : float or (D,), rad
        End of all paths, or of each path.
    body : str, default None
        Rotated and reported body; None is the only one.
    increments : int, default 20
    order : str
        "loads first" (default) or "together", as in ``spline_model.statics.solve_statics``. Weight and
        pre-strain act first.
    accuracy : float, 1, default None
        As in ``spline_model.statics.solve_statics``, for each design: each gets its own number of control
        points, and its estimated `errors`.
    threads : int, default None
        Number of threads; None is one per core. Results do not depend on it.
    section_depth : float or (D,), m, default None
        Depth of the sections in the plane of bending, for strains.

    Returns
    -------
    Batch
        D designs at S states: torque (D, S), stiffness (D, S), centre (D, S, 2) and more; NaN behind a path
        that stopped.

    Raises
    ------
    InvalidParameter
        A bad value, with the number of the design.

    Notes
    -----
    The compiled paths run without the interpreter's lock. A batch gives the numbers of single solves.

    References
    ----------
    Guyan, AIAA Journal 3 (1965), for the condensation of the strips.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> batch = solve_many(pivot, {"thickness": [4e-4, 5e-4]}, rotation=0.3, increments=5)
    >>> batch.torque.shape
    (2, 6)
    """
    require_count("increments", increments, 1)
    require_choice("order", order, ORDERS)
    require_mechanism(mechanism)
    mechanism.design.require_uncut("batches")
    given = varied(mechanism, values, np.size(rotation))
    count = len(given.ends)
    turned = np.broadcast_to(one_each("rotation", rotation, count), (count,))
    many = Many(
        base=mechanism,
        given=given,
        turned=turned,
        shared=np.ndim(rotation) == 0,
        depth=_depth(given, section_depth),
        body=mechanism.design.body_named(body),
        increments=increments,
        first=order == LOADS_FIRST,
        workers=threads or os.cpu_count() or 1,
    )
    chosen = wanted(accuracy, mechanism.design)
    if chosen is None:
        batch = many.empty(mechanism.design.discretisation.points, None)
        many.solve(batch, np.arange(count))
        return batch
    return _chosen(many, chosen)


def _chosen(many: Many, accuracy: float) -> Batch:
    """Answers with the control points that each design takes."""
    count, design = len(many.turned), many.base.design
    searches: list[Search[None]] = [
        Search(accuracy=accuracy, grid=design.discretisation, most_segments=1) for _ in range(count)
    ]
    answers: dict[int, tuple[Batch, NDArray[np.bool_]]] = {}
    best = many.empty(0, accuracy)

    def answer(points: int, rows: NDArray[np.int64]) -> Batch:
        batch, known = answers.setdefault(points, (many.empty(points, accuracy), np.zeros(count, dtype=bool)))
        many.solve(batch, rows[~known[rows]])
        known[rows] = True
        return batch

    while open_ones := [row for row, each in enumerate(searches) if not each.ended]:
        grid = min(searches[row].at for row in open_ones)
        rows = np.array([row for row in open_ones if searches[row].at == grid])
        coarse, fine = (answer(points, rows) for _, points in (grid, finer(*grid)))
        errors = _distances(many, coarse, fine, rows)
        worst = np.fmax.reduce(list(errors.values()))
        alike = (coarse.states[rows] == fine.states[rows]) & ~np.isnan(worst)
        better = [
            searches[row].judge(float(error) if same else None)
            for row, error, same in zip(rows, worst, alike, strict=True)
        ]
        best.take(coarse, rows[better], {name: each[better] for name, each in errors.items()})
        lost = [row for row in rows if searches[row].ended and searches[row].levels == []]
        best.take(coarse, np.array(lost, dtype=np.int64), {})
    return best


def _distances(many: Many, coarse: Batch, fine: Batch, rows: NDArray[np.int64]) -> dict[str, Array]:
    """Errors of some designs (R,) by the names of ``ErrorEstimate``, as ``accuracy.distances``."""
    given = many.given.rows(rows)
    length = given.span.max(axis=1)
    moment = given.rigidity.max(axis=1) / length
    moved, better = (each.centre[rows] - each.centre[rows][:, :1] for each in (coarse, fine))
    units = {"torque": moment, "stiffness": moment, "energy": moment, "strain": np.ones(len(rows))}
    return {"trajectory": relative(moved, better, length)} | {
        name: relative(getattr(coarse, name)[rows], getattr(fine, name)[rows], unit)
        for name, unit in units.items()
    }


def _depth(given: Given, section_depth: ArrayLike | None) -> Array:
    """Depth of each design's sections over its length (D,); (0,) where none is asked for."""
    if section_depth is None:
        return np.zeros(0)
    each = one_each("section_depth", section_depth, len(given.ends), above=0.0)
    return np.asarray(each / given.span.max(axis=1))
