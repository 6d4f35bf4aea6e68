"""The cross-axis flexural pivot of the paper's Fig 2 as a scene."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Unpack

import numpy as np

from spline_model.design import NOT_GIVEN, BodyDesign, StripDesign
from spline_model.discretisation import Described
from spline_model.effects.registry import DEFAULT_EFFECTS, Parameters
from spline_model.errors import InvalidParameter, is_finite, require_finite, require_positive
from spline_model.mechanism import Mechanism, compliant_mechanism

BODY = "body"
STRIPS = ("strip_1", "strip_2")


def cross_axis_pivot(
    *,
    length: float,
    inclination: float,
    crossing_ratio: float,
    area: float = NOT_GIVEN,
    second_moment_of_area: float = NOT_GIVEN,
    youngs_modulus: float,
    poisson_ratio: float,
    density: float,
    body_mass: float,
    body_moment_of_inertia: float,
    centre_offset: tuple[float, float] = (0.0, 0.0),
    orientation: float = 0.0,
    width: float | None = None,
    thickness: float | None = None,
    width_end: float | None = None,
    thickness_end: float | None = None,
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Parameters | None = None,
    **described: Unpack[Described],
) -> Mechanism:
    """Return the pivot of Table 1, or any other design.

    Parameters
    ----------
    length : float, m
        Length L of each strip.
    inclination : float, rad
        Angle between the strips and the x axis.
    crossing_ratio : float, 1
        Distance of the crossing from the ground end over L, in (0, 1).
    area, second_moment_of_area : float, m^2 and m^4
        Section of a strip; not needed with `width` and `thickness`.
    youngs_modulus, poisson_ratio, density : float, Pa, 1, kg/m^3
        Material. The Poisson ratio is used by `clamped_width` and `anticlastic` only.
    body_mass, body_moment_of_inertia : float, kg and kg m^2
        Inertia of the body; the moment is about its centre of mass.
    centre_offset : (2,) m, default (0, 0)
        Centre of mass relative to the midpoint of B1 and B2.
    orientation : float, rad, default 0
        Rotation of the whole pivot about A1.
    width, thickness : float, m, default None
        Rectangular section; the thickness is in the plane of bending.
    width_end, thickness_end : float, m, default None
        Sides at the body, of a taper.
    effects, parameters : sequence of str, mapping
        Names of the effects, and the parameters of each effect by name.
    described
        `control_points` ... `penalty_stiffness`, as in ``spline_model.discretisation.Discretisation``.
        Without `control_points`, solvers choose the number for an accuracy of 1e-4.

    Returns
    -------
    Mechanism
        Of two strips and one body.

    Raises
    ------
    InvalidParameter
        A value outside its range; the message has one line.

    References
    ----------
    Valentini and Pezzuti (2013), section 2 and Table 1.

    Examples
    --------
    >>> pivot = cross_axis_pivot(
    ...     length=0.08, inclination=0.785, crossing_ratio=0.5, width=0.01, thickness=5e-4,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0, body_mass=0.1,
    ...     body_moment_of_inertia=2e-5, control_points=6,
    ... )
    >>> [strip.name for strip in pivot.design.strips]
    ['strip_1', 'strip_2']
    """
    _check_shape(length, inclination, crossing_ratio, orientation)
    ends = ends_at_rest(length, inclination, crossing_ratio, orientation)
    offset = turned(*centre_offset, orientation)
    centre = [(a + b) / 2.0 + c for a, b, c in zip(ends[0][1], ends[1][1], offset, strict=True)]
    require_positive("body_mass", body_mass, "kg")
    require_positive("body_moment_of_inertia", body_moment_of_inertia, "kg m^2")
    body = BodyDesign(
        name=BODY,
        centre=(float(centre[0]), float(centre[1])),
        mass=body_mass,
        moment_of_inertia=body_moment_of_inertia,
    )
    strips = [
        StripDesign(
            name=name,
            start=(float(start[0]), float(start[1])),
            end=(float(end[0]), float(end[1])),
            tip=BODY,
            area=area,
            second_moment_of_area=second_moment_of_area,
            youngs_modulus=youngs_modulus,
            poisson_ratio=poisson_ratio,
            density=density,
            width=width,
            thickness=thickness,
            width_end=width_end,
            thickness_end=thickness_end,
        )
        for name, (start, end) in zip(STRIPS, ends, strict=True)
    ]
    made = compliant_mechanism(
        strips=strips, bodies=[body], effects=effects, parameters=parameters, **described
    )
    placing = {
        "length": length,
        "inclination": inclination,
        "crossing_ratio": crossing_ratio,
        "orientation": orientation,
    }
    return replace(made, placing=placing)


def ends_at_rest(
    length: Any, inclination: Any, crossing_ratio: Any, orientation: Any
) -> list[list[tuple[Any, Any]]]:
    """Return the clamped points x, y [m] of each strip, from the ground to the body; numbers or arrays (D,).

    The strips cross at r L from the ground.
    """
    x, y, zero = length * np.cos(inclination), length * np.sin(inclination), 0.0 * length
    root = 2.0 * crossing_ratio * x
    strips = ((zero, zero), (x, y)), ((root, zero), (root - x, y))
    c, s = np.cos(orientation), np.sin(orientation)
    return [[_turned_by(c, s, *point) for point in strip] for strip in strips]


def turned(x: Any, y: Any, angle: Any) -> tuple[Any, Any]:
    """Return a point (x, y) turned about the origin by an angle [rad]; numbers or arrays of one shape."""
    return _turned_by(np.cos(angle), np.sin(angle), x, y)


def _turned_by(c: Any, s: Any, x: Any, y: Any) -> tuple[Any, Any]:
    """The same by cosine and sine."""
    return c * x - s * y, s * x + c * y


def _check_shape(length: float, inclination: float, crossing_ratio: float, orientation: float) -> None:
    """Refuse keywords that place no two strips that cross."""
    require_positive("length", length, "m")
    require_finite("orientation", orientation, "rad")
    for name, value, most, expected in (
        ("inclination", inclination, math.pi / 2, "an angle between 0 and pi/2 [rad]"),
        ("crossing_ratio", crossing_ratio, 1.0, "a number between 0 and 1"),
    ):
        if not (is_finite(value) and 0 < value < most):
            raise InvalidParameter(name, value, expected)
