"""What the strips' elements know of a design, as complex numbers: value + i STEP x its derivative."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design
from spline_model.effects import Bending
from spline_model.plate.profile import STEP
from spline_model.reduced.model import Reduced
from spline_model.sensitivity.parameters import Rates
from spline_model.strip.element import CURL, PER_U, SPRING

Array = NDArray[Any]


class Varied(NamedTuple):
    """What of ``Strips`` knows the design, (..., G, P, 1) each: by P parameters, the same at all states.

    speed, stretching; bending, the rigidity EI, and aspect, the width over the length over that of the
    design, which ``along`` takes; curl as in ``Strips``; springs (2, ...) of the roots; compliance (2, ...)
    of stretching and sliding; frames (2, 3, ...) of root and tip; reach (2, ...), away from the clamp; dead
    (n, 2, ...); area [m^2], second_moment [m^4]; longer: the length over that of the design. All else is
    over L and EI/L of the design.
    """

    speed: Array
    bending: Array
    aspect: Array
    curl: Array
    springs: Array
    stretching: Array
    compliance: Array
    frames: Array
    reach: Array
    dead: Array
    area: Array
    second_moment: Array
    longer: Array

    def along(self, model: Reduced, u: Array) -> tuple[Array, Array]:
        """The rigidity at small curvature and the drop of ``curl_law`` at u (Q,), (Q, G, P, 1)."""
        scene = model.system.scene
        basis, bends = scene.strips[0].basis, {e.strip: e.curl for e in scene.of(Bending)}
        curls = [bends[strip.name] for strip in scene.strips]
        stiffer, rate = np.ones((len(u), len(curls))), np.zeros((len(u), len(curls)))
        for s, curl in enumerate(curls):
            if curl is not None:
                stiffer[:, s], rate[:, s] = curl.rigidity(basis, u), curl.rigidity_rate(basis, u)
        plate = _spread(np.array([0.0 if curl is None else curl.poisson_ratio**2 for curl in curls]))
        found = _spread(stiffer) + _spread(rate) * (self.aspect - 1.0)
        return found * self.bending, 1.0 - (1.0 - plate) * found


def varied_strips(model: Reduced, design: Design, rates: Rates) -> Varied:
    """The strips of a design, which ``model`` is of."""
    strips, step = model.strips, 1j * STEP
    given = np.array([(s.area, s.second_moment_of_area, s.youngs_modulus) for s in design.strips])
    area, second_moment, modulus = 1.0 + step * (rates.section / given).T[..., None]
    lengthening, turning = (each.T[..., None] for each in rates.by_length(design.strips))
    longer = 1.0 + step * lengthening
    thickness = np.sqrt(second_moment / area)
    width = area / thickness
    rigidity = np.array([s.flexural_rigidity for s in design.strips]) / (model.energy * model.length)
    compliance = np.zeros((2, len(given)))
    for k, part in enumerate((slice(strips.split), slice(strips.split, None))):
        if strips.compliance[:, part].size:
            compliance[k] = strips.compliance[:, part][:, 0]
    frames = np.stack((strips.root.T, strips.tip.T))[..., None, None]
    points = _point_rates(model, rates).transpose(2, 3, 1, 0)[..., None] / model.length
    moved = np.concatenate((points, np.stack((turning, turning))[:, None]), axis=1)
    return Varied(
        speed=_spread(strips.speed.T) * longer,
        bending=_spread(rigidity) * second_moment * modulus,
        aspect=width / longer,
        curl=_spread(strips.along[:, 0, CURL]) * width**2 / thickness,
        springs=_spread(strips.numbers[:, SPRING:PER_U].T) * second_moment * modulus / thickness,
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
