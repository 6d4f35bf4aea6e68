"""Many designs of a pivot or of any mechanism at once, on the condensed path and on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.compile import compile_scene
from spline_model.design import Described, Discretisation
from spline_model.effects import MixedStretching
from spline_model.effects.elastic import CLAMPED_WIDTH
from spline_model.errors import InvalidParameter, require_count
from spline_model.mechanism import Mechanism
from spline_model.newton import TOLERANCE
from spline_model.reduced.arrays import Answer, Route
from spline_model.reduced.designs import Given, designs_of, one_each, pivots, varied
from spline_model.reduced.many import Designs, Share, Stations, follow_all
from spline_model.reduced.model import Reduced, reduced
from spline_model.reduced.numbers import LEAST_COMPLIANCE
from spline_model.reduced.preload import Preload
from spline_model.sections import STATIONS

Array = NDArray[np.float64]

SAME = 1e-9
"""Relative difference to which two widths over lengths are one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Answers of D designs at S states each, the unloaded one first; nan behind a path that stopped.

    states (D,) converged states; rotation (S,), or (D, S) where designs have their own [rad];
    centre (D, S, 2) of the body [m]; torque (D, S) [N m]; stiffness (D, S) [N m/rad]; energy (D, S) [J];
    strain (D, S) the largest of the extreme fibres, |N / (EA)| + |M| d / (2 EI) over the
    stations of both strips [1], nan without a section depth d; inertia (D, S) negative
    eigenvalues of the reduced tangent, 0 for a stable state, -1 behind a path that stopped;
    moment_defect (D, S) as in ``Path``; iterations (D,) of Newton.
    """

    states: NDArray[np.int64]
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    energy: Array
    strain: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    iterations: NDArray[np.int64]

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Designs whose path reached its end, (D,)."""
        return np.asarray(self.states == self.rotation.shape[-1])


def solve_many(
    designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]] | Mechanism,
    values: Mapping[str, ArrayLike] | None = None,
    *,
    rotation: ArrayLike,
    body: str | None = None,
    increments: int = 20,
    threads: int | None = None,
    section_depth: ArrayLike | None = None,
    **described: Unpack[Described],
) -> Batch:
    """Static paths of many designs to one rotation, or each to its own [rad], a number or (D,).

    designs: keywords of ``cross_axis_pivot`` as columns, each a number or an array (D,), or
    one mapping a design, and ``described`` as there, the same for all, with FIRST_POINTS control points
    unless their number is given. Or a mechanism, with the
    ``values`` (D,) of its numbers that vary, by the names of ``spline_model.sensitivity.parameters``:
    "thickness" of all strips, "crank.centre_x" of a body, "ground_crank.end_y" of a strip; a strip's end
    does not go with the body that it is clamped to. body: the one that is turned and reported, or the
    only one; weight and pre-strain come on first, loads grow with the rotation. section_depth: in the
    plane of bending [m], a number or (D,), by which strains are asked for. The compiled paths run without
    the interpreter's lock on ``threads`` threads, default all cores; the answers do not depend on their
    number. Raises InvalidParameter with the number of a bad design.
    """
    require_count("increments", increments, 1)
    base, given = _given(designs, values, Discretisation(**described), np.size(rotation))
    count = len(given.ends)
    turned = np.broadcast_to(one_each("rotation", rotation, count), (count,))
    depth = _depth(base, given, section_depth)
    batch = _empty(count, increments, rotation, turned)
    model, names = _model(base, body), [b.name for b in base.design.bodies]
    place = 3 * names.index(base.design.body_named(body))
    split, small = model.strips.split, (given.compliance < LEAST_COMPLIANCE).any(axis=1)
    slender_ones = (small | ~model.strips.compliance[:, :split].all()) & (split > 0)
    workers = threads or os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as pool:
        for slender in (False, True):  # their elements differ: see ``LEAST_COMPLIANCE``
            rows = np.flatnonzero(slender_ones == slender)
            if rows.size:
                kind = model.as_slender(slender=slender)
                numbers = designs_of(kind, Given.of(base.design), given.rows(rows), turned[rows])
                deep = depth[rows] if depth.size else depth
                share = (workers, kind, place, rows, numbers, deep, increments, batch)
                together = map if workers == 1 else pool.map
                list(together(partial(_solve_share, *share), range(workers)))
    return batch


