"""Inertia of strips and bodies (Eqs 16 to 18)."""

from __future__ import annotations

from dataclasses import dataclass

from spline_model.effects.base import Inertia
from spline_model.errors import require_not_negative


@dataclass(frozen=True, kw_only=True, slots=True)
class StripInertia(Inertia):
    """Translational inertia of one strip.

        T = 1/2 int mu |dC/dt|^2 ds0                                               [J]

    over the reference length, where the mass is (Eq 18 with ds read as ds0): the mass
    matrix is constant in the control points. A strip without it is massless: it follows
    its bodies quasi-statically.

    Parameters: strip, linear_density mu >= 0 [kg/m].
    Left out: rotary inertia of the section.
    """

    strip: str
    linear_density: float

    def __post_init__(self) -> None:
        require_not_negative("linear_density", self.linear_density, "kg/m")


@dataclass(frozen=True, kw_only=True, slots=True)
class SectionRotaryInertia(Inertia):
    """Rotary inertia of the sections of one strip.

        T = 1/2 int rho I |d(C')/dt|^2 / J0^2 ds0                                  [J]

    The section's director is the tangent C' / J0 turned by a right angle, not normalised:
    its mass matrix stays constant. It is the inertia rho I (d theta/dt)^2 of a strip that
    does not stretch; otherwise it differs by the order of the axial strain and its rate.

    Parameters: strip, rotary_density rho I >= 0 [kg m].
    """

    strip: str
    rotary_density: float

    def __post_init__(self) -> None:
        require_not_negative("rotary_density", self.rotary_density, "kg m")


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyInertia(Inertia):
    """Inertia of one body about its centre, T = 1/2 m |v|^2 + 1/2 J omega^2 (Eq 17)  [J].

    Parameters: body, mass >= 0 [kg], moment_of_inertia J >= 0 [kg m^2].
    """

    body: str
    mass: float
    moment_of_inertia: float

    def __post_init__(self) -> None:
        require_not_negative("mass", self.mass, "kg")
        require_not_negative("moment_of_inertia", self.moment_of_inertia, "kg m^2")
