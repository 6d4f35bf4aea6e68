"""The neutral answer to small motion: arrays that do not tell which model they are of."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from studies.answers.response import chosen_by, estimate_of
from studies.kinds import Array


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
        estimate: of the frequencies' error, by name; None of a model that was not asked for an accuracy.
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
    estimate: dict[str, Any] | None = None

    @property
    def converged(self) -> bool:
        """Whether there are modes: whether statics reached the state."""
        return self.status == "converged"


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
    if body is None:  # strips alone: there is nothing to move
        shapes = np.zeros((len(result.frequency), 3))
    return Spectrum(
        model=model,
        settings=settings | chosen_by(result),
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
        estimate=estimate_of(result),
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
