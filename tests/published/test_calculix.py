"""CalculiX, another code for solids: where it is installed it agrees on the same mesh."""

import numpy as np
import pytest

from studies.cases.problem import named_case
from studies.errors import Unanswered
from studies.published import calculix
from studies.published.solid_pivot import STATES
from studies.published.solids import meshed, turned
from tests.gates import hold

ccx = pytest.mark.skipif(bool(calculix.STUDY.missing()), reason="ccx is not installed (calculix-ccx)")
PIVOT = named_case()


@ccx
def test_same_torque_on_the_same_mesh():
    """Torques agree up to 90 degrees; those of another material law do not."""

    def error(law="st-venant-kirchhoff"):
        strip = meshed(PIVOT, (8, 1, 1), law=law)
        path = turned(PIVOT, strip, STATES)
        return np.abs(calculix.driven(PIVOT, strip, path)[0] / path.torque - 1.0).max()

    hold("calculix", error)


@ccx
def test_a_state_that_is_not_reached_is_an_error():
    """Where CalculiX stops, the error has the number of states that it reached."""
    strip = meshed(PIVOT, (2, 1, 1))
    moves = np.full((1, len(strip.tip), 2), np.nan)
    with pytest.raises(Unanswered, match=r"^CalculiX: got 0 states, expected 1: "):
        calculix.end_forces(strip, moves)


def test_without_the_program_the_study_says_what_it_needs(monkeypatch):
    """Where CalculiX is absent, the study names it and how to install it."""
    monkeypatch.setattr(calculix, "PROGRAM", "no-such-program")
    assert calculix.STUDY.missing() == "it needs CalculiX: apt-get install calculix-ccx"
