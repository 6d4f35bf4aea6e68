"""The load that a pivot bears: Euler's and Haringx' closed forms, both models, and the command that tells."""

import cmath
import math
from dataclasses import replace

import pytest
from scipy.optimize import brentq

from studies.answers.adapters import answer_static
from studies.answers.critical import critical_load as capacity
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.effects import Effects
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from tests import gates

pytestmark = pytest.mark.slow

DOWN = -0.5 * math.pi
#: Slender strips, so that what they shorten before they buckle does not count: a share of 1e-5 of the load.
LENGTH, RIGIDITY, INCLINATION = 0.1, 206e9 * 1e-14, math.radians(60.0)
PIVOT = replace(
    named_case("cross_axis_pivot"),
    length=LENGTH,
    inclination=INCLINATION,
    **of_moments(1e-5, 1e-14),
    rotation=0.0,
    increments=2,
)
EULER = 4.0 * math.pi**2 * RIGIDITY / LENGTH**2
MODELS = SplineSettings(), FeSettings(elements=20)
BY_MODEL = pytest.mark.parametrize("settings", MODELS, ids=lambda s: s.model)


def stiffness(pull, ratio, inclination=INCLINATION):
    """Haringx' and Wittrick's stiffness under a force through the crossing, tension positive, exact in it."""
    u = LENGTH * cmath.sqrt(pull / (2.0 * math.sin(inclination)) / RIGIDITY)
    c, s = cmath.cosh(u), cmath.sinh(u)
    d = 2.0 - 2.0 * c + u * s
    value = u * (u * c - s) / d - 2.0 * ratio * u**2 * (c - 1.0) / d + ratio**2 * u**3 * s / d - ratio * u**2
    return 2.0 * RIGIDITY / LENGTH * value.real


def loaded(ratio, pull):
    """A pivot whose centre of mass is at the strips' crossing, pulled away from the ground."""
    height = -(1.0 - ratio) * LENGTH * math.sin(INCLINATION)
    effects = Effects(
        names=("bending", "stretching", "applied_force"), tables={"applied_force": {"force": (0.0, pull)}}
    )
    return replace(PIVOT, crossing_ratio=ratio, centre_offset=(0.0, height), effects=effects)


@BY_MODEL
@pytest.mark.parametrize("ratio", [0.127322, 0.3, 0.5])
@pytest.mark.parametrize("share", [-0.4, -0.1, 0.1, 0.4])
def test_stiffness_under_load_is_haringx_and_wittricks(settings, ratio, share):
    """Requirement: pushed and pulled through its crossing, a pivot has the stiffness of the beam-column."""
    pull = share * EULER
    expected = stiffness(pull, ratio)

    def error(how=settings, **options):
        answer = answer_static(loaded(ratio, pull), how, **options)
        return abs(answer.stiffness[-1] - expected) / (RIGIDITY / LENGTH)

    gates.check("haringx", error(accuracy=1e-6))
    if (ratio, share) == (0.3, -0.4):
        gates.refuse("haringx", lambda elements: error(FeSettings(elements=elements)))


@BY_MODEL
@pytest.mark.parametrize("inclination", [45.0, 60.0])
def test_held_strips_bear_eulers_load(settings, inclination):
    """Requirement: with the rotation held two strips bear 4 pi^2 EI / L^2 each, along their directions."""
    pivot = replace(PIVOT, inclination=math.radians(inclination))
    found = capacity(pivot, settings, direction=DOWN, held=True)
    expected = 2.0 * math.sin(math.radians(inclination)) * EULER

    def coarse(control_points):
        told = capacity(pivot, SplineSettings(control_points=control_points), direction=DOWN, held=True)
        return math.inf if told.force is None else abs(told.force / expected - 1.0)  # None: not resolved

    gates.check("capacity", abs(found.force / expected - 1.0))
    gates.refuse("capacity", coarse)
    assert found.relative_error < 1e-4


@BY_MODEL
def test_a_free_body_tips_where_its_stiffness_vanishes(settings):
    """Requirement: released, the pivot tips where the stiffness of its columns is that of the lever."""
    lever = 0.5 * LENGTH * math.sin(INCLINATION)  # of the centre above the crossing
    tips = brentq(lambda push: stiffness(-push, 0.5) - lever * push, 1e-3 * EULER, EULER)
    found = capacity(PIVOT, settings, direction=DOWN)
    gates.check("capacity", abs(found.force / tips - 1.0))


@BY_MODEL
def test_pulled_through_the_crossing_it_gives_way_in_tension(settings):
    """Requirement: at N L^2 / EI = 5.757 of tension the stiffness of the symmetric pivot is gone."""
    found = capacity(loaded(0.5, 1.0), settings, direction=-DOWN)
    expected = 5.757 * RIGIDITY / LENGTH**2 * 2.0 * math.sin(INCLINATION)
    assert found.force == pytest.approx(expected, rel=2e-4)  # the digits that are known
