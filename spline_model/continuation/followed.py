"""What a path is followed on: the scene's bordered system, or another one with its own unknowns.

And whether the control points resolve a state of it: bending moments by the law against those by balance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from spline_model import checks
from spline_model.basis import Bezier
from spline_model.compile import System
from spline_model.effects import Bending, Stretching
from spline_model.frames import Frames, carry, fold, spread
from spline_model.paper import RIGIDITY, SPEED, evaluate, strips_of
from spline_model.tables import Followers

Array = NDArray[np.float64]

LARGEST_DEFECT = 0.155
"""Largest moment defect of a state that is accepted: no formulation of the map of control points
exceeds it at a quarter turn. On the pivot of Table 1 it is reached near 108 degrees with four control
points and 197 with six, where the torque is wrong by 2 to 4 % and the stiffness by more; with four
a torque limit that the pivot has not follows at 137 degrees, and then another branch."""
SMALLEST_MOMENT = 1e-2
"""Root mean square moment below which strips count as unloaded, EI/L."""


def solved(matrix: Array, right_side: Array) -> Array:
    """Return the solution (N,) of a linear system (N, N), dimensionless; LinAlgError if it is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right_side))
    except np.linalg.LinAlgError:
        raise np.linalg.LinAlgError("the tangent is singular") from None


@dataclass(kw_only=True)
class _Counters:
    """Work that was done; the same on every machine."""

    increments: int = 0
    halved_increments: int = 0
    newton_iterations: int = 0
    residual_evaluations: int = 0
    tangent_evaluations: int = 0
    factorisations: int = 0


