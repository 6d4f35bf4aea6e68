"""Compute energies, section forces, reactions and stiffness from the states of a static path."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import ConvergenceError, InvalidParameter
from spline_model.reduced.model import from_unknowns, reduced, require_reduced
from spline_model.reduced.states import body_tangents
from spline_model.scene import AXES
from spline_model.sections import STATIONS, Sections, free_tips, reactions, sections
from spline_model.solution import (
    CriticalPoint,
    ErrorEstimate,
    Later,
    Status,
    Tabulated,
    body_columns,
    kept,
    resolution,
)

Array = NDArray[np.float64]

SINGULAR = 1e15
"""Condition of the rest, dimensionless, above which it does not follow."""


BY_STATE = (
    "load_factor",
    "poses",
    "reactions",
    "stiffness",
    "energies",
    "work",
    "inertia",
    "moment_defect",
)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StaticSolution(Tabulated):
    """Equilibrium path of a mechanism: S states, the unloaded one first, of G strips at P stations.

    Fields along the strips are computed at their first access.

    Attributes
    ----------
    system : System
        The assembled equations.
    load_factor : (S,) 1
        Share of the loads that acts, negative if they act in the opposite direction.
    poses : (S, 3 B) m and rad
        x, y, theta of the bodies.
    reactions : (S, D) N and N m
        Of the drives, as multipliers.
    unknowns : (S, N) m, rad and N
        z of all states.
    stiffness : (S,) N m/rad
        d(torque)/d(rotation) of a driven rotation (Eq 20) at fixed loads and driven displacements, from the
        tangent; nan without one.
    energies : (S, 2) J
        Bending and axial energy.
    work : (S,) J
        Of loads and drives since the first state.
    history : residual norms by increment, 1
    inertia : (S,)
        Negative eigenvalues of the reduced tangent with the drives held: 0 for a stable state, -1 if the
        published forces have no potential.
    moment_defect : (S,) 1
        Relative deviation of the strips' moments from balance (``continuation.followed``).
    critical_points : tuple of CriticalPoint
        In the order of the path.
    grown : float, 1
        Share of weight and pre-strain that finds an equilibrium. Below 1, the only state of the path is the
        shape at rest without them.
    effects : tuple of str
        Names of the assembled effects.
    balanced : bool
        Whether section forces are by balance, see ``Sections``.
    seconds : mapping of str to float, s
        By part, see ``spline_model.newton.Laps``.
    estimate : ErrorEstimate or None
        Of the error, if control points were chosen for an accuracy.
    asked : str or None
        Name of the reported body, if one was given.
    """

    system: System
    status: Status
    message: str
    load_factor: Array
    poses: Array
    reactions: Array
    unknowns: Later
    stiffness: Array
    energies: Array
    work: Array
    inertia: NDArray[np.int64]
    moment_defect: Array
    critical_points: tuple[CriticalPoint, ...]
    counters: dict[str, int]
    history: tuple[tuple[float, ...], ...]
    grown: float = 1.0
    effects: tuple[str, ...] = ()
    balanced: bool = False
    seconds: Mapping[str, float] = field(default_factory=dict)
    estimate: ErrorEstimate | None = None
    asked: str | None = None

    @property
    def settled(self) -> bool:
        """Whether the path begins under all of its weight and pre-strain."""
        return self.grown == 1.0

    @property
    def states(self) -> Array:
        """Unknowns z of all states (S, N) [m, rad, N]."""
        return self.unknowns.array

    def rows(self, kept: slice) -> Self:
        """Return the path of some of its states."""
        by_state = {name: getattr(self, name)[kept] for name in BY_STATE}
        return replace(self, unknowns=self.unknowns.rows(kept), **by_state)

    def followed_by(self, after: Self) -> Self:
        """Return this path and one that begins where it ends."""
        onward = after.rows(slice(1, None))
        by_state = {name: np.append(getattr(self, name), getattr(onward, name), axis=0) for name in BY_STATE}
        by_state["work"][len(self.work) :] += self.work[-1]
        return replace(
            after,
            system=self.system,
            message="; ".join(dict.fromkeys(m for m in (self.message, after.message) if m)),
            critical_points=self.critical_points + after.critical_points,
            counters={name: count + after.counters[name] for name, count in self.counters.items()},
            history=self.history + after.history,
            unknowns=self.unknowns.followed_by(onward.unknowns),
            **by_state,
        )

    def checked(self, raise_on_failure: bool) -> Self:
        """The answer itself; where it did not converge and that is asked for, ConvergenceError with it."""
        if raise_on_failure and self.status is not Status.CONVERGED:
            reached = float(self.load_factor[-1])
            raise ConvergenceError(self.message, solution=self, load_factor=reached, history=self.history)
        return self

    @property
    def control_points(self) -> int:
        """Control points of a segment of a strip."""
        return max((strip.basis.control_points for strip in self.system.scene.strips), default=0)

    @property
    def segments(self) -> int:
        """Segments of a strip."""
        return max((len(pieces) for pieces in self.system.scene.whole.values()), default=1)

    @cached_property
    def driven(self) -> str | None:
        """The body whose rotation is driven, if there is one."""
        turned = self.system.scene.turned
        return None if turned is None else turned.body

    @kept
    def bodies(self) -> dict[str, Array]:
        """Places x, y, theta (S, 3) of the bodies by name [m, m, rad]."""
        names = [body.name for body in self.system.scene.own_bodies]
        return {name: self.poses[:, 3 * i : 3 * i + 3] for i, name in enumerate(names)}

    @kept
    def torque(self) -> Array:
        """Torque on the body of the driven rotation (S,) [N m], lambda_13; nan without one."""
        driven = (self.driven, AXES[2])
        if driven not in self.prescribed:
            return np.full(len(self.work), np.nan)
        return np.asarray(self.reactions[:, self.prescribed.index(driven)])

    @cached_property
    def prescribed(self) -> tuple[tuple[str, str], ...]:
        """Body and "x", "y" or "rotation" of all coordinates that drives and supports prescribe, of which
        ``reactions`` (S, D) are the forces [N] and moments [N m] that have to act on the bodies."""
        drives, layout = self.system.drives, self.system.layout
        places = (layout.coordinate_of(int(at)) for at in drives.coordinate[self.system.prescribed])
        return tuple((name, AXES[axis]) for name, axis in places)

    @kept
    def tips(self) -> dict[str, Array]:
        """Place x, y [m] and turn since rest [rad] of the section at each free end (S, 3), by strip."""
        return free_tips(self.system, self.states)

    @property
    def bending_energy(self) -> Array:
        """Of the strips (S,) [J]."""
        return self.energies[:, 0]

    @property
    def axial_energy(self) -> Array:
        """Of the strips (S,) [J]."""
        return self.energies[:, 1]

    @property
    def shear_energy(self) -> Array:
        """Of the strips (S,) [J], zero: they are rigid in shear."""
        return np.zeros(len(self.work))

    @kept
    def spring_energy(self) -> Array:
        """Energy of the springs (S,) [J], zero without any."""
        return self.system.spring_energy(self.poses)

    @kept
    def gravity_energy(self) -> Array:
        """Potential of the dead weight against the state at rest (S,) [J]; zero without gravity."""
        system, weight = self.system, self.system.weight
        if not weight.size:
            return np.zeros(len(self.work))
        return np.asarray(-(self.states[:, : weight.size] - system.rest[: weight.size]) @ weight)

    @property
    def rotation(self) -> Array:
        """Rotation of the driven body, or of the only one (S,) [rad]."""
        return self._watched[:, 2]

    @property
    def centre(self) -> Array:
        """Centre of the driven body, or of the only one (S, 2) [m]."""
        return self._watched[:, :2]

    @kept
    def clamp_reactions(self) -> Array:
        """Return force [N] and moment [N m] of the clamps at root and tip of the strips (S, G, 2, 3)."""
        return reactions(self.system, self.states)

    @property
    def stations(self) -> Array:
        """Stations (P,) where sections are recovered: reference arc length over L [1]."""
        return STATIONS

    @cached_property
    def sections(self) -> Sections:
        """Shapes and section forces."""
        return sections(self.system, self.states, STATIONS, balanced=self.balanced)

    @property
    def shape(self) -> Array:
        """Points of the strips (S, G, P, 2) [m]."""
        return self.sections.shape

    @property
    def axial_force(self) -> Array:
        """N (S, G, P) [N]."""
        return self.sections.axial_force

    @property
    def bending_moment(self) -> Array:
        """M (S, G, P) [N m]."""
        return self.sections.bending_moment

    @property
    def shear_force(self) -> Array:
        """V (S, G, P) [N]."""
        return self.sections.shear_force

    def body_stiffness(self, body: str | None = None) -> Array:
        """Stiffness (S, 3, 3) of a body's x, y, theta about its centre [N/m, N, N m/rad].

        body: its name; None for the driven one, or the only one. Change of the force [N] and moment [N m] on
        it by its displacement [m] and turn [rad] in the axes of the ground, all loads fixed and all else in
        equilibrium: K_bb - K_br K_rr^-1 K_rb with the body's coordinates b and the rest r of the tangent,
        multipliers included. What drives the body is released, what drives others holds them. Exact for the
        discretisation; dead loads have a stiffness where they act beside centres. nan where a strip that
        cannot stretch leaves a direction none. Raises InvalidParameter for the published forces.
        """
        body = body or self._watched_name
        return self.own_stiffness if body == self.asked else self._stiffness_of(body)

    @kept
    def own_stiffness(self) -> Array:
        """Stiffness (S, 3, 3) [N/m, N, N m/rad] of the driven body or the only one, as ``body_stiffness``.

        nan without such a body, and for the published forces.
        """
        body = self.asked or self.driven or (next(iter(self.bodies)) if len(self.bodies) == 1 else None)
        if body is None or reduced(self.system) is None:
            return np.full((len(self.work), 3, 3), np.nan)
        return self._stiffness_of(body)

    def _stiffness_of(self, body: str) -> Array:
        """From the tangent at the bodies with the strips condensed, the Schur complement of all others on a
        body's coordinates."""
        model, y = require_reduced(self.system), self.unknowns.y
        y = from_unknowns(model, self.states) if y is None else y
        at = 3 * [each.name for each in model.system.scene.bodies].index(body)
        own, tangents = np.arange(at, at + 3), model.energy * body_tangents(model, y, self.load_factor)
        rest = np.delete(np.arange(tangents.shape[1]), [*own, *model.fixed])
        found = tangents[:, own[:, None], own]
        if rest.size:
            inner, beside = tangents[:, rest[:, None], rest], tangents[:, rest[:, None], own]
            # beside a unit, as all is of its order that is not round-off: one small number has no condition
            padded = np.pad(inner, ((0, 0), (0, 1), (0, 1)))
            padded[:, -1, -1] = model.energy
            regular = np.linalg.cond(padded, 1) < SINGULAR
            moves = np.linalg.solve(inner[regular], beside[regular])
            found[regular] -= beside[regular].swapaxes(1, 2) @ moves
            found[~regular] = np.nan
        unit = model.system.scales.pose
        return np.asarray(found / (unit[:, None] * unit))

    @property
    def resolution(self) -> str:
        """Empty, or how uncertain the control points make the answer: by its estimate, or by its moments."""
        return resolution(self.moment_defect) if self.estimate is None else self.estimate.remark

    @property
    def _watched(self) -> Array:
        return self.bodies[self._watched_name]

    @property
    def _watched_name(self) -> str:
        if self.driven is None and len(self.bodies) != 1:
            raise InvalidParameter("bodies", list(self.bodies), "one body, or the name of one in ``bodies``")
        return next(iter(self.bodies)) if self.driven is None else self.driven

    def columns(self) -> dict[str, Array]:
        """Return the columns of a frame: arrays (S,) of one number in every state, by names with units."""
        energies = ("bending_energy", "axial_energy", "gravity_energy", "work")
        return {
            "load_factor": self.load_factor,
            **body_columns(self.bodies),
            "torque_Nm": self.torque,
            "stiffness_Nm_per_rad": self.stiffness,
            **{f"{name}_J": getattr(self, name) for name in energies},
            "inertia": self.inertia,
            "moment_defect": self.moment_defect,
        }
