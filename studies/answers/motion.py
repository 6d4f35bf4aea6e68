"""The neutral answers to a release and to small motion: arrays that do not tell which model they are of."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from studies.answers.metrics import swing_frequency
from studies.answers.response import estimate_of

Array = NDArray[np.float64]

#: Arrays that a motion takes over from a model's trajectory as they are.
SHARED_ARRAYS = (
    "time",
    "kinetic_energy",
    "strain_energy",
    "gravity_energy",
    "work",
    "dissipated",
)
#: Those that a model may lack which keeps its constraints exactly, and everywhere.
RESIDUALS = ("constraint_residual", "velocity_residual")


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

    @property
    def seconds(self) -> Mapping[str, float]:
        """Time by part; "solve" is that of the steps alone."""


class ModesResult(Protocol):
    """What the modes of either model offer; see `Spectrum` for the arrays."""

    @property
    def held(self) -> bool:
        """Whether the body's rotation is held."""

    @property
    def frequency(self) -> Array:
        """Frequencies, ascending [Hz]."""

    @property
    def body_shapes(self) -> Array:
        """Displacement x, y and rotation of one or all bodies side by side, of unit modal mass."""


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Motion of a design after its release at rest, T records, the start first.

    Attributes:
        model: "spline", "fe" or "fe-shear".
        settings: discretisation keywords, integrator and step.
        status: "converged", "not_converged" or "unstable"; `message` says when and why it stopped.
        resolution: how far the step under-resolves the swing; empty when it resolves it.
        time: (T,) [s]; empty when statics does not reach the start.
        effects: names of what was assembled.
        bodies: (T, 3) by name: centre of mass x, y [m], rotation, counter-clockwise [rad]; a pivot's origin
            is A1.
        body: name of the one that swings: that was let go.
        kinetic_energy, strain_energy: (T,) of strips and bodies together [J].
        gravity_energy: (T,) against rest [J]; work, dissipated: (T,) by loads, and lost, since the start [J].
        constraint_residual: (T,) largest gap of clamps [m]; velocity_residual: (T,) its rate [m/s].
        counters: work done, by kind.
        wall_s: time of the motion alone, without the static path to its start [s].
        solve_s: of it, the steps alone [s].
        estimate: as in `Response`.
    """

    model: str
    settings: dict[str, Any]
    status: str
    message: str
    resolution: str
    effects: tuple[str, ...]
    time: Array
    bodies: dict[str, Array]
    body: str
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    velocity_residual: Array
    counters: dict[str, int]
    wall_s: float
    solve_s: float
    estimate: dict[str, Any] | None = None

    @property
    def converged(self) -> bool:
        """Whether the motion was followed to its end."""
        return self.status == "converged"

    @property
    def rotation(self) -> Array:
        """(T,) of the body that swings, counter-clockwise [rad]."""
        return self.bodies[self.body][:, 2]

    @property
    def centre(self) -> Array:
        """(T, 2) centre of mass of the body that swings [m]."""
        return self.bodies[self.body][:, :2]

    @property
    def energy_error(self) -> float:
        """Largest error of the balance of energies over the largest of its parts, the stored one at the
        start [1]; NaN without a record."""
        stored = self.kinetic_energy + self.strain_energy
        balance = stored + self.gravity_energy - self.work + self.dissipated
        if not len(balance):
            return float("nan")
        parts = (stored[:1], self.gravity_energy - self.gravity_energy[0], self.work, self.dissipated)
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0

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
        effects: names of what was assembled.
        frequency: (F,) [Hz]; negative where the state is unstable.
        body: name of the body that may be driven; None without one.
        body_shapes: (F, 3) its displacement x, y and rotation at unit modal mass.
        slide_frequency: frequencies that are left out because they are the discretisation's alone [Hz].
        wall_s: time of the static path to the state and of the modes [s].
    """

    model: str
    settings: dict[str, Any]
    status: str
    message: str
    effects: tuple[str, ...]
    rotation: float
    held: bool
    frequency: Array
    body: str | None
    body_shapes: Array
    slide_frequency: Array
    wall_s: float

    @property
    def converged(self) -> bool:
        """Whether there are modes: whether statics reached the state."""
        return self.status == "converged"


def motion(
    result: ReleaseResult,
    *,
    model: str,
    settings: dict[str, Any],
    effects: tuple[str, ...],
    bodies: Mapping[str, Array],
    body: str,
    wall_s: float,
    solve_s: float,
) -> Motion:
    """Return the neutral form of a model's trajectory; only some say how well they resolve the swing."""
    exact = np.zeros(len(result.time))
    arrays = {name: getattr(result, name) for name in SHARED_ARRAYS}
    arrays |= {name: getattr(result, name, exact) for name in RESIDUALS}
    return Motion(
        model=model,
        settings=settings | dict(result.settings),
        status=str(result.status.value),
        message=result.message,
        resolution=getattr(result, "resolution", ""),
        effects=effects,
        bodies={name: np.asarray(place, dtype=float) for name, place in bodies.items()},
        body=body,
        counters=dict(result.counters),
        wall_s=wall_s,
        solve_s=solve_s,
        estimate=estimate_of(result),
        **{name: np.asarray(array, dtype=float) for name, array in arrays.items()},
    )


def no_motion(
    message: str,
    *,
    model: str,
    settings: dict[str, Any],
    effects: tuple[str, ...],
    names: list[str],
    body: str,
) -> Motion:
    """Return the motion of bodies that statics does not bring to the start: without a record."""
    return Motion(
        model=model,
        settings=settings,
        status="not_converged",
        message=message,
        resolution="",
        effects=effects,
        bodies={name: np.zeros((0, 3)) for name in names},
        body=body,
        counters={},
        wall_s=0.0,
        solve_s=0.0,
        estimate=None,
        **{name: np.zeros(0) for name in (*SHARED_ARRAYS, *RESIDUALS)},
    )


def spectrum(
    result: ModesResult,
    *,
    model: str,
    settings: dict[str, Any],
    effects: tuple[str, ...],
    rotation: float,
    body: str | None,
    place: int,
    wall_s: float,
) -> Spectrum:
    """Return the neutral form of a model's modes; only a spline has slide modes.

    `place` is that of the body among those whose shapes the result holds side by side.
    """
    shapes = np.asarray(result.body_shapes, dtype=float)
    return Spectrum(
        model=model,
        settings=settings,
        status="converged",
        message="",
        effects=effects,
        rotation=rotation,
        held=result.held,
        frequency=np.asarray(result.frequency, dtype=float),
        body=body,
        body_shapes=shapes[:, 3 * place : 3 * place + 3],
        slide_frequency=np.asarray(getattr(result, "slide_frequency", ()), dtype=float),
        wall_s=wall_s,
    )


def no_spectrum(
    message: str,
    *,
    model: str,
    settings: dict[str, Any],
    effects: tuple[str, ...],
    rotation: float,
    held: bool,
    body: str | None,
) -> Spectrum:
    """Return the modes about a state that statics does not reach: none."""
    return Spectrum(
        model=model,
        settings=settings,
        status="not_converged",
        message=message,
        effects=effects,
        rotation=rotation,
        held=held,
        frequency=np.zeros(0),
        body=body,
        body_shapes=np.zeros((0, 3)),
        slide_frequency=np.zeros(0),
        wall_s=0.0,
    )
