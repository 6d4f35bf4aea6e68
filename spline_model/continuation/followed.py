"""What a path needs of the system it is followed on: the bordered one, or any other with its own unknowns."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from spline_model import checks
from spline_model.bordered import evaluate, open_energy
from spline_model.compile import compile_scene
from spline_model.continuation.resolution import LARGEST_DEFECT, Resolution
from spline_model.effects import StrainEnergy, Stretching
from spline_model.newton import Newton, Workspace, getrf, getrs, solve
from spline_model.solution import Later

if TYPE_CHECKING:
    from spline_model.continuation.point import Point

Array = NDArray[np.float64]

Energies = tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class Followed(Workspace):
    """A system with its unknowns z (N,), of which the first ``count`` are coordinates.

    grows: whether its load factor is the share of weight and pre-strain that acts, while no load does.
    """

    grows: bool = False

    @property
    @abstractmethod
    def count(self) -> int:
        """Number of coordinates; behind them stand axial forces and multipliers."""

    @property
    @abstractmethod
    def driven(self) -> int | None:
        """Place in z of the driven rotation's torque, if there is one."""

    @abstractmethod
    def fill(self, z: Array, load_factor: float, share: float) -> Energies:
        """Fill gradient and hessian at z under a share of the preload; returns bending and axial energy."""

    @abstractmethod
    def external(self, z: Array) -> tuple[float, float]:
        """Work from rest to z of all loads at load factor 1, and of all weight."""

    @property
    @abstractmethod
    def push_of_loads(self) -> Array:
        """Minus the derivative of the gradient in the load factor (N,)."""

    @abstractmethod
    def refuse(self, z: Array) -> str:
        """Why a state that was just evaluated is no strip; empty if it is one."""

    @abstractmethod
    def defect(self, z: Array, load_factor: float) -> float:
        """The moment defect of a state (``continuation.resolution``)."""

    @abstractmethod
    def state(self, unknowns: Array) -> Array:
        """z of the scene's unknowns, whose clamps hold."""

    @abstractmethod
    def unknowns(self, z: Array) -> Array:
        """The scene's unknowns at z."""

    @abstractmethod
    def moved(self, z: Array, direction: Array) -> Array:
        """Change (Q,) of the scene's coordinates, dimensionless, with that of the ``count`` coordinates."""

    @abstractmethod
    def rows(self, points: Sequence[Point], done: Sequence[float]) -> dict[str, Any]:
        """What a ``Path`` has by state; done (S,): int P_lambda d(lambda) to each of the points."""

    def room(self) -> Self:
        """The same with a gradient and a tangent of its own."""
        return replace(self, gradient=np.empty_like(self.gradient), hessian=np.empty_like(self.hessian))

    def growing(self) -> Self:
        """The same with the share of weight and pre-strain as its load factor."""
        return replace(self, grows=True)

    def finer(self) -> Self:
        """The same scene with twice the Gauss points."""
        scene = self.system.scene
        effects = tuple(
            replace(e, gauss_points=2 * e.gauss_points) if isinstance(e, StrainEnergy) else e
            for e in scene.effects
        )
        return replace(self.of(compile_scene(replace(scene, effects=effects))), grows=self.grows)

    def unresolved(self, z: Array, load_factor: float) -> str:
        """Why the control points no longer describe the strips; empty if they do."""
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
        """Load factor proper and share of weight and pre-strain."""
        return (0.0, load_factor) if self.grows else (load_factor, 1.0)

    def evaluate(self, z: Array, load_factor: float) -> Energies:
        """Fill gradient and hessian at z; returns bending and axial energy, not a number where C' = 0."""
        self.counters.residual_evaluations += 1
        self.counters.tangent_evaluations += 1
        try:
            return self.fill(z, *self.acting(load_factor))
        except ZeroDivisionError:
            self.gradient[:] = np.nan
            return np.nan, np.nan

    def push(self, z: Array, load_factor: float) -> Array:
        """Minus the derivative of the gradient in the load factor at z, shape (N,).

        Exact: in a share of the preload the gradient is a square at most.
        """
        if not self.grows:
            return self.push_of_loads
        apart = self.room()
        apart.fill(z, 0.0, load_factor - 0.5)
        less = apart.gradient.copy()
        apart.fill(z, 0.0, load_factor + 0.5)
        return less - apart.gradient

    def potential(self, z: Array, load_factor: float, energies: Energies) -> float:
        """Energy of strips, dead weight and loads."""
        factor, share = self.acting(load_factor)
        loads, weight = self.external(z)
        return sum(energies) - factor * loads - share * weight

    def conjugate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """First and second derivative of the potential in the load factor, drives released."""
        if not self.grows:
            return float(-self.push_of_loads[self.count :] @ z[self.count :]) - self.external(z)[0], 0.0
        apart = self.room()
        less, here, more = (
            self.potential(z, at, apart.fill(z, 0.0, at))
            for at in (load_factor - 0.5, load_factor, load_factor + 0.5)
        )
        return more - less, 4.0 * (more + less - 2.0 * here)


