"""A mechanism of which one body is held in a pose, or in its rotation alone: ``HeldPivot``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.effects import Driven, DrivenDisplacement, DrivenRotation
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.newton import TOLERANCE
from spline_model.reduced.arrays import AXIAL, BENDING, FORCE, Answer, Arrays, Route
from spline_model.reduced.equilibrium import ITERATIONS, bear
from spline_model.reduced.model import Reduced, reduced, require_reduced
from spline_model.reduced.path import follow
from spline_model.reduced.preload import Preload
from spline_model.reduced.states import unknowns_of
from spline_model.strip.element import STRETCHING

Array = NDArray[np.float64]

LONGEST = 0.15, 0.15, 0.5
"""Shifts [lengths] and rotation [rad] of the body in one part of the way."""


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
        name = mechanism.design.body_named(body)
        shift = DrivenDisplacement(body=name, displacement=(0.0, 0.0))
        turn = DrivenRotation(body=name, angle=0.0)
        turned, grasped = (_model(mechanism, drives) for drives in ((turn,), (shift, turn)))
        self._model, self._turned, self._grasped = turned, turned.arrays(), grasped.arrays()
        self._preload, self._y = Preload.of(turned), turned.start.copy()
        held = grasped.bodies.held
        self._own, self._unit = slice(int(held[0]), int(held[2]) + 1), turned.system.scales.pose
        self.pose = self._y[self._own] * self._unit
        self._led: Arrays | None = None  # those that the state was led with; none behind ``restore``

    def reset(self) -> HeldState:
        """Return to rest, unloaded; return this state."""
        rest = self._model.start
        return self.restore(np.concatenate((rest[self._own] * self._unit, rest)))

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
        state = self._lead(self._grasped, target / self._unit, stable=True)
        if state.solved:
            self.pose[:] = state.pose[:] = target
        return state

    def turn(self, rotation: float) -> HeldState:
        """Hold only the rotation [rad], so that no force acts on the body's centre; return the state."""
        if not math.isfinite(rotation):
            raise InvalidParameter("rotation", rotation, "a finite number [rad]")
        return self._lead(self._turned, np.array([rotation]), stable=False)

    def _lead(self, arrays: Arrays, target: Array, *, stable: bool) -> HeldState:
        """Lead the held coordinates to ``target`` (D,) along a path of equilibria, of which nothing is kept
        but the whole; ``stable``: to the first state that is not."""
        held = arrays.bodies.held
        whole, longest = target - self._y[held], np.array(LONGEST)[-len(held) :]
        if self._led is arrays and not whole.any():
            return self._state(1.0, 0)
        parts = max(1, math.ceil((np.abs(whole) / longest).max()))
        route = Route(np.arange(parts + 1.0) / parts, self._y[held], whole, 0.0, passes=True)
        answer = Answer.empty(parts + 1, len(self._y), len(held))
        done = follow(self._y, route, False, self._preload, arrays, TOLERANCE, answer)
        if stable and answer.inertia[:done].any():
            done = int(np.argmax(answer.inertia > 0))
        if done > parts:
            self._y[:] = answer.y[-1]
            self._y[held], self._led = target, arrays
            self.pose[:] = self._y[self._own] * self._unit
        return self._state(max(done - 1, 0) / parts, int(answer.counters[ITERATIONS]))

    def _state(self, reached: float, iterations: int) -> HeldState:
        model, arrays, own = self._model, self._turned, self._own
        bear(self._y, arrays)
        space, others = arrays.space, self._grasped.bodies.free
        full, unit = space.tangent + space.tangent.T, self._unit / model.energy  # of an upper triangle
        full.flat[:: len(full) + 1] *= 0.5
        tangent = full[own, own]
        if len(others):  # which follow without a force
            across = full[others, own]
            tangent = tangent - across.T @ np.linalg.solve(full[np.ix_(others, others)], across)
        return HeldState(
            solved=reached == 1.0,
            reached=reached,
            pose=self.pose.copy(),
            force=space.vectors[FORCE, own] / unit,
            tangent=tangent / (self._unit[:, None] * unit),
            bending_energy=float(space.out[BENDING]) * model.energy,
            axial_energy=float(space.out[AXIAL]) * model.energy,
            iterations=iterations,
        )

    def full_state(self, system: System) -> Array:
        """Return the unknowns z (N,) [m, rad, N] of a compiled scene of the mechanism, with clamp
        reactions."""
        model = require_reduced(system)
        reaction = self._turned.space.vectors[FORCE, model.bodies.held]
        return np.asarray(unknowns_of(model, self._y[None], reaction[None])[0])


def _model(mechanism: Mechanism, drives: Sequence[Driven]) -> Reduced:
    """The mechanism with these drives; refused where more than strips and bodies acts."""
    system = compile_scene(mechanism.scene.with_effects(*drives))
    model = reduced(system)
    acts = system.is_preloaded or system.acting.value.any() or len(system.scene.of(Driven)) > len(drives)
    own = mechanism.design.bodies == () or len(system.scene.bodies) > len(mechanism.design.bodies)
    if model is None or acts or own or model.strips.numbers[:, STRETCHING].any():
        expected = "bodies on strips that bend and stretch, mixed form, no loads"
        raise InvalidParameter("mechanism", list(mechanism.effects), expected)
    return model
