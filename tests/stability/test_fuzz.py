"""Random designs and commands: three outcomes, and never a fourth."""

import math
from itertools import islice

from hypothesis import given, settings
from hypothesis import strategies as st

from studies.answers.settings import SplineSettings
from studies.stability import fuzz
from studies.stability.fuzz import TOLERANCE
from studies.stability.verdict import judged
from tests import gates

#: Values that no design can have, among those that it can.
BAD = (-1.0, 0.0, math.nan, math.inf)


def number(low, high):
    """Return a finite number of that range."""
    return st.floats(low, high, allow_nan=False, allow_infinity=False)


def power(low, high):
    """Return ten to the power of a number of that range, now and then a bad one."""
    return st.one_of(*[number(low, high).map(lambda e: 10.0**e)] * 9, st.sampled_from(BAD))


EXAMPLES = st.builds(
    fuzz._Example,
    length=power(-3.0, 0.5),
    inclination=number(0.1, 1.45),
    crossing_ratio=st.one_of(*[number(0.02, 0.98)] * 9, st.sampled_from(BAD)),
    slenderness=number(0.7, 4.0).map(lambda e: 10.0**e),
    youngs_modulus=power(6.0, 12.0),
    control_points=st.integers(4, 9),
    targets=st.lists(number(-3.5, 3.5), min_size=1, max_size=3).map(tuple),
    increments=st.integers(1, 25),
    step=st.one_of(st.none(), st.none(), st.none(), number(-3.0, 0.0).map(lambda e: 10.0**e)),
)


def hold(example):
    """Ask the spline with both settings, and refuse the outcome that must not be."""
    for settings_ in (SplineSettings(control_points=example.control_points), SplineSettings()):
        verdict = judged(lambda: fuzz._asked(example, settings_), TOLERANCE)  # noqa: B023 - called at once
        assert verdict["outcome"] in ("right", "refused", "bad input"), (example, verdict)
        assert verdict["outcome"] == "right" or len(verdict["reason"]) > 10, (example, verdict)


@settings(max_examples=30, deadline=None, derandomize=True, database=None)
@given(EXAMPLES)
def test_some_designs(example):
    """Requirement: thirty random examples are right, refused or bad input."""
    hold(example)


def from_elements(paths=2, **settings):
    """Largest difference of the first random paths from those of elements, over their largest torque."""
    found = [fuzz._independent(*each, **settings)["elements"] for each in islice(fuzz._sample(), paths)]
    assert all(row["legs_compared"] == row["legs"] for row in found)
    return max(row["error"] for row in found)


def test_random_paths_are_those_of_elements():
    """Requirement: paths of random designs, with all their legs, are those of finite elements."""
    gates.hold("random_paths_by_elements", from_elements)
