"""Surroundings do not change answers: threads, the compiler, the order of strips and bodies."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.record.source import ROOT

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
CASE = "studies/cases/cross_axis_pivot.toml"
#: What is asked of the defaults, and the arrays of the answer that are compared.
ASKED = {
    "solve": (("--increments", "2"), ("torque_Nm", "stiffness_Nm_per_rad", "strain_energy_J", "com_x_m")),
    "release": (("--duration", "1e-3", "--step", "5e-5"), ("rotation_rad", "kinetic_J", "com_x_m")),
}
#: Largest relative difference that is none: round-off over all orders of the linkage's parts; frequencies
#: lose the digits by which the square of the highest exceeds that of the lowest.
SAME, SAME_FREQUENCY = 5e-12, 1e-9


@cache
def answer(command, **variables):
    """Return the JSON of a command in a process of its own, on one thread unless asked otherwise."""
    words = [sys.executable, "-m", "studies", command, CASE, "--json", "-", *ASKED[command][0]]
    environment = os.environ | dict.fromkeys(THREADS, "1") | variables
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("command", ASKED)
@pytest.mark.parametrize(
    "variables",
    [
        pytest.param({"NUMBA_DISABLE_JIT": "1"}, marks=pytest.mark.slow),
        pytest.param(dict.fromkeys(THREADS, "4"), marks=pytest.mark.slow),
    ],
    ids=["not compiled", "four threads"],
)
def test_surroundings_do_not_change_the_defaults(command, variables):
    """Requirement: path and motion of the default are the same whatever surrounds them."""
    one, other = answer(command), answer(command, **variables)
    for name in ASKED[command][1]:
        scale = np.abs(one[name]).max()
        np.testing.assert_allclose(other[name], one[name], rtol=0.0, atol=SAME * scale, err_msg=name)


@pytest.mark.parametrize("settings", [SplineSettings(), pytest.param(FeSettings(), marks=pytest.mark.slow)])
def test_order_of_strips_and_bodies_does_not_matter(settings):
    """Requirement: a linkage whose strips and bodies are listed backwards has the same path and modes."""
    given = replace(named_design("four_bar_of_flexures"), increments=4)
    turned = replace(given, strips=given.strips[::-1], bodies=given.bodies[::-1])
    one, other = (answer_static(each, settings) for each in (given, turned))
    for name in ("torque", "stiffness", "strain_energy"):
        found, known = getattr(other, name), getattr(one, name)
        np.testing.assert_allclose(found, known, rtol=0.0, atol=SAME * np.abs(known).max(), err_msg=name)
    modes = [answer_modes(each, settings, count=4).frequency for each in (given, turned)]
    np.testing.assert_allclose(*modes, rtol=SAME_FREQUENCY)
