"""The neutral answer to small motion: arrays that do not tell which model they are of."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.response import Answered, chosen_by, estimate_of
from studies.kinds import Array


@dataclass(frozen=True, kw_only=True)
class Spectrum(Answered):
    """Natural modes of small motion about a static state, F modes, the lowest first.

    Attributes:
        rotation: of the static state [rad]; held: whether it is held.
        frequency: (F,) [Hz]; negative where the state is unstable.
        body: name of the body that may be driven; None without one.
        body_shapes: (F, 3) its displacement x, y and rotation at unit modal mass.
        slide_frequency: frequencies that are left out because they are the discretisation's alone [Hz].
        wall_s: time of the static path to the state and of the modes [s].
        estimate: of the frequencies' error, by name; None of a model that was not asked for an accuracy.
    """

    rotation: float
    held: bool
    frequency: Array
    body: str | None
    body_shapes: Array
    slide_frequency: Array
    wall_s: float
    estimate: dict[str, Any] | None = None


def spectrum(result: Any, *, body: str | None, place: int, **identity: Any) -> Spectrum:
    """Return the neutral form of a model's modes; only a spline has slide modes.

    Args:
        place: that of the body among those whose shapes the result holds side by side.
        identity: model, settings, effects, rotation and time.
    """
    shapes = np.asarray(result.body_shapes, dtype=float)
    if body is None:  # strips alone: there is nothing to move
        shapes = np.zeros((len(result.frequency), 3))
    identity["settings"] = identity["settings"] | chosen_by(result)
    return Spectrum(
        status="converged",
        message="",
        solution=result,
        held=result.held,
        frequency=np.asarray(result.frequency, dtype=float),
        body=body,
        body_shapes=shapes[:, 3 * place : 3 * place + 3],
        slide_frequency=np.asarray(getattr(result, "slide_frequency", ()), dtype=float),
        estimate=estimate_of(result),
        **identity,
    )


def no_spectrum(message: str, **identity: Any) -> Spectrum:
    """Return the modes about a state that statics does not reach: none."""
    return Spectrum(
        status="not_converged",
        message=message,
        frequency=np.zeros(0),
        body_shapes=np.zeros((0, 3)),
        slide_frequency=np.zeros(0),
        wall_s=0.0,
        **identity,
    )