@dataclass(frozen=True, kw_only=True, eq=False)
class Point:
    """A converged state and its tangent in the parameter s of its path.

    z (N,); rate (N,) dz/ds and slope d(load factor)/ds: s is the load factor itself (slope 1)
    or the arc length; inertia: negative eigenvalues of the reduced tangent, drives held;
    turn (N,) dz/d(rotation) of the driven rotation at fixed load factor, None without one, and
    stiffness [N m/rad] d(torque)/d(rotation) of it, nan without one;
    energies (bending, axial) [J]; potential P [J], of which dP/d(load factor) = conjugate
    along any path of equilibria, and conjugate_rate = d(conjugate)/ds.
    """

    load_factor: float
    z: Array
    rate: Array
    slope: float
    turn: Array | None
    stiffness: float
    inertia: int
    energies: tuple[float, float]
    potential: float
    conjugate: float
    conjugate_rate: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Followed:
    """A system with its unknowns z (N,), of which the first ``count`` are coordinates, and arrays to fill.

    The unknowns are the scene's own: behind its coordinates stand axial forces and multipliers. Elements
    (``spline_model.reduced.elements``) have others. counters: of the work; grows: whether the load factor is
    the share of weight and pre-strain that acts, while no load does.
    """

    system: System
    gradient: Array
    hessian: Array
    counters: _Counters = field(default_factory=_Counters)
    grows: bool = False

    @classmethod
    def of(cls, system: System) -> Self:
        """Return fresh arrays for a system."""
        size = system.layout.size
        return cls(system=system, gradient=np.empty(size), hessian=np.empty((size, size)))

    @property
    def unit(self) -> Array:
        """Unit of each unknown (N,), which with that of energy makes residuals dimensionless."""
        return self.system.scales.unit

    @property
    def energy(self) -> float:
        """Unit of energy."""
        return self.system.scales.energy

    @property
    def count(self) -> int:
        """Number of coordinates."""
        return self.system.layout.coordinate_count

    @property
    def driven(self) -> int | None:
        """Place in z of the driven rotation's torque, if there is one."""
        return self.system.scene.driven_row

    def fill(self, z: Array, load_factor: float, share: float) -> tuple[float, float]:
        """Fill gradient and hessian at z (N,); return bending and axial energy [J].

        load_factor [1] of the loads; share [1] of the preload.
        """
        return evaluate(self.system, z, load_factor, self.gradient, self.hessian, share)

    def external(self, z: Array) -> tuple[float, float]:
        """Return the work from rest to z (N,) of all loads at load factor 1, and of all weight [J]."""
        loads, weight, moved = self.system.loads, self.system.weight, z - self.system.rest
        return float(moved[loads.coordinate] @ loads.value), float(moved[: weight.size] @ weight)

    @property
    def push_of_loads(self) -> Array:
        """Minus the derivative of the gradient in the load factor (N,)."""
        drives, loads = self.system.drives, self.system.loads
        force = np.zeros(self.system.layout.size)
        force[drives.row] = -drives.target
        np.add.at(force, loads.coordinate, loads.value)
        return force

    @property
    def followers(self) -> Followers:
        """Forces that turn with bodies, among the unknowns."""
        return self.system.followers

    @property
    def frames(self) -> Frames:
        """Frames that bodies carry, among the unknowns."""
        return self.system.frames

    def _arms(self, z: Array) -> Array:
        arms = np.empty_like(z)
        carry(z, self.frames, arms)
        return arms

    def along(self, z: Array, rate: Array) -> Array:
        """Return a rate (N,) of the unknowns at z (N,) [m, rad, N], with that of frames by their bodies."""
        if self.frames.place.size:
            spread(rate, self.frames, self._arms(z))
        return rate

    def refuse(self, z: Array) -> str:
        """Return why a state z (N,) [m, rad, N] that was just evaluated is no strip; empty if it is one."""
        return checks.refuse(self.system, z)

    def defect(self, z: Array, load_factor: float) -> float:
        """Return the moment defect [1] of a state z (N,) at a load factor (``moment_defect``)."""
        return moment_defect(self.system, z, self.acting(load_factor)[1])

    def state(self, unknowns: Array) -> Array:
        """Return z (N,) [m, rad, N] of the scene's unknowns (N,), whose clamps hold."""
        return unknowns

    def unknowns(self, z: Array) -> Array:
        """Return the scene's unknowns [m, rad, N] at z (N,) or (S, N)."""
        return z.copy()

    def moved(self, z: Array, direction: Array) -> Array:
        """Return the change (Q,) [1] of the scene's coordinates with that of the ``count`` ones at z (N,)."""
        del z  # they are the same ones
        return direction

    def rows(self, points: Sequence[Point], done: Sequence[float]) -> dict[str, Any]:
        """Return the arrays that a ``Path`` has by state, a row for each point.

        done (S,): int P_lambda d(lambda) to each of the S points [J].
        """
        by_state = ("z", "load_factor", "stiffness", "energies", "inertia")
        states, factors, stiffness, energies, inertia = (
            np.array([getattr(point, name) for point in points]) for name in by_state
        )
        return {
            "load_factor": factors,
            "poses": states[:, self.system.layout.poses],
            "reactions": states[:, self.system.drives.row],
            "z": states,
            "stiffness": stiffness,
            "energies": energies,
            "done": np.array(done),
            "inertia": inertia,
            "moment_defect": np.array([self.defect(p.z, p.load_factor) for p in points]),
        }

    def room(self) -> Self:
        """The same with a gradient and a tangent of its own."""
        return replace(self, gradient=np.empty_like(self.gradient), hessian=np.empty_like(self.hessian))

    def unresolved(self, z: Array, load_factor: float) -> str:
        """Return why the control points no longer describe the strips at z (N,); empty if they do.

        load_factor [1] is that of the state.
        """
        defect = self.defect(z, load_factor) if self.judged else 0.0
        if defect > LARGEST_DEFECT:
            return (
                "the control points do not resolve the strips any more: their moments differ from balance"
                f" by {defect:.0%}"
            )
        return ""

    @property
    def judged(self) -> bool:
        """Whether the moment defect refuses: stretching by quadrature, the paper's, shows what it does."""
        return not self.system.scene.of(Stretching)

    def acting(self, load_factor: float) -> tuple[float, float]:
        """Return load factor proper and share of weight and pre-strain [1]."""
        return (0.0, load_factor) if self.grows else (load_factor, 1.0)

    def evaluate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """Fill gradient and hessian at z (N,) and a load factor [1]; return bending and axial energy [J].

        Not a number where C' = 0: control points that coincide have neither tangent nor curvature.
        """
        self.counters.residual_evaluations += 1
        self.counters.tangent_evaluations += 1
        try:
            return self.fill(z, *self.acting(load_factor))
        except ZeroDivisionError:  # of kernels that run as Python
            self.gradient[:] = np.nan
            return np.nan, np.nan

    def norm(self) -> float:
        """Return the largest entry of the dimensionless residual [1]."""
        return float(np.abs(self.gradient * self.unit).max() / self.energy)

    def size(self, change: Array) -> float:
        """Return the largest entry of a change (N,) of the coordinates, in strip lengths and rad."""
        return float(np.abs(change / self.unit)[: self.count].max())

    def solve(self, right_side: Array) -> Array:
        """Return x of hessian x = right_side (N,) or (N, K), dimensionless inside.

        Raises LinAlgError if the hessian is singular.
        """
        unit, energy = self.unit, self.energy
        own = unit if right_side.ndim == 1 else unit[:, None]
        self.counters.factorisations += 1
        matrix = self.hessian * (unit[:, None] * unit / energy)
        if not np.isfinite(matrix).all():
            raise np.linalg.LinAlgError("the tangent is not finite")
        return own * solved(matrix, right_side * own / energy)

    def push(self, z: Array, load_factor: float) -> Array:
        """Return minus the derivative of the gradient in the load factor at z, shape (N,) [N, N m].

        Exact: in a share of the preload the gradient is a square at most.
        """
        if not self.grows:
            push = self.push_of_loads + self.followers.push(z)
            if self.frames.place.size:
                fold(push, self.frames, self._arms(z))
            return push
        apart = self.room()
        apart.fill(z, 0.0, load_factor - 0.5)
        less = apart.gradient.copy()
        apart.fill(z, 0.0, load_factor + 0.5)
        return less - apart.gradient

    def potential(self, z: Array, load_factor: float, energies: tuple[float, float]) -> float:
        """Return the energy of strips, springs, dead weight and loads at z (N,) and a load factor [J].

        energies: bending and axial energy of the strips there [J].
        """
        factor, share = self.acting(load_factor)
        loads, weight = self.external(z)
        return sum(energies) + self.in_springs(z) - factor * loads - share * weight

    def in_springs(self, z: Array) -> float:
        """Return the energy of the springs at z (N,) [J]."""
        return float(self.system.spring_energy(z[self.system.layout.poses]))

    def conjugate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """Return both derivatives [J] of the potential in the load factor at z (N,), drives released."""
        if not self.grows:
            return float(-self.push_of_loads[self.count :] @ z[self.count :]) - self.external(z)[0], 0.0
        apart = self.room()
        less, here, more = (
            self.potential(z, at, apart.fill(z, 0.0, at))
            for at in (load_factor - 0.5, load_factor, load_factor + 0.5)
        )
        return more - less, 4.0 * (more + less - 2.0 * here)


