"""What a scene may name, what it is refused, and that it pays for nothing else."""

from functools import cache
from typing import Any

import numpy as np
import pytest

from fe_reference import (
    solve_mechanism,
    solve_motion,
)
from tests.fe.scenes import NOTHING, four_bar
from tests.gates import hold

STILL = ("gravity", "applied_force", "applied_moment", "pre_strain")


#: Motions of the four-bar, by either scheme.
MOVED: tuple[dict[str, Any], ...] = tuple(
    {"body": "crank", "duration": 1e-5, "step": step, "increments": 5, "integrator": integrator}
    for integrator, step in (("central-difference", 5e-8), ("generalised-alpha", 1e-6))
)


@cache
def without_it() -> tuple[Any, list[Any]]:
    """Path and motions of the four-bar without any of the effects."""
    bare = four_bar(elements=4)
    path = solve_mechanism(bare, body="crank", rotation=0.4, increments=5)
    return path, [solve_motion(bare, **settings, start=0.4) for settings in MOVED]


@pytest.mark.parametrize("name", NOTHING)
def test_zero_equals_absent(name: str) -> None:
    """An effect with a coefficient of zero leaves statics, motion and frequencies as they are without it."""

    def error(turn: float = 0.4) -> float:
        named, (path, motions) = four_bar({name: NOTHING[name]}, elements=4), without_it()
        gaps = []
        if name in STILL:
            other = solve_mechanism(named, body="crank", rotation=turn, increments=5)
            gaps = [(path.torque[-1] - other.torque[-1]) / path.torque[-1]]
            gaps += [np.abs(path.shape[-1] - other.shape[-1]).max() / 0.1]
        for settings, motion in zip(MOVED, motions, strict=True):
            other_way = solve_motion(named, **settings, start=turn)
            gaps.append(np.abs(motion.shape - other_way.shape).max() / 0.1)
        # the same operations in the same order leave nothing: one unit in the last place stands for it
        return max(*(float(abs(gap)) for gap in gaps), float(np.finfo(float).eps))

    hold("fe_zero_equals_absent", error)
