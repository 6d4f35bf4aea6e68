"""A sizing question: which numbers of a case file make an objective least, within which limits."""

import copy
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple, Self

import numpy as np
from scipy.stats import qmc

from spline_model.accuracy import DEFAULT, MOST
from spline_model.confirmed import MORE
from spline_model.parameters import CENTRES, MATERIAL, POINTS
from studies.cases.design import Design, design_of
from studies.cases.document import is_mechanism, nearest
from studies.cases.keys import SIDES
from studies.cases.section import refuse_tapers
from studies.design import evaluate
from studies.design.evaluate import Answers
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep import varied

#: Control points that are added where the accuracy is not reached.
FURTHER = 2
#: Bounds of a number of a section or material where none are given, over its own.
ROOM = (0.5, 2.0)
#: Step of the differences by which a case's numbers are followed to those of its strips: polynomials of the
#: fourth degree at most, of which extrapolated differences are exact, and turned ends, nearly exact.
STEP = 0.05
#: Numbers of a pivot's file that the sensitivities know by a name of their own, both strips being alike.
LENGTH, THICKNESS, WIDTH = "strip.length_m", "strip.thickness_m", "strip.width_m"
INCLINATION, CROSSING = "strip.inclination_deg", "strip.crossing_ratio"
OF_PIVOTS = {
    LENGTH: "length",
    INCLINATION: "inclination",
    CROSSING: "crossing_ratio",
    THICKNESS: "thickness",
    WIDTH: "width",
}


class _Variable(NamedTuple):
    """A number of the case that may change.

    name: keys that share its value, with commas; own, low, high: its value in the case and its bounds, in the
    file's unit.
    """

    name: str
    own: float
    low: float
    high: float

    @property
    def span(self) -> float:
        """Width of the bounds in the unit of the variable, 0 of a variable that is held."""
        return self.high - self.low


class _Ratio(NamedTuple):
    """A limit on the ratio of two variables.

    name: of the constraint. top, bottom: places of the variables. limit: of the ratio, the least one if
    `side` is 1 and the largest if it is -1.
    """

    name: str
    top: int
    bottom: int
    limit: float
    side: int


