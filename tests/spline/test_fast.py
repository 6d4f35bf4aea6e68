"""A pivot on the strips' elements against the multiplier path, and many pivots at once."""

import math

import numpy as np

from spline_model import cross_axis_pivot, solve_many, solve_statics
from tests import gates
from tests.table_one import TABLE_ONE


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
    """Requirement: a batch gives the answers of single solves, for any threads and order of rows."""
    designs = many()
    asked = {"rotation": 1.2, "increments": 20, "control_points": 6}
    one, two = (solve_many(designs, threads=count, **asked) for count in (1, 2))
    backwards = solve_many(designs[::-1], threads=2, **asked)
    for name in ("torque", "stiffness", "centre", "energy"):
        assert np.array_equal(getattr(one, name), getattr(two, name))
        assert np.array_equal(getattr(one, name), getattr(backwards, name)[::-1])
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
