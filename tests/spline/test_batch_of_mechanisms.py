"""Many designs at once, of pivots and mechanisms: single solves, in any order and number of threads."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import spline_model
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.cases.design import named_design
from tests import gates
from tests.models import extrapolated, scene
from tests.table_one import BARE, SIX

VALUES = {
    "thickness": np.array([3e-4, 2e-4, 1.5e-2]),  # the last: thick, so that no axial force stays outside
    "rocker_ground.youngs_modulus": np.array([206e9, 190e9, 206e9]),
    "crank_coupler.end_y": np.array([0.1, 0.102, 0.1]),
    "coupler.centre_x": np.array([0.05, 0.05, 0.06]),
}


def linkage() -> spline_model.Mechanism:
    """The four-bar linkage of flexures, under its weight, with springs."""
    settings = SplineSettings(control_points=6)
    found: spline_model.Mechanism = put(named_design("four_bar_of_flexures"), settings).modelled
    springs = [
        {"body": "coupler", "other": "rocker", "stiffness": (50.0, 80.0), "rotational_stiffness": 0.02},
        {"body": "crank", "stiffness": (100.0, 0.0)},
    ]
    return spline_model.compliant_mechanism(
        strips=found.design.strips,
        bodies=found.design.bodies,
        effects=(*found.effects, "spring"),
        parameters={**found.parameters, "spring": springs},
        control_points=6,
    )


def rebuilt(given: spline_model.Mechanism, i: int) -> spline_model.Mechanism:
    """One of the designs, written separately."""
    strips = []
    for strip in given.design.strips:
        width = strip.area / np.sqrt(12.0 * strip.second_moment_of_area / strip.area)
        h = VALUES["thickness"][i]
        new = replace(strip, thickness=h, area=width * h, second_moment_of_area=width * h**3 / 12.0)
        if strip.name == "rocker_ground":
            new = replace(new, youngs_modulus=VALUES["rocker_ground.youngs_modulus"][i])
        if strip.name == "crank_coupler":
            new = replace(new, end=(strip.end[0], VALUES["crank_coupler.end_y"][i]))
        strips.append(new)
    bodies = [
        replace(b, centre=(VALUES["coupler.centre_x"][i], b.centre[1])) if b.name == "coupler" else b
        for b in given.design.bodies
    ]
    return spline_model.compliant_mechanism(
        strips=strips, bodies=bodies, effects=given.effects, parameters=given.parameters, control_points=6
    )


def batch_error(thickness: float = 1.0) -> float:
    """Largest error of torque and stiffness of the designs, with their thickness times a factor."""
    given, turns, errors = linkage(), [0.3, -0.2, 0.1], []
    values = VALUES | {"thickness": thickness * VALUES["thickness"]}
    batch = spline_model.solve_many(given, values, body="crank", rotation=turns, increments=3)
    assert batch.converged.all()
    for i, turn in enumerate(turns):
        path = spline_model.solve_statics(rebuilt(given, i), body="crank", rotation=turn, increments=3)
        errors.append(np.abs(batch.torque[i] - path.torque).max() / np.abs(path.torque).max())
        errors.append(np.abs(batch.stiffness[i] / path.stiffness - 1.0).max())
    return float(max(errors))


def test_a_batch_of_mechanisms_equals_single_solves():
    """Requirement: a mechanism over its numbers, weight included, gives the answers of single solves."""
    gates.hold("spline_batch_mechanism", batch_error)


@pytest.mark.parametrize(("name", "own"), [("crank_coupler.end_y", 0.1), ("coupler.centre_x", 0.05)])
def test_sensitivities_are_the_differences_of_a_batch(name, own):
    """Requirement: of any mechanism torque and stiffness change by an end and by a centre as in its batch."""
    given, asked = linkage(), {"body": "crank", "rotation": 0.3, "increments": 3}
    steps = 2e-3 / 2 ** np.arange(4)[:, None]
    batch = spline_model.solve_many(given, {name: own + np.concatenate((steps, -steps))[:, 0]}, **asked)
    found = spline_model.sensitivities(
        given, spline_model.solve_statics(given, **asked), parameters=(name,), body="crank"
    )
    for quantity in ("torque", "stiffness"):
        up, down = np.split(getattr(batch, quantity), 2)
        expected, exact = extrapolated((up - down) / (2.0 * steps)), getattr(found, quantity)
        scale = max(np.abs(expected).max(), 1e-2 * np.abs(exact.value).max())
        gates.check("sensitivities", np.abs(exact.derivative[..., 0] - expected).max() / scale)


#: Pivots and numbers of them that change together: sides under plate effects, and the shape.
PLATE = scene(("bending", "stretching", "clamped_width", "anticlastic", "root_compliance"))
COLUMNS = {
    "sides": (BARE | PLATE | {"control_points": 6}, {"thickness": [2e-3, 1e-3], "width": [0.03, 0.02]}),
    "shape": (SIX, {"length": [0.07, 0.09], "inclination": [0.6, 0.9], "crossing_ratio": [0.3, 0.6]}),
}


def pivots_error(name: str, **coarse: float) -> float:
    """Largest error of torques of a pivot whose numbers change in a batch, some of them times a factor."""
    given, columns = COLUMNS[name]
    rows = [{key: coarse.get(key, 1.0) * each[d] for key, each in columns.items()} for d in range(2)]
    made = [spline_model.cross_axis_pivot(**given | row) for row in rows]
    batch = spline_model.solve_many(made[0], columns, rotation=0.3, increments=3)
    paths = [spline_model.solve_statics(pivot, rotation=0.3, increments=3) for pivot in made]
    right = np.array([path.torque for path in paths])
    return float((np.abs(batch.torque - right).max(axis=1) / np.abs(right).max(axis=1)).max())


@pytest.mark.parametrize("name", COLUMNS)
def test_a_batch_by_several_numbers_has_the_pivots_of_all_of_them(name):
    """Requirement: length, inclination and crossing ratio place the strips of each design together; rigidity
    along a strip and flattening follow its b/L and t/L, design by design."""
    gates.check("spline_batch_mechanism", pivots_error(name))
    if name == "sides":
        gates.refuse("spline_batch_mechanism", partial(pivots_error, name))


def test_a_batch_is_the_same_in_any_order():
    """Requirement: a batch gives the answers of single solves, for any threads and order of rows."""
    generator, asked = np.random.default_rng(11), {"rotation": 1.2, "increments": 20}
    spans = {"crossing_ratio": (0.2, 0.8), "inclination": (0.6, 1.0), "second_moment_of_area": (3e-11, 3e-10)}
    designs = {name: generator.uniform(*span, 40) for name, span in spans.items()}
    pivot = spline_model.cross_axis_pivot(**SIX)
    one, two = (spline_model.solve_many(pivot, designs, threads=count, **asked) for count in (1, 2))
    turned = {name: values[::-1] for name, values in designs.items()}
    backwards = spline_model.solve_many(pivot, turned, threads=2, **asked)
    for name in ("torque", "stiffness", "centre", "energy"):
        assert np.array_equal(getattr(one, name), getattr(two, name))
        assert np.array_equal(getattr(one, name), getattr(backwards, name)[::-1])
    assert one.converged.all()
