"""Strips that shear: one that is rigid in shear, with a spring at its tip."""

import math

import numpy as np
import pytest

import spline_model
from spline_model import (
    DEFAULT_EFFECTS,
    BodyDesign,
    HeldPivot,
    InvalidParameter,
    StripDesign,
    compliant_mechanism,
    solve_loads,
    solve_many,
    solve_mechanism,
    solve_statics,
)
from spline_model.compile import compile_scene
from spline_model.reduced.model import at_rest, reduced
from spline_model.reduced.states import whole_tangents
from tests import gates
from tests.table_one import SIX

SHEARED = (*DEFAULT_EFFECTS, "shear")
ROOTS = {"parameters": {"root_compliance": {"root": "monolithic"}}, "width": 0.01, "thickness": 0.005}
#: A stubby strip: sides, length [m], modulus [Pa], Poisson ratio.
WIDTH, DEPTH, LENGTH, MODULUS, RATIO = 0.008, 0.01, 0.05, 2e9, 0.3
RIGIDITY, STRETCH = MODULUS * WIDTH * DEPTH**3 / 12.0, 1.0 / (MODULUS * WIDTH * DEPTH)
SHEAR = 2.0 * (1.0 + RATIO) * STRETCH / (5.0 / 6.0)


def cantilever(force, *, control_points=8, tip=None, effects=("bending", "stretching", "shear"), rise=0.0):
    """A stubby strip under a force at its tip, free or with a body there."""
    strip = StripDesign(
        name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip=tip, width=WIDTH, thickness=DEPTH,
        youngs_modulus=MODULUS, poisson_ratio=RATIO, density=1.0, rise=rise,
    )  # fmt: skip
    given = (
        {"tip_force": {"strip": "strip", "force": force}}
        if tip is None
        else {"applied_force": {"force": force}}
    )
    return compliant_mechanism(
        strips=[strip],
        bodies=[] if tip is None else [BodyDesign(name=tip, centre=(LENGTH, 0.0))],
        effects=(*effects, *given),
        parameters=given,
        control_points=control_points,
    )


@pytest.mark.parametrize("tip", [None, "body"])
def test_small_forces_bend_as_timoshenko_says(tip):
    """The tip goes F L^3 / 3 EI + F L / kGA: Timoshenko and Gere, Mechanics of Materials, 7."""

    def error(**changed):
        path = solve_mechanism(cantilever((0.0, 1e-3), tip=tip, **changed), increments=1)
        exact = 1e-3 * (LENGTH**3 / (3.0 * RIGIDITY) + SHEAR * LENGTH)
        return abs(path.shape[-1, 0, -1, 1] / exact - 1.0)

    gates.check("spline_shear_timoshenko", error())
    with pytest.raises(AssertionError):
        gates.check("spline_shear_timoshenko", error(**gates.teeth("spline_shear_timoshenko")))


def test_columns_buckle_as_haringx_says():
    """A column that shears and shortens buckles at P [1 + (c_s - c_a) P] = pi^2 EI / 4 L^2.

    J. A. Haringx, Philips Research Reports 3 (1948) 401; E. Reissner, J Appl Math Phys 23 (1972) 795.
    """
    euler, soft = math.pi**2 * RIGIDITY / (4.0 * LENGTH**2), SHEAR - STRETCH
    exact = (math.sqrt(1.0 + 4.0 * soft * euler) - 1.0) / (2.0 * soft)
    assert 0.015 < 1.0 - exact / euler < 0.02

    def error(control_points=10):
        column = cantilever((-1.25 * exact, 0.0), control_points=control_points, tip="body")
        path = solve_loads(column.scene, increments=6)[1]
        assert path.inertia.tolist() == [0] * 5 + [1, 1]
        return abs(1.25 * path.critical_points[0].load_factor - 1.0)

    gates.check("spline_shear_haringx", error())
    with pytest.raises(AssertionError):
        gates.check("spline_shear_haringx", error(**gates.teeth("spline_shear_haringx")))


