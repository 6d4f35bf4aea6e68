"""CalculiX, another code for solids: where it is installed it agrees on the same mesh."""

import numpy as np
import pytest

from studies.errors import Unanswered
from studies.published import calculix
from studies.published.solids import PIVOT, STIFF, Design
from studies.record.store import Store
from tests.gates import hold

ccx = pytest.mark.skipif(bool(calculix.missing()), reason="ccx is not installed (calculix-ccx)")
DESIGN = Design(step=9.0, states=10)


@ccx
def test_same_torque_on_the_same_mesh():
    """Torques agree up to 90 degrees; those of another material law do not."""

    def error(law="st-venant-kirchhoff"):
        strip = DESIGN.strip(1, law)
        path = DESIGN.solids(strip)
        return np.abs(calculix.driven(DESIGN.pivot, strip, path)[0] / path.torque - 1.0).max()

    hold("calculix", error)


@ccx
def test_a_state_that_is_not_reached_is_an_error():
    """Where CalculiX stops, the error has the number of states that it reached."""
    strip = DESIGN.strip(1)
    moves = np.full((1, len(strip.tip)), np.nan + 0.0j)
    with pytest.raises(Unanswered, match=r"^CalculiX: got 0 states, expected 1: "):
        calculix.end_forces(strip, moves)


def test_stored_torque_is_that_of_the_stored_solids():
    """The committed results of CalculiX agree with solids on the same meshes; a gate has how far."""

    def error(law=STIFF):
        key = ["fineness", "rotation_rad"]
        solids = Store().load_tables("model_form/solid_pivot")["meshes"]
        own = solids.query(f"design == '{PIVOT}' and element == 'serendipity' and law == '{law}'")
        both = Store().load_tables("model_form/calculix")["states"].merge(own, on=key)
        assert len(both) == 13 * len(calculix.MESHES)
        return (both["torque_Nm_x"] / both["torque_Nm_y"] - 1.0).abs().max()

    hold("calculix_stored", error)


def test_without_the_program_the_study_says_what_it_needs(monkeypatch):
    """Where CalculiX is absent, the study names it and how to install it."""
    monkeypatch.setattr(calculix, "PROGRAM", "no-such-program")
    assert calculix.STUDY.missing() == "it needs CalculiX: apt-get install calculix-ccx"
