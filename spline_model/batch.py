"""Many designs of the pivot at once, on the condensed path and on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.errors import InvalidParameter, require_count
from spline_model.fast.body import Frame
from spline_model.fast.many import follow_share
from spline_model.fast.solve import (
    LEAST_COMPLIANCE,
    TOLERANCE,
    arrays,
    at_rest,
    compliances,
    empty_answer,
    frame_of,
    grid_of,
    is_fast,
    mode_count,
)
from spline_model.fast.strain import stations_of
from spline_model.mechanism import Mechanism
from spline_model.pivot import cross_axis_pivot
from spline_model.statics import STATIONS

Array = NDArray[np.float64]

POSITIVE = ("length", "area", "second_moment_of_area", "youngs_modulus")
"""Columns that statics reads and that must be above zero; the others are checked on the first design."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Answers of D designs at S states each, the unloaded one first; nan behind a path that stopped.

    states (D,) converged states; rotation (S,), or (D, S) where designs have their own [rad];
    centre (D, S, 2) [m]; torque (D, S) [N m]; stiffness (D, S) [N m/rad]; energy (D, S) [J];
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
    designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]],
    *,
    rotation: ArrayLike,
    increments: int = 20,
    threads: int | None = None,
    section_depth: ArrayLike | None = None,
    **discretisation: Any,
) -> Batch:
    """Static paths of many pivots to one rotation, or each to its own [rad], a number or (D,).

    designs: keywords of ``cross_axis_pivot`` as columns, each a number or an array (D,), or
    one mapping a design; section_depth: in the plane of bending [m], a number or (D,), by
    which strains are asked for; discretisation: the same for all. The compiled paths run
    without the interpreter's lock on ``threads`` threads, default all cores; the answers do
    not depend on their number. Raises InvalidParameter with the number of a bad design.
    """
    require_count("increments", increments, 1)
    columns = _columns(designs)
    first = cross_axis_pivot(
        **{name: _plain(values[0]) for name, values in columns.items()}, **discretisation
    )
    if not is_fast(first.mechanism):
        raise InvalidParameter("discretisation", discretisation, "Bezier strips, material, mixed")
    frames = _frames(columns, first.mechanism)
    count = len(frames.length)
    paths = np.linspace(0.0, _one_each("rotation", rotation, count), increments + 1, axis=1)
    depth = np.zeros(0)
    if section_depth is not None:
        depth = np.broadcast_to(_one_each("section_depth", section_depth, count, above=0.0), (count,)).copy()
    batch = _empty(count, paths if np.ndim(rotation) else paths[0])
    workers = threads or os.cpu_count() or 1
    with ThreadPoolExecutor(workers) as pool:
        list(
            pool.map(
                lambda w: _solve_share(w, workers, first.mechanism, frames, paths, depth, batch),
                range(workers),
            )
        )
    return batch


