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
"""Keywords of ``cross_axis_pivot`` that the statics of both strips alike depends on. Of the others density
and the inertias do not enter, but by weight, nor Poisson's ratio, but by the section's curl;
``centre_offset`` and ``orientation`` move what is reported rigidly."""

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


def crossing_reach(pivot: Pivot) -> tuple[float, float]:
    """Crossing ratio r and the length L [m] of a pivot's strips, which cross at r L from the ground."""
    apart = pivot.clamp_directions[0, 0] - pivot.clamp_directions[1, 0]
    base, length = (
        pivot.clamp_points[1, 0] - pivot.clamp_points[0, 0],
        pivot.design.strips[0].length,
    )
    return float(base @ apart / (apart @ apart)) / length, length


def _shape_rates(pivot: Pivot, name: str) -> tuple[Array, Array]:
    """Derivatives of the strips' ends (2, 2, 2) and their crossing (2,) by a parameter of the shape.

    With the tangents t_i the roots are 0 and r L (t_1 - t_2), the crossing r L t_1.
    """
    by_length, by_angle, by_ratio = (float(name == each) for each in SHAPE)
    (ratio, length), tangents = crossing_reach(pivot), pivot.clamp_directions[:, 0]
    turned = by_angle * np.stack((-tangents[:, 1], tangents[:, 0]), axis=1) * [[1.0], [-1.0]]
    reach = (by_ratio * length + ratio * by_length) * tangents + ratio * length * turned
    ends = np.zeros((2, 2, 2))
    ends[1, 0] = reach[0] - reach[1]
    ends[:, 1] = ends[:, 0] + by_length * tangents + length * turned
    return ends, reach[0]


def rates_of(asked: Mechanism, names: Sequence[str]) -> Rates:
    """The rates of a design by the names of its parameters; refuses unknown and doubled ones."""
    if not names or len(set(names)) != len(names):
        raise InvalidParameter("parameters", list(names), "at least one name, each once")
    design = asked.design
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
            rates.ends[i], rates.crossing[i] = _shape_rates(asked, name)
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
