"""Mechanisms of any number of strips and rigid bodies, from designs that name what is joined to what.

The cross-axis flexural pivot is the one of two straight strips that cross without touching, and their body.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .arrays import Array, rotation_matrix
from .effects import DEFAULT_EFFECTS, Effects, Given
from .errors import finite, pair, positive, within
from .model import BodyDesign, Model
from .strip import StripDesign


def compliant_mechanism(
    *,
    strips: Sequence[StripDesign],
    bodies: Sequence[BodyDesign] = (),
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Mapping[str, Given] | None = None,
    elements: int = 20,
    element: str = "corotational",
) -> Model:
    """Return the model of a mechanism at rest, free of stress unless it has natural strains.

    Parameters
    ----------
    strips : sequence of StripDesign
    bodies : sequence of BodyDesign, default ()
    effects : sequence of str
        Names of the effects.
    parameters : mapping, SI units, default None
        Parameters of each named effect, by effect, or a sequence of them for an effect that acts several
        times.
    elements : int, default 20
        Finite elements per strip.
    element : str
        "corotational" (default) or "reissner" (with shear).

    Returns
    -------
    Model

    Raises
    ------
    InvalidParameter
        A value outside its domain, an end on an unknown body, or effects that contradict each other.

    References
    ----------
    Crisfield (1991) and Reissner (1972), as in ``fe_reference.law``.

    Examples
    --------
    >>> strip = StripDesign(
    ...     name="strip", start=(0.0, 0.0), end=(0.1, 0.0), root="ground", tip="tip",
    ...     width=0.01, thickness=1e-3,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0,
    ... )
    >>> tip = BodyDesign(name="tip", centre=(0.1, 0.0), mass=0.05, moment_of_inertia=1e-5)
    >>> compliant_mechanism(strips=[strip], bodies=[tip], elements=8).elements
    8
    """
    return Model(
        strips=tuple(strips),
        bodies=tuple(bodies),
        element=element,
        elements=elements,
        effects=Effects.read(effects, parameters or {}),
    )


def cross_axis_pivot(
    *,
    length: float,
    inclination: float,
    crossing_ratio: float,
    body_mass: float,
    body_moment_of_inertia: float,
    centre_offset: Sequence[float] = (0.0, 0.0),
    orientation: float = 0.0,
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Mapping[str, Given] | None = None,
    elements: int = 20,
    element: str = "corotational",
    **section: Any,
) -> Model:
    """Return the pivot at rest, with the ground end A1 of the first strip at the origin.

    With strip length L, inclination a and crossing ratio r (distance of the crossing from ground over L):

        A1 = (0, 0),  A2 = (2 r L cos a, 0),  B1 = A1 + L (cos a, sin a),  B2 = A2 + L (-cos a, sin a)

    and the body's centre at (B1 + B2)/2 + centre_offset; then the orientation rotates all of it about A1.

    Parameters
    ----------
    length : float, m
        L.
    inclination : float, rad
        a, between 0 and pi/2.
    crossing_ratio : float, 1
        r, between 0 and 1.
    body_mass, body_moment_of_inertia : float, kg and kg m^2
        The moment is about the centre of mass; zero is legal.
    centre_offset : (2,) m, default (0, 0)
    orientation : float, rad, default 0
        Counter-clockwise.
    effects, parameters : sequence of str, mapping
        Names of the effects, and the parameters of each effect by name.
    elements : int, default 20
        Finite elements per strip.
    element : str
        "corotational" (default) or "reissner" (with shear).
    section
        Of both strips, as of `StripDesign`: youngs_modulus [Pa], poisson_ratio [1], density [kg/m^3], and
        area [m^2] with second_moment_of_area [m^4], or width with thickness [m].

    Returns
    -------
    Model

    Raises
    ------
    InvalidParameter
        A value outside its domain; one line with name, value, expectation and unit.

    References
    ----------
    Valentini and Pezzuti (2013), Fig 2 and Table 1.

    Examples
    --------
    >>> pivot = cross_axis_pivot(
    ...     length=0.08, inclination=0.785, crossing_ratio=0.5, width=0.01, thickness=5e-4,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0, body_mass=0.1,
    ...     body_moment_of_inertia=2e-5, elements=8,
    ... )
    >>> len(pivot.strips), pivot.elements
    (2, 8)
    """
    ground, ends = _clamps(
        positive("length", length, "m"),
        within("inclination", inclination, 0.0, 0.5 * np.pi, "rad"),
        within("crossing_ratio", crossing_ratio, 0.0, 1.0, "1"),
    )
    turn = rotation_matrix(finite("orientation", orientation, "rad")).T
    offset = np.array(pair("centre_offset", centre_offset, "m"))
    ground, ends, offset = ground @ turn, ends @ turn, offset @ turn
    centre = ends.mean(axis=0) + offset
    body = BodyDesign(centre=centre, mass=body_mass, moment_of_inertia=body_moment_of_inertia)
    strips = [
        StripDesign(name=f"strip_{number}", start=a, end=b, tip=body.name, **section)
        for number, (a, b) in enumerate(zip(ground, ends, strict=True), start=1)
    ]
    return compliant_mechanism(
        strips=strips,
        bodies=[body],
        effects=effects,
        parameters=parameters,
        elements=elements,
        element=element,
    )


def _clamps(length: float, angle: float, ratio: float) -> tuple[Array, Array]:
    """Return the ends of both strips on ground and on the body (2, 2) [m]."""
    run, rise = length * np.cos(angle), length * np.sin(angle)
    ground = np.array([[0.0, 0.0], [2.0 * ratio * run, 0.0]])
    return ground, ground + np.array([[run, rise], [-run, rise]])
