"""Beyond the critical points: which branch is stable, and that both models find it."""

import numpy as np
import pytest

from studies.record.store import Store
from studies.stability.buckling import OTHER, PRIMARY
from studies.stability.verdict import DEFAULT, FE, PAPER, TWELVE
from tests import gates


def tables():
    """Return the stored tables of the study."""
    return Store().load_tables("stability/buckling")


def on(branch, model):
    """Return the states of the pushed pivot on a branch, by depth."""
    rows = tables()["branches"].set_index("asked_mm").sort_index()
    return rows[(rows["model"] == model) & (rows["branch"] == branch)]


@pytest.mark.parametrize("model", [TWELVE, FE])
def test_the_turned_branch_is_the_stable_one(model):
    """Requirement: pushed beyond the buckling of its strips the pivot turns: stable, with less energy."""
    turned, straight = on(OTHER, model), on(PRIMARY, model)
    assert (turned["unstable_directions"] == 0).all()
    assert (straight["unstable_directions"] == 2).all()
    assert (turned["energy_J"] < straight["energy_J"]).all()


def energy_difference(model=TWELVE):
    """Largest difference of stored energy to that of the elements, over both branches and all depths."""
    return max(
        float(np.abs(on(branch, model)["energy_J"] / on(branch, FE)["energy_J"] - 1.0).max())
        for branch in (PRIMARY, OTHER)
    )


def test_both_models_are_on_the_same_branches():
    """Requirement: on either branch both models store the same energy."""
    gates.hold("buckling_branches", energy_difference)


def test_the_default_is_right():
    """Requirement: limits, branches and the turned pivot: the default finds each, none is refused."""
    counts = tables()["counts"].set_index("model")
    assert counts.loc[DEFAULT, "right"] == counts.loc[DEFAULT, "tried"]


def test_the_paper_s_choices_are_wrong():
    """The judgement has teeth: the locking cubic misses most of what is asked."""
    counts = tables()["counts"].set_index("model")
    assert counts.loc[PAPER, "wrong"] > counts.loc[PAPER, "tried"] / 2
    assert counts.loc[TWELVE, "right"] == counts.loc[TWELVE, "tried"]
