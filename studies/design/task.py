"""A sizing question: what is to be least, what must hold, and between which bounds the design may move."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from studies.cases.problem import Problem

#: Variables of a sizing, as keywords of the sensitivities; both strips are alike.
VARIABLES = ("length", "inclination", "crossing_ratio", "thickness", "width")

CENTRE_SHIFT, VARIATION = "centre-shift", "stiffness-variation"
#: What may be made least: its meaning, over the whole range to both sides.
OBJECTIVES: Mapping[str, str] = {
    CENTRE_SHIFT: "largest displacement of the body's point in the strips' crossing at rest [m]",
    VARIATION: "largest change of the rotational stiffness, relative to that at rest [1]",
}


@dataclass(frozen=True, kw_only=True)
class Task:
    """One question about one pivot.

    The path goes to one side only: both strips are alike, so the other side is its mirror image.

    Args:
        start: the design to compare with; its material, range (`rotation`) and increments hold for all.
        objective: a key of `OBJECTIVES`.
        stiffness: wanted rotational stiffness at rest [N m / rad].
        allowable_stress: of the extreme fibres at the end of the range [Pa].
        bounds: lowest and highest value of every variable, SI and radians.
        least_slenderness: of the strips, L / h [1]: below, shear counts, which the strips do not have.
        largest_aspect: of the strips, b / L [1]: above, a strip is a plate.
        limits: largest value of an objective that is not the one to be least, by its name.
    """

    start: Problem
    objective: str
    stiffness: float
    allowable_stress: float
    bounds: Mapping[str, tuple[float, float]]
    least_slenderness: float
    largest_aspect: float
    limits: Mapping[str, float]

    @property
    def low(self) -> NDArray[np.float64]:
        """Lowest values of the variables (5,)."""
        return np.array([self.bounds[name][0] for name in VARIABLES])

    @property
    def span(self) -> NDArray[np.float64]:
        """Widths of the bounds (5,)."""
        return np.array([self.bounds[name][1] for name in VARIABLES]) - self.low

    def problem(self, variables: NDArray[np.float64]) -> Problem:
        """Return the design with these variables (5,) [m, rad, 1, m, m]."""
        length, inclination, ratio, thickness, width = map(float, variables)
        return replace(
            self.start,
            length=length,
            inclination=inclination,
            crossing_ratio=ratio,
            area=thickness * width,
            second_moment_of_area=thickness**3 * width / 12.0,
            section_depth=None,
        )


@dataclass(frozen=True, kw_only=True)
class Room:
    """How far a designer may leave a design: what bounds are taken where none are given.

    Args:
        length, thickness: of the start's own [1]. width: of the start's own, and of the start's length [1].
        inclination: [rad]; crossing_ratio: [1].
        largest_aspect: b / L [1]. The slenderness may not fall below the start's own.
    """

    length: tuple[float, float] = (0.5, 1.0)
    inclination: tuple[float, float] = (math.radians(20.0), math.radians(70.0))
    crossing_ratio: tuple[float, float] = (0.1, 0.9)
    thickness: tuple[float, float] = (0.1, 1.6)
    width: tuple[float, float] = (0.2, 1.0)
    largest_aspect: float = 1.0

    def bounds(self, start: Problem) -> dict[str, tuple[float, float]]:
        """Return the bounds of every variable about a design [m, rad, 1, m, m]."""
        length, _, _, thickness, width = map(float, variables_of(start))
        return {
            "length": (self.length[0] * length, self.length[1] * length),
            "inclination": self.inclination,
            "crossing_ratio": self.crossing_ratio,
            "thickness": (self.thickness[0] * thickness, self.thickness[1] * thickness),
            "width": (self.width[0] * width, self.width[1] * length),
        }


def variables_of(problem: Problem) -> NDArray[np.float64]:
    """Return the variables (5,) of a design, its section taken as the rectangle that A and I imply."""
    thickness = math.sqrt(12.0 * problem.second_moment_of_area / problem.area)
    return np.array(
        [problem.length, problem.inclination, problem.crossing_ratio, thickness, problem.area / thickness]
    )
