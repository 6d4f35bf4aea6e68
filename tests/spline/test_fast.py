"""Many pivots at once: the digits of a batch do not depend on the order of rows or the number of threads."""

import numpy as np

from spline_model import solve_many
from tests.table_one import TABLE_ONE


def many(count=40):
    """Designs around Table 1, drawn once."""
    generator = np.random.default_rng(11)
    return [
        TABLE_ONE
        | {
            "crossing_ratio": generator.uniform(0.2, 0.8),
            "inclination": generator.uniform(0.6, 1.0),
            "second_moment_of_area": 1.041e-10 * generator.uniform(0.3, 3.0),
        }
        for _ in range(count)
    ]


def test_a_batch_is_the_same_in_any_order():
    """Requirement: a batch gives the answers of single solves, for any threads and order of rows."""
    designs = many()
    asked = {"rotation": 1.2, "increments": 20, "control_points": 6}
    one, two = (solve_many(designs, threads=count, **asked) for count in (1, 2))
    backwards = solve_many(designs[::-1], threads=2, **asked)
    for name in ("torque", "stiffness", "centre", "energy"):
        assert np.array_equal(getattr(one, name), getattr(two, name))
        assert np.array_equal(getattr(one, name), getattr(backwards, name)[::-1])
    assert one.converged.all()
