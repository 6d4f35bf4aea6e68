"""A sizing question: which variables of a design make an objective least, within which limits."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import qmc

from studies.cases.design import document_of
from studies.cases.problem import Problem
from studies.cases.section import of_sides
from studies.design.evaluate import (
    CENTRE_SHIFT,
    CONTROL_POINTS,
    STIFFNESS,
    STRESS,
    TRAVEL,
    VARIABLES,
    VARIATION,
    Accurate,
    Answers,
    accurate,
    answers,
)
from studies.kinds import Array

#: Objectives of a pivot.
OF_PIVOT = (CENTRE_SHIFT, VARIATION)


class Variable(NamedTuple):
    """A number of a design that may change.

    name, own: what it is called, and its value in the design to compare with; low, high: its bounds.
    heading, factor, form: of its column in a table: its name, the factor to the unit shown, and the format.
    """

    name: str
    own: float
    low: float
    high: float
    heading: str
    factor: float = 1.0
    form: str = "12.6g"

    @property
    def span(self) -> float:
        """Width of the bounds in the unit of the variable, 0 of a variable that is held."""
        return self.high - self.low


class _Ratio(NamedTuple):
    """A limit on the ratio of two variables.

    name: of the constraint. top, bottom: places of the variables. limit: of the ratio, the least one if
    `side` is 1 and the largest if it is -1. words: ratio and limit as a phrase.
    """

    name: str
    top: int
    bottom: int
    limit: float
    side: int
    words: tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Question:
    """A question about a design: which of N variables make an objective least.

    Attributes:
        start: the design to compare with. variables: of the design.
        objective: what is to be least over the range, one of `objectives`.
        wanted: stiffness of the body as it begins to turn, under the loads [N m / rad], or its travel [m].
        allowable_stress: of the extreme fibres, at the states where it is held [Pa].
        ratios: limits of the form alone.
        control_points: of the strips while designs are sought.
    """

    start: Any
    variables: tuple[Variable, ...]
    objectives: tuple[str, ...]
    objective: str
    wanted: float = math.nan
    allowable_stress: float = math.inf
    ratios: tuple[_Ratio, ...] = ()
    control_points: int = CONTROL_POINTS

    def design(self, values: Array) -> Any:
        """Return the design with these variables (N,) in SI units."""
        raise NotImplementedError

    def document(self, values: Array) -> dict[str, Any]:
        """Return the document of the case with these variables (N,) in SI units."""
        raise NotImplementedError

    def dimensions(self, values: Array) -> dict[str, Any]:
        """Return these variables (N,) in SI units as the JSON has them."""
        return {"numbers": dict(zip(self.names, map(float, values), strict=True))}

    def parameters(self, values: Array) -> tuple[Sequence[str], Array | None]:
        """Return names (R,) of the sensitivities and derivatives (R, N) by the variables, as of `evaluate`.

        values: variables (N,) in SI units. None in place of derivatives: the names are the variables.
        """
        return self.names, None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the variables (N,)."""
        return tuple(variable.name for variable in self.variables)

    @property
    def held(self) -> str:
        """The quantity that is wanted: where the bodies follow the loads, how far the body goes."""
        return TRAVEL if self.start.rotation is None else STIFFNESS

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that are told of a design."""
        return (*self.objectives, self.held, *({STRESS} - {*self.objectives}))

    @property
    def own(self) -> Array:
        """Variables of the start (N,) in SI units."""
        return np.array([variable.own for variable in self.variables])

    @property
    def low(self) -> Array:
        """Lowest values of the variables (N,) in SI units."""
        return np.array([variable.low for variable in self.variables])

    @property
    def span(self) -> Array:
        """Widths of the bounds (N,) in SI units, 0 of a variable that is held."""
        return np.array([variable.span for variable in self.variables])

    def values(self, y: Array) -> Array:
        """Return the variables (N,) in their units, of y in [0, 1]^N, or (N + 1,)."""
        return self.low + self.span * y[: len(self.span)]

    def scaled(self, values: Array) -> Array:
        """Return y in [0, 1]^N of variables (N,), clipped to the bounds."""
        return np.clip((values - self.low) / np.where(self.span == 0.0, 1.0, self.span), 0.0, 1.0)

    def starts(self, count: int, seed: int = 8) -> Array:
        """Return starts (count, N) in [0, 1]^N: the design to compare with, and Sobol's points."""
        spread = qmc.Sobol(len(self.span), seed=seed).random_base2(math.ceil(math.log2(max(count - 1, 1))))
        return np.vstack((self.scaled(self.own), spread[: count - 1]))

    def answers(self, values: Array | None = None, control_points: int | None = None) -> Answers:
        """Return the answers of the design with these variables (N,) in SI units, or of the start.

        They are with the question's control points unless some are given; errors as of `evaluate.answers`.
        """
        design = self.start if values is None else self.design(values)
        names, chain = self.parameters(self.own if values is None else values)
        return answers(design, control_points or self.control_points, parameters=names, chain=chain)

    def accurate(self, values: Array | None = None) -> Accurate:
        """Return the answers of a design with as many control points as its accuracy takes.

        values: variables (N,) in SI units; None: those of the start.
        """
        return accurate(lambda points: self.answers(values, points), self.quantities)


