"""A mechanism of which one body is held in a pose, or in its rotation alone: ``HeldPivot``."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.newton import TOLERANCE
from spline_model.reduced.arrays import AXIAL, BENDING, FORCE, Answer, Arrays, Route
from spline_model.reduced.equilibrium import ITERATIONS, bear
from spline_model.reduced.model import Reduced, reduced
from spline_model.reduced.path import follow
from spline_model.reduced.preload import Preload
from spline_model.reduced.states import unknowns_of
from spline_model.strip.element import STRETCHING

Array = NDArray[np.float64]

LONGEST_TURN, LONGEST_SHIFT = 0.5, 0.15
"""Rotation [rad] and shift [lengths] of the body in one part of the way."""
LEAST_HELD_COMPLIANCE = 1e-9
"""Axial compliance in L^2/EI below which a strip cannot follow a pose (beyond a slenderness of 9000)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldState:
    """A static state of a held body; G strips of n control points.

    Attributes
    ----------
    solved : bool
        Whether the wanted pose was reached; if not, the state is the previous one.
    reached : float, 1
        Fraction of the way that was solved.
    pose : (3,) m, m and rad
        x, y, theta of the body.
    force : (3,) N, N and N m
        That holds the body; the moment is about its centre.
    tangent : (3, 3) N/m, N and N m
        Derivative of the force by the pose.
    bending_energy, axial_energy : float, J
    iterations : int
        Of Newton's method in this call.
    """

    solved: bool
    reached: float
    pose: Array
    force: Array
    tangent: Array
    bending_energy: float
    axial_energy: float
    iterations: int


