"""Still, unstable and rigid are told alike by both models, at thresholds that know a design's round-off."""

import json
import re
from pathlib import Path

import pytest

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case

FINDS = Path(__file__).with_name("finds")
#: Few steps of each model for a second of the column.
PACE = {"spline": ["--step", 0.02], "fe": ["--elements", 8, "--integrator", "generalised-alpha"]}


@pytest.mark.parametrize("model", ["spline", "fe"])
@pytest.mark.parametrize("duration", [0.1, 6.0], ids=["short", "long"])
def test_a_column_beyond_its_load_is_unstable(model, duration, command):
    """At 1.6 Euler loads the start is an unstable equilibrium, however far round-off has grown since."""
    words = ["release", FINDS / "column_upright.toml", "--rotation-deg", 0, "--duration", duration]
    answer = json.loads(command(*words, "--model", model, *PACE[model], "--no-check", "--json", "-").out)
    assert answer["status"] == "converged"
    assert re.search("unstable equilibrium, where a disturbance grows e-fold in 0.2[01]", answer["message"])


@pytest.mark.parametrize("settings", [SplineSettings(control_points=6), FeSettings(elements=4)])
def test_the_smallest_turn_is_a_motion(settings):
    """A turn of 1e-7 rad is no equilibrium, none is one."""
    motions = [
        answer_release(named_case("cross_axis_pivot"), settings, start=turn, duration=1e-4)
        for turn in (1e-7, 0.0)
    ]
    assert [motion.starts_still for motion in motions] == [False, True]
    assert motions[1].message.startswith("nothing moves")
