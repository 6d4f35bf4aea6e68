"""What lies beyond critical loads: a bent column and a toggle as finite elements."""

import numpy as np
import pytest

import fe_reference
from fe_reference import solve_mechanism
from tests.frames import column, toggle
from tests.gates import hold

EULER = np.pi**2 / 4.0


def test_a_bent_column_follows_the_elastica() -> None:
    """With a small side load the column bends smoothly to the elastica's angle at P = 2.5418 Pe, 140 deg."""

    def error(elements: int = 40) -> float:
        bent = column(fe_reference, load=EULER * 2.5422, side=1e-4, slenderness=1e4, elements=elements)
        answer = solve_mechanism(bent)
        assert answer.message == ""
        assert not answer.inertia.any()
        return float(abs(abs(np.degrees(answer.bodies["tip"][-1, 2])) - 140.0))

    hold("fe_bent_column", error)


def test_a_path_that_ends_at_a_limit_point_says_so() -> None:
    """Load control of a toggle stops at its limit point and names it, for any number of increments."""
    made, found = toggle(fe_reference, elements=6), []
    for increments in (7, 20):
        answer = solve_mechanism(made, increments=increments, raise_on_failure=False)
        (limit,) = answer.critical_points
        assert (answer.status.value, limit.kind) == ("not_converged", "limit point")
        assert answer.message.startswith("limit point: the strips give way with the body at ")
        found.append(limit.load_factor)
    assert found[0] == pytest.approx(found[1], rel=1e-8)
    assert found[0] == pytest.approx(0.5749, rel=0.02)