@dataclass(frozen=True, kw_only=True, eq=False)
class Bordered(Followed):
    """The scene's own unknowns: coordinates (Q,), axial forces and multipliers."""

    @property
    def count(self) -> int:
        """Number of coordinates."""
        return self.system.layout.coordinate_count

    @property
    def driven(self) -> int | None:
        """Place of the driven rotation's torque, if there is one."""
        return self.system.scene.driven_row

    @cached_property
    def resolution(self) -> Resolution:
        """The balance of moments of the system."""
        return Resolution(self.system)

    def fill(self, z: Array, load_factor: float, share: float) -> Energies:
        """Gradient, tangent and energies [J] at z."""
        system = self.system
        if share != 1.0:
            points, weight = system.points.with_share(share), share * system.weight
            system = system.with_tables(points=points, weight=weight)
        bending, axial = evaluate(system, z, load_factor, self.gradient, self.hessian)
        return bending, axial

    def potential(self, z: Array, load_factor: float, energies: Energies) -> float:
        """Energy of strips, dead weight, loads and potentials in Python [J]."""
        return super().potential(z, load_factor, energies) + open_energy(self.system, z)

    def external(self, z: Array) -> tuple[float, float]:
        """Work from rest to z of loads and of weight [J]."""
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

    def refuse(self, z: Array) -> str:
        """Why a state is no strip."""
        return checks.refuse(self.system, z)

    def defect(self, z: Array, load_factor: float) -> float:
        """The moment defect of a state."""
        return self.resolution.defect(z, self.acting(load_factor)[1])

    def state(self, unknowns: Array) -> Array:
        """The same."""
        return unknowns

    def unknowns(self, z: Array) -> Array:
        """The same."""
        return z

    def moved(self, z: Array, direction: Array) -> Array:
        """The same."""
        return direction

    def rows(self, points: Sequence[Point], done: Sequence[float]) -> dict[str, Any]:
        """What a ``Path`` has by state."""
        states, factors = (np.array([getattr(p, name) for p in points]) for name in ("z", "load_factor"))
        layout, drives = self.system.layout, self.system.drives
        begin = layout.coordinate_count - 3 * len(layout.bodies)
        return {
            "load_factor": factors,
            "poses": states[:, begin : layout.coordinate_count],
            "reactions": states[:, drives.row],
            "unknowns": Later(states.copy),
            "stiffness": np.array([p.stiffness for p in points]),
            "energies": np.array([p.energies for p in points]),
            "done": np.array(done),
            "inertia": np.array([p.inertia for p in points]),
            "moment_defect": np.array([self.defect(p.z, p.load_factor) for p in points]),
        }


def correct(work: Followed, z: Array, load_factor: float, normal: Array, along: float) -> Newton:
    """Newton from (z, load factor), orthogonal to (normal (N,), along) in dimensionless unknowns.

    The bordered matrix is regular at a limit point, where the tangent is not. normal = 0 and
    along = 1 hold the load factor.
    """
    unit, energy, size = work.unit, work.energy, len(z)
    matrix, right = np.zeros((size + 1, size + 1)), np.zeros(size + 1)
    matrix[size, :size], matrix[size, size] = normal, along

    def change(z: Array, load_factor: float) -> tuple[Array, float]:
        matrix[:size, size] = -work.push(z, load_factor) * unit / energy
        matrix[:size, :size] = work.hessian * (unit[:, None] * unit / energy)
        right[:size] = -work.gradient * unit / energy
        work.counters.factorisations += 1
        factors, pivots, failed = getrf(matrix)
        if failed:
            raise np.linalg.LinAlgError("the bordered tangent is singular")
        found = getrs(factors, pivots, right)[0].ravel()
        return unit * found[:size], float(found[size])

    return solve(work, z, load_factor, change)