@pytest.mark.parametrize("roots", [{}, ROOTS], ids=["clamped", "roots"])
def test_tangent_is_the_gradients_derivative(roots):
    """The tangent of strips that shear is the derivative of their gradient, off equilibrium as well."""
    effects = (*SHEARED, "root_compliance") if roots else SHEARED
    model = reduced(compile_scene(spline_model.cross_axis_pivot(**SIX | roots, effects=effects).driven(1.5)))
    y = at_rest(model)[None] + 0.05 * np.random.default_rng(0).standard_normal((1, model.size))
    step = 1e-6 * np.eye(model.size)
    there, back = (whole_tangents(model, y + sign * step)[0] for sign in (1.0, -1.0))
    tangent = whole_tangents(model, y)[1][0]
    assert np.abs((there - back) / 2e-6 - tangent).max() < 1e-7 * np.abs(tangent).max()


def test_energies_are_those_of_the_section_forces():
    """Of a curved strip that is bent far, stretch and shear hold N^2 / 2 EA and V^2 / 2 kGA."""
    given = cantilever((-300.0, -450.0), control_points=12, rise=0.01)
    path, arc = solve_mechanism(given, increments=8), given.design.strips[0].length
    for force, soft, energy in (
        (path.axial_force, STRETCH, path.axial_energy),
        (path.shear_force, SHEAR, path.shear_energy),
    ):
        by_force = 0.5 * soft * np.trapezoid(force[:, 0] ** 2, path.stations) * arc
        assert energy[1:] == pytest.approx(by_force[1:], rel=1e-3)
    whole = path.bending_energy + path.axial_energy + path.shear_energy
    assert np.abs(whole - path.work).max() < 2e-4 * path.work[-1]


def test_a_path_goes_on_from_its_states():
    """The spring of the tip follows from the clamp's force: states are equilibria to go on from."""
    pivot = spline_model.cross_axis_pivot(**SIX, effects=SHEARED)
    whole = solve_statics(pivot, rotation=1.0, increments=4)
    half = solve_statics(pivot, rotation=0.5, increments=2)
    rest = solve_statics(pivot, rotation=1.0, increments=2, start=half)
    assert rest.torque[0] == pytest.approx(half.torque[-1], rel=1e-14)
    assert rest.torque[-1] == pytest.approx(whole.torque[-1], rel=1e-10)
    assert rest.shear_energy[-1] == pytest.approx(whole.shear_energy[-1], rel=1e-8)


def test_inextensible_strips_shear():
    """Strips without stretch are the limit of those with ever less of it, under the same shear."""
    given = SIX | {"second_moment_of_area": 1e-14, "effects": ("bending", "inextensible", "shear")}
    stiff = solve_statics(spline_model.cross_axis_pivot(**given), rotation=1.0, increments=5)
    soft = given | {"effects": ("bending", "stretching", "shear")}
    slender = solve_statics(spline_model.cross_axis_pivot(**soft), rotation=1.0, increments=5)
    assert stiff.torque == pytest.approx(slender.torque, rel=1e-6)
    assert stiff.inertia.max() == 0


@pytest.mark.parametrize(
    "ask, line",
    [
        (lambda pivot: spline_model.solve_release(pivot, start=0.1, duration=1e-3), "none in motions"),
        (lambda pivot: spline_model.natural_frequencies(pivot), "none in motions and modes"),
        (lambda pivot: solve_statics(pivot, rotation=0.1, method="multipliers"), "multipliers"),
        (lambda pivot: HeldPivot(pivot), "no loads, no shear"),
        (lambda pivot: solve_many(pivot, rotation=[0.1]), "none in a batch"),
        (lambda pivot: pivot.with_discretisation(measure="spatial"), "measure: got 'spatial', .* material"),
        (lambda pivot: pivot.with_discretisation(stretch="consistent"), "stretch: .*, expected mixed"),
    ],
)
def test_what_does_not_know_shear_says_so(ask, line):
    """Motions, modes, batches, held poses and other discretisations refuse shear in one line."""
    with pytest.raises(InvalidParameter, match=line) as refusal:
        ask(spline_model.cross_axis_pivot(**SIX, effects=SHEARED))
    assert "\n" not in str(refusal.value)
