"""The largest stress of an answer, where it is, and from where on the material yields."""

import csv
import io
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.strength import strength
from studies.cases.design import named_design, read_design
from studies.cases.problem import named_case

TABLE_1, SIX = named_case("cross_axis_pivot"), SplineSettings(control_points=6)


def yielding(limit):
    """Table 1 of a material of that yield strength."""
    return replace(TABLE_1, yield_strength=limit)


@pytest.mark.parametrize(("settings", "how"), [(SplineSettings(), {}), (FeSettings(), {"accuracy": 1e-4})])
def test_the_largest_stress_may_lie_between_stations(settings, how):
    """Requirement: both models have the stress of 640 elements where it is largest inside a strip."""
    design = read_design(Path(__file__).parent / "finds" / "mirror_pivot.toml")
    assert answer_static(design, settings, **how).max_stress[-1] == pytest.approx(171.937e6, rel=1e-5)


def test_every_strip_has_its_own_yield_strength():
    """Requirement: each strip is held against its own strength, and the first to yield counts."""
    design = replace(named_design("four_bar_of_flexures"), increments=4)
    limits = [400e6, 300e6, 200e6, 100e6]
    strips = tuple(replace(s, yield_strength=y) for s, y in zip(design.strips, limits, strict=True))
    design = replace(design, strips=strips)
    found = strength(answer_static(design, SIX))
    there = answer_static(replace(design, rotation=found.yields.rotation), SIX)
    assert (there.stress[-1].max(axis=1) / limits).max() == pytest.approx(1.0, rel=1e-6)
    assert found.yield_strength == next(s.yield_strength for s in strips if s.name == found.strip)


def test_a_design_that_bears_its_path_has_no_end_of_range():
    """Requirement: below the yield strength all along there is a safety above one and no such angle."""
    design = yielding(1e12)
    found = strength(answer_static(design, SIX))
    assert (found.yields, found.safety > 1.0) == (None, True)
    assert found.yield_strength == 1e12


def test_without_a_yield_strength_there_is_the_stress_alone():
    """Requirement: what is largest has its strip, its place in words, and its state."""
    found = strength(answer_static(TABLE_1, SIX))
    assert (found.strip, found.place, found.safety, found.yields) == ("strip_1", "at its root", None, None)
    assert math.degrees(found.rotation) == pytest.approx(90.0)


def test_solve_says_how_safe_it_is(case, command):
    """Requirement: a yield strength is told with the safety and the angle from which on it yields."""
    path = case(("poisson_ratio = 0.29", "poisson_ratio = 0.29\nyield_strength_Pa = 500e6"))
    lines = command("solve", path, "--increments", 40, "--control-points", 6).out.splitlines()
    assert any(line.startswith("safety 0.03") and "500.0 MPa: it yields from 4.54" in line for line in lines)


def test_what_rests_has_no_stress_and_no_safety(case, command):
    """Requirement: unturned and without a load round-off is not told as a stress, nor what it is to yield."""
    path = case(("poisson_ratio = 0.29", "poisson_ratio = 0.29\nyield_strength_Pa = 500e6"))
    out = command("solve", path, "--rotation-deg", 0, "--increments", 2, "--control-points", 6).out
    assert "no stress: nothing is turned, and no load acts" in out
    assert "safety" not in out


@pytest.mark.parametrize("settings", [SIX, FeSettings(elements=20)], ids=lambda s: s.model)
def test_stress_of_a_strip_bent_by_a_moment(settings, command):
    """Requirement: a mechanism's stress is M / W of the rectangle with its A and I, by both models."""
    design = named_design("cantilever_with_body")
    effects = replace(design.effects, names=("bending", "stretching", "applied_moment"))
    effects = replace(effects, tables={"applied_moment": {"moment": 0.1}})
    answer = answer_static(replace(design, rotation=None, effects=effects, increments=2), settings)
    (strip,) = design.strips
    modulus = math.sqrt(strip.area * strip.second_moment_of_area / 3.0)
    assert answer.max_stress[-1] == pytest.approx(0.1 / modulus, rel=1e-5)


def test_csv_is_a_row_a_state(case, command, tmp_path):
    """Requirement: --csv writes what the JSON has by state, in order, with units in the column names."""
    words = ["solve", case(), "--model", "fe", "--increments", 2]
    outcome = command(*words, "--csv", tmp_path / "path.csv")
    assert outcome.out.endswith(f"{tmp_path / 'path.csv'}: the answer as CSV\n")
    rows = list(csv.DictReader(io.StringIO((tmp_path / "path.csv").read_text(encoding="utf-8"))))
    assert [row["model"] for row in rows] == ["fe"] * 3
    answer = json.loads(command(*words, "--json", "-").out)
    for name in set(rows[0]) - {"model"}:
        assert [float(row[name]) for row in rows] == pytest.approx(answer[name], rel=1e-9, abs=1e-6)
