"""Scenes with several loads, springs and supports: both models have the same states, reactions and modes."""

import numpy as np
import pytest

from studies.answers.adapters import answer_modes
from studies.answers.models import put
from studies.answers.response import Response
from studies.answers.settings import FeSettings, SplineSettings
from studies.commands.answer import not_estimated
from tests.agreement.random_scenes import listed

#: Each model promises 1e-4 of states, and 1e-3 of frequencies where it is asked for that.
LIMIT, OF_MODES = 2e-4, 2e-3
FEW, MANY = (1, 3, 4, 13), 60
#: Scenes in which forces hold bodies.
HELD = (1, 2, 5)


def measured(answer):
    """What is compared over the states: places, torque, what is exerted, energy of springs."""
    places = np.hstack([place - place[0] for place in answer.bodies.values()])
    found = {"places": places, "torque": answer.torque, "exerted": answer.solution.reactions}
    return found | {"springs": np.asarray(answer.solution.spring_energy)}


def apart(design):
    """Return the differences of both models over the largest value, by name; None where one has a remark."""
    found = []
    for settings, how in ((SplineSettings(), {}), (FeSettings(elements=20), {"accuracy": 1e-4})):
        asked = put(design, settings)
        answer = Response.of(asked, asked.static_path(raise_on_failure=False, **how))
        if not answer.converged or answer.message or answer.resolution:
            return None
        found.append(measured(answer))
    spline, fe = found
    sizes = {name: np.abs(values).max(initial=0.0) for name, values in fe.items()}
    return {
        name: float(np.abs(spline[name] - fe[name]).max() / size)
        for name, size in sizes.items()
        if np.isfinite(size) and size > 0.0
    }


def checked(seeds):
    """Compare scenes; return how many of them have no remark."""
    verdicts = {seed: apart(listed(seed)) for seed in seeds}
    silent = {seed: errors for seed, errors in verdicts.items() if errors is not None}
    assert {seed: errors for seed, errors in silent.items() if max(errors.values()) > LIMIT} == {}
    return len(silent)


def test_a_few_scenes_of_lists_are_alike():
    """Requirement: places, torque, what is exerted and the springs' energy agree to 2e-4."""
    assert checked(FEW) == len(FEW)


def exerted(design, settings, accuracy):
    """Return what is exerted on bodies but the torque of the drive (S, D), and the answer."""
    asked = put(design, settings)
    answer = Response.of(asked, asked.static_path(raise_on_failure=False, accuracy=accuracy))
    parts = answer.solution.prescribed
    own = [at for at, part in enumerate(parts) if part != (answer.solution.driven, "rotation")]
    return answer.solution.reactions[:, own], answer


@pytest.mark.parametrize("seed", HELD)
@pytest.mark.parametrize(
    ("coarse", "name"),
    [(SplineSettings(control_points=6), "reactions"), (FeSettings(elements=4), "exerted")],
    ids=["spline", "fe"],
)
def test_the_estimate_of_what_is_exerted_covers_its_error(coarse, name, seed):
    """Requirement: forces that supports and drives exert have an estimate, not below half of the error that
    the other model shows, and none of them is called not estimated."""
    other = FeSettings(elements=20) if coarse.model == "spline" else SplineSettings(control_points=12)
    mine, answer = exerted(listed(seed), coarse, 1.0)
    right, _ = exerted(listed(seed), other, 1e-6 if coarse.model == "spline" else None)
    error = float(np.abs(mine - right).max() / np.abs(right).max())
    assert error > 1e-8
    assert 0.5 * error <= answer.errors[name] < 100.0 * error
    assert not any("exerted" in part for part in not_estimated(answer))


@pytest.mark.slow
def test_many_scenes_of_lists_are_alike():
    """Requirement: the same of 60 scenes, or one model has a remark."""
    assert checked(range(MANY)) > 0.7 * MANY


@pytest.mark.slow
def test_modes_of_scenes_of_lists_are_alike():
    """Requirement: the lowest two frequencies about the end of the path agree to 2e-3."""
    compared = 0
    for seed in range(0, MANY, 2):
        design = listed(seed)
        asked = {"rotation": design.rotation, "count": 2, "accuracy": 1e-3}
        spline, fe = (
            answer_modes(design, each, **asked) for each in (SplineSettings(), FeSettings(elements=20))
        )
        if spline.converged and fe.converged:
            assert fe.frequency == pytest.approx(spline.frequency, rel=OF_MODES), seed
            compared += 1
    assert compared > MANY // 3
