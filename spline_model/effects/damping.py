"""Dissipation in the strips and on the bodies."""

from __future__ import annotations

from dataclasses import dataclass

from spline_model.effects.base import Dissipation
from spline_model.errors import require_not_negative


@dataclass(frozen=True, kw_only=True, slots=True)
class StripDamping(Dissipation):
    """Kelvin-Voigt damping in proportion to the stiffness of one strip.

    Every strain has the stress E (eps + relaxation_time d(eps)/dt): frame indifferent, so
    that a rigid motion is not damped. A mode of circular frequency omega has the damping
    ratio relaxation_time omega / 2.

    Parameters: strip, relaxation_time beta >= 0 [s].
    """

    strip: str
    relaxation_time: float

    def __post_init__(self) -> None:
        require_not_negative("relaxation_time", self.relaxation_time, "s")


@dataclass(frozen=True, kw_only=True, slots=True)
class StripDrag(Dissipation):
    """Drag in proportion to the mass of one strip: force per length - rate mu dC/dt.

    A mode has the damping ratio rate / (2 omega); a rigid motion is damped as well.
    Parameters: strip, linear_density mu [kg/m], rate alpha >= 0 [1/s].
    """

    strip: str
    linear_density: float
    rate: float

    def __post_init__(self) -> None:
        require_not_negative("rate", self.rate, "1/s")


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyDamper(Dissipation):
    """Viscous damper between a body and the ground: force - c v, moment - c_theta omega.

    Parameters: body, translation c >= 0 [N s/m], rotation c_theta >= 0 [N m s].
    """

    body: str
    translation: float
    rotation: float

    def __post_init__(self) -> None:
        require_not_negative("translation", self.translation, "N s/m")
        require_not_negative("rotation", self.rotation, "N m s")
