"""Rows of a sweep: the numbers of the models' own answers, and one for every design, come what may."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.cases.effects import DEFAULT, Effects
from studies.cases.problem import named_case
from studies.cases.section import of_sides
from studies.sweep import batch, points
from studies.sweep.plan import Plan
from studies.sweep.points import PATH, SHIFT, values
from tests.sweep.sweeps import GRID, RANDOM, plan


def rows(asked: Plan, start=0, stop=None):
    """Return the rows of points of a sweep."""
    columns = asked.rows(start, asked.points if stop is None else stop)
    return batch.solve_chunk(asked.task, start, columns).to_pandas()


#: A pivot whose section is given by its sides. Kernels and single paths begin from other guesses there: how
#: often they iterate is no answer.
SIDES = """
case = "titanium_pivot"
settings.control_points = 8
sample.method = "list"
[store]
quantities = ["torque_Nm", "stiffness_end_Nm_per_rad", "stress_max_Pa", "energy_J", "centre_shift_max_m"]
[vary]
"""


@pytest.mark.parametrize(
    ("text", "within"),
    [
        (GRID, 1e-11),
        # the shift is a difference of places that are up to a thousand times as large
        (RANDOM.replace("points = 200", "points = 12") + "[settings]\ncontrol_points = 6", 1e-10),
        (GRID + "drive.rotation_deg = [-40, 20]", 1e-11),
        (GRID + "drive.increments = [3, 5]\nstrip.outer_fibre_m = [0.001, 0.0025]", 1e-11),
        (GRID + "strip.slenderness = [15, 40]\nstrip.length_m = [0.05, 0.1]", 1e-11),
        (GRID + "material.youngs_modulus_Pa = [1e9, 2e11]\nstrip.area_m2 = [2e-5, 5e-5]", 1e-11),
        (GRID + "material.yield_strength_Pa = [1e8, 1e12]", 1e-11),
        (SIDES + "strip = { thickness_m = [2e-4, 3e-4], width_m = [0.008, 0.004] }", 1e-11),
        (SIDES + "strip = { slenderness = [80, 120], orientation_deg = [0, 40] }", 1e-11),
    ],
)
def test_the_kernel_and_single_solves_give_the_same_row(text, within):
    """Requirement: whatever of a pivot and of the settings varies is taken alike on both ways."""
    asked = plan(text)
    assert asked.task.batch
    by_batch = rows(asked)
    alone = rows(Plan(**{**vars(asked), "task": replace(asked.task, batch=False)}))
    assert set(by_batch["status"]) == set(alone["status"]) == {"converged"}
    for name in asked.task.quantities:
        scale = np.abs(alone[name]).max()
        one, other = by_batch[name] / scale, alone[name] / scale
        assert np.allclose(one, other, rtol=0.0, atol=within, equal_nan=True), name


def test_a_mechanism_is_swept_by_its_parts():
    """Requirement: keys of one strip and one body of a mechanism vary, and its bodies' places are stored."""
    asked = plan("""
        case = "four_bar_of_flexures"
        set.drive = { rotation_deg = 5, increments = 2 }
        vary.strips.crank_coupler.thickness_m = [3e-4, 4e-4]
        vary.bodies.coupler.centre_m.y = [0.1, 0.12]
    """)
    found = rows(asked)
    design = named_design("four_bar_of_flexures")
    strips = tuple(
        replace(strip, thickness=4e-4, **of_sides(0.01, 4e-4)) if strip.name == "crank_coupler" else strip
        for strip in design.strips
    )
    turned = replace(design, strips=strips, rotation=math.radians(5), increments=2)
    answer = answer_static(turned, SplineSettings())
    assert found["torque_Nm"][2] == answer.torque[-1]
    assert found["rocker_rotation_rad"][2] == answer.bodies["rocker"][-1, 2]
    assert found["coupler_y_m"][3] - found["coupler_y_m"][2] == pytest.approx(0.02, rel=0.2)
    assert (found["stress_max_Pa"] > 0).all()


