"""The bordered system as one to follow paths on: coordinates, axial forces and multipliers of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model import checks
from spline_model.bordered import evaluate, open_energy
from spline_model.compile import System
from spline_model.continuation.followed import Energies, Followed
from spline_model.continuation.point import Point, driven_row
from spline_model.continuation.resolution import Resolution
from spline_model.solution import Later

Array = NDArray[np.float64]


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
        return driven_row(self.system)

    @cached_property
    def resolution(self) -> Resolution:
        """The balance of moments of the system."""
        return Resolution(self.system)

    def fill(self, z: Array, load_factor: float, share: float) -> Energies:
        """Gradient, tangent and energies [J] at z."""
        system = self.system if share == 1.0 else partial(self.system, share)
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
            "bodies": states[:, begin : layout.coordinate_count],
            "reactions": states[:, drives.row],
            "unknowns": Later(states.copy),
            "stiffness": np.array([p.stiffness for p in points]),
            "energies": np.array([p.energies for p in points]),
            "done": np.array(done),
            "inertia": np.array([p.inertia for p in points]),
            "moment_defect": np.array([self.defect(p.z, p.load_factor) for p in points]),
        }


def partial(system: System, share: float) -> System:
    """The system with a share of weight and pre-strain."""
    return system.with_tables(points=system.points.with_share(share), weight=share * system.weight)
