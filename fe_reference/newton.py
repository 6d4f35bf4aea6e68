"""Newton's method to the equilibrium at one parameter of a path, with the consistent tangent."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .control import Control, factorise, free_block
from .structure import Structure

Array = NDArray[np.float64]

#: Newton's iterations of one increment; from a tangent predictor a sound increment takes four to six.
ITERATIONS = 25
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) taken as equilibrium where round-off allows
#: it.
TOLERANCE = 1e-10


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What Newton's method left: coordinates, norms of its residuals, and "" or the reason of its failure."""

    y: Array
    norms: tuple[float, ...]
    failure: str


def round_off(structure: Structure) -> float:
    """Return the dimensionless residual below which round-off decides.

    Displacements of order L carry an error of one unit in the last place: relative to an element of length l
    it is a strain of L/l of it, hence a force of EA L/l (or kGA L/l, if that is part of the element and
    larger); and a turn of the chord of L/l of it, hence a force of 12 EI L/l^3. The factor 4 covers the few
    operations between them.
    """
    e = structure.elements
    length = max(strip.length for strip in structure.model.strips)
    axial = np.max(structure.law.force_rigidity * length / e.length) / structure.force_unit
    bending = np.max(12.0 * e.flexural_rigidity * length / e.length**3) / structure.force_unit
    return float(4.0 * np.finfo(float).eps * (axial + bending))


def equilibrate(control: Control, start: Array, parameter: float, counters: Counter[str]) -> Outcome:
    """Iterate from `start` to equilibrium at `parameter`, with the consistent tangent at every iteration."""
    structure, free = control.structure, control.free
    tolerance = max(TOLERANCE, round_off(structure))
    y, norms = start.copy(), []
    y[control.held] = control.prescribed(parameter)
    for _ in range(ITERATIONS + 1):
        counters["residual_evaluations"] += 1
        residual = control.residual(y, parameter)[free]
        norms.append(float(np.abs(residual / structure.scale[free]).max(initial=0.0)))
        if norms[-1] <= tolerance:
            return Outcome(y=y, norms=tuple(norms), failure="")
        if not np.isfinite(norms[-1]):
            return Outcome(y=y, norms=tuple(norms), failure="the residual is not finite")
        if len(norms) > ITERATIONS:
            break
        counters["newton_iterations"] += 1
        counters["tangent_evaluations"] += 1
        try:
            y[free] -= factorise(free_block(control, control.tangent(y, parameter)), counters).solve(residual)
        except RuntimeError:
            return Outcome(y=y, norms=tuple(norms), failure="the tangent is singular")
    return Outcome(y=y, norms=tuple(norms), failure=f"no equilibrium in {ITERATIONS} iterations")
