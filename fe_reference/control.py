"""How a structure is led along an equilibrium path, what is held and loaded, and Newton's method to it.

The path is followed in one parameter p. On a span p_0 to p_1 the held coordinates go linearly from their
values at its beginning to those at its end, and so does the load a F, whose share a is p itself unless the
span says otherwise. The residual is r = f(y) - a F, with f the gradient of the potential. While a scene
settles, p is the share of gravity and natural strains instead, and nothing else acts.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .arrays import Array, Flags, Indices
from .freedom import loose_coordinates
from .matrix import GRAIN, Factors, Singular
from .structure import Evaluation, Structure

#: Newton's iterations of one increment; from a tangent predictor a sound increment takes one to four.
ITERATIONS = 25
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) taken as equilibrium where round-off allows
#: it.
TOLERANCE = 1e-10
#: Longest correction that equilibrium asks for [strip lengths, rad]; it is made. A longer one is round-off of
#: the residual over a stiffness that vanishes, if the next is no shorter.
LAST = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Balance:
    """Where the forces stand at coordinates and a parameter.

    Attributes:
        residual (size,): [N, N m]; on the held coordinates it is what the drives exert. at: the structure
            there, whose tangent is d r / d y: loads act at centres and free ends, where they have no
            stiffness. potential: whose gradient is r [J]. load_work: of the full load from rest [J].
    """

    residual: Array
    at: Evaluation
    potential: float
    load_work: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Control:
    """One span of a path.

    Args:
        structure: what is led, reduced about the centres of its bodies.
        held (H,): coordinates that are prescribed. values (2, H): at the beginning and the end of the span.
        span: parameter at both. load (size,): F, or None. shares: of it at both, by default the parameters.
        watched: coordinate of the turn whose torque and stiffness are reported, or None.
        settling: whether the parameter is the share of gravity and natural strains.
        props (P,): held coordinates that nothing else determines; in equilibrium they bear nothing.
    """

    structure: Structure
    held: Indices
    values: Array
    span: tuple[float, float] = (0.0, 1.0)
    load: Array | None = None
    watched: int | None = None
    settling: bool = False
    shares: tuple[float, float] | None = None
    props: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    @property
    def growth(self) -> float:
        """Rate of the load's share in p."""
        shares = self.span if self.shares is None else self.shares
        return (shares[1] - shares[0]) / (self.span[1] - self.span[0])

    def share(self, parameter: float) -> float:
        """Return the share of the load that acts at p."""
        return parameter if self.shares is None else self.shares[0] + self.growth * (parameter - self.span[0])

    @cached_property
    def is_held(self) -> Flags:
        """Which coordinates are held (size,)."""
        return self.structure.flags(self.held)

    @cached_property
    def free(self) -> Indices:
        """The coordinates that are not held."""
        return np.flatnonzero(~self.is_held)

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

    def balance(self, y: Array, parameter: float) -> Balance:
        """Return the forces at y and p, by one compiled call."""
        share = parameter if self.settling else 1.0
        here = self.structure.evaluate(y, share)
        residual, potential, work = here.gradient, sum(here.strain) + share * here.gravity, 0.0
        if self.load is not None:
            work = float(self.load @ y)
            acts = self.share(parameter)
            residual, potential = residual - acts * self.load, potential - acts * work
        return Balance(residual=residual, at=here, potential=potential, load_work=work)

    def unbalanced(self, residual: Array) -> float:
        """Return the largest residual of the free coordinates, forces over EI/L^2, moments over EI/L."""
        return float(np.abs(residual / self.structure.scale)[self.free].max(initial=0.0))

    def is_round_off(self, balance: Balance) -> bool:
        """Return whether every residual is below `TOLERANCE`, or below the round-off of its own terms."""
        structure = self.structure
        least = TOLERANCE * structure.scale + structure.round_off(balance.at.tangent)
        return bool((np.abs(balance.residual) <= least)[self.free].all())

    def rates(self, y: Array, parameter: float, load_work: float) -> tuple[Array | None, float, float]:
        """Return what p changes at fixed y: r (size,) or None; the potential, once and twice [J]."""
        if self.settling:
            force, rate, bend = self.structure.share_rates(y)
            return force, rate + (parameter - 1.0) * bend, bend
        if self.load is None or self.growth == 0.0:
            return None, 0.0, 0.0
        return -self.growth * self.load, -self.growth * load_work, 0.0

    def factors(self, balance: Balance, grain: float = 0.0) -> Factors:
        """Return the factors of the tangent on the free coordinates; raises `matrix.Singular`."""
        return balance.at.tangent.factors(self.is_held, grain)

    def describe(self, parameter: float) -> str:
        """Return what the parameter stands for, with its value."""
        if self.settling:
            return f"{100.0 * parameter:.6g} % of {self.structure.constant_words}"
        turning = self.watched is not None and self.watched in self.held[self.slope != 0.0]
        if turning and (self.load is None or self.growth == 0.0):
            at = self.held.tolist().index(self.watched)
            return f"rotation {np.degrees(self.prescribed(parameter)[at]):.6g} deg"
        return f"load factor {self.share(parameter):.6g}"


