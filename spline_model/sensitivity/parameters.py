"""Design parameters of a pivot or any mechanism: how fast points and sections change with each, and with
them what the strips' elements know of a design, as complex numbers: value + i STEP x its derivative."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.design import Design, StripDesign
from spline_model.effects import Bending
from spline_model.effects.plate import STEP
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.pivot import Pivot
from spline_model.reduced.model import Reduced
from spline_model.strip.element import CURL

Array = NDArray[np.float64]
Numbers = NDArray[Any]

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


def place_of(design: Design, name: str) -> tuple[str, tuple[Any, ...]]:
    """Where the numbers of that name stand: "section" or "sides" of strips, "ends" of one or "centres", as in
    ``Rates``, and the place there; "" for no name of a strip's or body's."""
    owner, _, field = name.rpartition(".")
    strips = [i for i, strip in enumerate(design.strips) if owner in ("", strip.name)]
    bodies = [i for i, body in enumerate(design.bodies) if owner == body.name]
    for part, names in (("section", MATERIAL), ("sides", SECTION)):
        if field in names and strips:
            return part, (strips, names.index(field))
    if field in POINTS and owner and strips:
        return "ends", (strips[0], *divmod(POINTS.index(field), 2))
    if field in CENTRES and bodies:
        return "centres", (bodies[0], CENTRES.index(field))
    return "", ()


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

    @classmethod
    def of(cls, asked: Mechanism, names: Sequence[str]) -> Rates:
        """The rates of a design by the names of its parameters; refuses unknown and doubled ones."""
        if not names or len(set(names)) != len(names):
            raise InvalidParameter("parameters", list(names), "at least one name, each once")
        design, count = asked.design, len(names)
        rates = cls(
            section=np.zeros((count, len(design.strips), 3)),
            ends=np.zeros((count, len(design.strips), 2, 2)),
            centres=np.zeros((count, len(design.bodies), 2)),
            crossing=np.zeros((count, 2)),
        )
        for i, name in enumerate(names):
            if isinstance(asked, Pivot) and name in SHAPE:
                rates.ends[i], rates.crossing[i] = _shape_rates(asked, name)
                rates.centres[i] = rates.ends[i, :, 1].mean(axis=0)
                continue
            part, at = place_of(design, name)
            if part == "ends" and design.strips[at[0]].rise != 0.0:
                raise InvalidParameter("parameters", name, "an end of a straight strip")
            if part == "sides":
                for s in at[0]:
                    rates.section[i, s, :2] = Section.of(design.strips[s]).rates(SECTION[at[1]])
            elif part:
                getattr(rates, part)[(i, *at)] = 1.0
            else:
                known = (*(SHAPE if isinstance(asked, Pivot) else ()), *MATERIAL, *SECTION)
                one = f"STRIP.{', STRIP.'.join(POINTS)} or BODY.{', BODY.'.join(CENTRES)}"
                raise InvalidParameter("parameters", name, f"one of {', '.join(known)}, {one}")
        return rates

    def by_length(self, strips: Sequence[StripDesign]) -> tuple[Array, Array]:
        """Derivatives (P, G) of log length and of direction [rad] of straight strips."""
        chord = np.array([np.subtract(s.end, s.start) for s in strips])
        moved = (self.ends[:, :, 1] - self.ends[:, :, 0]) / np.sum(chord**2, axis=1)[:, None]
        turned = chord[:, 0] * moved[..., 1] - chord[:, 1] * moved[..., 0]
        return np.sum(chord * moved, axis=-1), turned

    def points(self, model: Reduced) -> Numbers:
        """Derivatives (P, G, 2, 2) of the clamped points in their bodies' frames [m], free ends too."""
        moved = self.ends.copy()
        for end, bodies in enumerate((model.strips.roots, model.strips.tips)):
            for s, body in enumerate(bodies):
                if body >= self.centres.shape[1]:
                    moved[:, s, end] = 0.0
                elif body >= 0:
                    moved[:, s, end] -= self.centres[:, body]
        return moved

    def held(self, model: Reduced) -> Numbers:
        """Derivatives (P, D) of the driven coordinates: displacements begin at the centre at rest."""
        out = np.zeros((len(self.centres), len(model.bodies.held)))
        for d, place in enumerate(model.bodies.held):
            if place % 3 < 2:
                out[:, d] = self.centres[:, place // 3, place % 3] / model.length
        return out


def _shape_rates(pivot: Pivot, name: str) -> tuple[Array, Array]:
    """Derivatives of the strips' ends (2, 2, 2) and their crossing (2,) by a parameter of the shape.

    With the tangents t_i the roots are 0 and r L (t_1 - t_2), the crossing r L t_1.
    """
    by_length, by_angle, by_ratio = (float(name == each) for each in SHAPE)
    (ratio, length), tangents = pivot.crossing_reach, pivot.clamp_directions[:, 0]
    turned = by_angle * np.stack((-tangents[:, 1], tangents[:, 0]), axis=1) * [[1.0], [-1.0]]
    reach = (by_ratio * length + ratio * by_length) * tangents + ratio * length * turned
    ends = np.zeros((2, 2, 2))
    ends[1, 0] = reach[0] - reach[1]
    ends[:, 1] = ends[:, 0] + by_length * tangents + length * turned
    return ends, reach[0]


class Varied(NamedTuple):
    """What of ``Strips`` knows the design, (..., G, P, 1) each: by P parameters, the same at all states.

    speed, stretching; bending, the rigidity EI, and aspect and slimness, width and thickness over the length
    over those of the design, which ``along`` takes; curl as in ``Strips``; compliance (2, ...)
    of stretching and sliding; frames (2, 3, ...) of root and tip; reach (2, ...), away from the clamp;
    dead (n, 2, ...); area [m^2], second_moment [m^4]; longer: the length over that of the design. All else
    is over L and EI/L of the design.
    """

    speed: Numbers
    bending: Numbers
    aspect: Numbers
    slimness: Numbers
    curl: Numbers
    stretching: Numbers
    compliance: Numbers
    frames: Numbers
    reach: Numbers
    dead: Numbers
    area: Numbers
    second_moment: Numbers
    longer: Numbers

    @classmethod
    def of(cls, model: Reduced, design: Design, rates: Rates) -> Varied:
        """The strips of a design, which ``model`` is of."""
        strips, step = model.strips, 1j * STEP
        given = np.array([(s.area, s.second_moment_of_area, s.youngs_modulus) for s in design.strips])
        area, second_moment, modulus = 1.0 + step * (rates.section / given).T[..., None]
        lengthening, turning = (each.T[..., None] for each in rates.by_length(design.strips))
        longer = 1.0 + step * lengthening
        thickness = np.sqrt(second_moment / area)
        width = area / thickness
        rigidity = np.array([s.flexural_rigidity for s in design.strips]) / (model.energy * model.length)
        compliance = np.zeros((2, len(given)))
        for k, part in enumerate((slice(strips.split), slice(strips.split, None))):
            if strips.compliance[:, part].size:
                compliance[k] = strips.compliance[:, part][:, 0]
        frames = np.stack((strips.root.T, strips.tip.T))[..., None, None]
        points = rates.points(model).transpose(2, 3, 1, 0)[..., None] / model.length
        moved = np.concatenate((points, np.stack((turning, turning))[:, None]), axis=1)
        return cls(
            speed=_spread(strips.speed.T) * longer,
            bending=_spread(rigidity) * second_moment * modulus,
            aspect=width / longer,
            slimness=thickness / longer,
            curl=_spread(strips.along[:, 0, CURL]) * width**2 / thickness,
            stretching=_spread(strips.stretching) * area * modulus,
            compliance=_spread(compliance) * np.stack((1.0 / area, longer**2 / second_moment)) / modulus,
            frames=frames + step * moved,
            reach=_spread(strips.reach.T * [[1.0], [-1.0]]) * longer,
            dead=_spread(strips.dead.reshape(len(given), -1, 2).transpose(1, 2, 0)) * area * longer,
            area=_spread(given[:, 0]) * area,
            second_moment=_spread(given[:, 1]) * second_moment,
            longer=longer,
        )

    def along(self, model: Reduced, u: Numbers) -> tuple[Numbers, Numbers]:
        """The rigidity at small curvature and the drop of ``curl_law`` at u (Q,), (Q, G, P, 1)."""
        scene = model.system.scene
        degree, known = scene.strips[0].basis.degree, {e.strip: e for e in scene.of(Bending)}
        bends = [known[strip.name] for strip in scene.strips]
        curls = [replace(bend, roots=(0.0, 0.0)) for bend in bends]  # which roots take no part in
        square = [0.0 if bend.curl is None else bend.curl.poisson_ratio**2 for bend in bends]
        rigid, curled = (self._rigidity(each, degree, u) for each in (bends, curls))
        return rigid * self.bending, 1.0 - (1.0 - _spread(np.array(square))) * curled

    def _rigidity(self, bends: Sequence[Bending], degree: int, u: Numbers) -> Numbers:
        """The rigidity of strips at u (Q,) over that of beams, (Q, G, P, 1)."""
        rates = zip(*(each.rigidity_rates(degree, u) for each in bends), strict=True)
        found, by_width, by_thickness = (_spread(np.stack(each, axis=1)) for each in rates)
        return found + by_width * (self.aspect - 1.0) + by_thickness * (self.slimness - 1.0)


def _spread(values: Numbers) -> Numbers:
    """Values (..., G) beside parameters and states."""
    return values[..., None, None]