def _given(
    designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]] | Mechanism,
    values: Mapping[str, ArrayLike] | None,
    grid: Discretisation,
    count: int,
) -> tuple[Mechanism, Given]:
    """A mechanism, and the numbers of the designs that are like it; at least ``count`` of them."""
    if isinstance(designs, Mechanism):
        if grid != Discretisation():
            raise InvalidParameter("discretisation", grid, "none beside a mechanism, which has its own")
        given = varied(designs, values or {}, count)
        _require_shape(designs, given)
        return designs, given
    if values is not None:
        raise InvalidParameter("values", list(values), "none beside columns of pivots, which hold them")
    return pivots(designs, asdict(grid))


def _depth(base: Mechanism, given: Given, section_depth: ArrayLike | None) -> Array:
    """Depth of each design's sections over its length (D,); (0,) where none is asked for."""
    if section_depth is None:
        return np.zeros(0)
    if not base.scene.of(MixedStretching) or any(strip.rise for strip in base.design.strips):
        expected = "none without straight strips and mixed stretching"
        raise InvalidParameter("section_depth", section_depth, expected)
    each = one_each("section_depth", section_depth, len(given.ends), above=0.0)
    return np.asarray(each / np.abs(given.chord).max(axis=1))


def _require_shape(base: Mechanism, given: Given) -> None:
    """Refuse strips of another b/L than the mechanism's: clamped over the width they have other profiles."""
    if CLAMPED_WIDTH in base.design.curling:
        own = Given.of(base.design)
        shape, known = (each.width / np.abs(each.chord) for each in (given, own))
        other = np.argwhere(np.abs(shape / known - 1.0) > SAME)
        if other.size:
            d, s = other[0]
            name = f"design {d}: b/L of {base.design.strips[s].name}"
            raise InvalidParameter(
                name,
                float(shape[d, s]),
                f"{known[0, s]:.6g}, that of the mechanism, for {CLAMPED_WIDTH}",
            )


def _model(mechanism: Mechanism, body: str | None) -> Reduced:
    """The element's scene of a mechanism, one body turned; refused where a batch does not know it."""
    model = reduced(compile_scene(mechanism.driven(1.0, body)))
    if model is None:
        raise InvalidParameter("discretisation", "printed forces or long splines", "what the elements know")
    return model


def _empty(designs: int, increments: int, rotation: ArrayLike, turned: Array) -> Batch:
    shape = (designs, increments + 1)
    paths = np.linspace(0.0, turned, increments + 1, axis=1)
    return Batch(
        states=np.zeros(designs, dtype=np.int64),
        rotation=paths if np.ndim(rotation) else paths[0],
        centre=np.full((*shape, 2), np.nan),
        torque=np.full(shape, np.nan),
        stiffness=np.full(shape, np.nan),
        energy=np.full(shape, np.nan),
        strain=np.full(shape, np.nan),
        inertia=np.full(shape, -1, dtype=np.int64),
        moment_defect=np.full(shape, np.nan),
        iterations=np.zeros(designs, dtype=np.int64),
    )


def _solve_share(
    workers: int,
    model: Reduced,
    place: int,
    rows: NDArray[np.int64],
    designs: Designs,
    depth: Array,
    increments: int,
    batch: Batch,
    worker: int,
) -> None:
    """Solve what one thread does of the designs of one kind of element, with working arrays of its own.

    rows: theirs in the batch.
    """
    strips, bodies, preload = model.strips, model.bodies, Preload.of(model)
    own = {name: getattr(strips, name).copy() for name in ("along", "numbers", "compliance", "gain")}
    bodies = bodies._replace(**{k: getattr(bodies, k).copy() for k in ("rest", "load", "weight")})
    copies = {k: getattr(preload, k).copy() for k in ("curvature", "numbers", "bodies")}
    factors, held = np.linspace(0.0, 1.0, increments + 1), len(bodies.held)
    route = Route(factor=factors, origin=np.zeros(held), target=np.zeros(held), growth=1.0, passes=True)
    grows = factors[[0, -1]] if model.system.is_preloaded else factors[:0]
    share = Share(
        rows=rows,
        begin=worker,
        stride=workers,
        designs=designs,
        depth=depth,
        stations=Stations.of(model, STATIONS),
        growing=route._replace(factor=grows, target=np.zeros(held), growth=0.0, swells=True),
        place=place,
        along=strips.along,
        curved=preload.curvature,
        results=tuple(array for name, array in vars(batch).items() if name != "rotation"),
    )
    arrays = model.arrays()._replace(bodies=bodies, strips=strips._replace(**own))
    answer = Answer.empty(len(factors), model.size, held)
    # the moment defect refuses
    follow_all(share, designs.start[0], route, True, preload._replace(**copies), arrays, TOLERANCE, answer)
