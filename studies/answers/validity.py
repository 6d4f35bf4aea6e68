"""What an answer is worth: the ratios on which a planar beam rests, and in words what lies outside.

Of a strip of width b, thickness t and length L, bent to a radius R at its most: b/L says how much built-in
ends hold the section flat, b^2/(R t) how much strong bending flattens it, t/L what shear and roots take. A
planar beam knows none of it unless the scene names the effect; the remarks say about how much is missing.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from studies.cases.design import Design
from studies.cases.problem import Problem
from studies.kinds import Array

#: Effects that take in what a plain beam leaves out.
CLAMPED_WIDTH, ANTICLASTIC, ROOTS = "clamped_width", "anticlastic", "root_compliance"
#: Share of the stiffness that may be missing before it is said [1].
WORTH_SAYING = 0.01
#: Largest strain of a linear material, smallest length over thickness of a beam [1].
STRAIN, SLENDERNESS = 0.02, 10.0
#: Length over which each root from the same block turns, over the thickness [1]: plane-stress half-plane,
#: sharp corner; O'Donnell measured near 0.44 (Journal of Applied Mechanics 27 (1960) 461).
ROOT = 0.416
#: Rates at which the share of plate action grows with b/L, for a constant moment and a linear one of zero
#: mean: fitted to the study model_form/plate, within an eighth.
PLATE_RATES = (0.86, 2.4)
ROUND_OFF = 1e-9
#: Lengths [m], moduli [Pa] and densities [kg/m^3] that are not a slip of units.
LENGTHS, MODULI, DENSITIES = (1e-5, 5.0), (1e6, 1.3e12), (10.0, 23e3)


class Forces(Protocol):
    """What an answer must know of the strips' forces: (S, G, P) by state, strip and station [N], [N m]."""

    @property
    def axial_force(self) -> Array:
        """N."""

    @property
    def bending_moment(self) -> Array:
        """M."""


