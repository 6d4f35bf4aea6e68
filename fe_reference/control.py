"""How a structure is led along an equilibrium path: what is held, what is loaded, and what is reported.

The path is followed in one parameter p. On a span p_0 to p_1 the held coordinates go linearly from their
values at its beginning to those at its end, and the load is p F. The residual is r = f(y) - p F, with f the
gradient of the potential. While a scene settles, p is the share of gravity and natural strains instead, and
nothing else acts.
"""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from .effects.loads import DeadLoad
from .stability import negative_eigenvalues
from .structure import Structure

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Control:
    """One span of a path.

    Args:
        structure: what is led, reduced about the centres of its bodies.
        held (H,): coordinates that are prescribed. values (2, H): at the beginning and the end of the span.
        span: parameter at both. load: F, or None.
        watched: coordinate of the turn whose torque and stiffness are reported, or None.
        settling: whether the parameter is the share of gravity and natural strains.
    """

    structure: Structure
    held: Indices
    values: Array
    span: tuple[float, float] = (0.0, 1.0)
    load: DeadLoad | None = None
    watched: int | None = None
    settling: bool = False

    @cached_property
    def free(self) -> Indices:
        """The coordinates that are not held."""
        return np.setdiff1d(np.arange(self.structure.size), self.held)

    @cached_property
    def slope(self) -> Array:
        """Rate of the held coordinates in p, (H,)."""
        rate: Array = (self.values[1] - self.values[0]) / (self.span[1] - self.span[0])
        return rate

    def prescribed(self, parameter: float) -> Array:
        """Return the values of the held coordinates at p, exact at both ends of the span."""
        part = (parameter - self.span[0]) / (self.span[1] - self.span[0])
        value: Array = (1.0 - part) * self.values[0] + part * self.values[1]
        return value

    def share(self, parameter: float) -> float:
        """Return the share of gravity and natural strains at p."""
        return parameter if self.settling else 1.0

    def residual(self, y: Array, parameter: float) -> Array:
        """Return r (size,) [N, N m]; on the held coordinates it is what the drives exert."""
        force = self.structure.internal_force(y, self.share(parameter))
        return force if self.load is None else force - parameter * self.load.generalised(y)

    def tangent(self, y: Array, parameter: float) -> csc_matrix:
        """Return d r / d y; loads act at centres and free ends, where they have no stiffness."""
        return self.structure.tangent_stiffness(y, self.share(parameter))

    def residual_rate(self, y: Array) -> Array | None:
        """Return d r / d p at fixed y (size,); None if it is zero."""
        if self.settling:
            return self.structure.share_force(y)
        return None if self.load is None else -self.load.generalised(y)

    def load_work(self, y: Array) -> float:
        """Return the work of the full load F from rest to y [J]."""
        return 0.0 if self.load is None else self.load.work(y)

    def potential(self, y: Array, parameter: float) -> float:
        """Return the total potential [J]: whose gradient is r."""
        return self.structure.potential(y, self.share(parameter)) - parameter * self.load_work(y)

    def potential_rate(self, y: Array, parameter: float) -> tuple[float, float]:
        """Return its first and second derivative in p at fixed y [J]."""
        if self.settling:
            return self.structure.share_energy(y, parameter)
        return -self.load_work(y), 0.0

    def describe(self, parameter: float) -> str:
        """Return what the parameter stands for, with its value."""
        if self.settling:
            return f"{100.0 * parameter:.6g} % of {self.structure.constant_words}"
        if self.watched is not None and self.held.tolist() == [self.watched] and self.load is None:
            return f"rotation {np.degrees(self.prescribed(parameter)[0]):.6g} deg"
        return f"load factor {parameter:.6g}"


def free_block(control: Control, tangent: csc_matrix) -> csc_matrix:
    """Return the block of the free coordinates."""
    free, many = control.free, len(control.free)
    if many == tangent.shape[0]:
        return tangent
    # as where the last body is driven: slices take a third of the time
    leading = many > 0 and free[-1] == many - 1
    block: csc_matrix = (tangent[:many, :many] if leading else tangent[:, free][free]).tocsc()
    return block


def factorise(block: csc_matrix, counters: Counter[str]) -> SuperLU:
    """Factorise the block of the free coordinates; raises RuntimeError if it is singular."""
    counters["factorisations"] += 1
    return splu(block, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})


@dataclass(frozen=True, kw_only=True, eq=False)
class Response:
    """How an equilibrium changes along its path.

    Attributes:
        rate: d y / d p (size,).
        conjugate, slope: first and second derivative of the total potential along the path [J].
        torque, stiffness: generalised force on the watched turn [N m] and its derivative [N m/rad], all that
            is not held being free; nan if no turn is watched.
        torque_rate: derivative of the torque in p [N m]; zero unless a watched turn is driven.
        inertia: number of negative eigenvalues of the tangent on the free coordinates; 0: stable.
    """

    rate: Array
    conjugate: float
    slope: float
    torque: float
    stiffness: float
    torque_rate: float
    inertia: int


def respond(control: Control, y: Array, parameter: float, counters: Counter[str]) -> Response:
    """Return the response at an equilibrium: one factorisation, one solve for each drive and for the load.

    The signs of the eigenvalues take another elimination, without pivots off the diagonal.

    What is left of the residual is carried to the drives by the same solve: to first order what they exert
    is that of exact equilibrium, free of the round-off in the last elements' forces.
    """
    residual, tangent = control.residual(y, parameter), control.tangent(y, parameter)
    counters["residual_evaluations"] += 1
    counters["tangent_evaluations"] += 1
    block, free, held = free_block(control, tangent), control.free, control.held
    lu = factorise(block, counters)
    moves = np.zeros((control.structure.size, len(held)))
    moves[held] = np.eye(len(held))
    if len(held):
        moves[free] = lu.solve(-tangent[:, held].toarray()[free])
    drive = moves.T @ residual
    stiffness = moves.T @ (tangent @ moves)  # errors of the solve enter squared
    rate, change = moves @ control.slope, control.residual_rate(y)
    first, second = control.potential_rate(y, parameter)
    if change is not None:
        rate[free] -= lu.solve(change[free])
        second += 2.0 * float(change @ rate)
    pushed, torque_rate = tangent @ rate, 0.0
    if control.watched is None:
        torque, turning = np.nan, np.nan
    elif control.watched in control.held:
        k = int(np.flatnonzero(held == control.watched)[0])
        torque, turning = float(drive[k]), float(stiffness[k, k])
        if control.slope[k] != 0.0:
            torque_rate = float(
                pushed[control.watched] + (0.0 if change is None else change[control.watched])
            )
    else:
        unit = (free == control.watched).astype(float)
        torque = float(control.structure.internal_force(y)[control.watched])
        turning = 1.0 / float(unit @ lu.solve(unit))
    return Response(
        rate=rate,
        conjugate=first + float(drive @ control.slope),
        slope=second + float(rate @ pushed),
        torque=torque,
        stiffness=turning,
        torque_rate=torque_rate,
        inertia=negative_eigenvalues(block),
    )
