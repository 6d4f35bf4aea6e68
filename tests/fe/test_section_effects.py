"""Effects of a strip's width, thickness and roots: what they need, and what they make of the strip."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    DEFAULT_EFFECTS,
    ELEMENTS,
    BodyDesign,
    Model,
    StripDesign,
    compliant_mechanism,
    cross_axis_pivot,
    natural_frequencies,
    plate_factors,
    solve_loads,
    solve_statics,
    strip_fields,
)
from tests.fe.cases import LENGTH, TABLE_1, extrapolated, with_shear_factor
from tests.fe.scenes import SIDED, WIDE, guide
from tests.gates import hold

BARE = {name: value for name, value in TABLE_1.items() if name not in ("area", "second_moment_of_area")}


#: Width over length and Poisson ratio of clamped strips.
SHAPES = [(0.1, 0.3), *(pytest.param(each, marks=pytest.mark.slow) for each in ((0.5, 0.45), (2.0, 0.25)))]
EVERY: dict[str, dict[str, Any]] = {**SIDED, "root_compliance": {"root": "monolithic"}}


def to_body(
    length: float,
    strip: Mapping[str, float],
    parameters: Mapping[str, Mapping[str, Any]],
    *,
    effects: Sequence[str] = DEFAULT_EFFECTS,
    mass: tuple[float, float] = (0.0, 0.0),
    **discretisation: Any,
) -> Model:
    """Return a horizontal strip from ground to a body of a mass and a moment of inertia."""
    return compliant_mechanism(
        strips=[StripDesign(name="strip", start=(0.0, 0.0), end=(length, 0.0), tip="body", **strip)],
        bodies=[BodyDesign(name="body", centre=(length, 0.0), mass=mass[0], moment_of_inertia=mass[1])],
        effects=(*effects, *parameters),
        parameters=parameters,
        **discretisation,
    )


def wide_pivot() -> dict[str, Any]:
    """Return a pivot of thin strips a third as wide as long, with all effects of their sides."""
    sides = {"width": 0.03, "thickness": 5e-4, "effects": (*DEFAULT_EFFECTS, *EVERY)}
    return BARE | sides | {"parameters": {"root_compliance": EVERY["root_compliance"]}}


def clamped(ratio: float, nu: float, effects: Sequence[str] = ("clamped_width",)) -> dict[str, Any]:
    """Return a pivot's thin strips of a width over length and a Poisson ratio."""
    sides = {"width": ratio * LENGTH, "thickness": 1e-3 * LENGTH, "poisson_ratio": nu}
    return BARE | sides | {"effects": (*DEFAULT_EFFECTS, *effects)}


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("element", ELEMENTS)
def test_clamped_strips_are_as_stiff_as_their_plates(element: str, shape: tuple[float, float]) -> None:
    """A pivot at rest has the stiffness sum EI/L (f_b + 12 (r - 1/2)^2 f_s) of the plate at any crossing."""
    plate = plate_factors(*shape)

    def error(effects: Sequence[str] = ("clamped_width",)) -> float:
        gaps = []
        for crossing in (0.5, 0.2, 0.9):
            model = cross_axis_pivot(
                **clamped(*shape, effects) | {"crossing_ratio": crossing}, element=element
            )
            beams = 2.0 * model.strips[0].section.flexural_rigidity / LENGTH
            known = beams * (plate.constant + 12.0 * (crossing - 0.5) ** 2 * plate.linear)
            gaps.append(solve_statics(model, rotation=0.0, increments=1).stiffness[0] / known - 1.0)
        return float(np.abs(gaps).max())

    hold(f"fe_clamped_width_{element}", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_roots_are_springs_at_both_clamps(element: str) -> None:
    """A strip that is bent to a half turn between two roots turns as one that is longer by root t at either,
    and its end sections turn from the bodies by the moment over the springs."""
    root, model = 3.0, to_body(0.1, WIDE, {"root_compliance": {"root": 3.0}}, element=element)
    rigidity, extra = model.strips[0].section.flexural_rigidity, root * WIDE["thickness"]

    def error(turn: float = 3.0) -> float:
        bent = solve_statics(model, rotation=turn, increments=5)
        moment = rigidity * 3.0 / (0.1 + 2.0 * extra)
        turns = strip_fields(model, bent.states[-1:]).rotation[0, 0]
        gaps = [bent.torque[-1] / moment - 1.0]
        gaps += [turns[0] * rigidity / (moment * extra) - 1.0]
        gaps += [(turn - turns[-1]) * rigidity / (moment * extra) - 1.0]
        return float(np.abs(gaps).max())

    hold("fe_roots", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_curvature_is_the_slope_of_the_rotation(element: str) -> None:
    """With all effects of the sides the curvatures at the nodes add up to the turns between them."""

    def error(elements: int = 80) -> float:
        model = cross_axis_pivot(**wide_pivot(), elements=elements, element=element)
        fields = strip_fields(model, solve_statics(model, rotation=1.0, increments=5).states[-1:])
        steps = np.diff(fields.arc_length)
        means = 0.5 * (fields.curvature[..., 1:] + fields.curvature[..., :-1])
        gaps = np.cumsum(means * steps, axis=-1) - (fields.rotation[..., 1:] - fields.rotation[..., :1])
        return float(np.abs(gaps).max())

    hold("fe_curvature_of_sides", error)


@pytest.mark.slow
def test_both_elements_have_one_limit_with_all_effects() -> None:
    """At large rotations both elements go to the same torque and place of the body where shear is stiff."""

    def error(factor: float = 1e4) -> float:
        limits = []
        for element in ELEMENTS:
            found = []
            for elements in (10, 20, 40, 80):
                model = cross_axis_pivot(**wide_pivot(), elements=elements, element=element)
                bent = solve_statics(with_shear_factor(model, factor), rotation=1.2, increments=6)
                found.append([bent.torque[-1], *(bent.bodies["body"][-1, :2] / LENGTH)])
            limits.append(extrapolated(found))
        return float(np.abs(limits[0] / limits[1] - 1.0).max())

    hold("fe_sides_in_both_elements", error)


@pytest.mark.slow
@pytest.mark.parametrize("element", ELEMENTS)
def test_frequencies_are_those_of_the_flexibility(element: str) -> None:
    """A body on one strip without mass has the frequencies of the plate's flexibility with both roots."""
    mass, inertia, length, root = 0.2, 1e-4, 0.1, 3.0
    plate = plate_factors(WIDE["width"] / length, WIDE["poisson_ratio"])
    rigidity = WIDE["youngs_modulus"] * WIDE["width"] * WIDE["thickness"] ** 3 / 12.0
    extra = root * WIDE["thickness"]
    rate = length**2 * (0.5 / plate.constant + extra / length)
    along = length**3 * (0.25 / plate.constant + 1.0 / (12.0 * plate.linear)) + length**2 * extra
    turning = length / plate.constant + 2.0 * extra
    flexibility = np.array([[along, rate], [rate, turning]]) / rigidity
    periods = np.linalg.eigvals(flexibility @ np.diag([mass, inertia])) ** 0.5
    known = np.sort(1.0 / (2.0 * np.pi * periods))

    def error(rotation: float | None = None) -> float:
        found = []
        for elements in (20, 40, 80):
            model = to_body(
                length,
                WIDE,
                {"clamped_width": {}, "anticlastic": {}, "root_compliance": {"root": root}},
                effects=("bending", "stretching", "body_inertia"),
                mass=(mass, inertia),
                elements=elements,
                element=element,
            )
            modes = natural_frequencies(with_shear_factor(model, 1e4), rotation=rotation, count=2)
            found.append(modes.frequency / known - 1.0)
        return float(np.abs(extrapolated(found)).max())

    hold("fe_sides_modes", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_sides_without_a_curl_change_nothing(element: str) -> None:
    """Without a Poisson effect and with stiff roots a strip is a beam, to the last digit."""
    nothing = {"clamped_width": {}, "anticlastic": {}, "root_compliance": {"root": 0.0}}
    strip = WIDE | {"poisson_ratio": 0.0}
    bare, named = (guide(each, section=strip, element=element) for each in ({}, nothing))
    one, other = (solve_loads(model, force=(3.0, -2.0), increments=2) for model in (bare, named))
    for name in ("states", "curvature", "strain_energy", "largest_stress", "stiffness"):
        if hasattr(one, name):
            assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True)