@dataclass(frozen=True, kw_only=True)
class Question:
    """A question about a design: which of N numbers of its case make an objective least.

    Attributes:
        where, content: the case file and what stands in it.
        start: the design of it, to compare with. variables: the numbers, in the file's units.
        objective: what is to be least over the range, one of `objectives`.
        wanted: stiffness of the body as it begins to turn, under the loads [N m / rad], or its travel [m].
        allowable_stress: of the extreme fibres, at the states where it is held [Pa].
        ratios: limits of the form alone.
        control_points: of the strips while designs are sought.
    """

    where: str
    content: Mapping[str, Any]
    start: Design
    variables: tuple[_Variable, ...]
    objective: str
    wanted: float = math.nan
    allowable_stress: float = math.inf
    ratios: tuple[_Ratio, ...] = ()
    control_points: int = evaluate.CONTROL_POINTS

    @classmethod
    def of(
        cls,
        where: str,
        content: Mapping[str, Any],
        texts: Sequence[str] = (),
        *,
        aspect: float = 1.0,
        **asked: Any,
    ) -> Self:
        """Return the question about the numbers that texts KEY[,KEY...][=LOW:HIGH] stand for; `asked` are the
        other arguments. Sections have width and thickness where one of these is to be found.

        Of a pivot its length, inclination, crossing ratio, thickness and width are to be found as well,
        within bounds as far as a designer may leave it, with strips no stubbier than its own, below which
        shear counts, and no wider than `aspect` times their length, above which a strip is a plate.

        Raises:
            BadInput: a text that stands for no number of the case, or for one without gradients.
        """
        document, pivot = copy.deepcopy(dict(content)), not is_mechanism(content)
        if pivot or any(side.name in text for text in texts for side in SIDES):
            shared = document.get("strip" if pivot else "section", {})
            for table in (shared, *document.get("strips", ())):
                varied.to_sides(table)
        start = design_of(where, document)
        refuse_tapers(where, start.strips, "sizing")
        found = _usual(document) if pivot else {}
        for text in texts:
            variable = _variable(where, document, text, found)
            found[variable.name] = variable
        ratios = _ratios(list(found), found, aspect) if pivot else ()
        variables = tuple(found.values())
        return cls(where=where, content=document, start=start, variables=variables, ratios=ratios, **asked)

    @property
    def objectives(self) -> tuple[str, ...]:
        """What may be made least: the shift of a crossing that there is, the variation of a driven stiffness,
        and stress."""
        shift = (evaluate.CENTRE_SHIFT,) if self.start.crossing_point is not None else ()
        return (*shift, *(() if self.start.rotation is None else (evaluate.VARIATION,)), evaluate.STRESS)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the variables (N,)."""
        return tuple(variable.name for variable in self.variables)

    @property
    def held(self) -> str:
        """The quantity that is wanted: where the bodies follow the loads, how far the body goes."""
        return evaluate.TRAVEL if self.start.rotation is None else evaluate.STIFFNESS

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that are told of a design."""
        return (*self.objectives, self.held)

    @property
    def own(self) -> Array:
        """Variables of the start (N,) in the file's units."""
        return np.array([variable.own for variable in self.variables])

    @property
    def low(self) -> Array:
        """Lowest values of the variables (N,) in the file's units."""
        return np.array([variable.low for variable in self.variables])

    @property
    def span(self) -> Array:
        """Widths of the bounds (N,) in the file's units, 0 of a variable that is held."""
        return np.array([variable.span for variable in self.variables])

    def values(self, y: Array) -> Array:
        """Return the variables (N,) in the file's units, of y in [0, 1]^N, or (N + 1,)."""
        return self.low + self.span * y[: len(self.span)]

    def scaled(self, values: Array) -> Array:
        """Return y in [0, 1]^N of variables (N,), clipped to the bounds."""
        return np.clip((values - self.low) / np.where(self.span == 0.0, 1.0, self.span), 0.0, 1.0)

    def starts(self, count: int, seed: int = 8) -> Array:
        """Return starts (count, N) in [0, 1]^N: the design to compare with, and Sobol's points."""
        spread = qmc.Sobol(len(self.span), seed=seed).random_base2(math.ceil(math.log2(max(count - 1, 1))))
        return np.vstack((self.scaled(self.own), spread[: count - 1]))

    def document(self, values: Array) -> dict[str, Any]:
        """Return the case with these variables (N,) in the file's units."""
        document = copy.deepcopy(dict(self.content))
        for name, value in zip(self.names, values, strict=True):
            varied.put(document, dict.fromkeys(name.split(","), float(value)))
        return document

    def design(self, values: Array) -> Design:
        """Return the design with these variables (N,) in the file's units."""
        return design_of(self.where, self.document(values))

    def answers(self, values: Array | None = None, control_points: int | None = None) -> Answers:
        """Return the answers of the design with these variables (N,) in the file's units, or of the start.

        They are with the question's control points unless some are given; errors as of `evaluate.answers`.
        """
        design = self.start if values is None else self.design(values)
        names, chain = self._parameters(self.own if values is None else values)
        return evaluate.answers(design, control_points or self.control_points, names, chain)

    def accurate(self, values: Array | None = None) -> Answers:
        """Return the answers of a design with their errors, and as many control points as `DEFAULT` takes.

        The errors are estimated by `MORE` control points. values: variables (N,) in the file's units; None:
        those of the start.

        Raises:
            evaluate.PathEnds: the fewest control points do not reach the end of the range.
        """
        solved, least = cache(lambda points: self.answers(values, points)), math.inf
        found = replace(solved(evaluate.CONTROL_POINTS), errors=dict.fromkeys(self.quantities, math.nan))
        for points in range(evaluate.CONTROL_POINTS, MOST + 1, FURTHER):
            if least <= DEFAULT:
                break
            with suppress(evaluate.PathEnds):
                mine, fine = solved(points), solved(points + MORE)
                errors = {name: mine.apart(fine, name) for name in self.quantities}
                if max(errors.values()) < least:
                    least, found = max(errors.values()), replace(mine, errors=errors)
        return found

    def _parameters(self, values: Array) -> tuple[list[str], Array]:
        """Return names (R,) of the sensitivities, and derivatives (R, N) by the variables, in SI units per
        unit of the file."""
        columns = [self._changes(place, values) for place in range(len(values))]
        names = list(dict.fromkeys(name for column in columns for name in column if column[name] != 0.0))
        return names, np.array([[column.get(name, 0.0) for column in columns] for name in names])

    def _changes(self, place: int, values: Array) -> dict[str, float]:
        """Return the derivatives of the sensitivities' parameters by one variable."""
        variable, one = self.variables[place], np.eye(len(values))[place]
        if variable.name in OF_PIVOTS:
            return {OF_PIVOTS[variable.name]: math.radians(1.0) if variable.name == INCLINATION else 1.0}
        size, rows = STEP * (abs(values[place]) if variable.low > 0.0 else variable.span), []
        for step in (size, 0.5 * size):
            up, down = (_numbers(self.design(values + side * step * one)) for side in (1, -1))
            rows.append({name: (up[name] - down[name]) / (2.0 * step) for name in up})
        return {name: (4.0 * rows[1][name] - rows[0][name]) / 3.0 for name in rows[0]}

    def require_gradients(self) -> None:
        """Raise BadInput unless every variable is one that gradients are known by."""
        for number in self.variables:
            alone, ends = replace(self, variables=(number,)), []
            for value in (number.low, number.high):
                try:
                    ends.append(alone.design(np.array([value])))
                except BadInput as error:
                    raise BadInput(f"--free: {number.name} at its bound of {value:g}: {error}") from None
            expected = ""
            if any(_rest(end) != _rest(self.start) for end in ends):
                expected = "a number of sections, moduli, ends of straight strips or centres"
            elif number.span and _numbers(ends[0]) == _numbers(ends[1]):
                expected = "one that the design depends on: all strips have their own"
            if expected:
                raise BadInput(f"--free: got {number.name}, expected {expected}")


