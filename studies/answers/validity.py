"""What an answer is worth: the ratios on which a planar beam rests, and in words what lies outside.

Of a strip of width b, thickness t and length L, bent to a radius R at its most: b/L says how much built-in
ends hold the section flat, b^2/(R t) how much strong bending flattens it, t/L what shear and roots take. A
planar beam knows none of it unless the scene names the effect; the remarks say about how much is missing.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from studies.cases.design import Design
from studies.cases.mechanism import Strip

if TYPE_CHECKING:
    from studies.answers.response import Response

#: Effects that a plain beam neglects.
CLAMPED_WIDTH, ANTICLASTIC, ROOTS = "clamped_width", "anticlastic", "root_compliance"
#: Share of the stiffness that may be missing before it is said [1].
WORTH_SAYING = 0.01
#: Largest strain of a linear material, smallest length over thickness of a beam [1].
STRAIN, SLENDERNESS = 0.02, 10.0
ROUND_OFF = 1e-9
#: Lengths [m], moduli [Pa] and densities [kg/m^3] that are not a slip of units.
LENGTHS, MODULI, DENSITIES = (1e-5, 5.0), (1e6, 1.3e12), (10.0, 23e3)


class Bent(NamedTuple):
    """A strip as a rectangle of its depth and area, with its largest strain and curvature.

    Attributes:
        part: of the design.
        strain: largest of an extreme fibre [1]; curvature: largest [1/m]; both zero before an answer.
    """

    part: Strip
    strain: float = 0.0
    curvature: float = 0.0

    @property
    def thickness(self) -> float:
        """Thickness t [m]."""
        return self.part.depth

    @property
    def width(self) -> float:
        """Width b = A/t [m]."""
        return self.part.area / self.part.depth

    @property
    def strength(self) -> float:
        """Yield strength [Pa], infinite if none is given."""
        return self.part.yield_strength or math.inf

    @property
    def width_ratio(self) -> float:
        """b/L [1]."""
        return self.width / self.part.length

    @property
    def thickness_ratio(self) -> float:
        """t/L [1]."""
        return self.thickness / self.part.length

    @property
    def curvature_ratio(self) -> float:
        """b^2/(R t) [1]."""
        return self.width**2 * self.curvature / self.thickness

    @property
    def stress(self) -> float:
        """E times the largest strain [Pa]."""
        return self.part.youngs_modulus * self.strain

    @property
    def clamped(self) -> tuple[float, float]:
        """Relative increase of the stiffness by lateral clamping, for a constant and a linear moment [1].

        It follows from the plate of the splines at b/L in two digits, so that many designs need few plates.
        """
        return _plate(float(f"{self.width_ratio:.2g}"), round(self.part.poisson_ratio, 2))

    @property
    def flattened(self) -> float:
        """Relative increase of the moment by suppressed anticlastic bending at the largest curvature [1]."""
        return float(anticlastic_factor(self.curvature_ratio, self.part.poisson_ratio)) - 1.0


def turned_roots(ratio: float) -> float:
    """Return the relative decrease of the stiffness by two supports from the same block at t/L [1]."""
    from spline_model.effects.registry import MONOLITHIC

    return 1.0 - 1.0 / (1.0 + 2.0 * MONOLITHIC * ratio)


def anticlastic_factor(ratio: Any, poisson_ratio: Any) -> Any:
    """Return M / (EI kappa) [1] at b^2 kappa / t = `ratio` [1], by the law of the splines; 1 if it has
    none."""
    from spline_model.strip.laws import curl_factors

    square = np.asarray(poisson_ratio, dtype=float) ** 2
    return curl_factors(np.nan_to_num(ratio), square[..., None], np.sqrt(3.0 * (1.0 - square)))[1]


@cache
def _plate(ratio: float, poisson_ratio: float) -> tuple[float, float]:
    from spline_model.effects.elastic import WIDTHS
    from spline_model.effects.plate import plate_factors

    constant, linear = plate_factors(min(max(ratio, WIDTHS[0]), WIDTHS[1]), poisson_ratio)
    return constant - 1.0, linear - 1.0


class _Rule(NamedTuple):
    """A limit of the model: its warning, with numbers of `_told_of` in braces; the ratio of a strip's value
    to the limit; and the effect that removes the limit."""

    says: str
    excess: Callable[[Bent], float]
    effect: str = ""


def _told_of(s: Bent) -> dict[str, float]:
    """Return the numbers of sentences, in the units they are told in."""
    return {
        "length": s.part.length, "modulus": s.part.youngs_modulus, "density": s.part.density,
        "thickness_mm": 1e3 * s.thickness, "width_mm": 1e3 * s.width,
        "slenderness": 1.0 / s.thickness_ratio, "b_L": s.width_ratio, "t_L": s.thickness_ratio,
        "b2_Rt": s.curvature_ratio, "low": 100.0 * s.clamped[0], "high": 100.0 * s.clamped[1],
        "flattened": 100.0 * s.flattened, "roots": 100.0 * turned_roots(s.thickness_ratio),
        "strain": 100.0 * s.strain, "stress": s.stress / 1e6, "strength": s.strength / 1e6,
    }  # fmt: skip


def _beyond(value: float, limits: tuple[float, float]) -> float:
    return max(limits[0] / value, value / limits[1])


#: Faults that the data alone show: wrong units, or exchanged dimensions.
DATA = (
    _Rule(
        "length = {length:.3g} m: expected 10 um to 5 m (millimetres instead of metres?)",
        lambda s: _beyond(s.part.length, LENGTHS),
    ),
    _Rule(
        "Young's modulus = {modulus:.3g} Pa: expected 1 MPa to 1300 GPa (GPa instead of Pa?)",
        lambda s: _beyond(s.part.youngs_modulus, MODULI),
    ),
    _Rule(
        "density = {density:.3g} kg/m^3: expected 10 to 23000 (g/cm^3 instead of kg/m^3?)",
        lambda s: _beyond(s.part.density, DENSITIES),
    ),
    _Rule(
        "thickness = {thickness_mm:.3g} mm, width = {width_mm:.3g} mm: expected the thickness, in the "
        "plane of bending, to be the smaller value (exchanged?)",
        lambda s: s.thickness / (s.width * (1.0 + ROUND_OFF)),
    ),
    _Rule(
        f"length over thickness = {{slenderness:.3g}}: expected at least {SLENDERNESS:g} for beam theory",
        lambda s: SLENDERNESS * s.thickness_ratio,
    ),
)
#: Effects that beam theory neglects, and limits of the material.
MODEL = (
    _Rule(
        "b/L = {b_L:.3g}: lateral clamping would increase the stiffness by about {low:.2g} to {high:.2g} % "
        "(enable: --effects=+clamped_width)",
        lambda s: s.clamped[1] / WORTH_SAYING,
        CLAMPED_WIDTH,
    ),
    _Rule(
        "b^2/(R t) = {b2_Rt:.3g}: anticlastic stiffening would increase the stiffness by up to "
        "{flattened:.2g} % (enable: --effects=+anticlastic)",
        lambda s: s.flattened / WORTH_SAYING,
        ANTICLASTIC,
    ),
    _Rule(
        "t/L = {t_L:.3g}: monolithic supports would reduce the stiffness by about {roots:.2g} % "
        "(enable: --effects=+root_compliance; ignore for clamped strips)",
        lambda s: turned_roots(s.thickness_ratio) / WORTH_SAYING,
        ROOTS,
    ),
    _Rule(
        f"strain = {{strain:.3g}} %: expected at most {100 * STRAIN:g} % for a linear material",
        lambda s: s.strain / STRAIN,
    ),
    _Rule(
        "stress = {stress:.4g} MPa: expected at most the yield strength, {strength:.4g} MPa",
        lambda s: s.stress / s.strength,
    ),
)


RULES = (*DATA, *MODEL)


@dataclass(frozen=True, kw_only=True)
class _Validity:
    """The largest ratios of all strips [1], as of `Strip`, and what is outside, a sentence each."""

    width_ratio: float
    curvature_ratio: float
    thickness_ratio: float
    strain: float
    outside: tuple[str, ...]


def validity(answer: "Response") -> _Validity:
    """Return the validity of an answer: its ratios, and the warnings about neglected effects."""
    strips = strips_of(answer.design, answer)
    ratios = ("width_ratio", "curvature_ratio", "thickness_ratio", "strain")
    most = {name: max(float(getattr(strip, name)) for strip in strips) for name in ratios}
    outside = (*_assumed(answer.design), *told(RULES, strips, answer.effects))
    return _Validity(**most, outside=outside)


def _assumed(design: Design) -> Iterator[str]:
    """Yield the sentence that strips have no stress as no one says where their outermost fibre is, if any."""
    unknown = [strip.name for strip in design.strips if math.isnan(strip.fibre)]
    if unknown:
        yield (
            f"stress: none without the distance of the outermost fibre of {', '.join(unknown)}: give "
            "outer_fibre_m, of a round rod its radius, or width_m and thickness_m"
        )


def told(rules: Iterable[_Rule], strips: list[Bent], effects: Iterable[str]) -> Iterator[str]:
    """Yield the warning of every rule that a strip breaks, for the strip that breaks it most."""
    named = set(effects)
    for rule in rules:
        worst = max(strips, key=rule.excess)
        if rule.excess(worst) > 1.0 and rule.effect not in named:
            yield rule.says.format(**_told_of(worst))


def strips_of(design: Design, forces: Any = None) -> list[Bent]:
    """Return the strips of a design, with the largest strain and curvature of an answer."""
    if forces is None:
        return [Bent(part) for part in design.strips]
    found = []
    for i, part in enumerate(design.strips):
        axial, moment = forces.axial_force[:, i], forces.bending_moment[:, i]
        b, t = part.growth(np.linspace(0.0, 1.0, moment.shape[-1]))
        rigidity = part.youngs_modulus * part.second_moment_of_area
        curvature = (np.abs(moment) / (b * t**3)).max(initial=0.0) / rigidity
        strain = part.extreme_fibre_strain(axial, moment).max(initial=0.0)
        found.append(Bent(part, float(strain), float(curvature)))
    return found
