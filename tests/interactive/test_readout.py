"""Numbers as the user reads them: one formatter, no round-off, no nought with a sign."""

import re

import numpy as np
import pytest

from studies.interactive.presets import PRESETS
from studies.interactive.view import fixed, quantity
from tests.interactive.events import seen, session, turned


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        (quantity(0.00281, "N m"), "2.81 mN m"),
        (quantity(-3.12e-31, "N m", 1e-9), "0 N m"),
        (quantity(-0.0, "N"), "0 N"),
        (quantity(None, "N m/rad"), "–"),
        (quantity(999.7, "J"), "1 kJ"),
        (quantity(1.2e12, "Pa"), "1200 GPa"),
        (quantity(-4.5e-7, "J"), "-450 nJ"),
        (quantity(0.0, "N", 0.0, 4400.0), "0.0 ± 4.4 kN"),
        (quantity(-0.04, "N", 0.0, 4400.0), "0.0 ± 4.4 kN"),
        (quantity(2.945e-3, "N m", 0.0, 1.2e-5), "2.945 ± 0.012 mN m"),
        (fixed(-0.004, 2), "0.00"),
        (fixed(-1.23, 1), "-1.2"),
    ],
)
def test_quantity_is_written_as_it_should(written, expected):
    """Requirement: prefix, digits and spread suit the size; round-off is nought, without a sign."""
    assert written == expected


@pytest.mark.parametrize("drive", ["rotation", "pose"])
@pytest.mark.parametrize("preset", PRESETS)
def test_pivot_at_rest_reads_nought(preset, drive):
    """Requirement: at rest, and back there, no text holds round-off or a negative nought, and the
    sentence has the moment of the table."""
    made = session(preset, drive=drive)
    for state in (turned(made, 0), turned(made, 5, 2, 0)):
        texts = [*state["texts"].values(), state["status"]]
        assert [text for text in texts if re.search(r"e[-+]\d|(?<![\d.])-0(\.0*)?(?![\d.])", text)] == []
        assert (state["texts"]["moment"], state["texts"]["strain"]) == ("0 N m", "0 J")
        assert state["status"] == "Held at 0.0°: moment 0 N m, stress 0 % of yield."
    state = turned(made, 20, 45)
    assert f"moment {state['texts']['moment']}," in state["status"]


def test_scales_are_those_of_bending():
    """Requirement: the scale of moments is EI/L: half of the pivot's stiffness at rest."""
    state = turned(session("table-1"), 0)
    assert state["scale"]["moment"] == pytest.approx(state["stiffness"] / 2.0, rel=1e-3)


@pytest.mark.parametrize("preset", PRESETS)
def test_uncertainty_of_a_rotation_held_alone(preset):
    """Requirement: where the hand holds the rotation alone, the spread of the moment is the free stiffness
    times that of the rotation, the shift's follows the path, and forces, nought by make, have none."""
    made, sd = session(preset), [3e-5, 3e-5, 3e-4]
    body = turned(session(preset), 20, 40)["displacement"]
    for k in range(5):
        state = made.feed(
            {**seen(made, np.array(body[:2]) * k / 4, body[2] * k / 4), "sd": sd, "t": 0.04 * k}
        )
    around = [turned(session(preset), 20, 40 + change) for change in (-0.01, 0.01)]
    turn = around[1]["pose"][2] - around[0]["pose"][2]
    slope = (around[1]["force"][2] - around[0]["force"][2]) / turn
    assert state["force_sd"][:2] == [None, None]
    assert state["force_sd"][2] == pytest.approx(slope * sd[2], rel=1e-4)
    way = np.subtract(around[1]["pose"], around[0]["pose"]) / turn
    assert state["sd"] == pytest.approx(np.abs(way) * sd[2], rel=1e-4)
    assert "±" not in state["texts"]["force_x"]
    assert "±" in state["texts"]["moment"]
