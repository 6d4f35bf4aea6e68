"""The cross-axis flexural pivot: two straight strips that cross without touching, and the body they carry."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .effects import DEFAULT_EFFECTS
from .errors import InvalidParameter, finite, positive, within
from .mechanism import BodyDesign, StripDesign, mechanism
from .model import NOT_GIVEN, Model, rotation_matrix


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
    centre_offset: Sequence[float] = (0.0, 0.0),
    orientation: float = 0.0,
    width: float | None = None,
    thickness: float | None = None,
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Mapping[str, Mapping[str, Any]] | None = None,
    elements: int = 20,
    element: str = "corotational",
) -> Model:
    """Return the pivot at rest, with the ground end A1 of the first strip at the origin.

    With strip length L, inclination a and crossing ratio r (distance of the crossing from ground over L):

        A1 = (0, 0),  A2 = (2 r L cos a, 0),  B1 = A1 + L (cos a, sin a),  B2 = A2 + L (-cos a, sin a)

    and the body's centre at (B1 + B2)/2 + centre_offset; then the orientation turns all of it about A1.

    Args:
        length: L [m]. inclination: a [rad], between 0 and pi/2. crossing_ratio: r, between 0 and 1.
        area [m^2], second_moment_of_area [m^4], youngs_modulus [Pa], poisson_ratio [1], density [kg/m^3]: of
        strips. body_mass [kg], body_moment_of_inertia about its centre [kg m^2]; zero is legal.
        width, thickness [m]: of strips, in place of area and second moment of area, or beside them.
        centre_offset: (2,) [m]. orientation: of the whole, counter-clockwise [rad].
        effects: names of the effects of the scene. parameters: of those that have any, by name.
        elements: number of elements a strip. element: "corotational" or "reissner".

    Raises:
        InvalidParameter: a value outside its domain; one line with name, value, expectation and unit.
    """
    span = positive("length", length, "m")
    angle = within("inclination", inclination, 0.0, 0.5 * np.pi, "rad")
    ratio = within("crossing_ratio", crossing_ratio, 0.0, 1.0, "1")
    if len(centre_offset) != 2:
        raise InvalidParameter("centre_offset", centre_offset, "two coordinates [m]")
    offset = np.array([finite("centre_offset", part, "m") for part in centre_offset])
    run, rise = span * np.cos(angle), span * np.sin(angle)
    ground = np.array([[0.0, 0.0], [2.0 * ratio * run, 0.0]])
    ends = ground + np.array([[run, rise], [-run, rise]])
    turn = rotation_matrix(finite("orientation", orientation, "rad")).T
    ground, ends, offset = ground @ turn, ends @ turn, offset @ turn
    given: dict[str, Any] = {
        "area": area,
        "second_moment_of_area": second_moment_of_area,
        "youngs_modulus": youngs_modulus,
        "poisson_ratio": poisson_ratio,
        "density": density,
        "width": width,
        "thickness": thickness,
    }
    body = BodyDesign(
        name="body",
        centre=ends.mean(axis=0) + offset,
        mass=body_mass,
        moment_of_inertia=body_moment_of_inertia,
    )
    strips = [
        StripDesign(name=f"strip_{number}", start=a, end=b, tip=body.name, **given)
        for number, (a, b) in enumerate(zip(ground, ends, strict=True), start=1)
    ]
    return mechanism(
        strips=strips,
        bodies=[body],
        effects=effects,
        parameters=parameters,
        elements=elements,
        element=element,
    )
