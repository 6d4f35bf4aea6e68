"""The numerical contract (docs/numerics.md): threads, compiler, processor and order do not change results."""

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
#: Commands with default settings, their options, and the arrays of the answer that are compared.
PATH = ("torque_Nm", "stiffness_Nm_per_rad", "strain_energy_J", "com_x_m", "max_stress_Pa")
ASKED = {
    "solve": (("--increments", "2"), PATH),
    "solve --model fe": (("--increments", "2"), PATH),
    "release": (("--duration", "1e-3", "--step", "5e-5"), ("rotation_rad", "kinetic_J", "com_x_m")),
    "modes": ((), ("frequency_Hz",)),
}
#: Largest relative difference that is none: round-off over all orders of the linkage's parts; frequencies
#: lose the digits by which the square of the highest exceeds that of the lowest.
SAME, SAME_FREQUENCY = 5e-12, 1e-9
#: The instructions that every processor of this architecture has.
PLAIN = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "OPENBLAS_CORETYPE": "Prescott"}


@cache
def answer(command, **variables):
    """Return the JSON of a command in a process of its own, on one thread unless asked otherwise."""
    name, *model = command.split()
    words = [sys.executable, "-m", "studies", name, CASE, *model, "--json", "-", *ASKED[command][0]]
    environment = os.environ | dict.fromkeys(THREADS, "1") | variables
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("command", ASKED)
@pytest.mark.parametrize(
    ("variables", "same"),
    [({"NUMBA_DISABLE_JIT": "1"}, SAME), (dict.fromkeys(THREADS, "4"), 0.0), (PLAIN, SAME)],
    ids=["not compiled", "four threads", "plain processor"],
)
@pytest.mark.slow
def test_surroundings_do_not_change_the_defaults(command, variables, same, tmp_path_factory):
    """Requirement: paths, motions and modes are the same without the compiler and on other processors, and
    equal in every digit on four threads."""
    if "NUMBA_CPU_NAME" in variables:  # compiled once, beside the kernels of this processor
        variables |= {"NUMBA_CACHE_DIR": str(tmp_path_factory.getbasetemp() / "plain")}
    one, other = answer(command), answer(command, **variables)
    for name in ASKED[command][1]:
        bound = max(same, SAME_FREQUENCY * (name == "frequency_Hz" and same > 0.0)) * np.abs(one[name]).max()
        np.testing.assert_allclose(other[name], one[name], rtol=0.0, atol=bound, err_msg=name)


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
