"""The neutral static answer of any mechanism: arrays that do not tell which model they came from."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from studies.answers.response import Critical, StaticResult, assembled, chosen_by, critical_of, estimate_of
from studies.kinds import Array

#: Arrays that a response takes over from a model's solution as they are.
SHARED_ARRAYS = (
    "load_factor",
    "torque",
    "stiffness",
    "bending_energy",
    "axial_energy",
    "gravity_energy",
    "work",
)


@dataclass(frozen=True, kw_only=True)
class MechanismResponse:
    """Static answer of a mechanism over S converged states, that of load factor 0 first.

    Attributes:
        model, settings, status, message, resolution, critical_points, counters, wall_s, solve_s, estimate:
            as in `Response`.
        effects: names of what was assembled.
        load_factor: (S,) [1].
        bodies: (S, 3) by name: centre of mass x, y [m], rotation, counter-clockwise [rad].
        torque: (S,) driving torque [N m]; stiffness: (S,) its derivative [N m / rad]; NaN where nothing is
            driven.
        bending_energy, axial_energy: (S,) of all strips [J]; shear_energy: (S,) zero without shear [J].
        gravity_energy: (S,) against rest [J]; work: (S,) of loads and drives since the first state [J].
    """

    model: str
    settings: dict[str, Any]
    effects: tuple[str, ...]
    status: str
    message: str
    resolution: str
    critical_points: tuple[Critical, ...]
    load_factor: Array
    bodies: dict[str, Array]
    torque: Array
    stiffness: Array
    bending_energy: Array
    axial_energy: Array
    shear_energy: Array
    gravity_energy: Array
    work: Array
    counters: dict[str, int]
    wall_s: float
    solve_s: float
    estimate: dict[str, Any] | None = None

    @property
    def converged(self) -> bool:
        """Whether the whole path was reached."""
        return self.status == "converged"

    @property
    def strain_energy(self) -> Array:
        """(S,) bending, axial and shear energy together [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy


class MechanismResult(StaticResult, Protocol):
    """What the solution of either model offers; see `MechanismResponse` for the arrays."""

    @property
    def bodies(self) -> Mapping[str, Array]:
        """Places of the bodies by name."""

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of what was assembled."""


def mechanism_response(
    result: MechanismResult, *, model: str, settings: dict[str, Any], wall_s: float, solve_s: float
) -> MechanismResponse:
    """Return the neutral form of a model's `result`; only elements with shear have its energy."""
    arrays = {name: np.asarray(getattr(result, name), dtype=float) for name in SHARED_ARRAYS}
    shear = getattr(result, "shear_energy", np.zeros_like(arrays["work"]))
    return MechanismResponse(
        model=model,
        settings=settings | chosen_by(result),
        effects=assembled(result.effects),
        status=str(result.status.value),
        message=result.message,
        resolution=getattr(result, "resolution", ""),
        critical_points=critical_of(result),
        bodies={name: np.asarray(place, dtype=float) for name, place in result.bodies.items()},
        shear_energy=np.asarray(shear, dtype=float),
        counters=dict(result.counters),
        wall_s=wall_s,
        solve_s=solve_s,
        estimate=estimate_of(result),
        **arrays,
    )
