"""How a structure is led along an equilibrium path, what is held and loaded, and Newton's method to it.

The path is followed in one parameter p. On a span p_0 to p_1 the held coordinates go linearly from their
values at its beginning to those at its end, and so does the load a F with its share a. The residual is
r = f(y) - a F, with f the gradient of the potential. While a scene settles, p is the share of gravity and
natural strains instead, and nothing else acts.

Strips and bodies can move rigidly along x, along y and about the origin. What the ends of strips, springs and
held coordinates leave free of this is the null space of their rows. As many coordinates more, the first ones
that the null space moves, are held and make a path determinate. In equilibrium they bear nothing.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.linalg import null_space

from .arrays import Array, Flags, Indices
from .effects import factor_of, twice
from .matrix import Factors, Singular
from .places import FREE, GROUND
from .read import InvalidParameter
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
class State:
    """Where the forces stand at coordinates and a parameter, and how an equilibrium changes along its path.

    Attributes:
        y (size,), parameter: coordinates and where.
        at: the structure there, whose gradient is the residual r, on the held coordinates what the drives
            exert, and whose tangent is d r / d y. potential: of all but loads that follow [J], without which
            its gradient is r.
        norms: of the residuals of Newton's method. failure: "" or why it ended. factors: of the tangent.
        rate: d y / d p (size,).
        conjugate, slope: first and second derivative of the total potential along the path [J].
        drive (H,): what has to be exerted on the held coordinates [N, N m].
        torque, stiffness: generalised force on the driven turn [N m] and its derivative [N m/rad], all that
            is not held being free; nan if no turn is driven.
        work: of loads and drives since the first state of the path [J].
    """

    y: Array
    parameter: float
    at: Evaluation
    potential: float
    norms: tuple[float, ...] = (0.0,)
    failure: str = ""
    factors: Factors | None = None
    rate: Array = field(default_factory=lambda: np.zeros(0))
    conjugate: float = 0.0
    slope: float = 0.0
    drive: Array = field(default_factory=lambda: np.zeros(0))
    torque: float = np.nan
    stiffness: float = np.nan
    work: float = 0.0

    @property
    def inertia(self) -> int:
        """Number of negative eigenvalues of the tangent on the free coordinates; 0: stable.

        Under loads that follow: 1 where its determinant is negative.
        """
        return 0 if self.factors is None else self.factors.negative


@dataclass(frozen=True, kw_only=True, eq=False)
class Control:
    """One span of a path.

    Args:
        structure: what is led, reduced about the centres of its bodies.
        held (H,): coordinates that are prescribed. values (2, H): at the beginning and the end of the span.
        span: parameter at both. load (K,): factors of the loads that make F, or None. shares: of it at both.
        watched: coordinate of the driven turn, whose torque and stiffness are reported, or None.
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
    shares: tuple[float, float] = (0.0, 1.0)
    props: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    @property
    def growth(self) -> float:
        """Rate of the load's share in p."""
        return (self.shares[1] - self.shares[0]) / (self.span[1] - self.span[0])

    def share(self, parameter: float) -> float:
        """Return the share of the load that acts at p."""
        return self.shares[0] + self.growth * (parameter - self.span[0])

    @cached_property
    def is_held(self) -> Flags:
        """Which coordinates are held (size,)."""
        return self.structure.flags(self.held)

    @cached_property
    def slope(self) -> Array:
        """Rate of the held coordinates in p, (H,) [m, rad]."""
        rate: Array = (self.values[1] - self.values[0]) / (self.span[1] - self.span[0])
        return rate

    @property
    def turning(self) -> bool:
        """Whether the watched rotation is driven on, not only held."""
        return self.watched in self.held[self.slope != 0.0]

    def prescribed(self, parameter: float) -> Array:
        """Return the values of the held coordinates at p, (H,) [m, rad], exact at both ends of the span."""
        part = (parameter - self.span[0]) / (self.span[1] - self.span[0])
        value: Array = (1.0 - part) * self.values[0] + part * self.values[1]
        return value

    def balance(self, y: Array, parameter: float) -> State:
        """Return the forces at coordinates y (size,) [m, rad] and parameter p [1], by one compiled call."""
        share, acts = parameter if self.settling else 1.0, self.share(parameter)
        at = self.structure.evaluate(y, share, load=self.load, acts=acts)
        potential = sum(at.strain) + at.spring + share * at.gravity - acts * at.work
        return State(y=y, parameter=parameter, at=at, potential=potential)

    def rates(self, y: Array, parameter: float) -> tuple[Array | None, Array | None, float, float]:
        """Return what p changes at fixed y: r and the gradient of the potential (size,), alike without
        followers, or None; the potential, once and twice [J]."""
        if self.settling:
            force, rate, bend = self.structure.share_rates(y)
            return force, force, rate + (parameter - 1.0) * bend, bend
        if self.load is None or self.growth == 0.0:
            return None, None, 0.0, 0.0
        dead, work = self.structure.load_force(y, self.load, dead=True)
        force = self.structure.load_force(y, self.load)[0] if self.structure.loads.follows else dead
        return -self.growth * force, -self.growth * dead, -self.growth * work, 0.0

    def factors(self, balance: State, grain: float = 0.0) -> Factors:
        """Return the factors of the tangent (size, size) [N/m, N, N m] on the free coordinates.

        Raises:
            Singular: the tangent is singular to round-off. `grain` [1] is as of `Symmetric.factors`.
        """
        return balance.at.tangent.factors(self.is_held, grain)

    def describe(self, parameter: float) -> str:
        """Return the name of the quantity that the parameter stands for, with its value and unit."""
        if self.settling:
            return f"{100.0 * parameter:.6g} % of {self.structure.constant_words}"
        if self.turning and (self.load is None or self.growth == 0.0):
            at = self.held.tolist().index(self.watched)
            return f"rotation {np.degrees(self.prescribed(parameter)[at]):.6g} deg"
        return f"load factor {self.share(parameter):.6g}"


