"""A sizing question: what is to be least, what must hold, between which bounds; and those of the study."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from studies.cases.effects import MOTION_ONLY
from studies.cases.mechanism import of_sides
from studies.cases.problem import Problem, named_case

#: Variables of a sizing, as keywords of the sensitivities; both strips are alike.
VARIABLES = ("length", "inclination", "crossing_ratio", "thickness", "width")
#: What tables call them.
UNITS = ("length_m", "inclination_rad", "crossing_ratio", "thickness_m", "width_m")

CENTRE_SHIFT, VARIATION, STRESS = "centre-shift", "stiffness-variation", "stress"
#: What may be made least: its meaning, over the whole range to both sides.
OBJECTIVES: Mapping[str, str] = {
    CENTRE_SHIFT: "largest displacement of the body's point in the strips' crossing at rest [m]",
    VARIATION: "largest change of the rotational stiffness, relative to that at rest [1]",
}
#: Where fibre stresses are constrained, reference arc length over L.
STATIONS = np.linspace(0.0, 1.0, 21)
#: Fibre stresses of a pivot's state: two strips, both fibres.
FIBRES = 4 * len(STATIONS)

#: Effects under which both sides of a range are mirror images, as both strips are alike.
PLAIN = {"bending", "stretching", "clamped_width", "anticlastic", "root_compliance", *MOTION_ONLY}


def sides_of(problem: Problem) -> tuple[float, ...]:
    """Return the signs of the rotations that a range needs solved: both under loads, one without."""
    return (1.0,) if set(problem.effects.names) <= PLAIN else (1.0, -1.0)


class Bounded:
    """A question whose N variables have `bounds`: lowest and highest value of each by its name."""

    bounds: Mapping[str, tuple[float, float]]

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables (N,)."""
        return tuple(self.bounds)

    @property
    def low(self) -> NDArray[np.float64]:
        """Lowest values of the variables (N,)."""
        return np.array([low for low, _ in self.bounds.values()])

    @property
    def span(self) -> NDArray[np.float64]:
        """Widths of the bounds (N,), 0 of a variable that is held."""
        return np.array([high - low for low, high in self.bounds.values()])


