"""Newton's method on the bordered system of coordinates, axial forces and multipliers."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs

from spline_model.bordered import evaluate
from spline_model.compile import System
from spline_model.sparse import Pattern, pattern_of

Array = NDArray[np.float64]

getrf, getrs = get_lapack_funcs(("getrf", "getrs"))  # without the checks and warnings of lu_factor

TOLERANCE = 1e-11
"""Largest residual of a solved state, in EI/L^2, EI/L, L and rad."""
FLOOR = 1e-8
"""Below this a residual that Newton no longer halves is the round-off of the residual itself
(it grows with EA L^2 / EI in the paper's stretch form); above it, that is a failure."""
MOST_ITERATIONS = 15
"""From a tangent predictor Newton takes two to four; more than this is a wrong start."""


@dataclass(kw_only=True)
class Counters:
    """Work that was done; the same on every machine."""

    increments: int = 0
    halved_increments: int = 0
    newton_iterations: int = 0
    residual_evaluations: int = 0
    tangent_evaluations: int = 0
    factorisations: int = 0


@dataclass(frozen=True, kw_only=True, eq=False)
class Newton:
    """Outcome of one solve: the state, its energies (bending, axial) [J] and the residual norms.

    ``reason`` is empty when it converged and says what went wrong otherwise.
    """

    z: Array
    energies: tuple[float, float]
    norms: tuple[float, ...]
    reason: str


@dataclass(frozen=True, kw_only=True, eq=False)
class Workspace:
    """A system with the arrays that its kernels fill, and the counters of the work.

    pattern: of a tangent that is factorised sparse; None for a dense one.
    """

    system: System
    gradient: Array
    hessian: Array
    pattern: Pattern | None = None
    counters: Counters = field(default_factory=Counters)

    @classmethod
    def of(cls, system: System) -> Self:
        """Fresh arrays for a system."""
        size = system.layout.size
        return cls(
            system=system,
            gradient=np.empty(size),
            hessian=np.empty((size, size)),
            pattern=pattern_of(system),
        )

    @property
    def unit(self) -> Array:
        """Unit of each unknown (N,), which with that of energy makes residuals dimensionless."""
        return self.system.scales.unit

    @property
    def energy(self) -> float:
        """Unit of energy."""
        return self.system.scales.energy

    def evaluate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """Fill gradient and hessian at z; returns bending and axial energy [J].

        Not a number where C' = 0: control points that coincide have neither tangent nor curvature.
        """
        self.counters.residual_evaluations += 1
        self.counters.tangent_evaluations += 1
        return evaluate(self.system, z, load_factor, self.gradient, self.hessian)

    def norm(self) -> float:
        """Largest entry of the dimensionless residual."""
        return float(np.abs(self.gradient * self.unit).max() / self.energy)

    def solve(self, right_side: Array) -> Array:
        """Solve hessian x = right_side (N,) or (N, K), dimensionless inside; LinAlgError if singular."""
        unit, energy = self.unit, self.energy
        own = unit if right_side.ndim == 1 else unit[:, None]
        self.counters.factorisations += 1
        if self.pattern is not None:
            return np.asarray(own * self.pattern.factorise(self.hessian).solve(right_side * own / energy))
        matrix = self.hessian * (unit[:, None] * unit / energy)
        if not np.isfinite(matrix).all():
            raise np.linalg.LinAlgError("the tangent is not finite")
        factors, pivots, failed = getrf(matrix)
        if failed:
            raise np.linalg.LinAlgError("the tangent is singular")
        return np.asarray(own * getrs(factors, pivots, right_side * own / energy)[0])


def solve(work: Workspace, start: Array, load_factor: float) -> Newton:
    """Newton from ``start`` at fixed load factor, until the residual is below TOLERANCE."""
    z = start.copy()
    norms: list[float] = []
    for iteration in range(MOST_ITERATIONS + 1):
        energies = work.evaluate(z, load_factor)
        norms.append(work.norm())
        if not np.isfinite(norms[-1]):
            return Newton(z=z, energies=energies, norms=tuple(norms), reason="the residual is not finite")
        stalled = len(norms) > 1 and norms[-1] > 0.5 * norms[-2]
        if norms[-1] <= TOLERANCE or (stalled and norms[-1] <= FLOOR):
            return Newton(z=z, energies=energies, norms=tuple(norms), reason="")
        if iteration == MOST_ITERATIONS:
            break
        try:
            z = z + work.solve(-work.gradient)
        except np.linalg.LinAlgError as error:
            return Newton(z=z, energies=energies, norms=tuple(norms), reason=str(error))
        work.counters.newton_iterations += 1
    reason = f"no convergence in {MOST_ITERATIONS} iterations (residual {norms[-1]:.1e})"
    return Newton(z=z, energies=energies, norms=tuple(norms), reason=reason)