def test_designs_without_an_answer_are_rows_with_their_reason():
    """Requirement: what stops, and what a model refuses, keeps its row, without numbers and with why."""
    found = rows(
        plan("""
            case = "cross_axis_pivot"
            set.drive = { rotation_deg = 350, increments = 2 }
            settings.control_points = 4
            vary.strip.crossing_ratio = [0.05, 0.5]
        """)
    )
    assert len(found) == 2
    stopped = found["status"] == "not_converged"
    assert stopped.any()
    assert (found["reason"][stopped].str.len() > 10).all()
    assert found["torque_Nm"][stopped].isna().all()
    refused = rows(plan('case = "cross_axis_pivot"\nvary.scene.effects = ["bending,stretching", "gravity"]'))
    assert refused["status"][0] == "converged"
    assert refused["status"][1] != "converged"
    assert refused["reason"][1]


def test_a_fault_at_one_design_is_told_in_its_row(monkeypatch):
    """Requirement: an error that nobody foresaw costs its own design only."""
    asked = plan(GRID)
    task = replace(asked.task, batch=False)
    real = points.static_answer

    def faulty(design, settings):
        if design.crossing_ratio == 0.5:
            raise ZeroDivisionError("seen by nobody")
        return real(design, settings)

    monkeypatch.setattr(points, "static_answer", faulty)
    found = rows(Plan(**{**vars(asked), "task": task}))
    assert list(found["status"]).count("failed") == 4
    assert set(found["reason"]) == {"error not estimated", "ZeroDivisionError: seen by nobody"}


def test_what_the_kernel_does_not_take_goes_one_by_one():
    """Requirement: inextensible strips, those too slender for the kernel and named materials get another
    path's."""
    for text in (
        'case = "titanium_pivot"\nvary.material.name = ["peek", "pla"]',
        GRID.replace("[set]", '[settings]\nstretch = "inextensible"\n[set]'),
        GRID + "strip.slenderness = [50, 20000]",
    ):
        found = rows(plan(text.replace("[4, 6]", "[6]").replace("points = 3", "points = 2")))
        assert set(found["status"]) == {"converged"}
        assert found["torque_Nm"].notna().all()


#: Natural curvature that the drive of the pivot undoes, so that the stress falls on the way.
UNBENT = replace(
    named_case("cross_axis_pivot"),
    rotation=0.2,
    increments=8,
    effects=Effects(names=(*DEFAULT, "pre_strain"), tables={"pre_strain": {"curvature": 3.0}}),
)


@pytest.mark.parametrize(
    "settings", [SplineSettings(control_points=6), FeSettings(elements=10)], ids=lambda s: s.model
)
def test_values_are_those_of_the_answer(settings):
    """Requirement: quantities are those of `solve`, and stress_max_Pa and its kin the largest of all states,
    also of a path that relaxes."""
    answer = answer_static(UNBENT, settings)
    found = {name: float(value[0]) for name, value in values(PATH | SHIFT, points.paths_of(answer)).items()}
    stress, torque = answer.max_stress, np.abs(answer.torque)
    assert stress.max() > 1.2 * stress[-1] and torque.max() > 1.2 * torque[-1]  # the path does relax
    shift = np.hypot(*answer.centre_shift.T)
    expected = {
        "torque_max_Nm": torque.max(),
        "stress_end_Pa": stress[-1],
        "stress_max_Pa": stress.max(),
        "strain_max": stress.max() / UNBENT.youngs_modulus,
        "stiffness_rest_Nm_per_rad": answer.stiffness[0],
        "stiffness_end_Nm_per_rad": answer.stiffness[-1],
        "stiffness_variation": np.ptp(answer.stiffness) / answer.stiffness[0],
        "centre_shift_end_m": shift[-1],
        "centre_shift_max_m": shift.max(),
    }
    assert {name: found[name] for name in expected} == pytest.approx(expected, rel=1e-9)
