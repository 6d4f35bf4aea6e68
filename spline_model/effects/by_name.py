"""What each named effect makes of a design: the functions of the registry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from spline_model.basis import AxialModes, SlideModes
from spline_model.effects.constraints import DrivenDisplacement
from spline_model.effects.curl import curl_of
from spline_model.effects.damping import BodyDamper, StripDamping, StripDrag
from spline_model.effects.elastic import Bending, MixedStretching, RootCompliance, Stretching
from spline_model.effects.history import STEADY, History
from spline_model.effects.inertia import BodyInertia, SectionRotaryInertia, StripInertia
from spline_model.effects.loads import AppliedForce, AppliedMoment, BodyGravity, StripGravity, TipForce
from spline_model.errors import InvalidParameter, is_finite

if TYPE_CHECKING:
    from spline_model.design import Design, StripDesign
    from spline_model.scene import Effect

Vector = tuple[float, float]

MONOLITHIC = 0.416
"""Length of a root over the thickness: half-plane in plane stress, sharp corner, of any Poisson ratio."""


def bending(design: Design) -> Iterator[Effect]:
    """Bending of every strip, in the discretisation's measure, with the design's pre-strain and curl."""
    grid = design.discretisation
    for strip in design.strips:
        yield Bending(
            strip=strip.name,
            flexural_rigidity=strip.flexural_rigidity,
            natural_curvature=design.pre_strain.get("curvature", 0.0),
            curl=curl_of(design, strip),
            measure=grid.measure,
            gauss_points=grid.points_a_span,
        )


def stretching(design: Design) -> Iterator[Effect]:
    """Stretching of every strip: mixed, or by quadrature where the discretisation says so."""
    grid = design.discretisation
    for strip in design.strips:
        if grid.stretch != "consistent":
            yield from _mixed(design, strip, 1.0 / strip.axial_rigidity)
            continue
        yield Stretching(
            strip=strip.name,
            axial_rigidity=strip.axial_rigidity,
            natural_strain=design.pre_strain.get("strain", 0.0),
            measure=grid.measure,
            gauss_points=grid.points_a_span,
        )


def inextensible(design: Design) -> Iterator[Effect]:
    """Strips that keep their length: the mixed form with zero compliance."""
    for strip in design.strips:
        yield from _mixed(design, strip, 0.0)


def _mixed(design: Design, strip: StripDesign, compliance: float) -> Iterator[Effect]:
    grid = design.discretisation
    parts: list[tuple[float, AxialModes]] = [(compliance, grid.modes)]
    slide = grid.slide * strip.flexural_rigidity / strip.length**2
    if slide > 0 and grid.modes.count < grid.points - 1:
        parts.append((1.0 / slide, SlideModes(basis=grid.spline, axial=grid.modes)))
    for part, modes in parts:
        yield MixedStretching(
            strip=strip.name,
            axial_compliance=part,
            modes=modes,
            natural_strain=design.pre_strain.get("strain", 0.0),
            measure=grid.measure,
            gauss_points=grid.points_a_span,
        )


def strip_inertia(design: Design) -> Iterator[Effect]:
    """Translational inertia of every strip; without it strips are massless."""
    for strip in design.strips:
        yield StripInertia(strip=strip.name, linear_density=strip.linear_density)


def section_rotary_inertia(design: Design) -> Iterator[Effect]:
    """Rotary inertia of every strip's sections."""
    for strip in design.strips:
        yield SectionRotaryInertia(
            strip=strip.name, rotary_density=strip.density * strip.second_moment_of_area
        )


def body_inertia(design: Design) -> Iterator[Effect]:
    """Inertia of every body."""
    for body in design.bodies:
        yield BodyInertia(body=body.name, mass=body.mass, moment_of_inertia=body.moment_of_inertia)


