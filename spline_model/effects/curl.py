"""What the clamps leave of the curl of a strip's section, and with it of the difference to a plate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import SplineBasis
from spline_model.effects.plate import rigidity_of, rigidity_rate
from spline_model.errors import InvalidParameter

if TYPE_CHECKING:
    from spline_model.design import Design, StripDesign

Array = NDArray[np.float64]

CLAMPED_WIDTH = "clamped_width"
ANTICLASTIC = "anticlastic"
CURLING = (CLAMPED_WIDTH, ANTICLASTIC)
"""Names of the effects that bending takes up."""
WIDTHS = (0.005, 4.0)
"""Width over length for which the plate's factors and the profile that has them were seen to be exact."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Curl:
    """Bending of a strip whose section curls less than a narrow beam's, which makes it stiffer.

        V = 1/2 int EI kappa^2 (1 - nu^2 g(s) f(x)) / (1 - nu^2) ds0                 [J]

    with g the share of the curl that clamps over the whole width leave (``spline_model.effects.plate``)
    and f the one that the curvature of a wide strip leaves, x^2 = (3 (1 - nu^2))^(1/2) b^2 kappa / t
    (``spline_model.strip.laws.curl_law``). Each is 1 where its effect is not named.

    Parameters: poisson_ratio nu; clamped: b/L, or 0; flattening: x^2 / kappa, or 0 [m].
    """

    poisson_ratio: float
    clamped: float
    flattening: float

    def rigidity(self, basis: SplineBasis, u: Array) -> Array:
        """The rigidity at small curvature over EI at u (P,), as a strip of that basis can follow it."""
        if self.clamped == 0.0:
            return np.ones(len(u))
        return rigidity_of(self.clamped, self.poisson_ratio, basis, u)

    def rigidity_rate(self, basis: SplineBasis, u: Array) -> Array:
        """Its derivative by log(b/L) at u (P,)."""
        if self.clamped == 0.0:
            return np.zeros(len(u))
        return rigidity_rate(self.clamped, self.poisson_ratio, basis, u)

    def drop(self, basis: SplineBasis, u: Array) -> Array:
        """nu^2 g at u (P,): the part of the plate's rigidity that the curl takes at small curvature."""
        return np.asarray(1.0 - (1.0 - self.poisson_ratio**2) * self.rigidity(basis, u))


def curl_of(design: Design, strip: StripDesign) -> Curl | None:
    """The curl of a strip, if the design names an effect of it; refused where it has none."""
    if not design.curling:
        return None
    names = " and ".join(design.curling)
    width, thickness = strip.width, strip.thickness
    if width is None or thickness is None:
        raise InvalidParameter(f"width of {strip.name}", width, f"width and thickness [m] for {names}")
    if strip.rise != 0.0:
        raise InvalidParameter(f"rise of {strip.name}", strip.rise, f"0, a straight strip, for {names}")
    if design.pre_strain.get("curvature", 0.0) != 0.0:
        raise InvalidParameter(
            "natural curvature of pre_strain", design.pre_strain["curvature"], f"0 for {names}"
        )
    nu = strip.poisson_ratio
    if not 0.0 <= nu <= 0.5:
        raise InvalidParameter(f"poisson_ratio of {strip.name}", nu, f"0 to 0.5 for {names}")
    if ANTICLASTIC in design.curling and design.discretisation.measure != "material":
        raise InvalidParameter("measure", design.discretisation.measure, f"material for {ANTICLASTIC}")
    return Curl(
        poisson_ratio=nu,
        clamped=_clamped(strip, width / strip.length) if CLAMPED_WIDTH in design.curling else 0.0,
        flattening=math.sqrt(3.0 * (1.0 - nu * nu)) * width**2 / thickness * (ANTICLASTIC in design.curling),
    )


def _clamped(strip: StripDesign, ratio: float) -> float:
    """The width over the length of a strip between two clamps; refused where it has not."""
    if strip.tip is None:
        raise InvalidParameter(f"tip of {strip.name}", None, f"ground or a body for {CLAMPED_WIDTH}")
    low, high = WIDTHS
    if not low <= ratio <= high:
        raise InvalidParameter(f"width over length of {strip.name}", ratio, f"{low:g} to {high:g}")
    return ratio
