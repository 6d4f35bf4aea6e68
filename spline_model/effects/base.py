"""The kinds of effect a scene is made of, and those that act in a motion alone: inertia and dissipation.

    M a + dV/dq + f_d(q, v) - f(q, t) - G(q, t)^T lambda = 0,      psi(q, t) = 0

An effect is a frozen value that says what it acts on and with which constants; it holds no
state and no flag. ``spline_model.compile`` sorts the effects once into one flat table a
class; a class that no effect names has a table of length zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from spline_model.errors import require_not_negative


class Potential:
    """Adds an energy V(q), its gradient and its Hessian."""


class Inertia:
    """Adds to the mass matrix M and to the kinetic energy."""


class Dissipation:
    """Adds a force against the velocity; it takes energy out and never puts any in."""


class Load:
    """Adds a generalised force f."""


class Constraint:
    """Adds rows psi(q, t) = 0, their Jacobian G and second derivatives.

    Rows are written in metres and radians, so that multipliers are N and N m.
    """

    rows: ClassVar[int]


@dataclass(frozen=True, kw_only=True, slots=True)
class StripInertia(Inertia):
    """Translational inertia of all strips.

        T = 1/2 int mu |dC/dt|^2 ds0                                               [J]

    over the reference length, where the mass is (Eq 18 with ds read as ds0): the mass
    matrix is constant in the control points. Without it strips are massless: they follow
    their bodies quasi-statically.

    Neglected: rotary inertia of the section.
    """


@dataclass(frozen=True, kw_only=True, slots=True)
class SectionRotaryInertia(Inertia):
    """Rotary inertia of the sections of all strips.

        T = 1/2 int rho I |d(C')/dt|^2 / J0^2 ds0                                  [J]

    The section's director is the tangent C' / J0 turned by a right angle, not normalised:
    its mass matrix stays constant. It is the inertia rho I (d theta/dt)^2 of a strip that
    does not stretch; otherwise it differs by the order of the axial strain and its rate.
    """


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyInertia(Inertia):
    """Inertia of all bodies about their centres, T = 1/2 m |v|^2 + 1/2 J omega^2 (Eq 17)  [J]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Gravity(Potential):
    """Weight of all strips and bodies, V = - int mu g . C ds0 - m g . r [J], linear in the coordinates.

    It acts in full at any load factor. Parameter: acceleration g [m/s^2].
    """

    acceleration: tuple[float, float] = (0.0, -9.81)


@dataclass(frozen=True, kw_only=True, slots=True)
class StripDamping(Dissipation):
    """Kelvin-Voigt damping in proportion to the stiffness of all strips.

    Every strain has the stress E (eps + relaxation_time d(eps)/dt): frame indifferent, so
    that a rigid motion is not damped. A mode of circular frequency omega has the damping
    ratio relaxation_time omega / 2.

    Parameter: relaxation_time beta >= 0 [s].
    """

    relaxation_time: float

    def __post_init__(self) -> None:
        require_not_negative("relaxation_time", self.relaxation_time, "s")


@dataclass(frozen=True, kw_only=True, slots=True)
class StripDrag(Dissipation):
    """Drag in proportion to the mass of all strips: force per length - rate mu dC/dt.

    A mode has the damping ratio rate / (2 omega); a rigid motion is damped as well.
    Parameter: rate alpha >= 0 [1/s].
    """

    rate: float

    def __post_init__(self) -> None:
        require_not_negative("rate", self.rate, "1/s")


@dataclass(frozen=True, kw_only=True, slots=True)
class BodyDamper(Dissipation):
    """Viscous damper between every body and the ground: force - c v, moment - c_theta omega.

    Parameters: translation c >= 0 [N s/m], rotation c_theta >= 0 [N m s].
    """

    translation: float = 0.0
    rotation: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("translation", self.translation, "N s/m")
        require_not_negative("rotation", self.rotation, "N m s")