def spans(
    structure: Structure, body: int | None, rotations: Sequence[float] | None, *, first: bool, starts: bool
) -> list[Control]:
    """Return the spans of a path on which a body is driven through `rotations` [rad], one leg each.

    Other drives and the load grow with the load factor over all legs. With `first` they grow in a leg
    of their own before the rotation, and then are constant; but a body that is led goes where both lead it.
    Drives are led to their ends, or to the begin of their histories if a motion `starts` there, and so are
    loads.

    Raises:
        InvalidParameter: a rotation that another drive prescribes too.
    """
    load = structure.loads.factors(0.0 if starts else None)
    led = structure.model.prescribed(body)
    moved = any(end for end, _ in led.values())
    before = first and any(rotations or ()) and load is not None and not moved
    turn = structure.body_slice(0 if body is None else body).stop - 1
    legs = max(len(rotations or ()), 1) + before
    parameters = [leg / legs for leg in range(legs + 1)]
    shares = [min(float(leg), 1.0) for leg in range(legs + 1)] if before else parameters
    ways: dict[int, Any] = {}
    for at, (end, effect) in led.items():
        begin = factor_of(effect.leads, 0.0) if starts and effect.leads else 1.0
        ways[structure.first_body + at] = np.multiply(shares, end * begin)
    if rotations is not None:
        if turn in ways:
            raise twice(structure.model.body_names, turn - structure.first_body)
        ways[turn] = [0.0] * (1 + before) + [*rotations]
    props = loose_coordinates(structure, ways)
    ways |= {int(k): [0.0] * (legs + 1) for k in props}
    values = np.reshape([*ways.values()], (-1, legs + 1)).T
    given: dict[str, Any] = {"structure": structure, "load": load, "props": props}
    given |= {"held": np.array([*ways], dtype=np.int64), "watched": None if rotations is None else turn}
    parts = zip(pairwise(parameters), pairwise(shares), pairwise(values), strict=True)
    return [Control(span=span, shares=share, values=np.array(ends), **given) for span, share, ends in parts]


