"""The neutral answers to a release and to small motion: arrays that do not tell which model they are of."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from studies.answers.metrics import swing_frequency

Array = NDArray[np.float64]

#: Arrays that a motion takes over from a model's trajectory as they are.
SHARED_ARRAYS = (
    "time",
    "rotation",
    "centre",
    "kinetic_energy",
    "strain_energy",
    "constraint_residual",
    "velocity_residual",
)


class ReleaseResult(Protocol):
    """What the trajectory of either model offers; see `Motion` for the arrays."""

    @property
    def status(self) -> Any:
        """Enumeration of how the run ended; its value is "converged" unless it stopped early."""

    @property
    def message(self) -> str:
        """Why and when the run stopped; empty when it did not."""

    @property
    def time(self) -> Array:
        """Instants of the records, the start first [s]."""

    @property
    def counters(self) -> Mapping[str, int]:
        """Work done, by kind."""

    @property
    def settings(self) -> Mapping[str, Any]:
        """Integrator and step of the run."""


class ModesResult(Protocol):
    """What the modes of either model offer; see `Spectrum` for the arrays."""

    @property
    def rotation(self) -> float:
        """Rotation of the static state [rad]."""

    @property
    def held(self) -> bool:
        """Whether the body's rotation is held."""

    @property
    def frequency(self) -> Array:
        """Frequencies, ascending [Hz]."""

    @property
    def body_shapes(self) -> Array:
        """Displacement x, y and rotation of the body, of unit modal mass."""


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Motion of the body after its release at rest from a driven rotation, T records, the start first.

    Attributes:
        model: "spline", "fe" or "fe-shear".
        settings: discretisation keywords, integrator and step.
        status: "converged", "not_converged" or "unstable"; `message` says when and why it stopped.
        resolution: how far the step under-resolves the swing; empty when it resolves it.
        time: (T,) [s]; empty when statics does not reach the start.
        rotation: (T,) of the body, counter-clockwise [rad].
        centre: (T, 2) centre of mass of the body, origin at A1 [m].
        kinetic_energy, strain_energy: (T,) of strips and body together [J].
        constraint_residual: (T,) largest gap of clamps [m]; velocity_residual: (T,) its rate [m/s].
        counters: work done, by kind.
        wall_s: time of the motion alone, without the static path to its start [s].
    """

    model: str
    settings: dict[str, Any]
    status: str
    message: str
    resolution: str
    time: Array
    rotation: Array
    centre: Array
    kinetic_energy: Array
    strain_energy: Array
    constraint_residual: Array
    velocity_residual: Array
    counters: dict[str, int]
    wall_s: float

    @property
    def converged(self) -> bool:
        """Whether the motion was followed to its end."""
        return self.status == "converged"

    @property
    def energy_error(self) -> float:
        """Largest change of the energy, relative to that of the start [1]; NaN without a record."""
        energy = self.kinetic_energy + self.strain_energy
        return float(np.abs(energy / energy[0] - 1.0).max()) if len(energy) else float("nan")

    @property
    def frequency(self) -> float:
        """Frequency of the swing from the zero crossings of the rotation [Hz]; NaN with fewer than two."""
        return swing_frequency(self.time, self.rotation)


@dataclass(frozen=True, kw_only=True)
class Spectrum:
    """Natural modes of small motion about a static state, F modes, the lowest first.

    Attributes:
        model: "spline", "fe" or "fe-shear".
        settings: discretisation keywords.
        status: "converged" or "not_converged", when statics does not reach the state; `message` says where it
            stopped.
        rotation: of the static state [rad]; held: whether it is held.
        frequency: (F,) [Hz]; negative where the state is unstable.
        body_shapes: (F, 3) displacement x, y and rotation of the body at unit modal mass.
        slide_frequency: frequencies that are left out because they are the discretisation's alone [Hz].
        wall_s: time of the static path to the state and of the modes [s].
    """

    model: str
    settings: dict[str, Any]
    status: str
    message: str
    rotation: float
    held: bool
    frequency: Array
    body_shapes: Array
    slide_frequency: Array
    wall_s: float

    @property
    def converged(self) -> bool:
        """Whether there are modes: whether statics reached the state."""
        return self.status == "converged"


def motion(result: ReleaseResult, *, model: str, settings: dict[str, Any], wall_s: float) -> Motion:
    """Return the neutral form of a model's trajectory; only some say how well they resolve the swing."""
    return Motion(
        model=model,
        settings=settings | dict(result.settings),
        status=str(result.status.value),
        message=result.message,
        resolution=getattr(result, "resolution", ""),
        counters=dict(result.counters),
        wall_s=wall_s,
        **{name: np.asarray(getattr(result, name), dtype=float) for name in SHARED_ARRAYS},
    )


def no_motion(message: str, *, model: str, settings: dict[str, Any]) -> Motion:
    """Return the motion of a pivot that statics does not bring to the start: without a record."""
    arrays = {name: np.zeros((0, 2) if name == "centre" else 0) for name in SHARED_ARRAYS}
    return Motion(
        model=model,
        settings=settings,
        status="not_converged",
        message=message,
        resolution="",
        counters={},
        wall_s=0.0,
        **arrays,
    )


def spectrum(result: ModesResult, *, model: str, settings: dict[str, Any], wall_s: float) -> Spectrum:
    """Return the neutral form of a model's modes; only a spline has slide modes."""
    return Spectrum(
        model=model,
        settings=settings,
        status="converged",
        message="",
        rotation=result.rotation,
        held=result.held,
        frequency=np.asarray(result.frequency, dtype=float),
        body_shapes=np.asarray(result.body_shapes, dtype=float),
        slide_frequency=np.asarray(getattr(result, "slide_frequency", ()), dtype=float),
        wall_s=wall_s,
    )


def no_spectrum(
    message: str, *, model: str, settings: dict[str, Any], rotation: float, held: bool
) -> Spectrum:
    """Return the modes about a state that statics does not reach: none."""
    return Spectrum(
        model=model,
        settings=settings,
        status="not_converged",
        message=message,
        rotation=rotation,
        held=held,
        frequency=np.zeros(0),
        body_shapes=np.zeros((0, 3)),
        slide_frequency=np.zeros(0),
        wall_s=0.0,
    )