@dataclass(frozen=True, kw_only=True)
class PivotQuestion(Question):
    """A question about a pivot: designs have the material, range, increments and loads of the start.

    The variables are those of `VARIABLES` [m, rad, 1, m, m].
    """

    @classmethod
    def usual(
        cls,
        start: Problem,
        bounds: Mapping[str, tuple[float, float]] | None = None,
        *,
        aspect: float = 1.0,
        **asked: Any,
    ) -> "PivotQuestion":
        """Return the question about a design within bounds as far as a designer may leave it, or those that
        are given, with strips no stubbier than its own, below which shear counts, and no wider than `aspect`
        times their length, above which a strip is a plate; `asked` are the other arguments."""
        length, inclination, crossing, thickness, width = map(float, variables_of(start))
        degree = math.degrees(1.0)
        usual = (
            Variable("length", length, 0.5 * length, length, "L mm", 1e3, "9.3f"),
            Variable("inclination", inclination, 20.0 / degree, 70.0 / degree, "incl. deg", degree, "11.3f"),
            Variable("crossing_ratio", crossing, 0.1, 0.9, "crossing", 1.0, "10.4f"),
            Variable("thickness", thickness, 0.1 * thickness, 1.6 * thickness, "h mm", 1e3, "9.4f"),
            Variable("width", width, 0.2 * width, length, "b mm", 1e3, "9.3f"),
        )
        given = bounds or {}
        within = ((each, *given.get(each.name, (each.low, each.high))) for each in usual)
        slender = ("length over thickness", "the case's, the least,")
        ratios = (
            _Ratio("slenderness", 0, 3, length / thickness, 1, slender),
            _Ratio("aspect", 4, 0, aspect, -1, ("width over length", "the --aspect of")),
        )
        variables = tuple(each._replace(low=low, high=high) for each, low, high in within)
        return cls(start=start, variables=variables, objectives=OF_PIVOT, ratios=ratios, **asked)

    def design(self, values: Array) -> Problem:
        """Return the pivot with these variables (5,) in SI units."""
        return varied(self.start, values)

    def document(self, values: Array) -> dict[str, Any]:
        """Return the document of the pivot with these variables (5,) in SI units."""
        return document_of(self.design(values))

    def dimensions(self, values: Array) -> dict[str, Any]:
        """Return these variables (5,) with their units."""
        length, inclination, crossing, thickness, width = map(float, values)
        angle = {"inclination_deg": math.degrees(inclination), "crossing_ratio": crossing}
        return {"length_m": length, **angle, "thickness_m": thickness, "width_m": width}


def variables_of(problem: Problem) -> Array:
    """Return the variables (5,) [m, 1, rad] of a pivot, with the rectangular section that A and I imply."""
    values = vars(problem) | problem.rectangle()
    return np.array([values[name] for name in VARIABLES])


def varied(problem: Problem, variables: Array) -> Problem:
    """Return a pivot with other variables (5,) [m, rad, 1, m, m]."""
    values: dict[str, Any] = dict(zip(VARIABLES, map(float, variables), strict=True))
    return replace(problem, **values, **of_sides(values["width"], values["thickness"]))