def spans(
    structure: Structure,
    *,
    body: int | None = None,
    rotations: Sequence[float] | None = None,
    displacement: Sequence[float | None] | None = None,
    led: int | None = None,
    load: Array | None = None,
    watched: int | None = None,
    first: bool = False,
) -> list[Control]:
    """Return the spans of a path on which a body is led through `rotations` [rad], one leg each.

    The displacement [m] of the centre of that body, or of the `led` one, None where it is free, and the load
    grow with the load factor over all legs, or `first`: in a leg of their own before the rotation, and then
    they stay.
    """
    at = structure.body_slice(0 if body is None else body).start
    centre = structure.body_slice(led).start if led is not None else at
    legs = max(len(rotations or ()), 1) + first
    parameters = [leg / legs for leg in range(legs + 1)]
    shares = [min(float(leg), 1.0) for leg in range(legs + 1)] if first else parameters
    ways = {centre + k: np.multiply(shares, d) for k, d in enumerate(displacement or ()) if d is not None}
    if rotations is not None:
        ways[at + 2] = np.array([0.0] * (1 + first) + [*rotations])
    props = loose_coordinates(structure, ways)
    ways |= {int(k): np.zeros(legs + 1) for k in props}
    values = np.reshape([*ways.values()], (-1, legs + 1)).T
    return [
        Control(
            structure=structure,
            held=np.array([*ways], dtype=np.int64),
            values=values[leg : leg + 2],
            span=(parameters[leg], parameters[leg + 1]),
            load=load,
            watched=watched,
            shares=(shares[leg], shares[leg + 1]),
            props=props,
        )
        for leg in range(legs)
    ]


@dataclass(frozen=True, kw_only=True, eq=False)
class Outcome:
    """What Newton's method left.

    Attributes:
        y, parameter: coordinates and where. norms: of the residuals. failure: "" or the reason.
        balance, factors: at the last iterate; no factors after a failure.
    """

    y: Array
    parameter: float
    norms: tuple[float, ...]
    failure: str
    balance: Balance
    factors: Factors | None = None


def equilibrate(control: Control, start: Array, parameter: float, counters: Counter[str]) -> Outcome:
    """Iterate from `start` to equilibrium at `parameter`, with the consistent tangent at every iteration.

    One compiled call gives residual and tangent; the factors at the equilibrium serve what is asked there.
    """
    y, norms, before = start.copy(), [], np.inf
    while True:
        y[control.held] = control.prescribed(parameter)
        for counted in ("residual_evaluations", "tangent_evaluations"):
            counters[counted] += 1
        balance, factors = control.balance(y, parameter), None
        norms.append(control.unbalanced(balance.residual))
        failure = "" if np.isfinite(norms[-1]) else "the residual is not finite"
        if not failure:
            counters["factorisations"] += 1
            try:
                factors = control.factors(balance)
            except Singular as error:
                failure = str(error)
        done = factors is None
        if factors is not None:
            last = factors.solve(balance.residual)
            size = float(np.abs(control.structure.measure * last).max(initial=0.0))
            done = (size <= LAST or size > 0.5 * before) and control.is_round_off(balance)
            if size <= LAST or not done:
                y = y - last
            before = size
            if not done and len(norms) > ITERATIONS:
                done, factors, failure = True, None, f"no equilibrium in {ITERATIONS} iterations"
        if done:
            return Outcome(
                y=y,
                parameter=parameter,
                norms=tuple(norms),
                failure=failure,
                balance=balance,
                factors=factors,
            )
        counters["newton_iterations"] += 1


def taken(control: Control, y: Array, parameter: float) -> Outcome:
    """Return coordinates that are in equilibrium as such; raises Singular."""
    balance = control.balance(y, parameter)
    factors = control.factors(balance, GRAIN)
    return Outcome(y=y, parameter=parameter, norms=(0.0,), failure="", balance=balance, factors=factors)
