"""The names of the effects, and what each of them makes of a design.

An entry is a frozen effect of all strips and bodies, or a function of the design and of the effect's own
parameters that returns frozen effects. A new effect is such a function in a file of its own, and one line
here.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from inspect import signature
from typing import TYPE_CHECKING, Any

from spline_model.basis import SlideModes
from spline_model.effects import base, elastic, outside
from spline_model.errors import InvalidParameter, is_finite
from spline_model.scene import Body, Effect

if TYPE_CHECKING:
    from spline_model.design import Design, StripDesign

Parameters = Mapping[str, Mapping[str, Any] | Sequence[Mapping[str, Any]]]
Builder = Callable[..., Any]
"""Of one effect, or of frozen effects and frames of their own, which it yields."""

ROOTS = "root_compliance"
MONOLITHIC = 0.416
"""Length of a root over the thickness: half-plane in plane stress, sharp corner, of any Poisson ratio."""


def _bending(design: Design) -> Iterator[Effect]:
    """Bending of every strip, in the discretisation's measure, with the design's pre-strain and curl."""
    grid = design.discretisation
    for strip, whole, reach in design.pieces:
        yield elastic.Bending(
            strip=strip.name,
            flexural_rigidity=strip.flexural_rigidity,
            natural_curvature=design.pre_strain.get("curvature", 0.0),
            taper=strip.taper,
            curl=_curl(design, whole, reach),
            roots=_roots(design, whole, reach),
            measure=grid.measure,
            gauss_points=grid.quadrature,
        )


def _curl(design: Design, strip: StripDesign, reach: tuple[float, float]) -> elastic.Curl | None:
    """The curl of a strip over a ``reach`` of its length, if the design names an effect of it.

    Refused where it has none.
    """
    if not design.curling:
        return None
    names, nu, measure = " and ".join(design.curling), strip.poisson_ratio, design.discretisation.measure
    clamped, flattens = (name in design.curling for name in elastic.CURLING)
    width, thickness, natural = strip.width, strip.thickness, design.pre_strain.get("curvature", 0.0)
    if width is None or thickness is None:
        raise InvalidParameter(f"width of {strip.name}", width, f"width and thickness [m] for {names}")
    ratio, (low, high), name = width / strip.length, elastic.WIDTHS, strip.name
    widths = f"{low:g} to {high:g}"
    for right, what, got, expected in (
        (strip.rise == 0.0, f"rise of {name}", strip.rise, f"0, a straight strip, for {names}"),
        (strip.taper is None, f"taper of {name}", strip.taper, f"none for {names}"),
        (natural == 0.0, "natural curvature of pre_strain", natural, f"0 for {names}"),
        (0.0 <= nu <= 0.5, f"poisson_ratio of {name}", nu, f"0 to 0.5 for {names}"),
        (not flattens or measure == "material", "measure", measure, f"material for {elastic.ANTICLASTIC}"),
        (not clamped or strip.tip, f"tip of {name}", None, f"ground or a body for {elastic.CLAMPED_WIDTH}"),
        (not clamped or low <= ratio <= high, f"width over length of {name}", ratio, widths),
    ):
        if not right:
            raise InvalidParameter(what, got, expected)
    flattening = math.sqrt(3.0 * (1.0 - nu * nu)) * width**2 / thickness
    return elastic.Curl(
        poisson_ratio=nu, clamped=ratio * clamped, flattening=flattening * flattens, reach=reach
    )


def _roots(design: Design, strip: StripDesign, reach: tuple[float, float]) -> tuple[float, float]:
    """Lengths of the roots at the ends of a ``reach`` of a strip over its length; 0 where there is none."""
    if design.root_length == 0.0:
        return 0.0, 0.0
    if strip.thickness is None:
        needs = "width and thickness [m] for root_compliance"
        raise InvalidParameter(f"thickness of {strip.name}", None, needs)
    if strip.taper is not None:
        raise InvalidParameter(f"taper of {strip.name}", tuple(strip.taper), f"none for {ROOTS}")
    length = design.root_length * strip.thickness / (strip.length * (reach[1] - reach[0]))
    return length * (reach[0] == 0.0), length * (reach[1] == 1.0 and strip.tip is not None)


def _stretching(design: Design, stretches: bool = True) -> Iterator[Effect]:
    """Stretching of every strip: mixed, or by quadrature if the discretisation asks for it.

    stretches: whether they do; else they keep their length, the mixed form with zero compliance.
    """
    grid, slides = design.discretisation, design.discretisation.modes.count < design.discretisation.points - 1
    for strip, _, _ in design.pieces:
        given: dict[str, Any] = {"strip": strip.name, "natural_strain": design.pre_strain.get("strain", 0.0)}
        given |= {"measure": grid.measure, "gauss_points": grid.quadrature}
        if stretches and grid.stretch == "consistent":
            if strip.taper is not None:
                raise InvalidParameter("stretch", grid.stretch, f"mixed for the tapered {strip.name}")
            yield elastic.Stretching(axial_rigidity=strip.axial_rigidity, **given)
            continue
        compliance = 1.0 / strip.axial_rigidity if stretches else 0.0
        yield elastic.MixedStretching(
            axial_compliance=compliance, modes=grid.modes, taper=strip.taper, **given
        )
        if slides and grid.slide > 0:
            slide = grid.slide * strip.flexural_rigidity / strip.length**2
            modes = SlideModes(basis=grid.spline, axial=grid.modes)
            yield elastic.MixedStretching(axial_compliance=1.0 / slide, modes=modes, **given)


def root_length(root: float | str = "monolithic") -> float:
    """Return the length of a support over the thickness [1] of the parameter of "root_compliance".

    Raises
    ------
    InvalidParameter
        Neither "monolithic" nor a number that is not negative.
    """
    if isinstance(root, str) and root == "monolithic":
        return MONOLITHIC
    if isinstance(root, str) or not is_finite(root) or root < 0.0:
        raise InvalidParameter("root", root, '"monolithic" or a number >= 0, its length over the thickness')
    return root


REGISTRY: dict[str, Builder] = {
    "bending": _bending,
    "stretching": lambda design: _stretching(design),
    "inextensible": lambda design: _stretching(design, stretches=False),
    "strip_inertia": base.StripInertia,
    "section_rotary_inertia": base.SectionRotaryInertia,
    "body_inertia": base.BodyInertia,
    "gravity": base.Gravity,
    "strip_damping": base.StripDamping,
    "strip_drag": base.StripDrag,
    "body_damping": base.BodyDamper,
    **outside.SEVERAL,
    # bending and stretching take these up: clamps that hold sections flat over the width, sections that
    # flatten as wide strips bend (M(kappa) by Ashwell's law), and roots of all clamped ends
    "pre_strain": lambda design, curvature=0.0, strain=0.0: (),
    "clamped_width": lambda design: (),
    "anticlastic": lambda design: (),
    "root_compliance": lambda design, root="monolithic": (),
}

DEFAULT_EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")
INERTIA = ("strip_inertia", "section_rotary_inertia", "body_inertia")
MOTION_ONLY = (*INERTIA, "strip_damping", "strip_drag", "body_damping")
"""Effects that statics never asks for."""


def check_names(names: Sequence[str], parameters: Parameters) -> None:
    """Check the names of effects and of their parameters.

    Raises InvalidParameter for unknown, doubled, contradictory and missing effects, and for parameters of
    absent ones.
    """
    for name in (*names, *parameters):
        if name == "shear":
            raise InvalidParameter("effects", name, "splines without shear (use --model fe-shear)")
        if name not in REGISTRY:
            near = difflib.get_close_matches(name, REGISTRY, n=1)
            hint = f" (nearest: {near[0]})" if near else ""
            raise InvalidParameter("effects", name, f"one of {', '.join(REGISTRY)}{hint}")
    stretches = {"stretching", "inextensible"} & set(names)
    for wrong, got, expected in (
        (len(set(names)) != len(names), list(names), "each name once"),
        (len(stretches) > 1, "stretching and inextensible", "one of stretching, inextensible, not both"),
        ("bending" not in names, list(names), "bending, without which a strip has no stiffness"),
        (not stretches, list(names), "stretching or inextensible beside bending"),
    ):
        if wrong:
            raise InvalidParameter("effects", got, expected)
    for name in parameters:
        if name not in names:
            raise InvalidParameter(f"parameters of {name}", name, f"an effect of the scene, {list(names)}")
        if not isinstance(parameters[name], Mapping) and name not in outside.SEVERAL:
            raise InvalidParameter(f"parameters of {name}", parameters[name], "one mapping")


def build(names: Sequence[str], parameters: Parameters, design: Design) -> list[Effect | Body]:
    """Return the effects of these names for a design, in the order of the names, and frames of their own.

    parameters: in SI units by effect. The names were checked.

    Raises
    ------
    InvalidParameter
        A parameter that the effect rejects.
    """
    built: list[Effect | Body] = []
    for name in names:
        given, make = parameters.get(name), REGISTRY[name]
        of_all = isinstance(make, type)
        for each in ({},) if given is None else [given] if isinstance(given, Mapping) else given:
            try:
                built += [make(**each)] if of_all else make(design, **each)
            except TypeError as error:
                known = list(signature(make).parameters)[0 if of_all else 1 :]
                expected = "only " + ", ".join(known) if known else "none"
                raise InvalidParameter(f"parameters of {name}", sorted(each), expected) from error
    return built
