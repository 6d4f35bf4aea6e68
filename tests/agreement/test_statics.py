"""Both models on the same pivots: what they may differ by is listed, part by part, in gates.toml."""

import math
from functools import cache

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates
from tests.table_one import TABLE_ONE

QUARTER = math.pi / 2
DESIGNS = {
    "Table 1": {},
    "crossing ratio 0.2": {"crossing_ratio": 0.2},
    "crossing ratio 0.8": {"crossing_ratio": 0.8},
    "inclination 30 deg": {"inclination": math.radians(30)},
    "inclination 60 deg": {"inclination": math.radians(60)},
    "ten times thinner": {"area": 5e-6, "second_moment_of_area": 1.041e-13},
    "centre off the plate": {"centre_offset": (0.01, -0.02)},
}


@cache
def spline(design="Table 1", rotation=QUARTER, **settings):
    """Spline solution of a design."""
    pivot = spline_model.cross_axis_pivot(**(TABLE_ONE | DESIGNS[design] | settings))
    return spline_model.solve_statics(pivot, rotation=rotation)


@cache
def finite_elements(design="Table 1", rotation=QUARTER, **settings):
    """Finite-element solution of a design."""
    pivot = fe_reference.cross_axis_pivot(**(TABLE_ONE | DESIGNS[design] | settings))
    return fe_reference.solve_statics(pivot, rotation=rotation)


def refined(design, name, rotation=QUARTER):
    """Richardson value of a quantity from 40 and 80 elements, whose error goes with h^2 + O(h^4)."""
    coarse, fine = (getattr(finite_elements(design, rotation, elements=n), name) for n in (40, 80))
    return (4 * fine - coarse) / 3


def trajectory_difference(found, reference):
    """Largest distance of the centres over the centre's total displacement."""
    return np.linalg.norm(found - reference, axis=1).max() / np.linalg.norm(reference[-1] - reference[0])


def relative_difference(found, reference):
    """Largest relative difference over the loaded increments."""
    return np.abs(found[1:] / reference[1:] - 1).max()


def differences(design="Table 1", rotation=QUARTER, control_points=8):
    """Of trajectory, torque and stiffness, against the refined finite elements."""
    solution = spline(design, rotation, control_points=control_points)
    return {
        "trajectory": trajectory_difference(solution.centre, refined(design, "centre", rotation)),
        "torque": relative_difference(solution.torque, refined(design, "torque", rotation)),
        "stiffness": relative_difference(solution.stiffness, refined(design, "stiffness", rotation)),
    }


@pytest.mark.parametrize("quantity", ["trajectory", "torque", "stiffness"])
def test_eight_control_points_meet_the_refined_elements(quantity):
    """Requirement: n = 8, m = 6 agrees at every increment with the refined corotational elements."""
    gates.hold(f"agreement_{quantity}", lambda **grid: differences(**grid)[quantity])


def papers_claim(control_points=4, **settings):
    """Trajectory difference and signed torque difference at 90 deg against 20 elements."""
    found = spline(control_points=control_points, **settings)
    reference = finite_elements(elements=20)
    return (
        trajectory_difference(found.centre, reference.centre),
        found.torque[-1] / reference.torque[-1] - 1,
    )


def test_four_locking_free_control_points_meet_the_papers_claims():
    """Requirement: n = 4, m = 2: path within 1 % of 20 elements, torque at 90 deg above theirs within 3 %."""
    gates.hold("paper_trajectory", lambda **settings: papers_claim(**settings)[0])
    gates.hold("paper_torque", lambda **settings: papers_claim(**settings)[1])  # none below the elements'


def derived(section, strip_length, body):
    """What a model derives from the given data beside the clamps: rigidities, density, masses."""
    names = ("flexural_rigidity", "axial_rigidity", "linear_density")
    rigidities = [getattr(section, name) for name in names]
    return [
        *rigidities,
        section.linear_density * strip_length,
        body.mass,
        body.moment_of_inertia,
        *body.centre,
    ]


def test_derived_data_agree():
    """Requirement: both models derive EI, EA, clamps, directions and masses alike, to round-off."""
    for change in DESIGNS.values():
        design = TABLE_ONE | change
        ours, theirs = spline_model.cross_axis_pivot(**design), fe_reference.cross_axis_pivot(**design)
        one, other = ours.design.strips[0], theirs.strips[0]
        ends = np.diff(theirs.rest, axis=1)[:, [0, -1]]
        for mine, right in (
            (
                derived(one, one.length, ours.design.bodies[0]),
                derived(other, theirs.lengths[0], theirs.bodies[0]),
            ),
            (ours.clamp_points, theirs.rest[:, [0, -1]]),
            (ours.clamp_directions, ends / np.linalg.norm(ends, axis=2, keepdims=True)),
        ):
            assert mine == pytest.approx(np.array(right), rel=1e-14, abs=1e-14)


@pytest.mark.parametrize(
    ("models", "grid", "rotation"),
    [(spline_model, {"control_points": 8}, math.radians(230)), (fe_reference, {"elements": 8}, 40.0)],
    ids=["spline", "fe"],
)
def test_a_path_that_stops_keeps_its_converged_part(models, grid, rotation):
    """Requirement: a failed path says where and why, keeps its good states, and tells of each."""
    calls, pivot = [], models.cross_axis_pivot(**TABLE_ONE, **grid)
    told = {"increments": 30, "progress": lambda *call: calls.append(call)}
    with pytest.raises(models.ConvergenceError, match=r"between .* halvings|stopped between load") as caught:
        models.solve_statics(pivot, rotation=rotation, check=False, **told)
    kept = caught.value.solution
    assert (kept.status.value, 1 < len(kept.rotation) <= 30) == ("not_converged", True)
    assert "more increments" in kept.status.text and kept.message in str(caught.value)
    assert calls[: len(kept.rotation) - 1] == [(k, 30) for k in range(1, len(kept.rotation))]
    assert np.isfinite(kept.torque).all() and kept.rotation[-1] < rotation
    assert 0.0 < caught.value.load_factor < 1.0
