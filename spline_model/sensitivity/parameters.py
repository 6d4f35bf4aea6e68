"""Design parameters of the cross-axis pivot, and how fast what it is made of changes with each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.design import StripDesign
from spline_model.errors import InvalidParameter
from spline_model.pivot import Pivot

Array = NDArray[np.float64]

KEYWORDS = (
    "length",
    "inclination",
    "crossing_ratio",
    "area",
    "second_moment_of_area",
    "youngs_modulus",
)
"""Keywords of ``cross_axis_pivot`` that the statics of both strips alike depends on. Poisson's ratio,
density and the inertias do not enter; ``centre_offset`` and ``orientation`` move what is reported rigidly."""

SECTION = ("thickness", "width")
"""Sides of a rectangular section h x b, A = b h and I = b h^3 / 12, in place of A and I."""

PARAMETERS = (*KEYWORDS, *SECTION)
"""All that derivatives are taken by."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """A rectangular section with a strip's A and I: thickness h in the plane of bending, width b [m]."""

    thickness: float
    width: float

    @classmethod
    def of(cls, strip: StripDesign) -> Section:
        """h = sqrt(12 I / A), b = A / h."""
        thickness = math.sqrt(12.0 * strip.second_moment_of_area / strip.area)
        return cls(thickness=thickness, width=strip.area / thickness)

    def rates(self, name: str) -> tuple[float, float]:
        """d(A, I) by one side [m, m^3]."""
        h, b = self.thickness, self.width
        return (b, b * h**2 / 4.0) if name == "thickness" else (h, h**3 / 12.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Rates:
    """Derivatives by P parameters of what the equations of a pivot hold.

    length [m], area [m^2], second_moment [m^4], modulus [Pa] of both strips (P,); ground (P, 2, 2)
    [strip, xy] clamped points, arm (P, 2, 2) of the strips' ends from the body's centre at rest,
    direction (P, 2) of the clamps [rad], centre (P, 2) of the body at rest and crossing (P, 2) of
    the strips there, each over the parameter's own unit.
    """

    names: tuple[str, ...]
    length: Array
    area: Array
    second_moment: Array
    modulus: Array
    ground: Array
    arm: Array
    direction: Array
    centre: Array
    crossing: Array


def check_parameters(names: Sequence[str]) -> tuple[str, ...]:
    """The names as a tuple; refuses unknown and doubled ones."""
    for name in names:
        if name not in PARAMETERS:
            raise InvalidParameter("parameters", name, "one of " + ", ".join(PARAMETERS))
    if not names or len(set(names)) != len(names):
        raise InvalidParameter("parameters", list(names), "at least one name, each once")
    return tuple(names)


@dataclass(frozen=True, kw_only=True, eq=False)
class Geometry:
    """A pivot's shape read back from its clamps: L [m], inclination and orientation [rad], crossing ratio."""

    length: float
    inclination: float
    crossing_ratio: float
    orientation: float

    @classmethod
    def of(cls, pivot: Pivot) -> Geometry:
        """The shape of a pivot that ``cross_axis_pivot`` made."""
        first, second = pivot.clamp_directions[:, 0]
        axis = first + second  # 2 sin(inclination) along the pivot's axis of symmetry
        base = pivot.clamp_points[1, 0] - pivot.clamp_points[0, 0]
        across = float(np.hypot(*(first - second))) / 2.0
        length = pivot.mechanism.design.strips[0].length
        return cls(
            length=length,
            inclination=math.atan2(float(np.hypot(*axis)) / 2.0, across),
            crossing_ratio=float(np.hypot(*base)) / (2.0 * length * across),
            orientation=math.atan2(-axis[0], axis[1]),
        )

    @property
    def crossing(self) -> Array:
        """The strips' crossing at rest from the ground clamp of strip 1 (2,) [m]."""
        reach = self.crossing_ratio * self.length
        angle = self.inclination + self.orientation
        return np.array([reach * math.cos(angle), reach * math.sin(angle)])


def rates_of(pivot: Pivot, names: tuple[str, ...]) -> Rates:
    """The rates of a pivot, by the names of its parameters."""
    strip = pivot.mechanism.design.strips[0]
    basic = np.zeros((len(names), len(KEYWORDS)))  # each parameter as a direction in the keywords
    for i, name in enumerate(names):
        if name in KEYWORDS:
            basic[i, KEYWORDS.index(name)] = 1.0
        else:
            basic[i, 3:5] = Section.of(strip).rates(name)
    by_shape = _shape_rates(Geometry.of(pivot))
    return Rates(
        names=names,
        length=basic[:, 0],
        area=basic[:, 3],
        second_moment=basic[:, 4],
        modulus=basic[:, 5],
        **{key: np.tensordot(basic[:, :3], value, 1) for key, value in by_shape.items()},
    )


def _shape_rates(shape: Geometry) -> dict[str, Array]:
    """Rates of the clamps and points by length, inclination and crossing ratio, (3, ...) each."""
    length, ratio = shape.length, shape.crossing_ratio
    cos, sin = math.cos(shape.inclination), math.sin(shape.inclination)
    tangents = np.array([[cos, sin], [-cos, sin]])
    normals = np.array([[-sin, cos], [sin, cos]])  # d(tangents)/d(inclination)
    ground = np.zeros((3, 2, 2))
    ground[:, 1, 0] = 2 * ratio * cos, -2 * ratio * length * sin, 2 * length * cos
    ends = ground + np.stack((tangents, length * normals, np.zeros((2, 2))))
    centre = ends.mean(axis=1)
    crossing = np.stack((ratio * tangents[0], ratio * length * normals[0], length * tangents[0]))
    turn = np.array(
        [
            [math.cos(shape.orientation), math.sin(shape.orientation)],
            [-math.sin(shape.orientation), math.cos(shape.orientation)],
        ]
    )  # of row vectors
    return {
        "ground": ground @ turn,
        "arm": (ends - centre[:, None]) @ turn,
        "direction": np.array([[0.0, 0.0], [1.0, -1.0], [0.0, 0.0]]),
        "centre": centre @ turn,
        "crossing": crossing @ turn,
    }