def _usual(document: Mapping[str, Any]) -> dict[str, _Variable]:
    """Return the numbers of a pivot that are found unless it is said otherwise, with their bounds."""
    own = {key: float(varied.value_at(document, key)) for key in OF_PIVOTS}
    length, thickness, width = own[LENGTH], own[THICKNESS], own[WIDTH]
    bounds = {
        LENGTH: (0.5 * length, length),
        INCLINATION: (20.0, 70.0),
        CROSSING: (0.1, 0.9),
        THICKNESS: (0.1 * thickness, 1.6 * thickness),
        WIDTH: (0.2 * width, length),
    }
    return {key: _Variable(key, own[key], *ends) for key, ends in bounds.items()}


def _ratios(names: list[str], found: Mapping[str, _Variable], aspect: float) -> tuple[_Ratio, ...]:
    """Return the limits of a pivot's form: the least slenderness, that of the case, and the largest width."""
    length, thickness, width = map(names.index, (LENGTH, THICKNESS, WIDTH))
    own = found[LENGTH].own / found[THICKNESS].own
    return (
        _Ratio("slenderness", length, thickness, own, 1),
        _Ratio("aspect", width, length, aspect, -1),
    )


def _variable(
    where: str, document: Mapping[str, Any], text: str, usual: Mapping[str, _Variable]
) -> _Variable:
    """Return the number that a text stands for, of `usual` ones with their bounds; errors as of
    `Question.of`."""
    names, _, bounds = text.partition("=")
    given = tuple(name.strip() for name in names.split(","))
    known = varied.known(where, document, "spline")
    for name in given:
        if name not in known:
            alike = [key for key in known if key.rpartition(".")[2] == name.rpartition(".")[2]]
            such = ", ".join(alike[:6]) or nearest(name, known)
            raise BadInput(f"--free: got {name}, expected a number of {where}, such as {such}")
    own = _value(document, given[0])
    if own is None:
        raise BadInput(f"--free: got {given[0]}, expected a number that stands in {where}")
    if not bounds and text in usual:
        return usual[text]
    if not bounds and (own <= 0.0 or given[0].split(".")[-1] in varied.PARTS):
        raise BadInput(f"--free: got {text} without bounds, expected {text}=LOW:HIGH, in the file's unit")
    try:
        ends = list(map(float, bounds.split(":"))) if bounds else [own * room for room in ROOM]
    except ValueError:
        ends = []
    if not 1 <= len(ends) <= 2 or not -math.inf < ends[0] <= ends[-1] < math.inf:
        raise BadInput(f"--free: got {text}, expected KEY=LOW:HIGH with LOW < HIGH, in the file's unit")
    return _Variable(",".join(given), own, ends[0], ends[-1])


def _value(document: Mapping[str, Any], key: str) -> float | None:
    """Return the number at a key, of a strip the one of all where it has none; None where there is none."""
    shared = (
        varied.value_at(document, f"{table}.{key.rpartition('.')[2]}") for table in ("section", "material")
    )
    for found in (varied.value_at(document, key), *shared):
        if found is not None:
            return float(found) if isinstance(found, int | float) else None
    return None


def _numbers(design: Design) -> dict[str, float]:
    """Return all numbers that gradients are known by, by the names of the sensitivities."""
    found: dict[str, float] = {}
    for strip in design.strips:
        places = zip(POINTS, (*strip.start, *strip.end), strict=True)
        found |= {f"{strip.name}.{name}": getattr(strip, name) for name in MATERIAL}
        found |= {f"{strip.name}.{name}": value for name, value in places}
    for body in design.bodies:
        found |= {f"{body.name}.{n}": value for n, value in zip(CENTRES, body.centre, strict=True)}
    return found


def _rest(design: Design) -> tuple[Any, ...]:
    """Return what of a design gradients are not known by, to compare with another."""
    none: dict[str, Any] = dict.fromkeys((*MATERIAL, "width", "thickness"), 1.0)
    straight: dict[str, Any] = {"start": (0.0, 0.0), "end": (1.0, 0.0)}
    strips = [replace(each, **none, **({} if each.rise else straight)) for each in design.strips]
    bodies = [replace(each, centre=(0.0, 0.0)) for each in design.bodies]
    return strips, bodies, design.effects, design.rotation, design.increments, design.order, design.points
