"""The page in a real browser: what it shows is what the commands `release` and `critical-load` answer."""

import math

import numpy as np
import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.answers.adapters import answer_release
from studies.answers.critical import critical_load
from studies.answers.metrics import swing_frequency
from studies.answers.settings import SplineSettings
from studies.interactive.presets import PRESETS
from studies.interactive.web.browser import executable
from tests.interactive.pages import chosen, turned, typed

pytestmark = [pytest.mark.slow, pytest.mark.skipif(executable() is None, reason="no Chromium on the PATH")]

#: Rotation of the release [rad], and simulated time that is compared [s].
START, DURATION = math.radians(30), 4.0
#: Simulated time, rotation and energy of the states since the release.
SWING = """
studio.ring.states.filter((s) => s.mode === "released" && s.simulated > 0).map((s) => [
  s.simulated, s.pose[2], s.energy.strain + s.energy.kinetic])
"""


def test_release_is_that_of_the_command(page):
    """Requirement: a release on the page has the frequency of `release` to 0.2 %, and its energy, at all
    times, to 2 % of that at the start."""
    turned(page, round(math.degrees(START)))
    page.key("r")
    page.wait(f"studio.state.simulated > {DURATION}", 90.0)
    time, rotation, energy = np.unique(page.ask(SWING), axis=0).T
    kept = time <= DURATION
    time, rotation, energy = time[kept], rotation[kept], energy[kept]
    options = {"duration": DURATION, "start": START, "records": 400}
    known = answer_release(PRESETS["polymer"].design, SplineSettings(), **options)
    at = np.array([0.0, *time])
    stored = known.strain_energy + known.kinetic_energy
    frequency = swing_frequency(at, np.array([START, *rotation])).value
    assert frequency == pytest.approx(known.swing.value, rel=2e-3)
    assert np.abs(energy - np.interp(time, known.time, stored)).max() <= 0.02 * stored[0]


@pytest.mark.parametrize("preset", PRESETS)
def test_buckling_load_is_that_of_the_command(page, preset):
    """Requirement: the load beyond which the page says "unstable" is that of `critical-load` to 1 %, and so
    is the one that it names."""
    chosen(page, "preset", preset)
    page.wait(f"studio.state.preset === '{preset}'")
    force = critical_load(PRESETS[preset].design, SplineSettings(), direction=-math.pi / 2).force
    unstable = "studio.state.warnings.some((w) => w.code === 'unstable')"
    for part, said in ((0.99, "!"), (1.01, "")):
        typed(page, "load, downward in N", part * force)
        page.wait(f"Math.abs(studio.state.values.load - {part * force}) < {1e-3 * force} && {said}{unstable}")
    assert page.wait("studio.state.critical") == pytest.approx(force, rel=0.01)
    typed(page, "load, downward in N", 0)
    page.wait("studio.state.values.load === 0")
