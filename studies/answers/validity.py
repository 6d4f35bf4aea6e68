"""What an answer is worth: the ratios on which a planar beam rests, and in words what lies outside.

Of a strip of width b, thickness t and length L, bent to a radius R at its most: b/L says how much built-in
ends hold the section flat, b^2/(R t) how much strong bending flattens it, t/L what shear and roots take. A
planar beam knows none of it unless the scene names the effect; the remarks say about how much is missing.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from studies.cases.design import Design

if TYPE_CHECKING:
    from studies.answers.response import Response

#: Effects that a plain beam neglects.
CLAMPED_WIDTH, ANTICLASTIC, ROOTS = "clamped_width", "anticlastic", "root_compliance"
#: Share of the stiffness that may be missing before it is said [1].
WORTH_SAYING = 0.01
#: Largest strain of a linear material, smallest length over thickness of a beam [1].
STRAIN, SLENDERNESS = 0.02, 10.0
ROUND_OFF = 1e-9
#: What the strip of a design calls alike.
SAME_NAME = ("length", "youngs_modulus", "poisson_ratio", "density")
#: Lengths [m], moduli [Pa] and densities [kg/m^3] that are not a slip of units.
LENGTHS, MODULI, DENSITIES = (1e-5, 5.0), (1e6, 1.3e12), (10.0, 23e3)


@dataclass(frozen=True, kw_only=True)
class Strip:
    """A strip of rectangular section with its largest strain.

    Attributes:
        length, thickness, width: [m]; width follows from A = b t.
        youngs_modulus: [Pa]; poisson_ratio: [1]; density: [kg/m^3].
        strain: largest of an extreme fibre [1]; curvature: largest [1/m]; both zero before an answer.
        yield_strength: [Pa], infinite if none is given.
    """

    length: Any
    thickness: Any
    width: Any
    youngs_modulus: Any
    poisson_ratio: Any
    density: Any
    strain: Any = 0.0
    curvature: Any = 0.0
    yield_strength: Any = math.inf

    @property
    def width_ratio(self) -> Any:
        """b/L [1]."""
        return self.width / self.length

    @property
    def thickness_ratio(self) -> Any:
        """t/L [1]."""
        return self.thickness / self.length

    @property
    def curvature_ratio(self) -> Any:
        """b^2/(R t) [1]."""
        return self.width**2 * self.curvature / self.thickness

    @property
    def stress(self) -> Any:
        """E times the largest strain [Pa]."""
        return self.youngs_modulus * self.strain

    @property
    def clamped(self) -> tuple[Any, Any]:
        """Relative increase of the stiffness by lateral clamping, for a constant and a linear moment [1].

        It follows from the plate of the splines at b/L in two digits, so that many designs need few plates.
        """
        of = np.vectorize(lambda ratio, nu: _plate(float(f"{ratio:.2g}"), round(float(nu), 2)))
        low, high = of(self.width_ratio, self.poisson_ratio)
        return low, high

    @property
    def flattened(self) -> Any:
        """Relative increase of the moment by suppressed anticlastic bending at the largest curvature [1]."""
        return anticlastic_factor(self.curvature_ratio, self.poisson_ratio) - 1.0

    @property
    def turned_roots(self) -> Any:
        """Relative decrease of the stiffness by two supports from the same block [1]."""
        from spline_model.effects.registry import MONOLITHIC

        return 1.0 - 1.0 / (1.0 + 2.0 * MONOLITHIC * self.thickness_ratio)


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
    excess: Callable[[Strip], Any]
    effect: str = ""


def _told_of(s: Strip) -> dict[str, float]:
    """Return the numbers of sentences, in the units they are told in."""
    return {
        "length": s.length, "modulus": s.youngs_modulus, "density": s.density,
        "thickness_mm": 1e3 * s.thickness, "width_mm": 1e3 * s.width,
        "slenderness": 1.0 / s.thickness_ratio, "b_L": s.width_ratio, "t_L": s.thickness_ratio,
        "b2_Rt": s.curvature_ratio, "low": 100.0 * s.clamped[0], "high": 100.0 * s.clamped[1],
        "flattened": 100.0 * s.flattened, "roots": 100.0 * s.turned_roots, "strain": 100.0 * s.strain,
        "stress": s.stress / 1e6, "strength": s.yield_strength / 1e6,
    }  # fmt: skip


def _beyond(value: Any, limits: tuple[float, float]) -> Any:
    return np.maximum(limits[0] / value, value / limits[1])


#: Faults that the data alone show: wrong units, or exchanged dimensions.
DATA = (
    _Rule(
        "length = {length:.3g} m: expected 10 um to 5 m (millimetres instead of metres?)",
        lambda s: _beyond(s.length, LENGTHS),
    ),
    _Rule(
        "Young's modulus = {modulus:.3g} Pa: expected 1 MPa to 1300 GPa (GPa instead of Pa?)",
        lambda s: _beyond(s.youngs_modulus, MODULI),
    ),
    _Rule(
        "density = {density:.3g} kg/m^3: expected 10 to 23000 (g/cm^3 instead of kg/m^3?)",
        lambda s: _beyond(s.density, DENSITIES),
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
        lambda s: s.turned_roots / WORTH_SAYING,
        ROOTS,
    ),
    _Rule(
        f"strain = {{strain:.3g}} %: expected at most {100 * STRAIN:g} % for a linear material",
        lambda s: s.strain / STRAIN,
    ),
    _Rule(
        "stress = {stress:.4g} MPa: expected at most the yield strength, {strength:.4g} MPa",
        lambda s: s.stress / s.yield_strength,
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


def told(rules: Iterable[_Rule], strips: list[Strip], effects: Iterable[str]) -> Iterator[str]:
    """Yield the warning of every rule that a strip breaks, for the strip that breaks it most."""
    named = set(effects)
    for rule in rules:
        worst = max(strips, key=rule.excess)
        if rule.excess(worst) > 1.0 and rule.effect not in named:
            yield rule.says.format(**_told_of(worst))


def strips_of(design: Design, forces: Any = None) -> list[Strip]:
    """Return the strips of a design, with the largest strain and curvature of an answer."""
    found = []
    for i, part in enumerate(design.strips):
        given = {name: getattr(part, name) for name in SAME_NAME}
        strength, width = part.yield_strength or math.inf, part.area / part.depth
        strip = Strip(thickness=part.depth, width=width, yield_strength=strength, **given)
        if forces is not None:
            axial, moment = forces.axial_force[:, i], forces.bending_moment[:, i]
            b, t = part.growth(np.linspace(0.0, 1.0, moment.shape[-1]))
            most = (np.abs(moment) / (b * t**3)).max(initial=0.0)
            most /= part.youngs_modulus * part.second_moment_of_area
            strain = part.extreme_fibre_strain(axial, moment).max(initial=0.0)
            strip = replace(strip, strain=float(strain), curvature=float(most))
        found.append(strip)
    return found
