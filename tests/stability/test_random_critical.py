"""Critical loads of random asymmetric pivots in random directions: both models find the same, or none."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.critical import critical_load
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case

pytestmark = pytest.mark.slow

#: Relative difference of the two models.
SAME = 1e-3


def random_pivot(seed):
    """Return an asymmetric pivot and the direction of the force on it [rad]."""
    random = np.random.default_rng(seed)
    pivot = replace(
        named_case("cross_axis_pivot"),
        length=random.uniform(0.03, 0.1),
        inclination=math.radians(random.uniform(20.0, 70.0)),
        crossing_ratio=random.uniform(0.2, 0.8),
        centre_offset=tuple(random.uniform(-0.02, 0.02, 2)),
        rotation=0.0,
    )
    return pivot, random.uniform(-math.pi, math.pi)


@pytest.mark.parametrize("seed", range(30))
def test_both_models_find_the_same_critical_load(seed):
    """Requirement: the critical loads agree within 1e-3, or neither model has one; both are resolved."""
    pivot, direction = random_pivot(seed)
    spline, elements = (
        critical_load(pivot, s, direction=direction) for s in (SplineSettings(), FeSettings())
    )
    assert (spline.status, elements.status) == ("converged", "converged")
    assert spline.kind == elements.kind
    if spline.force is None:
        assert elements.force is None
        assert spline.soft == pytest.approx(elements.soft, rel=SAME)
    else:
        assert spline.force == pytest.approx(elements.force, rel=SAME)
