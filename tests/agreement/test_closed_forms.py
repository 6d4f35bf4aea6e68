"""Strips and pivots of both models against closed forms: the elastica, frequencies, stiffness at rest."""

import math

import numpy as np
import pytest

import fe_reference
import spline_model
from fe_reference import ELEMENTS
from studies.published.case import published
from tests import gates
from tests.closed_forms import CANTILEVER_ROOTS, by_quadrature, elastica_tip, end_body_roots
from tests.frames import LENGTH, STEEL, one_strip
from tests.models import BOTH, refined, short
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
    path = models.solve_mechanism(made, increments=20)
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
