"""Errors of meshes: an accuracy that is asked for, and the level of the default."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_reference as fe
from studies.answers.models import put
from studies.answers.settings import FeSettings
from studies.commands.arguments import read_design
from tests.fe.scenes import pivot
from tests.gates import hold
from tests.models import extrapolated, scene


def apart(found: Any, exact: Any, name: str) -> float:
    """Return the largest difference of a quantity, in parts of its largest value."""
    one, two = (np.asarray(getattr(each, name)) for each in (found, exact))
    return float(np.abs(one - two).max() / np.abs(two).max())


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_the_limit_of_a_path_is_within_its_estimate(element: str) -> None:
    """Torque, stiffness, energy and largest stress err by less than estimated, which is what was asked."""
    coarse, exact = (
        fe.solve_statics(pivot(elements=4, element=element), rotation=1.0, increments=5, accuracy=accuracy)
        for accuracy in (1e-3, 1e-7)
    )
    assert coarse.estimate is not None and exact.estimate is not None
    assert coarse.estimate.largest <= coarse.estimate.accuracy
    assert exact.estimate.meshes[: len(coarse.estimate.meshes)] == coarse.estimate.meshes
    for name in ("torque", "stiffness", "strain_energy", "largest_stress"):
        assert 0.0 < apart(coarse, exact, name) < coarse.estimate.errors[name]
    assert coarse.shape.shape == exact.shape.shape == (6, 2, 5, 2)
    assert apart(coarse, exact, "bending_moment") < coarse.estimate.largest
    assert coarse.stations == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0], rel=1e-14)


def test_frequencies_have_a_limit() -> None:
    """The first frequencies about a bent state err by less than estimated."""
    coarse, exact = (
        fe.natural_frequencies(pivot(elements=6), rotation=0.5, count=3, accuracy=accuracy)
        for accuracy in (1e-3, 1e-7)
    )
    assert coarse.estimate is not None
    errors = np.abs(coarse.frequency / exact.frequency - 1.0)
    assert np.all(errors < list(coarse.estimate.errors.values()))
    with pytest.raises(fe.ConvergenceError, match=r"accuracy 1e-14 is not reached with up to \d+ elements"):
        fe.natural_frequencies(pivot(elements=6), rotation=0.5, count=3, accuracy=1e-14)


def test_an_accuracy_out_of_reach_is_told() -> None:
    """What round-off does not let reach is the best answer with its estimate, and not converged."""
    asked = {"rotation": 0.5, "increments": 2, "accuracy": 1e-13}
    best = fe.solve_statics(pivot(elements=4), raise_on_failure=False, **asked)
    assert best.status.value == "not_converged"
    assert "ask for no less" in best.message
    assert best.estimate is not None and best.estimate.largest > best.estimate.accuracy
    with pytest.raises(fe.ConvergenceError, match="is not reached"):
        fe.solve_statics(pivot(elements=4), **asked)
    pressed = pivot(elements=2, **scene(fe.DEFAULT_EFFECTS, applied_force={"force": (0.0, -1e6)}))
    stopped = fe.solve_mechanism(pressed, accuracy=1e-3, raise_on_failure=False)
    assert stopped.status.value == "not_converged" and stopped.estimate is None


def test_a_mesh_that_round_off_stops_leaves_the_coarser_ones_their_answer() -> None:
    """A chain of strips of 100, 0.2 and 100 mm: 160 elements stop at rest, with 41 bifurcations that are
    round-off, and were the answer. 20, 40 and 80 elements agree within 1.2e-4."""
    design = read_design(str(Path(__file__).parents[1] / "suite" / "finds" / "mixed_lengths.toml"))
    asked = put(design, FeSettings(elements=20))
    path = asked.static_path(raise_on_failure=False, accuracy=1e-5)
    assert path.estimate is not None and path.estimate.meshes == (20, 40, 80)
    assert not path.critical_points and path.load_factor[-1] == 1.0
    assert path.status.value == "not_converged"
    assert "round-off stops 160 elements; ask for no less" in path.message
    assert path.estimate.largest > 1e-5


QUANTITIES = {
    "torque": lambda path: path.torque,
    "trajectory": lambda path: path.centre,
    "stiffness": lambda path: path.stiffness,
}


@cache
def path(element: str, elements: int) -> fe.StaticSolution:
    return fe.solve_statics(pivot(element=element, elements=elements), rotation=np.pi / 2.0, increments=10)


def deviation(value: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest deviation over the path, over the largest change of the quantity on it."""
    size = np.linalg.norm(
        np.atleast_2d(exact.T - exact[0][..., None] if exact.ndim > 1 else exact), axis=0
    ).max()
    gap = value - exact
    return float((np.linalg.norm(gap, axis=1) if gap.ndim > 1 else np.abs(gap)).max() / size)


@pytest.mark.parametrize("element", fe.ELEMENTS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_level_of_twenty_elements(element: str, quantity: str) -> None:
    """Twenty elements are as near to the extrapolated value as stated."""
    pick = QUANTITIES[quantity]

    def error(elements: int = 20) -> float:
        return deviation(
            pick(path(element, elements)), extrapolated([pick(path(element, n)) for n in (40, 80, 160)])
        )

    hold(f"fe_level_{quantity}_{element}", error)