def _columns(designs: Mapping[str, ArrayLike] | Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Designs as columns of equal length, pairs with a second axis."""
    if not isinstance(designs, Mapping):
        designs = {name: np.array([design[name] for design in designs]) for name in designs[0]}
    pairs = {name: 1 + (name == "centre_offset") for name in designs}
    values = {name: np.asarray(value, dtype=float) for name, value in designs.items()}
    count = max((len(v) for name, v in values.items() if v.ndim >= pairs[name]), default=1)
    shape = {name: (count, 2) if pairs[name] == 2 else (count,) for name in values}
    return {name: np.broadcast_to(value, shape[name]) for name, value in values.items()}


def _plain(value: Any) -> Any:
    return tuple(float(part) for part in value) if np.ndim(value) else float(value)


def _frames(columns: Mapping[str, Array], first: Mechanism) -> Frame:
    """Frames of all designs, every field with a first axis (D, ...)."""
    for name in POSITIVE:
        _refuse(columns, name, columns[name] > 0, "a finite number > 0")
    _refuse(
        columns,
        "inclination",
        (columns["inclination"] > 0) & (columns["inclination"] < np.pi / 2),
        "0 to pi/2",
    )
    _refuse(
        columns, "crossing_ratio", (columns["crossing_ratio"] > 0) & (columns["crossing_ratio"] < 1), "0 to 1"
    )
    c = columns
    length, count = c["length"], len(c["length"])
    turn = np.broadcast_to(c.get("orientation", np.zeros(1)), (count,))
    offset = np.broadcast_to(c.get("centre_offset", np.zeros((1, 2))), (count, 2))
    cos, sin = np.cos(c["inclination"]), np.sin(c["inclination"])
    axis = np.stack((np.stack((cos, sin), -1), np.stack((-cos, sin), -1)), axis=1)
    root = np.zeros((count, 2, 2))
    root[:, 1, 0] = 2 * c["crossing_ratio"] * length * cos
    tip = root + length[:, None, None] * axis
    arm = tip - (tip.mean(axis=1) + offset)[:, None]
    matrix = np.moveaxis(np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]), -1, 0)
    axis, root, arm = (np.einsum("dij,dsj->dsi", matrix, part) for part in (axis, root, arm))
    rigidity = c["youngs_modulus"] * c["second_moment_of_area"]
    axial = rigidity / (c["youngs_modulus"] * c["area"] * length**2)
    _refuse(columns, "area", axial >= LEAST_COMPLIANCE, "strips below a slenderness of 9000")
    return Frame(
        root=root,
        axis=axis,
        length=np.repeat(length[:, None], 2, axis=1),
        rigidity=np.repeat(rigidity[:, None], 2, axis=1),
        arm=arm,
        compliance=np.repeat(compliances(first.design, axial)[:, None], 2, axis=1),
        centre=root[:, 0] + length[:, None] * axis[:, 0] - arm[:, 0],
    )


def _refuse(columns: Mapping[str, Array], name: str, good: NDArray[np.bool_], expected: str) -> None:
    bad = np.flatnonzero(~(good & np.isfinite(columns[name])))
    if bad.size:
        raise InvalidParameter(f"design {bad[0]}: {name}", float(columns[name][bad[0]]), expected)


def _one_each(name: str, given: ArrayLike, count: int, above: float = -np.inf) -> Array:
    """A number for all designs, (1,), or one for each, (D,)."""
    values = np.atleast_1d(np.asarray(given, dtype=float))
    if values.shape not in ((1,), (count,)):
        raise InvalidParameter(name, values.shape, f"a number or an array of {count}, one a design")
    bound = "" if above == -np.inf else f" > {above:g}"
    _refuse({name: values}, name, values > above, f"a finite number{bound}")
    return values


def _empty(designs: int, rotations: Array) -> Batch:
    shape = (designs, rotations.shape[-1])
    return Batch(
        states=np.zeros(designs, dtype=np.int64),
        rotation=rotations,
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
    worker: int, workers: int, first: Mechanism, frames: Frame, paths: Array, depth: Array, batch: Batch
) -> None:
    """Solve the designs of one thread with one set of working arrays."""
    design = first.design
    n, modes = design.discretisation.control_points, mode_count(design)
    grid = grid_of(design)
    locals_, space = arrays(len(design.strips), grid)
    answer = empty_answer(paths.shape[1], len(space.y))
    stations = stations_of(n, modes, STATIONS)
    results = (
        batch.states,
        batch.centre,
        batch.torque,
        batch.stiffness,
        batch.energy,
        batch.strain,
        batch.inertia,
        batch.moment_defect,
        batch.iterations,
    )
    follow_share(
        worker,
        workers,
        frames,
        at_rest(frame_of(first), n, modes),
        np.ascontiguousarray(paths[:, 1:]),
        grid,
        locals_,
        space,
        TOLERANCE,
        answer,
        depth,
        stations,
        results,
    )
