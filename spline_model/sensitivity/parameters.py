"""Design parameters of a pivot or any mechanism, and how fast points and sections change with each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design, StripDesign
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.pivot import Pivot

Array = NDArray[np.float64]

SHAPE = ("length", "inclination", "crossing_ratio")
MATERIAL = ("area", "second_moment_of_area", "youngs_modulus")
KEYWORDS = (*SHAPE, *MATERIAL)
"""Keywords of ``cross_axis_pivot`` that the statics of both strips alike depends on. Poisson's ratio,
density and the inertias do not enter, but by weight; ``centre_offset`` and ``orientation`` move what is
reported rigidly."""

SECTION = ("thickness", "width")
"""Sides of a rectangular section h x b, A = b h and I = b h^3 / 12, in place of A and I."""

PARAMETERS = (*KEYWORDS, *SECTION)
"""All that derivatives of a pivot are taken by. Those of section and material are of all strips alike, in any
mechanism; a name before a dot picks one strip, "strip_1.thickness", and then also its ends' places at rest,
"strip_1.end_x", or a body's centre, "body.centre_y"."""

POINTS = ("start_x", "start_y", "end_x", "end_y")
CENTRES = ("centre_x", "centre_y")


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
    """Derivatives by P parameters of a design of G strips and B bodies, over the parameter's own unit.

    section (P, G, 3) of area [m^2], second moment [m^4] and modulus [Pa]; ends (P, G, 2, 2) [root / tip,
    xy] of the strips at rest, centres (P, B, 2) of the bodies [m]; crossing (P, 2) of a pivot's strips [m].
    """

    section: Array
    ends: Array
    centres: Array
    crossing: Array

    def by_length(self, strips: Sequence[StripDesign]) -> tuple[Array, Array]:
        """Derivatives (P, G) of log length and of direction [rad] of straight strips."""
        chord = np.array([np.subtract(s.end, s.start) for s in strips])
        moved = (self.ends[:, :, 1] - self.ends[:, :, 0]) / np.sum(chord**2, axis=1)[:, None]
        turned = chord[:, 0] * moved[..., 1] - chord[:, 1] * moved[..., 0]
        return np.sum(chord * moved, axis=-1), turned


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

    def rates(self, name: str) -> tuple[Array, Array]:
        """Derivatives of the strips' ends (2, 2, 2) and their crossing (2,) by a parameter of the shape."""
        cos, sin, at = math.cos(self.inclination), math.sin(self.inclination), SHAPE.index(name)
        tangents, normals = np.array([[cos, sin], [-cos, sin]]), np.array([[-sin, cos], [sin, cos]])
        length, ratio = self.length, self.crossing_ratio
        moved = (tangents, length * normals, np.zeros((2, 2)))[at]  # of the tips from the roots
        ends = np.zeros((2, 2, 2))
        ends[1, :, 0] = (2 * ratio * cos, -2 * ratio * length * sin, 2 * length * cos)[at]
        ends[:, 1] += moved
        crossing = (ratio * tangents[0], ratio * length * normals[0], length * tangents[0])[at]
        cos, sin = math.cos(self.orientation), math.sin(self.orientation)
        turn = np.array([[cos, sin], [-sin, cos]])  # of row vectors
        return ends @ turn, crossing @ turn


def rates_of(asked: Pivot | Mechanism, names: Sequence[str]) -> Rates:
    """The rates of a design by the names of its parameters; refuses unknown and doubled ones."""
    if not names or len(set(names)) != len(names):
        raise InvalidParameter("parameters", list(names), "at least one name, each once")
    design = (asked.mechanism if isinstance(asked, Pivot) else asked).design
    strips, bodies = [s.name for s in design.strips], [b.name for b in design.bodies]
    rates = Rates(
        section=np.zeros((len(names), len(strips), 3)),
        ends=np.zeros((len(names), len(strips), 2, 2)),
        centres=np.zeros((len(names), len(bodies), 2)),
        crossing=np.zeros((len(names), 2)),
    )
    for i, name in enumerate(names):
        owner, _, field = name.rpartition(".")
        if isinstance(asked, Pivot) and name in SHAPE:
            rates.ends[i], rates.crossing[i] = Geometry.of(asked).rates(name)
            rates.centres[i] = rates.ends[i, :, 1].mean(axis=0)
        elif field in (*MATERIAL, *SECTION) and owner in ("", *strips):
            _set_section(rates.section[i], design, owner, field)
        elif field in POINTS and owner in strips:
            if design.strips[strips.index(owner)].rise != 0.0:
                raise InvalidParameter("parameters", name, "an end of a straight strip")
            rates.ends[i, strips.index(owner)].flat[POINTS.index(field)] = 1.0
        elif field in CENTRES and owner in bodies:
            rates.centres[i, bodies.index(owner), CENTRES.index(field)] = 1.0
        else:
            known = (*(SHAPE if isinstance(asked, Pivot) else ()), *MATERIAL, *SECTION)
            one = f"STRIP.{', STRIP.'.join(POINTS)} or BODY.{', BODY.'.join(CENTRES)}"
            raise InvalidParameter("parameters", name, f"one of {', '.join(known)}, {one}")
    return rates


def _set_section(section: Array, design: Design, owner: str, field: str) -> None:
    """Rates (G, 3) of A, I and E of one strip, or of all."""
    for rate, strip in zip(section, design.strips, strict=True):
        if owner in ("", strip.name):
            if field in SECTION:
                rate[:2] = Section.of(strip).rates(field)
            else:
                rate[MATERIAL.index(field)] = 1.0
