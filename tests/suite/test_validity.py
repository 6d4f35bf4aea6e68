"""Warnings of an answer: ratios, neglected effects, and wrong units of a case that still solves."""

from dataclasses import replace
from functools import cache

import pytest

from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.answers.validity import (
    ANTICLASTIC,
    CLAMPED_WIDTH,
    DATA,
    ROOTS,
    RULES,
    Strip,
    anticlastic_factor,
    strips_of,
    told,
    validity,
)
from studies.cases.design import named_design
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from tests import gates
from tests.agreement.test_section_laws import ASHWELL, RITZ

SIX = SplineSettings(control_points=6)


def doubts(design):
    """Return what the data of a design give away before anything is solved."""
    return tuple(told(DATA, strips_of(design), ()))


@cache
def solved(name):
    """Return a case and its answer."""
    given = named_case(name)
    return given, answer_static(given, SIX)


def left_out(answer, *effects):
    """Return the neglected effects of an answer if these effects are named."""
    return list(told(RULES, strips_of(answer.design, answer), effects))


def test_what_is_left_out_is_said_until_an_effect_takes_it_in():
    """Requirement: plate action, flattening, roots and strain are told, those of named effects not."""
    _, answer = solved("polymer_pivot")
    thin = validity(answer).outside
    assert [line.split()[0] for line in thin] == ["b/L", "b^2/(R"]
    assert left_out(answer, CLAMPED_WIDTH, ANTICLASTIC) == []
    _, answer = solved("cross_axis_pivot")
    thick = validity(answer).outside
    assert [line.split()[0] for line in thick] == ["b/L", "t/L", "strain"]
    left = left_out(answer, CLAMPED_WIDTH, ROOTS)
    assert [line.split()[0] for line in left] == ["strain"]


def test_the_strip_that_is_worst_speaks():
    """Requirement: of a mechanism's strips the one that is furthest outside is the one that is told of."""
    given = named_design("parallel_strip_guide")
    short = replace(given.strips[1], start=(0.06, 0.05))
    design = replace(given, strips=(given.strips[0], short))
    found = validity(answer_static(design, SIX))
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
    return max(abs(float(anticlastic_factor(each, poisson_ratio)) - known) for each, known, _ in ASHWELL)


def test_flattening_of_a_strip():
    """Requirement: what strong bending adds is Ashwell's, to the printed digits, between both its limits."""
    gates.hold("validity_anticlastic", flattening_error)
    assert anticlastic_factor(0.0, 0.3) == pytest.approx(1.0, abs=1e-9)
    assert anticlastic_factor(1e9, 0.3) == pytest.approx(1.0 / 0.91, rel=1e-3)


def plate_error(**other):
    """Return the largest share by which the estimate of the clamps' plate action is off."""
    errors = []
    for width, nu, constant, linear in RITZ:
        strip = Strip(
            length=1.0, width=width, thickness=0.01, youngs_modulus=1e9, density=1e3,
            poisson_ratio=other.get("poisson_ratio", nu),
        )  # fmt: skip
        pairs = zip(strip.clamped, (constant - 1.0, linear - 1.0), strict=True)
        errors += [abs(found / known - 1.0) for found, known in pairs]
    return max(errors)


def test_estimate_of_plate_action():
    """Requirement: what clamps over the whole width add is told within 2 % of the plate's solution."""
    gates.hold("validity_plate", plate_error)
