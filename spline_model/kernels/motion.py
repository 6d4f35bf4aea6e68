"""What does not change during a motion, as one argument of the compiled kernels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.kernels.assemble import Tables
from spline_model.kernels.bending import BendingTable
from spline_model.kernels.stretching import StretchingTable


class Motion(NamedTuple):
    """A system in motion: N unknowns, Q coordinates, C clamps, M axial modes.

    tables: the scene's operator tables; mass (Q, Q) [kg, kg m^2]; drag (Q, Q) or (0, 0)
    [N s/m, N m s]; bending_damping, stretching_damping: tables whose rigidities are beta EI
    and beta EA; axial_relaxation (P,) beta [s] at the points of the mixed stretching, or
    (0,); turns: places of the rotations in q; chord (C,) length of each clamp's end chord at
    rest [m]; rigidity (M, M) inverse compliance of the axial modes [N/m], zero where a strip
    is inextensible; unit (N,)
    and energy [J] make residuals dimensionless.
    """

    tables: Tables
    mass: NDArray[np.float64]
    drag: NDArray[np.float64]
    bending_damping: BendingTable
    stretching_damping: StretchingTable
    axial_relaxation: NDArray[np.float64]
    turns: NDArray[np.int64]
    chord: NDArray[np.float64]
    rigidity: NDArray[np.float64]
    unit: NDArray[np.float64]
    energy: float
