"""Sizing a mechanism by named numbers of its case file, with exact gradients by any of them."""

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from spline_model.parameters import CENTRES, MATERIAL, POINTS
from studies.answers.reference import reference
from studies.cases.keys import SIDES
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.design.evaluate import CONTROL_POINTS, STRESS, VARIATION, Answers, answers
from studies.design.task import Sizing
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep import plan

#: Bounds of a number of a section or material where none are given, over its own.
ROOM = (0.5, 2.0)
#: Step of the differences by which a case's numbers are followed to those of its strips, polynomials of the
#: fourth degree at most, of which extrapolated differences are exact.
STEP = 0.05


@dataclass(frozen=True, kw_only=True)
class _Number:
    """Keys of a case file that hold one value, in the file's unit, and its bounds."""

    keys: tuple[str, ...]
    own: float
    low: float
    high: float

    @property
    def name(self) -> str:
        """The keys with commas."""
        return ",".join(self.keys)


def number_of(where: str, document: Mapping[str, Any], text: str) -> _Number:
    """Return the number that `KEY[,KEY...][=LOW:HIGH]` stands for; BadInput where it is none of the case."""
    names, _, bounds = text.partition("=")
    given = tuple(name.strip() for name in names.split(","))
    known = plan.known(document, "spline")
    for name in given:
        if name not in known:
            near = [key for key in known if key.rpartition(".")[2] == name.rpartition(".")[2]] or list(known)
            raise BadInput(f"--free: got {name}, expected a number of {where}, such as {', '.join(near[:6])}")
    own = _value(document, given[0])
    if own is None:
        raise BadInput(f"--free: got {given[0]}, expected a number that stands in {where}")
    if not bounds and (own <= 0.0 or given[0].split(".")[-1] in plan.PARTS):
        raise BadInput(f"--free: got {text} without bounds, expected {text}=LOW:HIGH, in the file's unit")
    try:
        low, high = map(float, bounds.split(":")) if bounds else (own * ROOM[0], own * ROOM[1])
    except ValueError:
        low = high = math.nan
    if not -math.inf < low < high < math.inf:
        raise BadInput(f"--free: got {text}, expected KEY=LOW:HIGH with LOW < HIGH, in the file's unit")
    return _Number(keys=given, own=own, low=low, high=high)


def by_sides(document: Mapping[str, Any], texts: Sequence[str]) -> dict[str, Any]:
    """Return the document with its sections by width and thickness, where one of these is to be found."""
    found = copy.deepcopy(dict(document))
    if not any(side.name in text for text in texts for side in SIDES):
        return found
    for table in (found.get("section", {}), *found["strips"]):
        plan.to_sides(table)
    return found


def _value(document: Mapping[str, Any], key: str) -> float | None:
    """Return the number at a key, of a strip the one of all where it has none; None where there is none."""
    found, name = plan.value_at(document, key), key.rpartition(".")[2]
    for shared in ("section", "material"):
        if found is None:
            found = document.get(shared, {}).get(name)
    return float(found) if isinstance(found, int | float) else None


