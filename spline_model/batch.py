"""Many designs of the pivot at once, on the condensed path and on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter, require_count
from spline_model.fast.path import follow
from spline_model.fast.solve import (
    TOLERANCE,
    arrays,
    at_rest,
    empty_answer,
    frame_of,
    grid_of,
    is_fast,
    mode_count,
)
from spline_model.mechanism import Mechanism
from spline_model.pivot import cross_axis_pivot

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Batch:
    """Answers of D designs at S states each, the unloaded one first; nan behind a path that stopped.

    states (D,) converged states; rotation (S,) [rad]; centre (D, S, 2) [m]; torque (D, S)
    [N m]; stiffness (D, S) [N m/rad]; energy (D, S) [J]; iterations (D,) of Newton.
    """

    states: NDArray[np.int64]
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    energy: Array
    iterations: NDArray[np.int64]

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Designs whose path reached its end, (D,)."""
        return np.asarray(self.states == len(self.rotation))


def solve_many(
    designs: Sequence[Mapping[str, Any]],
    *,
    rotation: float,
    increments: int = 20,
    threads: int | None = None,
    **discretisation: Any,
) -> Batch:
    """Static paths of many pivots to one rotation [rad].

    designs: keywords of ``cross_axis_pivot``, one mapping a design; discretisation: the same
    for all. The compiled paths run without the interpreter's lock on ``threads`` threads,
    default all cores; the answers do not depend on their number. Raises InvalidParameter
    with the number of the design that is bad or has no condensed path.
    """
    require_count("increments", increments, 1)
    mechanisms = [_mechanism(i, design, discretisation) for i, design in enumerate(designs)]
    rotations = np.linspace(0.0, rotation, increments + 1)
    batch = _empty(len(designs), rotations)
    workers = threads or os.cpu_count() or 1
    shares = [range(w, len(mechanisms), workers) for w in range(workers)]
    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(lambda share: _solve_share(mechanisms, share, rotations[1:], batch), shares))
    return batch


def _mechanism(number: int, design: Mapping[str, Any], discretisation: Mapping[str, Any]) -> Mechanism:
    try:
        mechanism = cross_axis_pivot(**(dict(design) | dict(discretisation))).mechanism
    except InvalidParameter as error:
        raise InvalidParameter(f"design {number}: {error.name}", error.got, error.expected) from None
    if not is_fast(mechanism):
        raise InvalidParameter(f"design {number}", "no condensed path", "Bezier strips, material, mixed")
    return mechanism


def _empty(designs: int, rotations: Array) -> Batch:
    shape = (designs, len(rotations))
    return Batch(
        states=np.zeros(designs, dtype=np.int64),
        rotation=rotations,
        centre=np.full((*shape, 2), np.nan),
        torque=np.full(shape, np.nan),
        stiffness=np.full(shape, np.nan),
        energy=np.full(shape, np.nan),
        iterations=np.zeros(designs, dtype=np.int64),
    )


def _solve_share(mechanisms: Sequence[Mechanism], share: range, rotations: Array, batch: Batch) -> None:
    """Solve the designs of one thread with one set of working arrays."""
    if not share:
        return
    design = mechanisms[share[0]].design
    n, modes = design.discretisation.control_points, mode_count(design)
    grid = grid_of(design)
    locals_, space = arrays(len(design.strips), n, modes)
    answer = empty_answer(len(rotations) + 1, len(space.y))
    for i in share:
        frame = frame_of(mechanisms[i])
        answer.counters[:] = 0
        start = at_rest(frame, n, modes)
        done = follow(start, rotations, frame, grid, locals_, space, TOLERANCE, answer)
        batch.states[i] = done
        batch.centre[i, :done] = answer.y[:done, :2] * frame.length[0]
        batch.torque[i, :done] = answer.torque[:done]
        batch.stiffness[i, :done] = answer.stiffness[:done]
        batch.energy[i, :done] = answer.energies[:done].sum(axis=1)
        batch.iterations[i] = answer.counters[0]
