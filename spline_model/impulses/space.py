"""Work space of a step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.impulses.blocks import Blocks

Array = NDArray[np.float64]


class Space(NamedTuple):
    """Arrays that a step fills; N unknowns, Q coordinates, R rows, M axial modes.

    z, gradient (N,), matrix (N, N); v, base, drift, x (Q,); drag (Q, Q) all damping of the
    coordinates; schur (R, R); mu, change, gap, unit (R,), unit making a row's gap
    dimensionless; strains (M,).
    """

    z: Array
    gradient: Array
    matrix: Array
    v: Array
    base: Array
    drift: Array
    x: Array
    drag: Array
    schur: Array
    mu: Array
    change: Array
    gap: Array
    unit: Array
    strains: Array


def make_space(system: System, blocks: Blocks) -> Space:
    """Arrays of a system's size."""
    size, rows = system.layout.size, len(blocks.row)
    coordinates, modes = system.layout.coordinate_count, len(blocks.relaxation)
    return Space(
        z=np.zeros(size),
        gradient=np.zeros(size),
        matrix=np.zeros((size, size)),
        v=np.zeros(coordinates),
        base=np.zeros(coordinates),
        drift=np.zeros(coordinates),
        x=np.zeros(coordinates),
        drag=np.zeros((coordinates, coordinates)),
        schur=np.zeros((rows, rows)),
        mu=np.zeros(rows),
        change=np.zeros(rows),
        gap=np.zeros(rows),
        unit=system.scales.unit[blocks.row] / system.scales.energy,
        strains=np.zeros(modes),
    )


class Moving(NamedTuple):
    """A motion on its way, advanced in place.

    z (N,) unknowns, v (Q,) velocities; earlier_q, earlier_v (Q,) those of the step before;
    status (3,): 1 if they count, the largest residual so far [1], the energy [J]; counters (5,)
    as named in ``totals``; totals (2,) work done on it and energy dissipated [J].
    """

    z: Array
    v: Array
    earlier_q: Array
    earlier_v: Array
    status: Array
    counters: NDArray[np.int64]
    totals: Array


class Log(NamedTuple):
    """K records, the start first: states (K, N), rates (K, Q) and rows (K, 7) of ``kernels.record``."""

    states: Array
    rates: Array
    rows: Array


class Options(NamedTuple):
    """Most sweeps of a linear system, iterations of a step, tolerance [1], least part of a step."""

    sweeps: int
    iterations: int
    tolerance: float
    least_part: float
