"""Effects with nothing in them, effects of the sides of strips, and what they make of these."""

from typing import Any

import numpy as np
import pytest

from fe_reference import (
    DEFAULT_EFFECTS,
    ELEMENTS,
    cross_axis_pivot,
    solve_mechanism,
    solve_motion,
    solve_statics,
    strip_fields,
)
from tests.fe.scenes import SIDED, WIDE, guide, pivot
from tests.gates import hold
from tests.spline.test_effects import ZERO
from tests.table_one import BARE, LENGTH

EVERY: dict[str, dict[str, Any]] = {**SIDED, "root_compliance": {"root": "monolithic"}}


def wide_pivot() -> dict[str, Any]:
    """Return a pivot of thin strips a third as wide as long, with all effects of their sides."""
    sides = {"width": 0.03, "thickness": 5e-4, "effects": (*DEFAULT_EFFECTS, *EVERY)}
    return BARE | sides | {"parameters": {"root_compliance": EVERY["root_compliance"]}}


@pytest.mark.parametrize("element", ELEMENTS)
def test_curvature_is_the_slope_of_the_rotation(element: str) -> None:
    """With all effects of the sides the curvatures at the nodes add up to the turns between them."""

    def error(elements: int = 320) -> float:
        model = cross_axis_pivot(**wide_pivot(), elements=elements, element=element)
        fields = strip_fields(model, solve_statics(model, rotation=1.0, increments=5).states[-1:])
        steps = np.diff(fields.arc_length)
        means = 0.5 * (fields.curvature[..., 1:] + fields.curvature[..., :-1])
        gaps = np.cumsum(means * steps, axis=-1) - (fields.rotation[..., 1:] - fields.rotation[..., :1])
        return float(np.abs(gaps).max())

    hold("fe_curvature_of_sides", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_sides_without_a_curl_change_nothing(element: str) -> None:
    """Without a Poisson effect and with stiff roots a strip is a beam, to the last digit."""
    pulled: dict[str, dict[str, Any]] = {"applied_force": {"force": (3.0, -2.0)}}
    nothing = {"clamped_width": {}, "anticlastic": {}, "root_compliance": {"root": 0.0}}
    strip = WIDE | {"poisson_ratio": 0.0}
    bare, named = (guide(each, section=strip, element=element) for each in (pulled, pulled | nothing))
    one, other = (solve_mechanism(model, increments=2) for model in (bare, named))
    for name in ("states", "curvature", "strain_energy", "largest_stress", "stiffness"):
        if hasattr(one, name):
            assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True)


MOTIONS = ({"step": 1e-7}, {"integrator": "generalised-alpha", "step": 1e-5})


@pytest.mark.parametrize("name", ZERO)
def test_zero_equals_absent(name: str) -> None:
    """An effect with a coefficient of zero gives the path and the motion of either scheme without it."""
    scene = {"effects": (*DEFAULT_EFFECTS, name), "parameters": {name: ZERO[name]}}
    bare, named = pivot(elements=4), pivot(elements=4, **scene)
    paths = [solve_statics(each, rotation=0.4, increments=5, order="together") for each in (bare, named)]
    assert np.abs(paths[0].torque - paths[1].torque).max() <= 1e-14 * paths[0].torque[-1]
    for how in MOTIONS:
        runs = [solve_motion(each, start=0.4, duration=1e-4, check=False, **how) for each in (bare, named)]
        assert np.ptp(runs[0].rotation) > 1e-6
        assert np.abs(runs[0].shape - runs[1].shape).max() <= 1e-14 * LENGTH
