"""A sizing question: what is to be least, what must hold, between which bounds; and those of the study."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from scipy.stats import qmc

from studies.cases.problem import Problem, named_case
from studies.cases.section import of_sides
from studies.design import evaluate
from studies.design.evaluate import (
    CENTRE_SHIFT,
    CONTROL_POINTS,
    STATIONS,
    STRESS,
    VARIABLES,
    VARIATION,
    Accurate,
    Answers,
    accurate,
    held_states,
    sides_of,
)
from studies.kinds import Array

#: What tables call them.
UNITS = ("length_m", "inclination_rad", "crossing_ratio", "thickness_m", "width_m")

#: What may be made least: its meaning, over the whole range to both sides.
OBJECTIVES: Mapping[str, str] = {
    CENTRE_SHIFT: "largest displacement of the body's point in the strips' crossing at rest [m]",
    VARIATION: "largest change of the rotational stiffness, relative to that at rest [1]",
}


class Sizing:
    """A question about a design: which of N variables make an objective least.

    Attributes:
        start: the design to compare with. bounds: lowest and highest value of each variable by its name.
        objective: what is to be least, one of `objectives`.
        stiffness: wanted: of the body as it begins to turn, under the loads [N m / rad], or its travel [m].
        allowable_stress: of the extreme fibres, at the states of `held_states` [Pa].
        control_points: of the strips while designs are sought.
        own: variables of the start (N,).
        columns: of the variables in a table: heading, factor to the unit it shows them in, and format.
    """

    start: Any
    bounds: Mapping[str, tuple[float, float]]
    objective: str
    stiffness: float
    allowable_stress: float
    control_points: int
    #: Properties of one kind, fields of the other.
    own: Any
    objectives: Any
    columns: Any
    problem: Callable[[Array], Any]
    quantities: Callable[[Answers], dict[str, float]]
    by_elements: Callable[[Any], dict[str, float]]

    @property
    def held(self) -> str:
        """What the wanted stiffness is called: where the bodies follow the loads, how far the body goes."""
        return "travel" if self.start.rotation is None else "stiffness"

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables (N,)."""
        return tuple(self.bounds)

    @property
    def low(self) -> Array:
        """Lowest values of the variables (N,)."""
        return np.array([low for low, _ in self.bounds.values()])

    @property
    def span(self) -> Array:
        """Widths of the bounds (N,), 0 of a variable that is held."""
        return np.array([high - low for low, high in self.bounds.values()])

    @property
    def fibres(self) -> int:
        """Fibre stresses that are held: both fibres of the strips, at `STATIONS` of the held states."""
        return 2 * len(self.start.strips) * len(STATIONS) * len(held_states(self.start))

    @property
    def states(self) -> int:
        """States behind the first, of all sides."""
        return int(self.start.increments * len(sides_of(self.start)))

    def values(self, y: Array) -> Array:
        """Return the variables (N,) in their units, of y in [0, 1]^N, or (N + 1,)."""
        return self.low + self.span * y[: len(self.span)]

    def starts(self, count: int, seed: int = 8) -> Array:
        """Return starts (count, N) in [0, 1]^N: the design to compare with, clipped to the bounds, and
        Sobol's points."""
        span = np.where(self.span == 0.0, 1.0, self.span)
        own = np.clip((self.own - self.low) / span, 0.0, 1.0)
        spread = qmc.Sobol(len(own), seed=seed).random_base2(int(np.ceil(np.log2(max(count - 1, 1)))))
        return np.vstack((own, spread[: count - 1]))

    def shape(self, values: Array) -> tuple[Array, Array, dict[str, float]]:
        """Return rows of the form alone, their Jacobian by the scaled variables, and their changes over
        relative ones of their limits by name: none unless a kind of design has some."""
        return np.zeros(0), np.zeros((0, len(values))), {}

    def changed(self, **fields: Any) -> Self:
        """Return the question with other values of some of its fields."""
        return replace(self, **fields)  # type: ignore[type-var]

    def answers(self, values: Array, control_points: int | None = None) -> Answers:
        """Return what the design with these variables (N,) answers, with the task's control points unless
        some are given; errors as of `evaluate.answers`."""
        return evaluate.answers(self.problem(values), control_points or self.control_points)

    def case(self, control_points: int | None = None) -> Answers:
        """Return what the start answers."""
        return self.answers(self.own, control_points)

    def accurate(self, values: Array | None = None) -> Accurate:
        """Return what the design with these variables (N,) answers, or the start, with as many control points
        as it takes."""
        if values is None:
            return accurate(self.case, self.quantities)
        return accurate(lambda points: self.answers(values, points), self.quantities)