class HeldPivot:
    """Static states of a mechanism in which one body is held, each found from the one before.

    ``hold`` prescribes x, y and theta (a body in the hand), ``turn`` theta alone. A call that finds no
    equilibrium in a bounded number of iterations, or held strips that buckle, leaves the state as it was and
    reports this in the state that it returns.

    Parameters
    ----------
    mechanism : Mechanism
        Bodies on strips; those beside the held one are free.
    body : str, default None
        The held body; None for that of the case.

    Raises
    ------
    InvalidParameter
        A mechanism that the elements of the strips do not support.

    Notes
    -----
    Exact for the discretised equations to TOLERANCE, as the path with the same drives is; neglects gravity
    and loads.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7 and section 4.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> print(f"{HeldPivot(pivot).turn(0.1).force[2]:.4f} N m")
    0.0537 N m
    """

    def __init__(self, mechanism: Mechanism, body: str | None = None) -> None:
        model = _held_model(mechanism, body)
        if model is None:
            expected = "bodies on strips that bend and stretch, mixed form, no loads"
            raise InvalidParameter("mechanism", list(mechanism.effects), expected)
        self.model = model
        self._arrays = model.arrays()
        self._y = model.start.copy()
        self._rest, self._preload = self._y.copy(), Preload.of(model)
        turn = int(model.bodies.held[0])
        self._own = own = slice(turn - 2, turn + 1)
        every = np.arange(len(model.bodies.rest))
        self._longest = np.where(every % 3 == 2, LONGEST_TURN, LONGEST_SHIFT)
        others = np.delete(every, own)
        grasped = replace(model, bodies=model.bodies._replace(free=others, held=every[own], driven=-1))
        self._grasped = grasped.arrays()
        self.pose = self._y[own] * self._unit
        self._led: Arrays | None = None  # those that the state was led with; none behind ``restore``
        self.reset()

    @property
    def _unit(self) -> Array:
        return self.model.system.scales.pose

    def reset(self) -> HeldState:
        """Return to rest, unloaded; return this state."""
        return self.restore(np.concatenate((self._rest[self._own] * self._unit, self._rest)))

    @property
    def unknowns(self) -> Array:
        """Return a copy of the unknowns (N,), dimensionless, for ``restore``."""
        return np.concatenate((self.pose, self._y))

    def restore(self, unknowns: Array) -> HeldState:
        """Return to the state of ``unknowns`` (N,) [m, rad, N]; return this state."""
        self.pose[:], self._y[:], self._led = unknowns[:3], unknowns[3:], None
        return self._state(1.0, 0)

    def hold(self, x: float, y: float, rotation: float) -> HeldState:
        """Hold the body's centre at (x, y) [m] and its rotation [rad]; return the state."""
        target = np.array([x, y, rotation])
        if not np.isfinite(target).all():
            raise InvalidParameter("pose", [x, y, rotation], "finite numbers [m, m, rad]")
        reached, iterations = self._lead(self._grasped, target / self._unit, stable=True)
        if reached == 1.0:
            self.pose[:] = target
        return self._state(reached, iterations)

    def turn(self, rotation: float) -> HeldState:
        """Hold only the rotation [rad], so that no force acts on the body's centre; return the state."""
        if not math.isfinite(rotation):
            raise InvalidParameter("rotation", rotation, "a finite number [rad]")
        reached, iterations = self._lead(self._arrays, np.array([rotation]), stable=False)
        self.pose[:] = self._y[self._own] * self._unit
        return self._state(reached, iterations)

    def _lead(self, arrays: Arrays, target: Array, *, stable: bool) -> tuple[float, int]:
        """Lead the held coordinates to ``target`` (D,) along a path of equilibria; the fraction of the way
        that was solved, of which nothing is kept but the whole, and Newton's iterations."""
        held = arrays.bodies.held
        whole, longest = target - self._y[held], self._longest[held]
        if self._led is arrays and not whole.any():
            return 1.0, 0
        parts = max(1, math.ceil((np.abs(whole) / longest).max()))
        route = Route(np.arange(parts + 1.0) / parts, self._y[held], whole, 0.0, passes=not stable)
        answer = Answer.empty(parts + 1, len(self._y), len(held))
        given = route, False, self._preload, arrays, TOLERANCE, answer
        done = follow(self._y, *given)
        if stable and answer.inertia[:done].any():
            done = 0
        if done > parts:
            self._y[:] = answer.y[-1]
            self._y[held], self._led = target, arrays
        return max(done - 1, 0) / parts, int(answer.counters[ITERATIONS])

    def _state(self, reached: float, iterations: int) -> HeldState:
        model, space = self.model, self._arrays.space
        bear(self._y, self._arrays)
        units, full = 1.0 / self._unit, space.tangent + space.tangent.T  # of an upper triangle
        full.flat[:: len(full) + 1] *= 0.5
        own, others = self._own, self._grasped.bodies.free
        tangent = full[own, own]
        if len(others):  # which follow without a force
            across = full[others, own]
            tangent = tangent - across.T @ np.linalg.solve(full[np.ix_(others, others)], across)
        return HeldState(
            solved=reached == 1.0,
            reached=reached,
            pose=self.pose.copy(),
            force=space.vectors[FORCE, self._own] * units * model.energy,
            tangent=tangent * (units[:, None] * units * model.energy),
            bending_energy=float(space.out[BENDING]) * model.energy,
            axial_energy=float(space.out[AXIAL]) * model.energy,
            iterations=iterations,
        )

    @property
    def control_points(self) -> Array:
        """Return the control points of the strips in the ground's frame (G, n, 2) [m]."""
        shape, points = self.model.shape, self._arrays.local.points
        ordered = np.empty((len(points), len(shape.order), 2))
        ordered[:, shape.order] = points.reshape(ordered.shape) * self.model.length
        return ordered

    def full_state(self, system: System) -> Array:
        """Return the unknowns z (N,) [m, rad, N] of a compiled scene of the mechanism, with clamp
        reactions."""
        model = reduced(system)
        assert model is not None, "the scene of a held mechanism"
        reaction = self._arrays.space.vectors[FORCE, model.bodies.held]
        return np.asarray(unknowns_of(model, self._y[None], reaction[None])[0])


def _held_model(mechanism: Mechanism, body: str | None) -> Reduced | None:
    """The mechanism with a body's rotation driven; all axial forces are the strips' own."""
    if mechanism.design.discretisation.segments != 1:
        return None
    system = compile_scene(mechanism.driven(1.0, body))
    model = reduced(system)
    if model is None or model.strips.numbers[:, STRETCHING].any():
        return None
    if (model.strips.compliance < LEAST_HELD_COMPLIANCE).any():
        return None
    bodies, count = model.bodies, 3 * len(mechanism.design.bodies)
    if system.is_preloaded or system.acting.value.any() or len(bodies.held) != 1 or len(bodies.rest) != count:
        return None
    return replace(
        model,
        strips=model.strips._replace(outer=0),
        bodies=bodies._replace(
            load=bodies.load[:count],
            weight=bodies.weight[:count],
            free=np.setdiff1d(np.arange(count), bodies.held),
        ),
    )
