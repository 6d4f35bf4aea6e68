"""Motion after release: what a run tells of itself, steps that are too long, stable and unstable ones."""

import numpy as np
import pytest

from fe_reference import ConvergenceError, Status, solve_release
from tests.fe.cases import pivot
from tests.gates import hold

QUARTER = np.pi / 2.0


def test_run_is_described() -> None:
    """A trajectory carries its step, its limit and its work, and samples as asked, the start first."""
    calls: list[tuple[int, int]] = []
    motion = solve_release(
        pivot(), start=0.5, duration=1e-4, samples=10, progress=lambda *call: calls.append(call)
    )
    assert len(motion.time) == 11 == len(calls) + 1
    assert motion.time[0] == 0.0
    assert motion.rotation[0] == 0.5
    assert motion.kinetic_energy[0] == 0.0
    assert motion.settings["step_s"] <= 0.9 * motion.settings["critical_step_s"]
    assert motion.counters["steps"] * motion.settings["step_s"] == pytest.approx(1e-4, rel=1e-12)


def test_implicit_step_without_solution_ends_the_run() -> None:
    """A step that no halving makes solvable ends the run with the motion until then."""
    motion = solve_release(
        pivot(),
        start=QUARTER,
        duration=10.0,
        step=1.0,
        integrator="generalised-alpha",
        raise_on_failure=False,
    )
    assert motion.status is not Status.CONVERGED
    assert motion.message != ""
    assert len(motion.time) >= 1


def test_an_implicit_step_that_is_too_long_is_told() -> None:
    """A step of 1 ms on a swing whose strips follow within it: halved where it gains energy, and told."""
    settings = {"start": 1.0, "duration": 0.02, "integrator": "generalised-alpha", "check": False}
    motion = solve_release(pivot(elements=10), **settings, step=1e-3)
    assert motion.counters["halvings"] > 0
    assert motion.energy_error < 0.01
    assert "steps in a mean period" in motion.resolution
    sound = solve_release(pivot(elements=10), **settings, step=1e-4)
    assert motion.rotation[-1] == pytest.approx(sound.rotation[-1], abs=0.05)
    assert sound.resolution == ""
    assert list(sound.columns())[:4] == ["time_s", "x_m", "y_m", "rotation_rad"]


def test_explicit_is_stable_and_keeps_its_energy() -> None:
    """At 0.9 of the limit the energy after release from 90 degrees stays; at 1.1 it does not."""

    def error(safety: float = 0.9) -> float:
        motion = solve_release(
            pivot(), start=QUARTER, duration=0.01, samples=200, safety=safety, raise_on_failure=False
        )
        return motion.energy_error if motion.status is Status.CONVERGED else np.inf

    hold("fe_explicit_energy", error)
    with pytest.raises(ConvergenceError, match=r"the energy grew from .* use a smaller time step") as failure:
        solve_release(pivot(), start=QUARTER, duration=0.002, safety=1.1)
    assert failure.value.solution.status is Status.UNSTABLE