def equilibrate(control: Control, start: Array, parameter: float, counters: Counter[str]) -> State:
    """Return the equilibrium at `parameter` by Newton's method with the consistent tangent.

    One compiled call gives residual and tangent. The state keeps the factors at the equilibrium; after a
    failure it has none.

    Args:
        start: reduced coordinates (size,) [m, rad] of the first iteration.
        parameter: load factor of the span [1].
        counter: counts iterations, evaluations and factorisations.
    """
    structure, y, norms, before, done = control.structure, start.copy(), [], np.inf, False
    while not done:
        y[control.held] = control.prescribed(parameter)
        counters.update(residual_evaluations=1, tangent_evaluations=1)
        found, factors = control.balance(y, parameter), None
        residual = np.where(control.is_held, 0.0, found.at.gradient)
        norms.append(float(np.abs(residual / structure.scale).max(initial=0.0)))
        failure = "" if np.isfinite(norms[-1]) else "the residual is not finite"
        if not failure:
            counters["factorisations"] += 1
            try:
                factors = control.factors(found)
            except Singular as error:
                failure = str(error)
        if factors is None:
            break
        last = factors.solve(found.at.gradient)
        size = structure.extent(last)
        done = size <= LAST or size > 0.5 * before
        if done:
            least = TOLERANCE * structure.scale + structure.round_off(found.at.tangent)
            done = bool((np.abs(residual) <= least).all())
        if size <= LAST or not done:
            y = y - last
        before = size
        if not done and len(norms) > ITERATIONS:
            done, factors, failure = True, None, f"no equilibrium in {ITERATIONS} iterations"
        if not done:
            counters["newton_iterations"] += 1
    return replace(found, y=y, norms=tuple(norms), failure=failure, factors=factors)


#: Largest part of a row of unit size that is round-off.
RIGID = 1e-9
#: Largest force over EI/L^2, or moment over EI/L, that is none, beside that part of the largest load.
NONE = 1e-8
DIRECTIONS = ("in the direction x", "in the direction y", "against turning")
UNITS = ("N", "N", "N m")


class NothingHolds(InvalidParameter):
    """A load along a rigid motion that nothing resists."""

    def __init__(self, body: str, axis: int, load: float) -> None:
        expected = f"none, or a clamp or a drive that bears it: nothing holds body {body} {DIRECTIONS[axis]}"
        super().__init__(f"load on body {body}", f"{load:.4g} {UNITS[axis]}", f"{expected} [{UNITS[axis]}]")


def loose_coordinates(structure: Structure, held: Iterable[int]) -> Indices:
    """Return coordinates of bodies that, held beside the `held` ones, leave no rigid motion free.

    Parts are the strips, then the bodies, and last the ground, which does not move.
    """
    model, strips = structure.model, len(structure.model.strips)
    ground = strips + len(model.bodies)

    def motions(part: int, point: Array) -> Array:
        """Return the rates (3, 3 parts) of a point [over L] and a turn in the rigid motions of its part."""
        rates, (x, y) = np.zeros((3, 3 * ground + 3)), point / structure.length
        rates[:, 3 * part : 3 * part + 3] = [[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]]
        return rates[:, : 3 * ground]

    # rates that ends of strips and springs resist
    ties = [np.zeros((0, 3 * ground))]
    for (strip, end), there in np.ndenumerate(model.ends):
        if there != FREE:
            place, on = model.rest[strip, -end], ground if there == GROUND else strips + int(there)
            resisted = 2 if model.strips[strip].hinges[end] else 3
            ties.append((motions(strip, place) - motions(on, place))[:resisted])
    (strip_links, rows, stiffnesses, _), centres = structure.links, np.vstack([model.centres, np.zeros(2)])
    for pair, stiffness in zip(
        structure.carriers[rows[strip_links:]] - structure.nodes, stiffnesses[strip_links:], strict=True
    ):
        one, other = (motions(strips + b, centres[b]) for b in pair)
        ties.append((one - other)[stiffness > 0.0])
    points = enumerate(structure.points, start=strips)
    rates = np.vstack([ties[0], *(motions(k, place) for k, place in points)])
    free = null_space(np.vstack([*ties, rates[[at - structure.first_body for at in held]]]), rcond=RIGID)
    chosen: list[int] = []
    for coordinate, row in enumerate(rates, start=structure.first_body):
        if np.abs(row @ free).max(initial=0.0) > RIGID:
            chosen.append(coordinate)
            free = free @ null_space((row @ free)[None], rcond=RIGID)
    return np.array(chosen, dtype=np.int64)


def require_balance(control: Control, residual: Array) -> None:
    """Check that coordinates that are held for want of anything else bear no force.

    Args:
        control: the last span of the path.
        residual: forces of the state (size,) [N, N m].

    Raises:
        NothingHolds: such a coordinate bears a force.
    """
    structure, load, rest = control.structure, control.load, np.zeros(control.structure.size)
    largest = 0.0 if load is None else float(np.abs(structure.load_force(rest, load)[0]).max())
    for k in control.props:
        if abs(residual[k]) > NONE * (structure.scale[k] + largest):
            body, axis = divmod(int(k) - structure.first_body, 3)
            raise NothingHolds(structure.model.body_names[body], axis, abs(float(residual[k])))
