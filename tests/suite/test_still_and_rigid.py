"""Still, unstable and rigid are told alike by both models, at thresholds that know a design's round-off."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from studies.answers.adapters import answer_release
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case

FINDS = Path(__file__).with_name("finds")
#: Few steps of each model for a second of the column.
PACE = {"spline": ["--step", 0.02], "fe": ["--elements", 8, "--integrator", "generalised-alpha"]}

#: Two bodies on a strip that nothing holds.
FREE = """
[[strips]]
name = "s"
start_m = [0, 0]
end_m = [0.1, 0]
root = "A"
tip = "B"
[[bodies]]
name = "A"
centre_m = [-0.01, 0.003]
mass_kg = 0.02
moment_of_inertia_kg_m2 = 3e-6
[[bodies]]
name = "B"
centre_m = [0.11, 0]
mass_kg = 0.05
moment_of_inertia_kg_m2 = 8e-6
[section]
width_m = 0.01
thickness_m = 0.0005
[material]
name = "titanium_6al_4v"
[drive]
body = "A"
increments = 5
"""


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


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_rigid_motions_are_rigid(model, tmp_path, command):
    """Two bodies on a strip that nothing holds have three rigid motions, which are not unstable."""
    case = tmp_path / "free.toml"
    case.write_text(FREE, encoding="utf-8")
    words = ["modes", case, "--model", model, "--count", 5]
    frequency = json.loads(command(*words, "--json", "-").out)["frequency_Hz"]
    assert frequency[:3] == [0.0, 0.0, 0.0]
    assert np.all(np.array(frequency[3:]) > 10.0)
    out = command(*words).out
    assert "3 of frequency 0: rigid motions that nothing holds" in out and "unstable" not in out
