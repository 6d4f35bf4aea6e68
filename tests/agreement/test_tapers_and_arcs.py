"""Tapered strips, and arcs of any opening: closed forms, and both models together."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import fe_reference
import spline_model
from tests import gates
from tests.frames import STATIC
from tests.models import BOTH, held, refined, short
from tests.table_one import TABLE_ONE

LENGTH, YOUNG, DENSITY = 0.1, 200e9, 7800.0
#: Loads [N, m/s^2] so small that bending is linear, so large that no digit is lost.
FORCE, PULL, FALL = 1e-4, 100.0, 0.1
SIDES = {"width": 0.01, "thickness": 1e-3, "width_end": 0.006, "thickness_end": 0.5e-3}
MATERIAL = {"youngs_modulus": YOUNG, "poisson_ratio": 0.3, "density": DENSITY}
#: Turn about the middle, angle at the centre of the largest arc.
TURN, OPENING = 2.0, math.radians(300.0)


def area(x):
    """Area of the tapered section [m^2]."""
    width, thickness = (
        SIDES[name] + (SIDES[f"{name}_end"] - SIDES[name]) * x / LENGTH for name in ("width", "thickness")
    )
    return width * thickness


def second_moment(x):
    """Second moment of the tapered section [m^4]."""
    return (
        area(x)
        * (SIDES["thickness"] + (SIDES["thickness_end"] - SIDES["thickness"]) * x / LENGTH) ** 2
        / 12.0
    )


def over(function):
    """Integral over the length."""
    return quad(function, 0.0, LENGTH, epsabs=0.0, epsrel=1e-12)[0]


def weight_beyond(x):
    """Moment of the weight beyond a place about it [N m]."""
    return quad(lambda y: DENSITY * FALL * area(y) * (y - x), x, LENGTH, epsrel=1e-12)[0]


def first_frequency():
    """First frequency of the cantilever [Hz], from the equation of its bending."""

    def tip(square):
        def rates(x, y):
            return [y[1], y[2] / (YOUNG * second_moment(x)), y[3], DENSITY * area(x) * square * y[0]]

        ends = [
            solve_ivp(rates, (0.0, LENGTH), start, "DOP853", rtol=1e-11, atol=1e-13).y[2:, -1]
            for start in ((0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        ]
        return float(np.linalg.det(ends))

    unit = YOUNG * second_moment(0.0) / (DENSITY * area(0.0)) / LENGTH**4
    return math.sqrt(brentq(tip, 10.0 * unit, 40.0 * unit, rtol=1e-12)) / (2.0 * math.pi)


EXACT = np.array(
    [
        over(lambda x: FORCE * (LENGTH - x) ** 2 / (YOUNG * second_moment(x))),
        over(lambda x: PULL / (YOUNG * area(x))),
        over(lambda x: weight_beyond(x) * (LENGTH - x) / (YOUNG * second_moment(x))),
        first_frequency(),
    ]
)


def cantilever(models, effect="strip_inertia", given=None, **grid):
    """A tapered cantilever with an effect besides bending and stretching."""
    strip = models.StripDesign(
        name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip=None, **SIDES, **MATERIAL
    )
    parameters = {} if given is None else {effect: given}
    return models.compliant_mechanism(
        strips=[strip], bodies=[], effects=(*STATIC, effect), parameters=parameters, **grid
    )


def answers(models, **grid):
    """Displacement of the tip across and along by a force there, by its weight, and the first frequency."""

    def tip(*given):
        path = models.solve_mechanism(cantilever(models, *given, **grid), increments=1)
        return path.shape[-1, 0, -1] - (LENGTH, 0.0)

    across, along = (tip("tip_force", {"strip": "strip", "force": f}) for f in ((0.0, FORCE), (PULL, 0.0)))
    heavy = tip("gravity", {"acceleration": (0.0, FALL)})
    modes = models.natural_frequencies(cantilever(models, **grid), count=1)
    return np.array([across[1], along[0], heavy[1], modes.frequency[0]])


@BOTH
def test_a_tapered_cantilever_meets_its_closed_forms(models):
    """Bending, stretching, weight and swing are integrals over the section, of one piece or more."""

    def error(segments=None, **grid):
        grid |= {} if segments is None else {"segments": segments}
        return np.abs(refined(lambda **mesh: answers(models, **mesh), **grid) / EXACT - 1.0).max()

    held(f"{short(models)}_taper", models, error, control_points=12, elements=(10, 20, 40, 80))
    if models is spline_model:
        gates.check("spline_taper", error(segments=2, control_points=10))


def test_pivots_of_tapered_strips_agree():
    """The torque of a pivot up to a quarter turn is that of refined elements."""
    given = {name: TABLE_ONE[name] for name in ("length", "inclination", "crossing_ratio", *MATERIAL)}
    given |= {"body_mass": 1.0, "body_moment_of_inertia": 1.0, **SIDES}

    def torque(models, **grid):
        made = models.cross_axis_pivot(**given, **grid)
        return models.solve_statics(made, rotation=0.5 * math.pi, increments=5).torque[1:]

    def error(control_points=14):
        right = refined(lambda **mesh: torque(fe_reference, **mesh), elements=(20, 40, 80))
        return np.abs(torque(spline_model, control_points=control_points) / right - 1.0).max()

    gates.hold("taper_agreement", error)


@BOTH
def test_an_arc_of_any_opening_bends_as_its_length(models):
    """A moment at the end of an arc of 300 deg turns it by M s/EI, and it stays an arc."""
    chord, sagitta = 2.0 * math.sin(0.5 * OPENING), 1.0 - math.cos(0.5 * OPENING)  # of radius 1 m
    section = {"width": 0.01, "thickness": 0.01}
    moment = YOUNG * 0.01**4 / 12.0 * TURN / OPENING
    bent = (OPENING - TURN) / OPENING  # curvature of the end, clockwise from a start at half the opening
    angles = 0.5 * OPENING - np.array([0.0, OPENING - TURN])
    place = np.array([math.sin(angles[0]) - math.sin(angles[1]), math.cos(angles[1]) - math.cos(angles[0])])

    def error(**grid):
        def tip(**mesh):
            strip = models.StripDesign(
                name="arc", start=(0.0, 0.0), end=(chord, 0.0), rise=sagitta, tip="tip", **section, **MATERIAL
            )
            made = models.compliant_mechanism(
                strips=[strip],
                bodies=[models.BodyDesign(name="tip", centre=(chord, 0.0))],
                effects=(*STATIC, "applied_moment"),
                parameters={"applied_moment": {"moment": moment}},
                **mesh,
            )
            return models.solve_mechanism(made, increments=10).bodies["tip"][-1]

        return np.abs(refined(tip, **grid) - [*(place / bent), TURN]).max()

    held(f"{short(models)}_long_arc", models, error, control_points=12, elements=(20, 40, 80, 160))


@pytest.mark.parametrize("effect", ["clamped_width", "anticlastic", "root_compliance"])
@BOTH
def test_effects_of_constant_sections_are_refused(models, effect):
    """What is known of constant sections alone is refused of tapered ones in one line."""
    with pytest.raises(models.InvalidParameter, match=r"taper of strip|a constant section"):
        cantilever(models, effect, {})
