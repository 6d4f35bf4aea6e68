"""What the strips' elements know of a design, as complex numbers: value + i STEP x its derivative."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design
from spline_model.reduced.model import Reduced
from spline_model.sensitivity.parameters import Rates

Array = NDArray[Any]

STEP = 1e-40
"""Its square is beyond any round-off."""


class Varied(NamedTuple):
    """What of ``Strips`` knows the design, (..., G, P, 1) each: by P parameters, the same at all states.

    speed, rigidity (Q, ...), stretching; compliance (2, ...) of stretching and sliding; frames (2, 3, ...)
    of root and tip; reach (2, ...), away from the clamp; dead (n, 2, ...); area [m^2], second_moment [m^4];
    longer: the length over that of the design. All else is over L and EI/L of the design.
    """

    speed: Array
    rigidity: Array
    stretching: Array
    compliance: Array
    frames: Array
    reach: Array
    dead: Array
    area: Array
    second_moment: Array
    longer: Array


def varied_strips(model: Reduced, design: Design, rates: Rates) -> Varied:
    """The strips of a design, which ``model`` is of."""
    strips, step = model.strips, 1j * STEP
    given = np.array([(s.area, s.second_moment_of_area, s.youngs_modulus) for s in design.strips])
    area, second_moment, modulus = 1.0 + step * (rates.section / given).T[..., None]
    lengthening, turning = (each.T[..., None] for each in rates.by_length(design.strips))
    longer = 1.0 + step * lengthening
    compliance = np.zeros((2, len(given)))
    for k, part in enumerate((slice(strips.split), slice(strips.split, None))):
        if strips.compliance[:, part].size:
            compliance[k] = strips.compliance[:, part][:, 0]
    frames = np.stack((strips.root.T, strips.tip.T))[..., None, None]
    points = _point_rates(model, rates).transpose(2, 3, 1, 0)[..., None] / model.length
    moved = np.concatenate((points, np.stack((turning, turning))[:, None]), axis=1)
    return Varied(
        speed=_spread(strips.speed.T) * longer,
        rigidity=_spread(strips.rigidity.T) * second_moment * modulus,
        stretching=_spread(strips.stretching) * area * modulus,
        compliance=_spread(compliance) * np.stack((1.0 / area, longer**2 / second_moment)) / modulus,
        frames=frames + step * moved,
        reach=_spread(strips.reach.T * [[1.0], [-1.0]]) * longer,
        dead=_spread(strips.dead.reshape(len(given), -1, 2).transpose(1, 2, 0)) * area * longer,
        area=_spread(given[:, 0]) * area,
        second_moment=_spread(given[:, 1]) * second_moment,
        longer=longer,
    )


def _spread(values: Array) -> Array:
    """Values (..., G) beside parameters and states."""
    return values[..., None, None]


def _point_rates(model: Reduced, rates: Rates) -> Array:
    """Derivatives (P, G, 2, 2) of the clamped points in their bodies' frames [m]; a free end is a body."""
    moved = rates.ends.copy()
    for end, bodies in enumerate((model.strips.roots, model.strips.tips)):
        for s, body in enumerate(bodies):
            if body >= rates.centres.shape[1]:
                moved[:, s, end] = 0.0
            elif body >= 0:
                moved[:, s, end] -= rates.centres[:, body]
    return moved


def held_rates(model: Reduced, rates: Rates) -> Array:
    """Derivatives (P, D) of the driven coordinates: a driven displacement begins at the centre at rest."""
    out = np.zeros((len(rates.centres), len(model.bodies.held)))
    for d, place in enumerate(model.bodies.held):
        if place % 3 < 2:
            out[:, d] = rates.centres[:, place // 3, place % 3] / model.length
    return out
