"""A pivot on the strips' elements against the multiplier path, and many pivots at once."""

import math
from functools import partial

import numpy as np
import pytest

from spline_model import InvalidParameter, cross_axis_pivot, solve_many, solve_statics
from tests import gates
from tests.table_one import SIX, TABLE_ONE

FIELDS = (
    "centre",
    "torque",
    "stiffness",
    "bending_energy",
    "axial_energy",
    "clamp_reactions",
    "shape",
    "axial_force",
    "bending_moment",
    "shear_force",
    "work",
)
DESIGNS = (
    {"control_points": 4},
    {},
    {"control_points": 7, "axial_modes": 4},
    {"control_points": 8, "axial_modes": 7},
    {"control_points": 12},
    {"crossing_ratio": 0.3, "inclination": 0.6, "centre_offset": (0.01, 0.02), "orientation": 0.4},
    {"area": 5e-6, "second_moment_of_area": 1.041e-13},
)


def difference(changed, **settings):
    """Largest difference of any answer of the two methods, over its largest value, there and back.

    settings : of the condensed path alone, none being right.
    """
    path = {"rotation": [1.5, -0.7], "increments": 15}
    fast, reference = (
        solve_statics(cross_axis_pivot(**SIX | changed | more), method=method, **path)
        for method, more in (("condensed", settings), ("multipliers", {}))
    )
    return max(
        np.abs(getattr(fast, name) - getattr(reference, name)).max() / np.abs(getattr(reference, name)).max()
        for name in FIELDS
    )


@pytest.mark.parametrize("changed", DESIGNS, ids=str)
def test_both_methods_give_the_same_answer(changed):
    """Requirement: condensed and multiplier path agree to 1e-10 in every answer, multipliers included."""
    gates.check("spline_fast_path", difference(changed))


def test_another_slide_stiffness_is_another_answer():
    """Requirement: the check notices a slide stiffness that differs by a per mille."""
    gates.refuse("spline_fast_path", partial(difference, {}))


def many(count=40):
    """Designs around Table 1, drawn once."""
    generator = np.random.default_rng(11)
    return [
        TABLE_ONE
        | {
            "crossing_ratio": generator.uniform(0.2, 0.8),
            "inclination": generator.uniform(0.6, 1.0),
            "second_moment_of_area": 1.041e-10 * generator.uniform(0.3, 3.0),
        }
        for _ in range(count)
    ]


def test_a_batch_equals_single_solves():
    """Requirement: many designs at once give the answers of single solves, whatever the threads."""
    designs = many()
    one, two = (solve_many(designs, rotation=1.2, increments=20, threads=t, control_points=6) for t in (1, 2))
    for name in ("torque", "stiffness", "centre", "energy"):
        assert np.array_equal(getattr(one, name), getattr(two, name))
    assert one.converged.all()

    def error(design=0):
        """Largest difference of three designs, and of the `design` places after them, to single solves."""
        worst = np.finfo(float).eps  # the same code on the same numbers: zero is right here
        for i in (0, 17, 38):
            single = solve_statics(cross_axis_pivot(**designs[i], control_points=6), rotation=1.2)
            torque = np.abs(one.torque[i + design] - single.torque).max() / single.torque.max()
            centre = np.abs(one.centre[i + design] - single.centre).max() / designs[i]["length"]
            worst = max(worst, torque + centre)
        return worst

    gates.hold("spline_batch", error)


def test_failed_designs_are_rows():
    """Requirement: a design whose path stops is reported in its row, nan from there on; the others go on."""
    designs = [TABLE_ONE, TABLE_ONE | {"crossing_ratio": 0.95}, TABLE_ONE]
    batch = solve_many(designs, rotation=math.radians(400), increments=40, control_points=8)
    stopped = batch.states < 41
    assert stopped.any()
    for i in np.flatnonzero(stopped):
        assert not batch.converged[i]
        assert np.isfinite(batch.torque[i, : batch.states[i]]).all()
        assert np.isnan(batch.torque[i, batch.states[i] :]).all()
    assert np.array_equal(batch.torque[0], batch.torque[2], equal_nan=True)


def test_a_bad_design_in_a_batch_is_named():
    """Requirement: the row of a bad design and its fault are in the one line of the refusal."""
    with pytest.raises(InvalidParameter, match=r"design 1: length: got -1\.0"):
        solve_many([TABLE_ONE, TABLE_ONE | {"length": -1.0}], rotation=1.0)


def test_columns_are_the_same_as_rows():
    """Requirement: designs as columns, with numbers for what they share, give the answers of a list."""
    designs = many(5)
    varied = ("crossing_ratio", "inclination", "second_moment_of_area")
    columns = TABLE_ONE | {name: np.array([d[name] for d in designs]) for name in varied}
    rows = solve_many(designs, rotation=1.0, increments=5)
    assert np.array_equal(solve_many(columns, rotation=1.0, increments=5).torque, rows.torque)


def strain_error(depth=4e-3):
    """Largest strain of three designs in a batch, by a depth, against the section forces of single solves."""
    designs = many(3)
    turns = [0.9, -0.6, 1.2]
    batch = solve_many(designs, rotation=turns, increments=10, section_depth=depth, control_points=6)
    errors = [np.finfo(float).eps]
    for design, rotation, found in zip(designs, batch.rotation, batch.strain, strict=True):
        path = solve_statics(
            cross_axis_pivot(**design, control_points=6), rotation=rotation[-1], increments=10
        )
        modulus, inertia = design["youngs_modulus"], design["second_moment_of_area"]
        axial = np.abs(path.axial_force) / (modulus * design["area"])
        bending = np.abs(path.bending_moment) * 4e-3 / (2.0 * modulus * inertia)
        strain = (axial + bending).max(axis=(1, 2))
        errors.append(np.abs(found - strain).max() / strain[-1])
    return max(errors)


def test_strain_of_a_batch_follows_from_the_section_forces():
    """Requirement: a batch's largest strain, on paths of its designs' own, is that of single solves."""
    gates.hold("spline_batch_strain", strain_error)


def test_rotations_of_a_batch_may_differ():
    """Requirement: designs with rotations of their own get the paths that they have one by one."""
    designs, turns = many(3), (1.0, -0.5, 0.7)
    batch = solve_many(designs, rotation=turns, increments=5)
    for i, turn in enumerate(turns):
        assert np.array_equal(
            batch.torque[i], solve_many([designs[i]], rotation=turn, increments=5).torque[0]
        )
    assert np.isnan(batch.strain).all()
    with pytest.raises(InvalidParameter, match="rotation"):
        solve_many(designs, rotation=[1.0, 0.5])
    with pytest.raises(InvalidParameter, match=r"design 1: rotation: got nan"):
        solve_many(designs, rotation=[1.0, math.nan, 0.5])
    with pytest.raises(InvalidParameter, match=r"section_depth: got 0\.0, expected a finite number > 0"):
        solve_many(designs, rotation=1.0, section_depth=0.0)