@dataclass(frozen=True, kw_only=True)
class Task(Bounded):
    """One question about one pivot.

    Args:
        start: the design to compare with; all have its material, range (`rotation`), increments and loads.
        objective: a key of `OBJECTIVES`.
        stiffness: wanted rotational stiffness at rotation 0, under the loads [N m / rad].
        allowable_stress: of the extreme fibres at the ends of the range, and before it under loads [Pa].
        bounds: lowest and highest value of every variable in the order of `VARIABLES`, SI and radians.
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
    def sides(self) -> tuple[float, ...]:
        """Signs of the rotations that are solved, as of `sides_of`."""
        return sides_of(self.start)

    @property
    def own(self) -> NDArray[np.float64]:
        """Variables of the start (5,)."""
        return variables_of(self.start)

    @property
    def objectives(self) -> tuple[str, ...]:
        """What may be made least of a pivot."""
        return tuple(OBJECTIVES)

    @property
    def held(self) -> str:
        """What the wanted stiffness is called."""
        return "stiffness"

    @property
    def fibres(self) -> int:
        """Fibre stresses that are held: at the end of each side, under loads before the body turns too."""
        return FIBRES * (1 if len(self.sides) == 1 else len(self.sides) + 1)

    @property
    def states(self) -> int:
        """States behind the first, of all sides."""
        return self.start.increments * len(self.sides)

    def shape(
        self, values: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, float]]:
        """Return the rows of slenderness, L / h, and of aspect, b / L, linear in the variables (5,), over the
        longest length; their Jacobian by the scaled variables (2, 5); and their changes over relative ones of
        the limits."""
        length, _, _, thickness, width = values
        whole = self.low[0] + self.span[0]
        rows = np.zeros((2, len(VARIABLES)))
        rows[0, [0, 3]] = self.span[[0, 3]] * (1.0, -self.least_slenderness) / whole
        rows[1, [0, 4]] = self.span[[0, 4]] * (self.largest_aspect, -1.0) / whole
        changes = {
            "slenderness": self.least_slenderness * thickness / whole,
            "aspect": -self.largest_aspect * length / whole,
        }
        slender = length - self.least_slenderness * thickness
        return np.array([slender, self.largest_aspect * length - width]) / whole, rows, changes

    def begun_at(self, start: Problem) -> "Task":
        """Return the same question about another design."""
        return replace(self, start=start)

    def problem(self, variables: NDArray[np.float64]) -> Problem:
        """Return the design with these variables (5,) [m, rad, 1, m, m]."""
        return varied(self.start, variables)


def usual_bounds(start: Problem) -> dict[str, tuple[float, float]]:
    """Return how far a designer may leave a design where no bounds are given [m, rad, 1, m, m].

    The slenderness may not fall below the start's own, nor the width exceed the start's length.
    """
    length, _, _, thickness, width = map(float, variables_of(start))
    return {
        "length": (0.5 * length, length),
        "inclination": (math.radians(20.0), math.radians(70.0)),
        "crossing_ratio": (0.1, 0.9),
        "thickness": (0.1 * thickness, 1.6 * thickness),
        "width": (0.2 * width, length),
    }


def variables_of(problem: Problem) -> NDArray[np.float64]:
    """Return the variables (5,) of a design, its section taken as the rectangle that A and I imply."""
    thickness = math.sqrt(12.0 * problem.second_moment_of_area / problem.area)
    return np.array(
        [problem.length, problem.inclination, problem.crossing_ratio, thickness, problem.area / thickness]
    )


def varied(problem: Problem, variables: NDArray[np.float64]) -> Problem:
    """Return a design with other variables (5,) [m, rad, 1, m, m]."""
    length, inclination, ratio, thickness, width = map(float, variables)
    return replace(
        problem,
        length=length,
        inclination=inclination,
        crossing_ratio=ratio,
        width=width,
        thickness=thickness,
        **of_sides(width, thickness),
    )


#: Designs to compare with: their case.
TABLE_ONE, SPRING_STEEL = "Table 1", "spring steel"
BASELINES: Mapping[str, str] = {TABLE_ONE: "cross_axis_pivot", SPRING_STEEL: "spring_steel_pivot"}

#: Range of Table 1's pivot to either side; at its 90 degrees the stress is above 14 GPa.
RANGE_DEG = 45.0
#: Increments of the path to the end of the range.
INCREMENTS = 12
#: Starts of every search: the design to compare with and points spread over the bounds.
STARTS = 8
#: Stress at which a strip of hardened spring steel lasts under repeated bending, a choice [Pa].
ALLOWABLE = 500e6
#: Strips no wider than half their length, in place of no wider than long.
NARROW = 0.5
#: Largest variations of stiffness for which the centre shift is made least [1].
TRADE = (0.07, 0.06, 0.05, 0.04, 0.03, 0.02, 0.01, 0.005, 0.002, 0.001)


@dataclass(frozen=True, kw_only=True)
class Question:
    """What is to be least beside which design.

    Args:
        baseline: the design to compare with, a key of `BASELINES`; objective: a key of `OBJECTIVES`.
        aspect: largest width over length [1].
        stress: allowable [Pa]; None for the baseline's own at the end of the range.
    """

    baseline: str
    objective: str
    aspect: float = 1.0
    stress: float | None = None


QUESTIONS: Mapping[str, Question] = {
    "least centre shift": Question(baseline=TABLE_ONE, objective=CENTRE_SHIFT),
    "least variation of stiffness": Question(baseline=TABLE_ONE, objective=VARIATION),
    "least centre shift, narrow strips": Question(baseline=TABLE_ONE, objective=CENTRE_SHIFT, aspect=NARROW),
    "least variation of stiffness, narrow strips": Question(
        baseline=TABLE_ONE, objective=VARIATION, aspect=NARROW
    ),
    "least centre shift, spring steel": Question(
        baseline=SPRING_STEEL, objective=CENTRE_SHIFT, stress=ALLOWABLE
    ),
    "least variation of stiffness, spring steel": Question(
        baseline=SPRING_STEEL, objective=VARIATION, stress=ALLOWABLE
    ),
}
#: The two between which the trade lies.
WIDE = ("least centre shift", "least variation of stiffness")


def baseline(name: str = TABLE_ONE) -> Problem:
    """Return the design to compare with, over its range."""
    given = named_case(BASELINES[name])
    rotation = math.radians(RANGE_DEG) if name == TABLE_ONE else given.rotation
    return replace(given, rotation=rotation, increments=INCREMENTS)


def task_of(start: Problem, question: Question, *, stiffness: float, stress: float, **limits: float) -> Task:
    """Return the task of a question, at the stiffness of the design to compare with.

    Args:
        start: that design, with its own stiffness at rest [N m / rad] and largest stress [Pa].
        question: of what is to be least.
        limits: largest variation of stiffness, as `variation` [1].
    """
    length, _, _, thickness, _ = variables_of(start)
    return Task(
        start=start,
        objective=question.objective,
        stiffness=stiffness,
        allowable_stress=stress if question.stress is None else question.stress,
        bounds=usual_bounds(start),
        least_slenderness=float(length / thickness),
        largest_aspect=question.aspect,
        limits={VARIATION: limits["variation"]} if limits else {},
    )
