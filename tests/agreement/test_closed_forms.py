"""Strips of both models against closed forms: elastica, frequencies, stiffness at rest, tapers and arcs."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import fe_reference
import spline_model
from fe_reference import ELEMENTS
from studies.published.case import published
from tests import gates
from tests.closed_forms import CANTILEVER_ROOTS, by_quadrature, elastica_tip, end_body_roots
from tests.frames import LENGTH, STATIC, STEEL, one_strip
from tests.models import BOTH, held, refined, short
from tests.table_one import SECTION, TABLE_ONE

#: Of the tip force in EI/L^2, in twenty equal parts of which every one is a state.
LARGEST = 10.0
RIGIDITY = SECTION["youngs_modulus"] * SECTION["second_moment_of_area"]
#: EI / (EA L^2) and EI / (kGA L^2) of Table 1's section, 0.1 m long.
STRETCH = SECTION["second_moment_of_area"] / (SECTION["area"] * LENGTH**2)
SHEAR = STRETCH * 2.0 * (1.0 + SECTION["poisson_ratio"]) * 6.0 / 5.0


def tips(models, name, given, **grid):
    """Rotation [rad], x/L and y/L (20, 3) of the tip under shares of a load."""
    made = one_strip(models, [name], {name: given}, section=SECTION, **grid)
    path = models.solve_statics(made, increments=20)
    return path.bodies["tip"][1:, [2, 0, 1]] / (1.0, LENGTH, LENGTH)


def roll_up(models, **grid):
    """Largest error of the tip while an end moment rolls the strip up to a full circle."""
    moment = {"moment": 2.0 * math.pi * RIGIDITY / LENGTH}
    found = refined(lambda **mesh: tips(models, "applied_moment", moment, **mesh), **grid)
    angle = 2.0 * math.pi * np.arange(1, 21) / 20.0
    exact = np.column_stack((angle, np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle))
    return np.abs(found - exact).max()


def tip_force(models, **grid):
    """Largest error of the tip over twenty forces across the strip, with the stretch and shear it has."""
    force = {"force": (0.0, LARGEST * RIGIDITY / LENGTH**2)}
    found = refined(lambda **mesh: tips(models, "applied_force", force, **mesh), **grid)
    shear = SHEAR if grid.get("element") == "reissner" else 0.0
    loads = LARGEST * np.arange(1, 21) / 20.0
    return np.abs(found - [by_quadrature(load, stretch=STRETCH, shear=shear) for load in loads]).max()


def frequencies(models, bodies=((0.0, 0.0),), mass=None, **grid):
    """Largest relative error of the first five frequencies of a strip, or of three with bodies at its end."""
    line, errors = STEEL["density"] * STEEL["area"], []
    unit = math.sqrt(STEEL["youngs_modulus"] * STEEL["second_moment_of_area"] / line) / LENGTH**2
    for eta, zeta in bodies:
        body = {"mass": eta * line * LENGTH, "inertia": zeta * line * LENGTH**3}
        exact = end_body_roots(eta, zeta, 3) if eta else CANTILEVER_ROOTS
        how = {"count": len(exact)} | ({"mass": mass} if mass else {})
        names = ("strip_inertia", "body_inertia") if eta else ("strip_inertia",)

        def found(names=names, body=body, how=how, **mesh):
            return models.natural_frequencies(one_strip(models, names, {}, **body, **mesh), **how).frequency

        errors.append(np.abs(refined(found, **grid) * 2.0 * math.pi / unit / exact**2 - 1.0).max())
    return max(errors)


def end_bodies(models, **grid):
    """Largest relative error of the frequencies with a heavy, an extended and a light end body."""
    return frequencies(models, ((1.0, 1e-9), (1.0, 0.1), (0.2, 0.5)), **grid)


POINTS, MESHES = {"control_points": 16}, {"elements": (10, 20, 40, 80)}
#: Gate, what is held against it, and by which discretisation.
HELD = [
    ("spline_roll_up", roll_up, spline_model, POINTS),
    ("fe_roll_up", roll_up, fe_reference, MESHES),
    ("spline_tip_force", tip_force, spline_model, POINTS),
    *((f"fe_tip_force_{each}", tip_force, fe_reference, MESHES | {"element": each}) for each in ELEMENTS),
    ("spline_cantilever_frequencies", frequencies, spline_model, POINTS),
    ("fe_cantilever_frequencies", frequencies, fe_reference, {"elements": (40,)}),
    ("fe_lumped_frequencies", frequencies, fe_reference, {"elements": (20, 40, 80), "mass": "lumped"}),
    ("spline_end_body_frequencies", end_bodies, spline_model, POINTS),
    ("fe_end_body_frequencies", end_bodies, fe_reference, {"elements": (40,)}),
]


@pytest.mark.parametrize(("gate", "error", "models", "grid"), HELD, ids=[row[0] for row in HELD])
def test_strips_meet_their_closed_forms(gate, error, models, grid):
    """Requirement: with a grid that is fine enough, and no coarser one, a strip bends and swings as theory
    has it: rolled up to a circle, under a tip force, alone and with bodies at its end."""
    gates.hold(gate, lambda **coarse: error(models, **grid | coarse))


#: What puts the stretch of the strips out of the way.
STIFF = {
    spline_model: {"control_points": 4, "stretch": "inextensible"},
    fe_reference: {"area": 1e3 * TABLE_ONE["area"]},
}


@BOTH
def test_small_angle_stiffness_is_the_linear_closed_form(models):
    """Requirement: K at rest is 8 (EI/L)(1 - 3 l + 3 l^2) at any crossing and angle, without stretch."""

    def error(**stretched):
        errors = []
        for ratio, degrees in ((0.5, 45.0), (0.35, 30.0), (0.2, 60.0), (0.8, 45.0), (0.127322, 45.0)):
            given = {"crossing_ratio": ratio, "inclination": math.radians(degrees)}
            pivot = models.cross_axis_pivot(**TABLE_ONE | given | STIFF[models] | stretched)
            found = models.solve_statics(pivot, rotation=1e-3, increments=1).stiffness[0]
            exact = 8.0 * RIGIDITY / TABLE_ONE["length"] * (1.0 - 3.0 * ratio + 3.0 * ratio**2)
            errors.append(abs(found / exact - 1.0))
        return max(errors)

    gates.hold(f"{short(models)}_small_angle_stiffness", error)


def test_closed_forms_are_those_in_print():
    """Requirement: the elastica meets Mattiasson's table to its last digit, its quadrature the elliptic
    integrals, and the equation of the end body its published first roots."""
    for value in published("tip_force").values:
        angle, x, y = elastica_tip(value.load)
        found = {"displacement_x": x - 1.0, "displacement_y": y, "rotation": angle}[value.quantity]
        assert abs(found - value.published) < 1.02 * value.uncertainty

    def quadrature(stretch=0.0):
        pairs = [(by_quadrature(p, stretch=stretch, shear=0.0), elastica_tip(p)) for p in (0.5, 2.0, 10.0)]
        return max(np.abs(np.subtract(*pair)).max() for pair in pairs)

    def roots(inertia=0.1):
        found = (end_body_roots(1.0, each, 1)[0] for each in (0.0, inertia))
        return max(abs(one - other) for one, other in zip(found, (1.24792, 1.19567), strict=True))

    gates.hold("fe_elastica_reference", quadrature)
    gates.hold("fe_published_roots", roots)


YOUNG, DENSITY = 200e9, 7800.0
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
        path = models.solve_statics(cantilever(models, *given, **grid), increments=1)
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
    section = {"width": 0.01, "thickness": 0.01, "rise": sagitta} | MATERIAL
    given = {"applied_moment": {"moment": YOUNG * 0.01**4 / 12.0 * TURN / OPENING}}
    bent = (OPENING - TURN) / OPENING  # curvature of the end, clockwise from a start at half the opening
    angles = 0.5 * OPENING - np.array([0.0, OPENING - TURN])
    place = np.array([math.sin(angles[0]) - math.sin(angles[1]), math.cos(angles[1]) - math.cos(angles[0])])

    def error(**grid):
        def tip(**mesh):
            made = one_strip(models, given, given, end=(chord, 0.0), section=section, **mesh)
            return models.solve_statics(made, increments=10).bodies["tip"][-1]

        return np.abs(refined(tip, **grid) - [*(place / bent), TURN]).max()

    held(f"{short(models)}_long_arc", models, error, control_points=12, elements=(20, 40, 80, 160))


@BOTH
def test_free_arc_with_pre_strain_turns_by_it_without_stress(models):
    """A free curved strip takes up its natural curvature beside the one at rest, stress-free: both models are
    exact for the turn, and the elements for the moment as well."""
    curvature, given = 1.5, {"rise": 0.01, "area": 5e-6, "second_moment_of_area": 1.0416667e-13}

    def left_over(control_points=8):
        """Largest moment over EI kappa_n, and error of the tip's turn over kappa_n L."""
        grid = {"control_points": control_points} if models is spline_model else {"elements": 10}
        arc = models.StripDesign(
            name="arc", start=(0.0, 0.0), end=(LENGTH, 0.0), tip=None, **given | MATERIAL
        )
        made = models.compliant_mechanism(
            strips=[arc],
            bodies=[],
            effects=(*STATIC, "pre_strain"),
            parameters={"pre_strain": {"curvature": curvature}},
            **grid,
        )
        fields = models.strip_fields(made, models.solve_statics(made, increments=4).states)
        moment = np.abs(fields.bending_moment[-1]).max() / (
            YOUNG * given["second_moment_of_area"] * curvature
        )
        return moment, abs(fields.rotation[-1, 0, -1] / (curvature * fields.arc_length[0, -1]) - 1.0)

    if models is spline_model:
        gates.hold("pre_strain_arc_spline", lambda **coarse: left_over(**coarse)[0])
    assert max(left_over(control_points=12)) < 1e-10


@pytest.mark.parametrize("effect", ["clamped_width", "anticlastic", "root_compliance"])
@BOTH
def test_effects_of_constant_sections_are_refused(models, effect):
    """What is known of constant sections alone is refused of tapered ones in one line."""
    with pytest.raises(models.InvalidParameter, match=r"taper of strip|a constant section"):
        cantilever(models, effect, {})
