"""Newton's method on the reduced coordinates, for a driven rotation or for a load of given size.

The path is followed in one parameter p: the driven rotation theta = p [rad], or the factor p of a dead load
F. The unknowns are all coordinates that are not driven; the residual is the internal force less p F on them.
"""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from .structure import Structure

Array = NDArray[np.float64]

#: Newton's iterations of one increment; from a tangent predictor a sound increment takes four to six.
ITERATIONS = 25
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) taken as equilibrium where round-off allows
#: it.
TOLERANCE = 1e-10


@dataclass(frozen=True, kw_only=True, eq=False)
class Control:
    """How the path is driven: by the rotation of the body (`load` is zero), or by the load p F.

    Args:
        structure: what is driven.
        driven: whether the parameter is the rotation of the body.
        load: F in the reduced coordinates, (size,) [N, N m].
    """

    structure: Structure
    driven: bool
    load: Array

    @property
    def free(self) -> int:
        """Number of unknowns; the rotation is the last coordinate."""
        return self.structure.size - (1 if self.driven else 0)

    def rate(self, tangent: csc_matrix, counters: Counter[str]) -> Array:
        """Return d y / d p along the equilibrium path, (size,): one factorisation, one solve."""
        n = self.free
        rate = np.ones(self.structure.size)
        right = -tangent[:, -1].toarray()[:n, 0] if self.driven else self.load
        rate[:n] = factor(tangent, n, counters).solve(right)
        return rate

    def turn_rate(self, tangent: csc_matrix, counters: Counter[str]) -> float:
        """Return d theta / d (moment on the body) with all coordinates free [rad/(N m)]."""
        unit = np.zeros(self.structure.size)
        unit[-1] = 1.0
        return float(factor(tangent, self.structure.size, counters).solve(unit)[-1])


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What Newton's method left: coordinates, norms of its residuals, and "" or the reason of its failure."""

    y: Array
    norms: tuple[float, ...]
    failure: str


def factor(tangent: csc_matrix, free: int, counters: Counter[str]):  # type: ignore[no-untyped-def]
    """Factorise the leading (free, free) block; raises RuntimeError if it is singular."""
    counters["factorisations"] += 1
    block = tangent if free == tangent.shape[0] else tangent[:, :free][:free]
    return splu(block.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})


def round_off(structure: Structure) -> float:
    """Return the dimensionless residual below which round-off decides.

    Displacements of order L carry an error of one unit in the last place: relative to an element of
        length l it is a
    strain of L/l of it, hence a force of EA L/l (or kGA L/l, if that is part of the element and larger); and
    a turn of the chord of L/l of it, hence a force of 12 EI L/l^3. The factor 4 covers the few operations
    between them.
    """
    e = structure.elements
    length = max(strip.length for strip in structure.model.strips)
    axial = np.max(structure.law.force_rigidity * length / e.length) / structure.force_unit
    bending = np.max(12.0 * e.flexural_rigidity * length / e.length**3) / structure.force_unit
    return float(4.0 * np.finfo(float).eps * (axial + bending))


def equilibrate(control: Control, start: Array, parameter: float, counters: Counter[str]) -> Outcome:
    """Iterate from `start` to equilibrium at `parameter`, with the consistent tangent at every iteration."""
    structure, n = control.structure, control.free
    tolerance = max(TOLERANCE, round_off(structure))
    y, norms = start.copy(), []
    for _ in range(ITERATIONS + 1):
        counters["residual_evaluations"] += 1
        residual = structure.internal_force(y)[:n] - parameter * control.load[:n]
        norms.append(float(np.abs(residual / structure.scale[:n]).max()))
        if norms[-1] <= tolerance:
            return Outcome(y=y, norms=tuple(norms), failure="")
        if not np.isfinite(norms[-1]):
            return Outcome(y=y, norms=tuple(norms), failure="the residual is not finite")
        if len(norms) > ITERATIONS:
            break
        counters["newton_iterations"] += 1
        counters["tangent_evaluations"] += 1
        try:
            y[:n] -= factor(structure.tangent_stiffness(y), n, counters).solve(residual)
        except RuntimeError:
            return Outcome(y=y, norms=tuple(norms), failure="the tangent is singular")
    return Outcome(y=y, norms=tuple(norms), failure=f"no equilibrium in {ITERATIONS} iterations")
