"""Scenes of effects and mechanisms: what a case file and `--effects` say is what is assembled."""

import pytest

from spline_model import DEFAULT_EFFECTS, REGISTRY
from studies.cases.effects import DEFAULT
from studies.cases.keys import EFFECT_KEYS as KEYS
from studies.cases.problem import FOLDER

#: A coarse discretisation of each model; the splines' is nearly exact.
COARSE = {"spline": [], "fe": ["--elements", 8]}


SHIPPED = sorted(path.stem for path in FOLDER.glob("*.toml"))
QUICK = ("cross_axis_pivot", "parallel_strip_guide")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else pytest.mark.slow) for name in SHIPPED]
)
def test_shipped_cases_take_the_effects_of_their_sides(name, answered):
    """Every case that comes with the suite names its sides: both models take what asks for them, alike."""
    words = ("solve", name, "--effects=+clamped_width,+anticlastic,+root_compliance", "--increments", 2)
    spline, fe = (
        answered(*words, "--model", model, *coarse)["strain_energy_J"][-1] for model, coarse in COARSE.items()
    )
    assert fe == pytest.approx(spline, rel=5e-3)  # eight elements leave 2e-3 of Table 1's at 90 degrees


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_tables_of_effects_are_there_for_the_command_line(model, case, answered):
    """A table gives the parameters of an effect that --effects adds; without it weight is the earth's. A
    scene in the case gives the same, and a table that --effects takes out stays behind."""
    end = ("increments = 20", "increments = 2\n[effects.gravity]\nacceleration_m_per_s2 = [0, -9810]")
    words = ["--model", model, *COARSE[model], "--rotation-deg", 1, "--increments", 2]
    bare = answered("solve", case(), *words)
    assert bare["effects"] == ["bending", "stretching"]
    shifts = []
    for changes in ((), (end,)):
        loaded = answered("solve", case(*changes), *words, "--effects=+gravity")
        shifts.append(loaded["com_y_m"][0] - bare["com_y_m"][0])
    named = case((end[0], end[1].replace("[eff", '[scene]\neffects = ["+gravity"]\n[eff')))
    heavy = answered("solve", named, *words)
    assert heavy["com_y_m"] == loaded["com_y_m"]
    assert answered("solve", named, *words, "--effects=-gravity")["com_y_m"] == bare["com_y_m"]
    assert shifts[0] < 0.0
    assert shifts[1] == pytest.approx(1000.0 * shifts[0], rel=0.05)  # nearly linear


def test_effects_of_case_files_are_those_of_the_splines():
    """Every effect with keys is in the registry but the elements' shear; the default ones are the same."""
    assert set(KEYS) - {"shear"} <= set(REGISTRY)
    assert DEFAULT_EFFECTS == DEFAULT
