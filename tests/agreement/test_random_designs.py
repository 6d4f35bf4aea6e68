"""Default answers on random pivots: right by the elements, and none is refused without a physical reason."""

import math
from functools import cache, partial

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates

#: Designs of a seed; the first ones are judged, the others on demand: `judged(range(COUNT))`.
SEED, COUNT, JUDGED = 14, 200, 24
MESHES = 40, 80
#: Designs whose stress is judged, and meshes for it: strips that are bent far have short peaks.
STRESSED, FINER = 50, (80, 160)
#: Length [m], area [m^2] and modulus [Pa] of all strips; I follows from the slenderness L / sqrt(I / A).
LENGTH, AREA, MODULUS = 0.1, 1e-5, 206e9
#: What is judged of a path of elements: torque and place of the body.
OF = (lambda path: path.torque), (lambda path: path.bodies["body"][:, :2])
CRITICAL = "limit point", "bifurcation", "turning point"


@cache
def designs():
    """Keywords and rotation [rad] of random pivots, every third one under a force and a moment."""
    draw, made = np.random.default_rng(SEED), []
    for number in range(COUNT):
        inclination, crossing_ratio = math.radians(draw.uniform(15, 75)), draw.uniform(0.1, 0.9)
        slenderness = math.exp(draw.uniform(math.log(20), math.log(2000)))
        rotation = math.radians(draw.uniform(60, 200)) * float(draw.choice([-1, 1]))
        x, y, moment = draw.uniform(-1, 1, 3)
        design = {
            "length": LENGTH,
            "inclination": inclination,
            "crossing_ratio": crossing_ratio,
            "area": AREA,
            "second_moment_of_area": AREA * (LENGTH / slenderness) ** 2,
            "youngs_modulus": MODULUS,
            "poisson_ratio": 0.3,
            "density": 7800.0,
            "body_mass": 0.1,
            "body_moment_of_inertia": 1e-4,
        }
        if number % 3 == 2:
            unit = MODULUS * design["second_moment_of_area"] / LENGTH**2
            loads = {
                "applied_force": {"force": (x * unit, y * unit)},
                "applied_moment": {"moment": moment * unit * LENGTH},
            }
            design |= {"effects": ("bending", "stretching", *loads), "parameters": loads}
        made.append((design, rotation))
    return made


def judged(numbers, **settings):
    """Largest error of path and torque of these designs by the elements, and the reasons of those refused."""
    worst, refused = 0.0, []
    for number in numbers:
        design, rotation = designs()[number]
        pivot = spline_model.cross_axis_pivot(**design, **settings)
        answer = spline_model.solve_statics(pivot, rotation=rotation, raise_on_failure=False)
        if answer.status.value != "converged":
            refused.append(answer.message)
            continue
        fine = [
            fe_reference.solve_statics(
                fe_reference.cross_axis_pivot(**design, elements=count), rotation=rotation
            )
            for count in MESHES
        ]
        torque, place = ((4.0 * b - a) / 3.0 for a, b in (map(of, fine) for of in OF))
        travel = np.linalg.norm(place - place[0], axis=1).max()
        worst = max(
            worst,
            float(np.linalg.norm(answer.centre - place, axis=1).max() / travel),
            float(np.abs(answer.torque - torque).max() / np.abs(torque).max()),
        )
    return worst, refused


@pytest.mark.slow
def test_default_answers_are_right():
    """Requirement: path and torque of default answers are right by elements; a refusal names what buckles."""
    worst, refused = judged(range(JUDGED))
    assert all(any(kind in reason for kind in CRITICAL) for reason in refused), refused
    gates.check("default_answers", worst)
    gates.refuse("default_answers", lambda **grid: judged(range(4), **grid)[0])


def stress_apart(numbers, **settings):
    """Largest error of the largest stress over the paths of these designs, over its largest value."""
    worst = 0.0
    for number in numbers:
        design, rotation = designs()[number]
        pivot = spline_model.cross_axis_pivot(**design, **settings)
        answer = spline_model.solve_statics(pivot, rotation=rotation)
        coarse, fine = (
            fe_reference.solve_statics(
                fe_reference.cross_axis_pivot(**design, elements=count), rotation=rotation
            ).largest_stress
            for count in FINER
        )
        limit = (4.0 * fine - coarse) / 3.0
        modulus = math.sqrt(AREA * design["second_moment_of_area"] / 3.0)
        stress = np.abs(answer.axial_force) / AREA + np.abs(answer.bending_moment) / modulus
        worst = max(worst, float(np.abs(stress.max(axis=(1, 2)) - limit).max() / limit.max()))
    return worst


@pytest.mark.slow
def test_default_stress_is_right():
    """Requirement: the largest stress of default answers is within 0.1 % of refined elements."""
    gates.check("default_stress", stress_apart(range(STRESSED)))
    gates.refuse("default_stress", partial(stress_apart, (4,)))