def gravity(design: Design, acceleration: Vector = (0.0, -9.81)) -> Iterator[Effect]:
    """Weight of every strip and body; acceleration [m/s^2]."""
    for strip in design.strips:
        yield StripGravity(strip=strip.name, linear_density=strip.linear_density, acceleration=acceleration)
    for body in design.bodies:
        yield BodyGravity(body=body.name, mass=body.mass, acceleration=acceleration)


def strip_damping(design: Design, relaxation_time: float) -> Iterator[Effect]:
    """Kelvin-Voigt damping of every strip; relaxation_time [s]."""
    for strip in design.strips:
        yield StripDamping(strip=strip.name, relaxation_time=relaxation_time)


def strip_drag(design: Design, rate: float) -> Iterator[Effect]:
    """Mass-proportional drag on every strip; rate [1/s]."""
    for strip in design.strips:
        yield StripDrag(strip=strip.name, linear_density=strip.linear_density, rate=rate)


def body_damping(design: Design, translation: float = 0.0, rotation: float = 0.0) -> Iterator[Effect]:
    """Damper between every body and the ground; translation [N s/m], rotation [N m s]."""
    for body in design.bodies:
        yield BodyDamper(body=body.name, translation=translation, rotation=rotation)


def applied_force(
    design: Design, force: Vector, body: str | None = None, history: History = STEADY
) -> Iterator[Effect]:
    """Dead force [N] on a body, the only one if it is not named."""
    yield AppliedForce(body=design.body_named(body), force=force, history=history)


def applied_moment(
    design: Design, moment: float, body: str | None = None, history: History = STEADY
) -> Iterator[Effect]:
    """Moment [N m] on a body, the only one if it is not named."""
    yield AppliedMoment(body=design.body_named(body), moment=moment, history=history)


def tip_force(design: Design, strip: str, force: Vector, history: History = STEADY) -> Iterator[Effect]:
    """Dead force [N] at the free end of a strip."""
    if strip not in {s.name for s in design.strips if s.tip is None}:
        raise InvalidParameter("strip", strip, "a strip with a free end")
    yield TipForce(strip=strip, end="end", force=force, history=history)


def driven_displacement(
    design: Design,
    displacement: tuple[float | None, float | None],
    body: str | None = None,
    history: History | None = None,
) -> Iterator[Effect]:
    """Displacement [m] of a body's centre prescribed beside its rotation, None where it is free; in a motion
    only with a history."""
    yield DrivenDisplacement(body=design.body_named(body), displacement=displacement, history=history)


def pre_strain(design: Design, curvature: float = 0.0, strain: float = 0.0) -> Iterator[Effect]:
    """Natural curvature [1/m] and strain of the strips, from rest: bending and stretching take them up."""
    del design, curvature, strain  # the design carries them to the two potentials
    yield from ()


def clamped_width(design: Design) -> Iterator[Effect]:
    """Clamps that hold every strip's section flat over its width: bending takes it up."""
    del design
    yield from ()


def anticlastic(design: Design) -> Iterator[Effect]:
    """Sections that flatten as wide strips bend, M(kappa) by Ashwell's law: bending takes it up."""
    del design
    yield from ()


def root_compliance(design: Design, root: float | str) -> Iterator[Effect]:
    """Roots of all clamped ends, of length ``root`` over the thickness: "monolithic", or a number >= 0."""
    if root != "monolithic" and not (not isinstance(root, str) and is_finite(root) and root >= 0.0):
        raise InvalidParameter("root", root, '"monolithic" or a number >= 0, its length over the thickness')
    length = MONOLITHIC if isinstance(root, str) else root
    for strip in design.strips:
        if strip.thickness is None:
            needs = "width and thickness [m] for root_compliance"
            raise InvalidParameter(f"thickness of {strip.name}", None, needs)
        compliance = length * strip.thickness / strip.flexural_rigidity
        if compliance > 0.0:
            yield RootCompliance(strip=strip.name, end="start", compliance=compliance)
            if strip.tip is not None:
                yield RootCompliance(strip=strip.name, end="end", compliance=compliance)
