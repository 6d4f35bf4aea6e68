"""Releases of scenes with several loads, springs and supports: both models move alike."""

from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import Design
from studies.commands.release import SWINGS, _usual
from tests.agreement.random_scenes import listed
from tests.agreement.test_loads_release import UNSTEADY

#: Accuracy that either model is asked for, of rotations [rad] and places over a strip; they differ by both.
ACCURACY = 1e-3
LIMIT = 2.0 * ACCURACY
#: Swings that are followed, instants that are compared, and the share of the motion after which loads end
#: where no rotation is released.
FOLLOWED, INSTANTS, ENDS = 0.5, 30, 0.2
FEW, MANY = (1, 3), 30


def moving(seed: int) -> tuple[Design, float]:
    """Return a scene of lists that moves when it is released, and how long it is followed [s]."""
    design = listed(seed)
    duration = FOLLOWED * _usual(design, SplineSettings())[0] / SWINGS
    if design.rotation is not None:
        return design, duration
    history = ((0.0, 1.0), (ENDS * duration, 0.0))
    tables = dict(design.effects.tables)
    for name in set(UNSTEADY) & tables.keys():
        tables[name] = tuple({**own, "history": history} for own in design.effects.every(name))
    return replace(design, effects=replace(design.effects, tables=tables)), duration


def apart(seed: int) -> float | None:
    """Return the largest difference of rotations [rad] and places [1].

    None where a model has a remark, or hardly anything moves.
    """
    design, duration = moving(seed)
    asked = {"duration": duration, "accuracy": ACCURACY, "records": INSTANTS}
    found = []
    for settings in (SplineSettings(), FeSettings(elements=20)):
        answer = answer_release(design, settings, **asked)
        if not answer.converged or answer.message:
            return None
        found.append(np.stack(list(answer.bodies.values())))
    length = max(strip.length for strip in design.strips)
    spline, fe = (places / [length, length, 1.0] for places in found)
    return float(np.abs(spline - fe).max()) if np.ptp(fe, axis=1).max() > ACCURACY else None


def checked(seeds) -> int:
    """Compare scenes; return how many of them have no remark."""
    verdicts = {seed: apart(seed) for seed in seeds}
    silent = {seed: error for seed, error in verdicts.items() if error is not None}
    assert {seed: error for seed, error in silent.items() if error > LIMIT} == {}
    return len(silent)


def test_a_few_releases_of_lists_are_alike():
    """Requirement: rotations and places agree within what both promise."""
    assert checked(FEW) == len(FEW)


@pytest.mark.slow
def test_many_releases_of_lists_are_alike():
    """Requirement: the same of 30 scenes, or one model has a remark, or hardly anything moves."""
    assert checked(range(MANY)) > 0.7 * MANY
