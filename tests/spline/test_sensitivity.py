"""Exact sensitivities of the static path: against differences, dimensional analysis and closed forms."""

import math
from functools import partial

import numpy as np
import pytest

from spline_model import cross_axis_pivot, sensitivities, solve_statics
from tests import gates
from tests.models import extrapolated, scene
from tests.table_one import BARE, SIX, TABLE_ONE

#: Keywords of a pivot that its statics depend on, and the sides of its section.
KEYWORDS = ("length", "inclination", "crossing_ratio", "area", "second_moment_of_area", "youngs_modulus")
PARAMETERS = (*KEYWORDS, "thickness", "width")
#: Quantities of shape alone, and what does not move with a parameter.
SHAPES = ("centre", "body_shift", "centre_shift")
UNMOVED = {"youngs_modulus": SHAPES, "width": (*SHAPES, "fibre_stress")}
FORMS = ({}, {"control_points": 8}, {"stretch": "consistent"}, {"control_points": 5, "axial_modes": 3})

#: All loads of a pivot, of a size that is seen.
LOADED = scene(
    ("bending", "stretching"),
    gravity={"acceleration": (2e3, -9e3)},
    applied_force={"force": (900.0, -1500.0)},
    applied_moment={"moment": 30.0},
    pre_strain={"curvature": 2.0, "strain": 1e-4},
)


QUANTITIES = ("torque", "stiffness", "bending_energy", "axial_energy", "fibre_stress", *SHAPES)
STATIONS = np.linspace(0.0, 1.0, 9)
#: First step of the differences over the parameter: a path hardly knows area and modulus beside the shape.
STEPS = {"length": 0.03, "inclination": 0.03, "crossing_ratio": 0.03}
SECTION_STEP = 0.2


def random_design(rng):
    """A design within what a designer would try, of any size, material and orientation."""
    length = 10.0 ** rng.uniform(-3, 0)
    thickness = length / rng.uniform(8.0, 60.0)
    width = thickness * rng.uniform(0.5, 10.0)
    return TABLE_ONE | {
        "length": length,
        "inclination": np.radians(rng.uniform(25.0, 65.0)),
        "crossing_ratio": rng.uniform(0.1, 0.9),
        "area": thickness * width,
        "second_moment_of_area": thickness**3 * width / 12.0,
        "youngs_modulus": 10.0 ** rng.uniform(9, 11.5),
        "centre_offset": tuple(length * rng.uniform(-0.5, 0.5, 2)),
        "orientation": rng.uniform(-3.0, 3.0),
    }


def exact(design, parameters, rotation, grid):
    """Exact derivatives along the path to a rotation [rad]."""
    pivot = cross_axis_pivot(**{"control_points": 6} | design | grid)
    path = solve_statics(pivot, rotation=rotation, increments=6)
    return sensitivities(pivot, path, parameters=parameters, stations=STATIONS)


def changed(design, name, factor):
    """The design with one parameter, or one side of its section, times a factor."""
    if name in design:
        return {**design, name: design[name] * factor}
    powers = {"area": 1, "second_moment_of_area": {"width": 1, "thickness": 3}[name]}
    return design | {key: design[key] * factor**power for key, power in powers.items()}


def value_of(design, name):
    """A design's parameter, or side of its section [m]."""
    if name in design:
        return float(design[name])
    strip = cross_axis_pivot(**design).design.strips[0]
    thickness = math.sqrt(12.0 * strip.second_moment_of_area / strip.area)
    return {"thickness": thickness, "width": strip.area / thickness}[name]


def by_differences(design, name, rotation, grid, levels=5):
    """p dq/dp of every quantity, central differences of halved steps extrapolated ``levels`` - 1 times."""
    rows = {quantity: [] for quantity in QUANTITIES}
    for level in range(levels):
        step = STEPS.get(name, SECTION_STEP) / 2**level
        up, down = (
            exact(changed(design, name, 1.0 + sign * step), ("length",), rotation, grid) for sign in (1, -1)
        )
        for quantity in QUANTITIES:
            change = getattr(up, quantity).value - getattr(down, quantity).value
            rows[quantity].append(change / (2.0 * step))
    return {quantity: extrapolated(row) for quantity, row in rows.items()}


def _error(design, parameter, rotation, grid, quantities=QUANTITIES, **keywords):
    """Largest error of p dq/dp over quantities and path, relative to the largest one along it."""
    found = exact(design, (parameter,), rotation, grid)
    expected = by_differences(design, parameter, rotation, grid, **keywords)
    size = value_of(design, parameter)
    errors = [
        np.abs(size * getattr(found, name).derivative[..., 0] - expected[name]).max()
        / np.abs(expected[name]).max()
        for name in quantities
        if name not in UNMOVED.get(parameter, ())
    ]
    return max(errors)


def _worst(seed, grid, **keywords):
    rng = np.random.default_rng(seed)
    design, rotation = random_design(rng), math.radians(rng.uniform(15.0, 90.0)) * rng.choice((-1, 1))
    return max(_error(design, parameter, rotation, grid, **keywords) for parameter in PARAMETERS)


