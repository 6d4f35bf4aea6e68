"""Inertia of strips and bodies (Eqs 16 to 18)."""

from __future__ import annotations

from dataclasses import dataclass

from spline_model.effects.base import Inertia
from spline_model.errors import require_positive


@dataclass(frozen=True, kw_only=True, slots=True)
class StripInertia(Inertia):
    """Translational inertia of one strip.

        T = 1/2 int mu |dC/dt|^2 ds0                                               [J]

    over the reference length, where the mass is (Eq 18 with ds read as ds0): the mass
    matrix is constant in the control points.

    Parameters: strip, linear_density mu > 0 [kg/m].
    Left out: rotary inertia of the section, mu I / A per length.
    """

    strip: str
    linear_density: float

    def __post_init__(self) -> None:
        require_positive("linear_density", self.linear_density, "kg/m")


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyInertia(Inertia):
    """Inertia of one body about its centre, T = 1/2 m |v|^2 + 1/2 J omega^2 (Eq 17)  [J].

    Parameters: body, mass > 0 [kg], moment_of_inertia J > 0 [kg m^2].
    """

    body: str
    mass: float
    moment_of_inertia: float

    def __post_init__(self) -> None:
        require_positive("mass", self.mass, "kg")
        require_positive("moment_of_inertia", self.moment_of_inertia, "kg m^2")