@dataclass(frozen=True, kw_only=True)
class NumbersTask(Sizing):
    """A question about a mechanism, over numbers of its case.

    Attributes:
        where, document: the case file and what stands in it. numbers: to be found.
    """

    where: str
    document: Mapping[str, Any]
    numbers: tuple[_Number, ...]
    objective: str = STRESS
    stiffness: float = math.nan
    allowable_stress: float = math.inf
    control_points: int = CONTROL_POINTS

    @cached_property
    def start(self) -> Mechanism:
        """The case as it is."""
        return read_mechanism(self.where, self.document)

    @property
    def objectives(self) -> tuple[str, ...]:
        """What may be made least of this mechanism."""
        return (STRESS,) if self.start.rotation is None else (STRESS, VARIATION)

    @cached_property
    def bounds(self) -> Mapping[str, tuple[float, float]]:  # type: ignore[override]
        """Lowest and highest value of every number, in the file's unit."""
        return {number.name: (number.low, number.high) for number in self.numbers}

    @property
    def columns(self) -> Sequence[tuple[str, float, str]]:
        """The numbers in a table, by their places."""
        return [(str(place), 1.0, "12.6g") for place in range(1, len(self.numbers) + 1)]

    @property
    def own(self) -> Array:
        """Values of the case (N,)."""
        return np.array([number.own for number in self.numbers])

    def content(self, values: Array) -> dict[str, Any]:
        """Return the case with these values (N,)."""
        document = copy.deepcopy(dict(self.document))
        for number, value in zip(self.numbers, values, strict=True):
            plan.put(document, dict.fromkeys(number.keys, float(value)))
        return document

    def problem(self, values: Array) -> Mechanism:
        """Return the mechanism with these values (N,)."""
        return read_mechanism(self.where, self.content(values))

    def answers(self, values: Array, control_points: int | None = None) -> Answers:
        """Solve the mechanism with these values, with exact gradients by its numbers; as of `Sizing`."""
        names, chain = self._chain(values)
        points = control_points or self.control_points
        return answers(self.problem(values), points, parameters=names, chain=chain)

    def quantities(self, found: Answers) -> dict[str, float]:
        """Return what the splines say of a design, by name: what is held, and the objectives."""
        return {self.held: found.stiffness, **{name: found.largest(name) for name in self.objectives}}

    def by_elements(self, design: Mechanism) -> dict[str, float]:
        """Return what the finite elements say in the limit of refinement, stress on the finest mesh.

        Raises:
            NoReference: they do not reach the end of the path.
        """
        limit = reference(design)
        begin = len(limit.rotation) - 1 - design.increments
        stress = {STRESS: float(limit.finest.max_stress[[begin, -1]].max())}
        if design.rotation is None:
            return {self.held: float(np.linalg.norm(limit.centre[-1] - limit.finest.centre[0])), **stress}
        stiffness = limit.stiffness[begin:]
        variation = float(np.abs(stiffness / stiffness[0] - 1.0).max())
        return {self.held: float(stiffness[0]), **stress, VARIATION: variation}

    def _chain(self, values: Array) -> tuple[list[str], Array]:
        """Return names of the strips' and bodies' numbers that change, and derivatives (R, N) of these by the
        case's."""
        columns = []
        for i, number in enumerate(self.numbers):
            size = STEP * (abs(values[i]) if number.low > 0.0 else number.high - number.low)
            one, rows = np.eye(len(values))[i], []
            for step in (size, 0.5 * size):
                up, down = (_raw(self.problem(values + side * step * one)) for side in (1, -1))
                rows.append({name: (up[name] - down[name]) / (2.0 * step) for name in up})
            columns.append({name: (4.0 * rows[1][name] - rows[0][name]) / 3.0 for name in rows[0]})
        names = [name for name in columns[0] if any(abs(column[name]) > 0.0 for column in columns)]
        return names, np.array([[column[name] for column in columns] for name in names])

    def require_numbers(self) -> None:
        """Raise BadInput unless every number is one that gradients are known by."""
        given = _rest(self.start)
        for number in self.numbers:
            alone = replace(self, numbers=(number,))
            for value in (number.low, number.high):
                try:
                    other = alone.problem(np.array([value]))
                except BadInput as error:
                    raise BadInput(f"--free: {number.name} at its bound of {value:g}: {error}") from None
                if _rest(other) != given:
                    expected = "a number of sections, moduli, ends of straight strips or centres"
                    raise BadInput(f"--free: got {number.name}, expected {expected}")
            if _raw(alone.problem(np.array([number.low]))) == _raw(other):
                expected = "one that the design depends on: all strips have their own"
                raise BadInput(f"--free: got {number.name}, expected {expected}")


def _raw(design: Mechanism) -> dict[str, float]:
    """Return all numbers that gradients are known by, by the names of the sensitivities."""
    found: dict[str, float] = {}
    for strip in design.strips:
        found |= {f"{strip.name}.{name}": getattr(strip, name) for name in MATERIAL}
        places = zip(POINTS, (*strip.start, *strip.end), strict=True)
        found |= {f"{strip.name}.{name}": value for name, value in places}
    for body in design.bodies:
        found |= {f"{body.name}.{n}": value for n, value in zip(CENTRES, body.centre, strict=True)}
    return found


def _rest(design: Mechanism) -> Mechanism:
    """Return a design without what gradients are known by, to compare with another."""
    none: dict[str, Any] = dict.fromkeys((*MATERIAL, "width", "thickness"), 1.0)
    straight: dict[str, Any] = {"start": (0.0, 0.0), "end": (1.0, 0.0)}
    strips = (replace(each, **none, **({} if each.rise else straight)) for each in design.strips)
    bodies = (replace(each, centre=(0.0, 0.0)) for each in design.bodies)
    return replace(design, strips=tuple(strips), bodies=tuple(bodies))
