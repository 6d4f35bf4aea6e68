"""How an answer to a hard case is judged: every way it can end."""

import math

import pytest

from studies.answers.settings import SplineSettings
from studies.errors import BadInput
from studies.paper import formulations
from studies.stability import verdict as columns
from studies.stability.verdict import OUTCOMES, Found, judged


def raising(error):
    """Return an attempt that raises."""

    def attempt():
        raise error

    return attempt


@pytest.mark.parametrize(
    ("attempt", "outcome"),
    [
        (lambda: Found(error=0.01), "right"),
        (lambda: Found(error=0.5), "wrong"),
        (lambda: Found(error=math.nan), "wrong"),
        (lambda: Found(error=math.inf), "wrong"),
        (lambda: Found(error=0.01, reached=False, reason="stopped"), "refused"),
        (lambda: Found(error=0.5, reached=False, reason="stopped"), "wrong"),
        (lambda: Found(error=0.5, reason="too coarse", states_limit=True), "refused"),
        (lambda: Found(error=0.01, reason="too coarse", states_limit=True), "right"),
        (lambda: Found(error=0.01, fault="energy grows", states_limit=True), "wrong"),
        (raising(BadInput("length: got -1")), "bad input"),
        (raising(ZeroDivisionError("division by zero")), "wrong"),
    ],
)
def test_every_ending_has_its_outcome(attempt, outcome):
    """An answer is right, refused, wrong or bad input; a refusal must leave a good state."""
    verdict = judged(attempt, 0.05)
    assert verdict["outcome"] == outcome
    assert outcome in OUTCOMES


def test_columns_are_what_they_say():
    """The default is the model's own default, and the paper's choices are those of the paper's figures."""
    assert columns.COLUMNS[columns.DEFAULT] == SplineSettings()
    assert columns.COLUMNS[columns.PAPER] == formulations.SETTINGS[formulations.PAPER]
    assert set(columns.COLUMNS) <= set(columns.ORDER)
