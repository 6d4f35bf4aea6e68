"""Sizing a mechanism by named numbers of its case file, with exact gradients by any of them."""

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from spline_model.parameters import CENTRES, MATERIAL, POINTS
from studies.cases.document import nearest
from studies.cases.keys import SIDES
from studies.cases.mechanism import Mechanism, read_mechanism
from studies.cases.section import refuse_tapers
from studies.design.evaluate import STRESS, VARIATION
from studies.design.question import Question, Variable
from studies.errors import BadInput
from studies.kinds import Array
from studies.sweep import plan

#: Objectives of a mechanism that is driven; of one that follows its loads the first alone.
OBJECTIVES = (STRESS, VARIATION)
#: Bounds of a number of a section or material where none are given, over its own.
ROOM = (0.5, 2.0)
#: Step of the differences by which a case's numbers are followed to those of its strips, polynomials of the
#: fourth degree at most, of which extrapolated differences are exact.
STEP = 0.05


@dataclass(frozen=True, kw_only=True)
class MechanismQuestion(Question):
    """A question about a mechanism, over numbers of its case, in the file's units.

    Attributes:
        where, content: the case file and what stands in it. The name of a variable is that of the keys that
            share its value, with commas.
    """

    where: str
    content: Mapping[str, Any]

    @classmethod
    def of(cls, where: str, content: Mapping[str, Any], texts: Sequence[str], **asked: Any) -> Self:
        """Return the question about the numbers that texts KEY[,KEY...][=LOW:HIGH] stand for; `asked` are the
        other arguments. Sections have width and thickness where one of these is to be found.

        Raises:
            BadInput: a text that stands for no number of the case, or for one without gradients.
        """
        document = copy.deepcopy(dict(content))
        if any(side.name in text for text in texts for side in SIDES):
            for table in (document.get("section", {}), *document["strips"]):
                plan.to_sides(table)
        numbers = enumerate(texts, start=1)
        variables = tuple(_variable(where, document, text, str(place)) for place, text in numbers)
        start = read_mechanism(where, document)
        refuse_tapers(where, start.strips, "sizing")
        objectives = OBJECTIVES[:1] if start.rotation is None else OBJECTIVES
        given = {"start": start, "variables": variables, "objectives": objectives, **asked}
        return cls(where=where, content=document, **given)

    def document(self, values: Array) -> dict[str, Any]:
        """Return the case with these values (N,) in SI units."""
        document = copy.deepcopy(dict(self.content))
        for name, value in zip(self.names, values, strict=True):
            plan.put(document, dict.fromkeys(name.split(","), float(value)))
        return document

    def design(self, values: Array) -> Mechanism:
        """Return the mechanism with these values (N,) in SI units."""
        return read_mechanism(self.where, self.document(values))

    def parameters(self, values: Array) -> tuple[list[str], Array]:
        """Return names of the strips' and bodies' numbers that change, and derivatives by the case's values.

        values: (N,) in SI units. The derivatives (R, N) are per SI unit.
        """
        columns = []
        for i, number in enumerate(self.variables):
            size = STEP * (abs(values[i]) if number.low > 0.0 else number.span)
            one, rows = np.eye(len(values))[i], []
            for step in (size, 0.5 * size):
                up, down = (_numbers(self.design(values + side * step * one)) for side in (1, -1))
                rows.append({name: (up[name] - down[name]) / (2.0 * step) for name in up})
            columns.append({name: (4.0 * rows[1][name] - rows[0][name]) / 3.0 for name in rows[0]})
        names = [name for name in columns[0] if any(abs(column[name]) > 0.0 for column in columns)]
        return names, np.array([[column[name] for column in columns] for name in names])

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
            elif _numbers(ends[0]) == _numbers(ends[1]):
                expected = "one that the design depends on: all strips have their own"
            if expected:
                raise BadInput(f"--free: got {number.name}, expected {expected}")


def _variable(where: str, document: Mapping[str, Any], text: str, heading: str) -> Variable:
    """Return the number that a text stands for; errors as of `MechanismQuestion.of`."""
    names, _, bounds = text.partition("=")
    given = tuple(name.strip() for name in names.split(","))
    known = plan.known(where, document, "spline")
    for name in given:
        if name not in known:
            alike = [key for key in known if key.rpartition(".")[2] == name.rpartition(".")[2]]
            such = ", ".join(alike[:6]) or nearest(name, known)
            raise BadInput(f"--free: got {name}, expected a number of {where}, such as {such}")
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
    return Variable(",".join(given), own, low, high, heading)


def _value(document: Mapping[str, Any], key: str) -> float | None:
    """Return the number at a key, of a strip the one of all where it has none; None where there is none."""
    shared = (
        plan.value_at(document, f"{table}.{key.rpartition('.')[2]}") for table in ("section", "material")
    )
    for found in (plan.value_at(document, key), *shared):
        if found is not None:
            return float(found) if isinstance(found, int | float) else None
    return None


def _numbers(design: Mechanism) -> dict[str, float]:
    """Return all numbers that gradients are known by, by the names of the sensitivities."""
    found: dict[str, float] = {}
    for strip in design.strips:
        places = zip(POINTS, (*strip.start, *strip.end), strict=True)
        found |= {f"{strip.name}.{name}": getattr(strip, name) for name in MATERIAL}
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