@dataclass(frozen=True, kw_only=True)
class Strip:
    """A strip of rectangular section and the most that happens to it; numbers, or arrays over designs.

    Where only the largest strain is known, `bent` takes the curvature that it would be alone.

    Attributes:
        length, thickness, width: [m]; width follows from A = b t.
        youngs_modulus: [Pa]; poisson_ratio: [1]; density: [kg/m^3].
        strain: largest of an extreme fibre [1]; curvature: largest [1/m]; both zero before an answer.
        yield_strength: [Pa], infinite where none is given.
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

    def bent(self, strain: Any) -> "Strip":
        """Return the strip with that strain, and the curvature of which it would be all: an upper bound."""
        return replace(self, strain=strain, curvature=2.0 * strain / self.thickness)

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
        """Stiffness that clamps over the whole width add, of a constant and a linear moment [1]."""
        bound = self.poisson_ratio**2 / (1.0 - self.poisson_ratio**2)
        low, high = (bound * (1.0 - np.exp(-rate * self.width_ratio)) for rate in PLATE_RATES)
        return low, high

    @property
    def flattened(self) -> Any:
        """Moment that suppressed anticlastic bending adds at the largest curvature [1]."""
        return anticlastic_factor(self.curvature_ratio, self.poisson_ratio) - 1.0

    @property
    def turned_roots(self) -> Any:
        """Stiffness that two roots from the same block take [1]."""
        return 1.0 - 1.0 / (1.0 + 2.0 * ROOT * self.thickness_ratio)


def anticlastic_factor(ratio: Any, poisson_ratio: Any) -> Any:
    """Return M / (EI kappa) at b^2 kappa / t = `ratio`: 1 for small ones, 1 / (1 - nu^2) for large.

    x^2 = sqrt(3 (1 - nu^2)) ratio, f = (2/x) (cosh x - cos x) / (sinh x + sin x),
    M = D b kappa (1 - nu^2 (f + x f'/4)). Exact for circular bending of a thin strip away from its ends.
    D. G. Ashwell, Journal of the Royal Aeronautical Society 54 (1950) 708.
    """
    square = np.asarray(poisson_ratio, dtype=float) ** 2
    x = np.sqrt(np.sqrt(3.0 * (1.0 - square)) * np.asarray(ratio, dtype=float))
    x = np.clip(x, 1e-2, 300.0)  # below the series' error is round-off, above cosh ends and f is 2/x
    top, bottom = np.cosh(x) - np.cos(x), np.sinh(x) + np.sin(x)
    f = 2.0 / x * top / bottom
    slope = f * (-1.0 / x + bottom / top - (np.cosh(x) + np.cos(x)) / bottom)
    return (1.0 - square * (f + 0.25 * x * slope)) / (1.0 - square)


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A limit of the model, and the sentence that says that a strip lies beyond it.

    Attributes:
        excess: of the strip, how many times the limit it has. says: of a strip, numbers only.
        effect: that lifts the limit where it is named.
    """

    excess: Callable[[Strip], Any]
    says: Callable[[Strip], str]
    effect: str = ""


def _beyond(value: Any, limits: tuple[float, float]) -> Any:
    return np.maximum(limits[0] / value, value / limits[1])


#: What data alone give away: a slip of units, or dimensions that are exchanged.
DATA = (
    Rule(
        excess=lambda s: _beyond(s.length, LENGTHS),
        says=lambda s: f"length {s.length:.3g} m: expected 10 um to 5 m; are millimetres given as metres?",
    ),
    Rule(
        excess=lambda s: _beyond(s.youngs_modulus, MODULI),
        says=lambda s: (
            f"Young's modulus {s.youngs_modulus:.3g} Pa: expected 1 MPa to 1300 GPa; is it given in GPa?"
        ),
    ),
    Rule(
        excess=lambda s: _beyond(s.density, DENSITIES),
        says=lambda s: f"density {s.density:.3g} kg/m^3: expected 10 to 23000; is it given in g/cm^3?",
    ),
    Rule(
        excess=lambda s: s.thickness / (s.width * (1.0 + ROUND_OFF)),
        says=lambda s: (
            f"thickness {1e3 * s.thickness:.3g} mm, width {1e3 * s.width:.3g} mm: expected the "
            "thickness, in the plane of bending, to be the smaller; are they exchanged?"
        ),
    ),
    Rule(
        excess=lambda s: SLENDERNESS * s.thickness_ratio,
        says=lambda s: (
            f"length over thickness {1.0 / s.thickness_ratio:.3g}: expected at least "
            f"{SLENDERNESS:g}, below which it is no beam"
        ),
    ),
)
#: What a beam leaves out, and where its material ends.
MODEL = (
    Rule(
        excess=lambda s: s.clamped[1] / WORTH_SAYING,
        says=lambda s: (
            f"b/L {s.width_ratio:.3g}: clamps over the whole width make it stiffer by about "
            f"{100 * s.clamped[0]:.2g} to {100 * s.clamped[1]:.2g} %, which is left out"
        ),
        effect=CLAMPED_WIDTH,
    ),
    Rule(
        excess=lambda s: s.flattened / WORTH_SAYING,
        says=lambda s: (
            f"b^2/(R t) {s.curvature_ratio:.3g}: bent so far, a strip flattens and is stiffer by up to "
            f"{100 * s.flattened:.2g} %, which is left out"
        ),
        effect=ANTICLASTIC,
    ),
    Rule(
        excess=lambda s: s.turned_roots / WORTH_SAYING,
        says=lambda s: (
            f"t/L {s.thickness_ratio:.3g}: strips cut from one block with their bodies are softer "
            f"by about {100 * s.turned_roots:.2g} %, which is left out; clamped ones are not"
        ),
        effect=ROOTS,
    ),
    Rule(
        excess=lambda s: s.strain / STRAIN,
        says=lambda s: (
            f"strain {100 * s.strain:.3g} %: expected at most {100 * STRAIN:g} %, up to which the "
            "material is taken as linear"
        ),
    ),
    Rule(
        excess=lambda s: s.stress / s.yield_strength,
        says=lambda s: (
            f"stress {s.stress / 1e6:.4g} MPa: over the yield strength, {s.yield_strength / 1e6:.4g} MPa"
        ),
    ),
)


RULES = (*DATA, *MODEL)


@dataclass(frozen=True, kw_only=True)
class Validity:
    """The largest ratios of all strips, and what is outside, a sentence each.

    Attributes:
        width_ratio: b/L. curvature_ratio: b^2/(R t). thickness_ratio: t/L.
        strain: largest of an extreme fibre; all [1].
        outside: sentences; none where the model covers the answer.
    """

    width_ratio: float
    curvature_ratio: float
    thickness_ratio: float
    strain: float
    outside: tuple[str, ...]


def validity(
    design: Design, forces: Forces, *, effects: Iterable[str], yield_strength: float | None = None
) -> Validity:
    """Return what the answer to a design is worth.

    Args:
        design: that was asked.
        forces: the answer, or anything with `axial_force` and `bending_moment` (S, G, P) of all states.
        effects: names of what was assembled.
        yield_strength: of the material [Pa]; None for that of the design, where it has one.
    """
    strips = strips_of(design, forces, yield_strength)
    ratios = ("width_ratio", "curvature_ratio", "thickness_ratio", "strain")
    most = {name: max(float(getattr(strip, name)) for strip in strips) for name in ratios}
    return Validity(**most, outside=tuple(told(RULES, strips, effects)))


def doubts(design: Design) -> tuple[str, ...]:
    """Return what the data of a design give away before anything is solved, a sentence each."""
    return tuple(told(DATA, strips_of(design), ()))


def told(rules: Iterable[Rule], strips: list[Strip], effects: Iterable[str]) -> Iterator[str]:
    """Yield the sentence of every rule that a strip breaks, of the strip that breaks it most."""
    named = set(effects)
    for rule in rules:
        worst = max(strips, key=rule.excess)
        if rule.excess(worst) > 1.0 and rule.effect not in named:
            yield rule.says(worst)


def passed(strips: Iterable[Strip], effects: Iterable[str]) -> Any:
    """Return how many rules a design breaks by any of its strips; of arrays one number a design."""
    strips, named = tuple(strips), set(effects)
    rules = [rule for rule in RULES if rule.effect not in named]
    return sum(np.any([rule.excess(strip) > 1.0 for strip in strips], axis=0).astype(int) for rule in rules)


def strips_of(
    design: Design, forces: Forces | None = None, yield_strength: float | None = None
) -> list[Strip]:
    """Return the strips of a design, those of a pivot as one, with the most that an answer says of them."""
    parts: Any = (design,) if isinstance(design, Problem) else design.strips
    found = []
    for i, part in enumerate(parts):
        rectangle = math.sqrt(12.0 * part.second_moment_of_area / part.area)
        depth = part.depth if isinstance(part, Problem) else rectangle
        strip = Strip(
            length=part.length if isinstance(part, Problem) else math.dist(part.start, part.end),
            thickness=depth,
            width=part.area / depth,
            youngs_modulus=part.youngs_modulus,
            poisson_ratio=part.poisson_ratio,
            density=part.density,
            yield_strength=yield_strength or part.yield_strength or math.inf,
        )
        if forces is not None:
            own = slice(None) if isinstance(design, Problem) else slice(i, i + 1)
            rigidity = part.youngs_modulus * part.second_moment_of_area
            curvature = np.abs(forces.bending_moment[:, own]) / rigidity
            axial = np.abs(forces.axial_force[:, own]) / (part.youngs_modulus * part.area)
            strain = float((axial + 0.5 * depth * curvature).max(initial=0.0))
            strip = replace(strip, strain=strain, curvature=float(curvature.max(initial=0.0)))
        found.append(strip)
    return found
