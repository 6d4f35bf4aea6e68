"""Every load at rotations of either sign, at none and undriven: statics and modes of both models agree."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from studies.answers.adapters import answer_modes
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from tests import gates
from tests.agreement import loaded
from tests.agreement.loaded import LOADS, ROTATION, angle, apart, design

HELD = (ROTATION, -ROTATION, 0.0)
EFFECTS = pytest.mark.parametrize("effect", LOADS)
MODELS = pytest.mark.parametrize(
    "settings", [SplineSettings(control_points=10), FeSettings(elements=10)], ids=lambda s: s.model
)
#: The loads whose errors a gate is about: a body that is led is stiff, and its errors are larger.
STIFF = "driven_displacement"
QUANTITIES = ("torque", "stiffness", "path", "moments", "axial", "energy")


@EFFECTS
@pytest.mark.parametrize("rotation", [*HELD, None], ids=angle)
def test_loaded_statics_agree(effect, rotation):
    """Requirement: torque, stiffness, path, clamp moments, axial forces and energy agree under every load."""
    found = apart(design(effect, rotation))
    for name in QUANTITIES:
        if rotation is None and name in ("torque", "stiffness"):
            assert np.isnan(found[name])
        elif rotation != 0.0 or name != "path":  # at rotation 0 some bodies do not move at all
            gates.check("loads_led" if effect == STIFF else f"loads_{name}", max(found[name], 1e-16))


@pytest.mark.parametrize(
    "gate, effect", [*((f"loads_{name}", "applied_force") for name in QUANTITIES), ("loads_led", STIFF)]
)
def test_fewer_control_points_are_apart(gate, effect):
    """Requirement: fewer control points do not pass."""
    names = QUANTITIES if effect == STIFF else [gate.removeprefix("loads_")]
    gates.refuse(gate, lambda **grid: max(apart(design(effect), **grid)[name] for name in names))


def quotient(effect, rotation, settings, by=3e-4):
    """Difference of the stiffness from that of torques of two paths of their own, over EI/L."""
    asked = design(effect, rotation)
    torques = [
        loaded.state(replace(asked, rotation=rotation + turn), settings)["torque"] for turn in (by, -by)
    ]
    slope = (torques[0] - torques[1]) / (2.0 * by)
    return abs(loaded.state(asked, settings)["stiffness"] - slope) / loaded.MOMENT_UNIT


@MODELS
@EFFECTS
@pytest.mark.parametrize("rotation", [pytest.param(ROTATION, marks=pytest.mark.slow), -ROTATION], ids=angle)
def test_stiffness_is_the_slope_of_the_torque_at_fixed_loads(effect, rotation, settings):
    """Requirement: stiffness is the difference quotient of the torques of paths with the same full load."""
    gate = "loads_quotient_led" if effect == STIFF else "loads_quotient"
    gates.check(gate, quotient(effect, rotation, settings))
    if effect in ("applied_force", STIFF) and settings.model == "fe":
        gates.refuse(gate, partial(quotient, effect, rotation, settings))


def frequencies(asked: Design, settings: Settings, count: int = 3) -> np.ndarray:
    """Lowest frequencies about the state that the design is driven to, which is then released [Hz]."""
    answer = answer_modes(asked, settings, rotation=asked.rotation or 0.0, count=count)
    assert answer.converged, answer.message
    return answer.frequency


def modes_apart(asked: Design, control_points: int = 8, meshes: tuple[int, int] = (5, 10)) -> float:
    """Largest relative difference of the lowest frequencies from the limit of two meshes."""
    coarse, fine = (frequencies(asked, FeSettings(elements=count)) for count in meshes)
    found = frequencies(asked, SplineSettings(control_points=control_points))
    return float(np.abs(found / ((4.0 * fine - coarse) / 3.0) - 1.0).max())


@pytest.mark.parametrize("effect", LOADS)
@pytest.mark.parametrize(
    "rotation",
    [-ROTATION, *(pytest.param(each, marks=pytest.mark.slow) for each in (ROTATION, 0.0, None))],
    ids=angle,
)
def test_modes_about_loaded_states_agree(effect, rotation):
    """Requirement: the first three modes about a released state agree under every load."""
    gate, meshes = ("loads_modes_led", (10, 20)) if effect == STIFF else ("loads_modes", (5, 10))
    error = partial(modes_apart, design(effect, rotation), meshes=meshes)
    gates.check(gate, error())
    if effect in ("applied_force", STIFF) and rotation == -ROTATION:
        gates.refuse(gate, error)
