"""Pivots drawn at random within bounds: a Latin hypercube, the same for the same seed."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.stats import qmc

from studies.answers.adapters import answer_modes
from studies.answers.settings import SplineSettings
from studies.cases.problem import Problem

Bounds = Mapping[str, tuple[float, float]]


def drawn(problem: Problem, bounds: Bounds, *, count: int, seed: int) -> list[Problem]:
    """Return `count` pivots like `problem` whose values fill the bounds evenly.

    Args:
        problem: gives what is not drawn: length, width of the section, material, body.
        bounds: of "slenderness" (L over the depth of the section, drawn evenly in its logarithm),
            "crossing_ratio" [1], "inclination" [rad] and "rotation" [rad].
        count: of pivots [1].
        seed: of the Latin hypercube.
    """
    names = ("slenderness", "crossing_ratio", "inclination", "rotation")
    low, high = np.array([bounds[name] for name in names]).T
    low[0], high[0] = math.log(low[0]), math.log(high[0])
    points = qmc.scale(qmc.LatinHypercube(d=len(names), seed=seed).random(count), low, high)
    width = problem.area / problem.depth
    designs = []
    for logarithm, crossing_ratio, inclination, rotation in points:
        depth = problem.length / math.exp(logarithm)
        designs.append(
            replace(
                problem,
                area=width * depth,
                second_moment_of_area=width * depth**3 / 12.0,
                crossing_ratio=float(crossing_ratio),
                inclination=float(inclination),
                rotation=float(rotation),
            )
        )
    return designs


def period(problem: Problem) -> float:
    """Return the period of the slowest small swing at rest [s]."""
    return 1.0 / float(answer_modes(problem, SplineSettings(), count=1).frequency[0])


def described(number: int, problem: Problem) -> dict[str, float]:
    """Return the columns that say which design a row is of."""
    return {
        "design": number,
        "slenderness": problem.length / problem.depth,
        "crossing_ratio": problem.crossing_ratio,
        "inclination_rad": problem.inclination,
        "rotation_rad": problem.rotation,
    }