def moment_defect(system: System, z: Array, share: float = 1.0) -> float:
    """Return the root of the energy of the moment defect over the bending energy at z (N,); share: of the
    preload.

    The constitutive moment M = EI (kappa - kappa_0) satisfies the balance M_b, of the root's reaction and the
    weight, in the mean only; M - M_b is the discretisation error. Zero for the exact solution. Strips that
    are not clamped at their root are skipped. Source: Prager and Synge, Q Appl Math 5 (1947) 241: the error
    in energy of two dual fields.
    """
    strips = strips_of(system).with_share(share)
    moments, length = strips.moments(z), strips.weight * strips.along[..., SPEED]
    wrong, stored = 0.0, SMALLEST_MOMENT**2 * system.scales.energy
    for s, points, clamp, (values, where), load in system.once("strips in balance", _in_balance):
        ds, moment = length[s] / strips.along[s, :, RIGIDITY], moments[s]
        held = balance(z[points].reshape(-1, 2), values, where, z[clamp], share * load)
        wrong += float(ds @ (moment - held) ** 2)
        stored += float(ds @ moment**2)
    return math.sqrt(wrong / stored)


def balance(points: Array, values: Array, where: tuple[Bezier, Array], reaction: Array, load: Array) -> Array:
    """Return the bending moment (..., P) that holds the balance of a strip up to u (P,) [N m].

    points (..., n, 2); values (P, n): basis functions; where: basis and u; reaction (..., 3) of the clamp at
    the root; load (3, 2): parts of the weight per du with 1, u and u^2 [N].
    """
    here = values @ points
    arm, (x, y, moment) = here - points[..., :1, :], np.moveaxis(reaction, -1, 0)[..., None]
    held = arm[..., 0] * y - arm[..., 1] * x - moment
    basis, u = where
    for power, (x, y) in enumerate(load):
        if x or y:
            whole = u[:, None] ** (power + 1) / (power + 1)
            weighed = whole * here - basis.areas(u, power) @ points
            held += weighed[..., 0] * y - weighed[..., 1] * x
    return np.asarray(held)


def _in_balance(system: System) -> list[tuple[int, slice, slice, tuple[Array, Any], Array]]:
    """Of each strip that is clamped at its root: its number, places of its control points and of the clamp's
    multipliers, basis as ``balance`` takes it, and weight per du (3, 2) [N]."""
    scene, found = system.scene, []
    for s, bending in enumerate(scene.of(Bending)):
        strip = scene.strip(bending.strip)
        u, clamp = strip.basis.gauss_rule(bending.gauss_points)[0], scene.clamps.get((strip.name, "start"))
        if clamp is not None:
            basis = strip.basis.evaluate(u), (strip.basis, u)
            points, load = system.layout.strip(strip.name), scene.weight_of(strip.name)
            found.append((s, points, clamp, basis, load))
    return found
