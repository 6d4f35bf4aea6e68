"""The largest stress of an answer and from where on it yields; what an answer warns of."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from studies.answers import validity
from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.answers.strength import strength
from studies.cases.design import named_design, read_design
from studies.cases.mechanism import Strip
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from tests import gates
from tests.agreement.test_section_laws import ASHWELL, RITZ

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


def doubts(design):
    """Return what the data of a design give away before anything is solved."""
    return tuple(validity.told(validity.DATA, validity.strips_of(design), ()))


@cache
def case_solved(name):
    """Return a case and its answer."""
    given = named_case(name)
    return given, answer_static(given, SIX)


def left_out(answer, *effects):
    """Return the neglected effects of an answer if these effects are named."""
    return list(validity.told(validity.RULES, validity.strips_of(answer.design, answer), effects))


def test_what_is_left_out_is_said_until_an_effect_takes_it_in():
    """Requirement: plate action, flattening, roots and strain are told, those of named effects not."""
    _, answer = case_solved("polymer_pivot")
    thin = validity.validity(answer).outside
    assert [line.split()[0] for line in thin] == ["b/L", "b^2/(R"]
    assert left_out(answer, validity.CLAMPED_WIDTH, validity.ANTICLASTIC) == []
    _, answer = case_solved("cross_axis_pivot")
    thick = validity.validity(answer).outside
    assert [line.split()[0] for line in thick] == ["b/L", "t/L", "strain"]
    left = left_out(answer, validity.CLAMPED_WIDTH, validity.ROOTS)
    assert [line.split()[0] for line in left] == ["strain"]


def test_the_strip_that_is_worst_speaks():
    """Requirement: of a mechanism's strips the one that is furthest outside is the one that is told of."""
    given = named_design("parallel_strip_guide")
    short = replace(given.strips[1], start=(0.06, 0.05))
    design = replace(given, strips=(given.strips[0], short))
    found = validity.validity(answer_static(design, SIX))
    assert found.width_ratio == pytest.approx(0.01 / 0.05)
    assert found.outside[0].startswith("b/L = 0.2:")


@pytest.mark.parametrize(
    ("slip", "word"),
    [
        ({"length": 84.85}, "millimetres"),
        ({"youngs_modulus": 206.0}, "GPa"),
        ({"density": 7.8}, "g/cm^3"),
        (of_moments(5e-5, 5e-5 * 0.01**2 / 12.0), "exchanged"),
        ({"length": 0.04}, "beam theory"),
    ],
)
def test_slips_of_units_are_doubted(slip, word):
    """Requirement: metres for millimetres, GPa for Pa, b for t and stubby strips are told before solving."""
    given = named_case("cross_axis_pivot")
    assert doubts(given) == ()
    assert any(word in line for line in doubts(replace(given, **slip)))


def test_cases_of_the_suite_are_not_doubted():
    """Requirement: no design that comes with the suite looks like a slip."""
    for name in ("spring_steel_pivot", "polymer_pivot", "parallel_strip_guide", "four_bar_of_flexures"):
        assert doubts(named_design(name)) == ()


def flattening_error(poisson_ratio=0.3):
    """Return the largest difference of the factor to the printed ones."""
    return max(
        abs(float(validity.anticlastic_factor(each, poisson_ratio)) - known) for each, known, _ in ASHWELL
    )


def test_flattening_of_a_strip():
    """Requirement: what strong bending adds is Ashwell's, to the printed digits, between both its limits."""
    gates.hold("validity_anticlastic", flattening_error)
    assert validity.anticlastic_factor(0.0, 0.3) == pytest.approx(1.0, abs=1e-9)
    assert validity.anticlastic_factor(1e9, 0.3) == pytest.approx(1.0 / 0.91, rel=1e-3)


def plate_error(**other):
    """Return the largest share by which the estimate of the clamps' plate action is off."""
    errors = []
    for width, nu, constant, linear in RITZ:
        plate = {"width": width, "poisson_ratio": other.get("poisson_ratio", nu)}
        strip = Strip(
            name="", start=(0.0, 0.0), end=(1.0, 0.0), tip=None, thickness=0.01,
            youngs_modulus=1e9, density=1e3, **plate,
        )  # fmt: skip
        pairs = zip(validity.Bent(strip).clamped, (constant - 1.0, linear - 1.0), strict=True)
        errors += [abs(found / known - 1.0) for found, known in pairs]
    return max(errors)


def test_estimate_of_plate_action():
    """Requirement: what clamps over the whole width add is told within 2 % of the plate's solution."""
    gates.hold("validity_plate", plate_error)