def test_agrees_with_extrapolated_differences():
    """Every quantity by every parameter agrees with differences that are extrapolated, and no others."""
    gates.hold("sensitivities", partial(_worst, 0, FORMS[0]))


def _error_of_axial_forces(step=1e-5):
    """Largest error of the derivative of the strips' axial forces by their length, against a difference."""
    sides = (SIX | {"length": (1.0 + side * step) * SIX["length"]} for side in (1.0, -1.0))
    more, less = (solve_statics(cross_axis_pivot(**each), rotation=0.3, increments=1) for each in sides)
    pivot = cross_axis_pivot(**SIX)
    path = solve_statics(pivot, rotation=0.3, increments=1)
    forces = slice(path.system.layout.coordinate_count, path.system.layout.multiplier_start)
    found = sensitivities(pivot, path, parameters=("length",)).states[:, forces, 0]
    expected = (more.states - less.states)[:, forces] / (2.0 * step * SIX["length"])
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def test_derivatives_of_axial_forces_follow_their_modes():
    """The modes of the axial forces change with the length of their strips, and so do derivatives."""
    gates.check("sensitivities", _error_of_axial_forces())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 22))
def test_agrees_with_extrapolated_differences_on_many_designs(seed):
    """The same on more designs, in all forms of strip in turn."""
    gates.check("sensitivities", _worst(seed, FORMS[seed % len(FORMS)]))


SKEWED = TABLE_ONE | {"crossing_ratio": 0.4}
WIDE = BARE | {"crossing_ratio": 0.4, "width": 0.03, "thickness": 0.002}
SPATIAL = {"measure": "spatial", "stretch": "consistent"}
PLATE = ("bending", "stretching", "clamped_width")
ROOTED = scene((*PLATE, "anticlastic"), root_compliance={"root": "monolithic"})
#: A design, its parameter, the rotation [rad] and a scene.
SCENES = [
    (SKEWED, "inclination", 0.6, SPATIAL),
    *((SKEWED, name, 0.6, LOADED) for name in ("area", "crossing_ratio", "thickness")),
    *(
        (WIDE, name, 0.9, each)
        for name in ("length", "thickness", "width")
        for each in (SPATIAL | scene(PLATE), ROOTED)
    ),
]


@pytest.mark.parametrize("asked", SCENES, ids=[row[1] for row in SCENES])
def test_agrees_with_differences_of_other_scenes(asked):
    """Weight, dead loads and pre-strain and the spatial measure count as they act, the plate's rigidity by
    b/L, the flattening by b, t and the bend, and roots by t exactly."""
    gates.check("sensitivities", _error(*asked))


def test_inextensible_strips_do_not_know_their_area():
    """Of inextensible strips the area moves the stress alone; the other derivatives hold as they do else."""
    grid, design = {"stretch": "inextensible"}, random_design(np.random.default_rng(5))
    found = exact(design, ("area",), 0.8, grid)
    assert not found.states.any()
    assert found.fibre_stress.derivative.any()
    stressed = [name for name in QUANTITIES if name != "axial_energy"]
    for parameter in ("length", "inclination", "crossing_ratio", "thickness"):
        names = stressed if parameter != "thickness" else ("torque", "stiffness", "fibre_stress")
        gates.check("sensitivities", _error(design, parameter, 0.8, grid, names))


def test_values_are_those_of_the_path():
    """Stiffness, stress and centre shift are the path's own, and either method of solving gives the same."""
    pivot = cross_axis_pivot(**SIX | {"crossing_ratio": 0.4})
    path = solve_statics(pivot, rotation=1.2, increments=8)
    found = sensitivities(pivot, path, parameters=PARAMETERS)
    np.testing.assert_allclose(found.stiffness.value, path.stiffness, rtol=1e-9)
    depth = math.sqrt(12.0 * TABLE_ONE["second_moment_of_area"] / TABLE_ONE["area"])
    bending = path.bending_moment * depth / (2.0 * TABLE_ONE["second_moment_of_area"])
    stress = np.abs(path.axial_force) / TABLE_ONE["area"] + np.abs(bending)
    np.testing.assert_allclose(np.abs(found.fibre_stress.value).max(axis=-1), stress, rtol=1e-9, atol=1.0)
    np.testing.assert_allclose(found.largest_stress().value, stress.max(axis=(1, 2)), rtol=1e-9, atol=1.0)
    bordered = solve_statics(pivot, rotation=1.2, increments=8, method="multipliers")
    other = sensitivities(pivot, bordered, parameters=PARAMETERS)
    scale = np.abs(found.torque.derivative).max(axis=0)
    assert (np.abs(found.torque.derivative - other.torque.derivative) / scale).max() < 1e-7


def test_one_factorisation_a_state_and_one_back_substitution_a_parameter():
    """Work is counted: a factorisation a state, a back-substitution a parameter and one for the rate."""
    pivot = cross_axis_pivot(**SIX)
    path = solve_statics(pivot, rotation=1.2, increments=8)
    assert sensitivities(pivot, path).counters == {"factorisations": 9, "back_substitutions": 9 * 7}
    more = sensitivities(pivot, path, parameters=PARAMETERS)
    assert more.counters == {"factorisations": 9, "back_substitutions": 9 * 9}