@dataclass(frozen=True, kw_only=True)
class Task(Sizing):
    """A question about a pivot: designs have the material, range (`rotation`), increments and loads of the
    start.

    Args:
        bounds: in the order of `VARIABLES`, SI and radians.
        least_slenderness: of the strips, L / t [1]: below, shear counts, which the strips do not have.
        largest_aspect: of the strips, b / L [1]: above, a strip is a plate.
    """

    start: Problem
    objective: str
    stiffness: float
    allowable_stress: float
    bounds: Mapping[str, tuple[float, float]]
    least_slenderness: float
    largest_aspect: float
    control_points: int = CONTROL_POINTS

    objectives = tuple(OBJECTIVES)
    columns = (
        ("L mm", 1e3, "9.3f"),
        ("incl. deg", math.degrees(1.0), "11.3f"),
        ("crossing", 1.0, "10.4f"),
        ("h mm", 1e3, "9.4f"),
        ("b mm", 1e3, "9.3f"),
    )

    @classmethod
    def usual(
        cls, start: Problem, bounds: Mapping[str, tuple[float, float]] | None = None, **asked: Any
    ) -> "Task":
        """Return the question about a design within bounds as far as a designer may leave it, or those that
        are given, with strips no stubbier than its own, and no wider than it is long; `asked` are the other
        arguments."""
        length, _, _, thickness, width = map(float, variables_of(start))
        usual = {
            "length": (0.5 * length, length),
            "inclination": (math.radians(20.0), math.radians(70.0)),
            "crossing_ratio": (0.1, 0.9),
            "thickness": (0.1 * thickness, 1.6 * thickness),
            "width": (0.2 * width, length),
        }
        within = usual | dict(bounds or {})
        return cls(start=start, bounds=within, least_slenderness=length / thickness, **asked)

    @property
    def own(self) -> Array:
        """Variables of the start (5,)."""
        return variables_of(self.start)

    def shape(self, values: Array) -> tuple[Array, Array, dict[str, float]]:
        """Return the rows of slenderness, L / t, and of aspect, b / L, linear in the variables (5,), over the
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

    def problem(self, variables: Array) -> Problem:
        """Return the design with these variables (5,) [m, rad, 1, m, m]."""
        return varied(self.start, variables)

    def case(self, control_points: int | None = None) -> Answers:
        """Return what the start answers."""
        return evaluate.answers(self.start, control_points or self.control_points)

    def quantities(self, found: Answers) -> dict[str, float]:
        """Return what the splines say of a design, by name."""
        return found.measured().quantities()

    def by_elements(self, design: Problem) -> dict[str, float]:
        """Return what the finite elements say of it; NoReference where they do not reach its range's end."""
        return evaluate.by_elements(design).quantities()


def variables_of(problem: Problem) -> Array:
    """Return the variables (5,) of a design, its section taken as the rectangle that A and I imply."""
    values = vars(problem) | problem.rectangle()
    return np.array([values[name] for name in VARIABLES])


def varied(problem: Problem, variables: Array) -> Problem:
    """Return a design with other variables (5,) [m, rad, 1, m, m]."""
    values: dict[str, Any] = dict(zip(VARIABLES, map(float, variables), strict=True))
    return replace(problem, **values, **of_sides(values["width"], values["thickness"]))


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

    def task(self, start: Problem, own: Answers) -> Task:
        """Return what is asked beside that design at the stiffness of its own answers."""
        return Task.usual(
            start,
            objective=self.objective,
            stiffness=own.stiffness,
            allowable_stress=own.largest(STRESS) if self.stress is None else self.stress,
            largest_aspect=self.aspect,
        )


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


def baseline(name: str = TABLE_ONE) -> Problem:
    """Return the design to compare with, over its range."""
    given = named_case(BASELINES[name])
    rotation = math.radians(RANGE_DEG) if name == TABLE_ONE else given.rotation
    return replace(given, rotation=rotation, increments=INCREMENTS)
