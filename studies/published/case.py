"""Read a published problem: its design and its published values, each with source and uncertainty.

A case file has [problem], [[values]] and a design as any case file has one.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from studies.cases import document
from studies.cases.design import Design, design_of
from studies.cases.document import CaseError
from studies.cases.mechanism import Mechanism
from studies.cases.rules import Key, Rule, choice, finite, not_negative, positive, shown, text

FOLDER = Path(__file__).parent / "cases"

DISPLACEMENT_X, DISPLACEMENT_Y, ROTATION = "displacement_x", "displacement_y", "rotation"
LIMIT_LOAD, LIMIT_POINTS, LOAD_AT_ROTATION = "limit_load", "limit_points", "load_at_rotation"
CENTRE_SHIFT = "centre_shift"
#: Asked of a path; the others of a path with its critical points, or of a pivot.
PLACES = (DISPLACEMENT_X, DISPLACEMENT_Y, ROTATION)
QUANTITIES = (*PLACES, LIMIT_LOAD, LIMIT_POINTS, LOAD_AT_ROTATION, CENTRE_SHIFT)
EQUAL, AT_MOST, AT_LEAST = "equal", "at most", "at least"
MODELS = ("spline", "fe", "fe-shear")
#: Kinds of answer: the plain beam, and beams with the effects that are named.
BEAM, CLAMPED_WIDTH, SHEAR, SHEARED = "beam", "clamped_width", "shear", "clamped_width, shear"
ANSWERS = (BEAM, CLAMPED_WIDTH, SHEAR, SHEARED)


def _key(section: str, name: str, rule: Any, *, attribute: str = "", optional: bool = False) -> Key:
    return Key(
        section=section, name=name, attribute=attribute or name, rule=rule, optional=optional,
        meaning=rule.expected, example="",
    )  # fmt: skip


def _names(*known: str) -> Rule:
    """Return the rule for a list of different names, out of those that are known if there are such."""
    expected = f"a list of {', '.join(known) or 'names'}"

    def read(value: Any) -> tuple[str, ...]:
        good = isinstance(value, list) and all(isinstance(name, str) for name in value)
        if not good or len(set(value)) < len(value) or (known and set(value) - set(known)):
            raise ValueError(f"got {shown(value)}, expected {expected}")
        return tuple(value)

    return Rule(expected=expected, read=read)


LIMITS = f"a table of the largest relative difference by answer: {', '.join(ANSWERS)}"


def _limits(value: Any) -> dict[str, float]:
    """Return the largest relative difference of each kind of answer; ValueError says what was got."""
    if not isinstance(value, dict) or not value or set(value) - set(ANSWERS):
        raise ValueError(f"got {shown(value)}, expected {LIMITS}")
    return {name: not_negative("1").parse(limit) for name, limit in value.items()}


PROBLEM = (
    _key("problem", "title", text("a title")),
    _key("problem", "source", text("where the values are published")),
    _key("problem", "body", text("the name of the body whose place is asked"), optional=True),
    _key("problem", "models", _names(*MODELS)),
    _key("problem", "answers", _names(*ANSWERS)),
)
VALUE = (
    _key("values", "quantity", choice(*QUANTITIES)),
    _key("values", "at", finite("1 or deg"), optional=True),
    _key("values", "load", positive("load of the design"), optional=True),
    _key("values", "models", _names(*MODELS), optional=True),
    _key("values", "published", finite("unit")),
    _key("values", "unit", text("the printed unit")),
    _key("values", "unit_SI", positive("SI"), attribute="scale"),
    _key("values", "uncertainty", not_negative("unit")),
    _key("values", "bound", choice(EQUAL, AT_MOST, AT_LEAST), optional=True),
    _key("values", "limit", Rule(expected=LIMITS, read=_limits), attribute="limits"),
)
#: What grows with the load beside loads.
WEIGHT = {"gravity": ("acceleration",)}
#: Part of a force that acts across a frame to lead elements onto a branch: the angle of a column moves by
#: less than 1 %, and with a tenth of it the steps of their path jump the bend.
SIDE = 1e-4


@dataclass(frozen=True, kw_only=True)
class Value:
    """A published value.

    Attributes:
        quantity: of `QUANTITIES`. at: which of the limit points, 1 the first; of a load or a pivot at which
            rotation [deg].
        load: times the load of the design that acts, or up to which critical points are looked for [1].
        models: those of the problem's that are asked for it.
        published, uncertainty: in `unit`; that of the print or its reading, or of the source's own method.
        scale: what the unit is in that of the answer. bound: whether equal, or at most or least that.
        limits: largest relative difference beside the uncertainty, by kind of answer [1].
    """

    quantity: str
    at: float = 1.0
    load: float = 1.0
    models: tuple[str, ...] = MODELS
    published: float
    unit: str
    scale: float
    uncertainty: float
    bound: str = EQUAL
    limits: Mapping[str, float]

    def met(self, found: float, limit: float) -> bool:
        """Return whether a number meets the value: within its uncertainty and the limit."""
        slack = self.uncertainty + limit * abs(self.published)
        over = {EQUAL: abs(found - self.published), AT_MOST: found - self.published}
        over[AT_LEAST] = self.published - found
        return bool(over[self.bound] <= slack * (1.0 + 1e-12))


@dataclass(frozen=True, kw_only=True)
class Frame:
    """A design and how it is loaded.

    Attributes:
        load: force or displacement at load factor 1, in its units.
        body: whose place is reported.
        tilt: turn of that body from which elements, which have no way onto a branch, find it [rad]; without
            one they are loaded aside.
    """

    design: Mechanism
    load: float
    body: str
    tilt: float = 0.0

    @property
    def rest(self) -> tuple[float, float]:
        """Place (x, y) of the reported body at rest, in the length unit of the frame."""
        return next(body.centre for body in self.design.bodies if body.name == self.body)

    def aside(self) -> Mechanism:
        """Return the design with a part of its force across it, to the right of it."""
        effects = self.design.effects
        (force,) = effects.every("applied_force")
        x, y = force["force"]
        leant = {**force, "force": (x + SIDE * y, y - SIDE * x)}
        return replace(self.design, effects=effects.plus(applied_force=leant))


@dataclass(frozen=True, kw_only=True)
class _Published:
    """A published problem: what is asked, of whom, and of which design.

    Attributes:
        name: of its file. title, source: in words. values: as published.
        models, answers: who is asked, and for which kinds of answer.
        body: whose place is reported.
    """

    name: str
    title: str
    source: str
    values: tuple[Value, ...]
    models: tuple[str, ...]
    answers: tuple[str, ...]
    design: Design
    body: str = ""

    def frame(self, load: float | None = None, answer: str = BEAM) -> Frame:
        """Return the design under so many times its loads, of None those of its first value, as a beam or
        with the effects that the answer names."""
        load = self.values[0].load if load is None else load
        assert isinstance(self.design, Mechanism)
        acting = self.design.effects.grown(load, WEIGHT).plus(*(() if answer == BEAM else answer.split(", ")))
        return Frame(design=replace(self.design, effects=acting), load=load, body=self.body)


@cache
def published(name: str) -> _Published:
    """Return the published problem of that name."""
    return read_published(FOLDER / f"{name}.toml")


def read_published(path: Path) -> _Published:
    """Return the published problem of a case file.

    Raises:
        CaseError: one line: file, key, got, expected.
    """
    where, content = str(path), document.parsed(path)
    about = document.values(where, PROBLEM, document.table(where, content, "problem"), "problem")
    given = content.get("values", [])
    if not isinstance(given, list) or not given:
        raise CaseError(f"{where}: values: got {shown(given)}, expected tables [[values]]")
    values = tuple(
        Value(**document.values(where, VALUE, each, f"values number {i}"))
        for i, each in enumerate(given, start=1)
    )
    for i, value in enumerate(values, start=1):
        without = set(about["answers"]) - set(value.limits)
        if without:
            raise CaseError(
                f"{where}: values number {i}.limit: got none of {', '.join(without)}, expected one"
            )
    rest = {key: part for key, part in content.items() if key not in ("problem", "values")}
    design = design_of(where, rest)
    if isinstance(design, Mechanism):
        known = [each.name for each in design.bodies]
        if (body := about.get("body", "no such key")) not in known:
            raise CaseError(f"{where}: problem.body: got {body}, expected {document.nearest(body, known)}")
    return _Published(name=path.stem, values=values, design=design, **about)
