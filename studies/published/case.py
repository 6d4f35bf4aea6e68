"""Read a published problem: its design and its published values, each with source and uncertainty.

A case file has [problem], [[values]] and a design as any case file has one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from studies.cases import document
from studies.cases.design import Design, design_of
from studies.cases.document import CaseError
from studies.cases.mechanism import Mechanism

FOLDER = Path(__file__).parent / "cases"

DISPLACEMENT_X, DISPLACEMENT_Y, ROTATION = "displacement_x", "displacement_y", "rotation"
LIMIT_LOAD, LIMIT_POINTS, LOAD_AT_ROTATION = "limit_load", "limit_points", "load_at_rotation"
CENTRE_SHIFT = "centre_shift"
#: Asked of the end of a path, x, y and turn of a body; the others of a path with its critical points, or of a
#: pivot.
PLACES = (DISPLACEMENT_X, DISPLACEMENT_Y, ROTATION)
QUANTITIES = (*PLACES, LIMIT_LOAD, LIMIT_POINTS, LOAD_AT_ROTATION, CENTRE_SHIFT)
EQUAL, AT_MOST = "equal", "at most"
MODELS = ("spline", "fe", "fe-shear")
#: Kinds of answer: the plain beam, and beams with the effects that are named.
BEAM, CLAMPED_WIDTH, SHEAR, SHEARED = "beam", "clamped_width", "shear", "clamped_width, shear"
#: Keys of a case file whose values are names -> the names that are known.
KNOWN = {
    "quantity": QUANTITIES,
    "bound": (EQUAL, AT_MOST),
    "models": MODELS,
    "limit": (BEAM, CLAMPED_WIDTH, SHEAR, SHEARED),
}
#: What grows with the load beside loads.
WEIGHT = {"gravity": ("acceleration",)}
#: Part of a force that acts across a frame to lead elements onto a branch: the angle of a column moves by
#: less than 1 %, and with a tenth of it the steps of their path jump the bend.
SIDE = 1e-4


@dataclass(frozen=True, kw_only=True)
class Value:
    """A published value: a table [[values]] of a case file.

    Attributes:
        quantity: of `QUANTITIES`. at: which of the limit points, 1 the first; of a load or a pivot at which
            rotation [deg].
        load: times the load of the design that acts, or up to which critical points are looked for [1].
        models: those of the problem's that are asked for it.
        published, uncertainty: in `unit`; that of the print or its reading, or of the source's own method.
        unit_SI: what the unit is in that of the answer. bound: whether equal, or at most that.
        limit: largest relative difference beside the uncertainty, by kind of answer [1].
    """

    quantity: str
    at: float = 1.0
    load: float = 1.0
    models: Sequence[str] = MODELS
    published: float
    unit: str
    unit_SI: float
    uncertainty: float
    bound: str = EQUAL
    limit: Mapping[str, float]

    def met(self, found: float, limit: float) -> bool:
        """Return whether a number meets the value: within its uncertainty and the limit."""
        slack = self.uncertainty + limit * abs(self.published)
        over = found - self.published
        return bool((abs(over) if self.bound == EQUAL else over) <= slack * (1.0 + 1e-12))


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
        models: who is asked. body: whose place is reported.
    """

    name: str
    title: str
    source: str
    values: tuple[Value, ...]
    models: Sequence[str]
    design: Design
    body: str = ""

    @property
    def answers(self) -> list[str]:
        """Kinds of answer that are asked for: those with a limit."""
        return [*self.values[0].limit]

    def frame(self, load: float | None = None, answer: str = BEAM) -> Frame:
        """Return the design under so many times its loads, of None those of its first value, as a beam or
        with the effects that the answer names."""
        load = self.values[0].load if load is None else load
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
    where, content = str(path), dict(document.parsed(path))
    about, given = content.pop("problem", {}), content.pop("values", [])
    parts = {"problem": about} | {f"values number {i}": each for i, each in enumerate(given, start=1)}
    for label, part in parts.items():
        for key in part.keys() & KNOWN.keys():
            names = [part[key]] if isinstance(part[key], str) else part[key]
            if unknown := set(names) - set(KNOWN[key]):
                expected = ", ".join(KNOWN[key])
                raise CaseError(f"{where}: {label}.{key}: got {', '.join(unknown)}, expected {expected}")
    try:
        values = tuple(Value(**each) for each in given)
        problem = _Published(name=path.stem, values=values, design=design_of(where, content), **about)
    except TypeError as error:
        raise CaseError(f"{where}: [problem] or [[values]]: {error}") from None
    if len({tuple(value.limit) for value in values}) != 1:
        raise CaseError(f"{where}: values: got limits of different answers or no values, expected the same")
    if problem.design.crossing_point is None:
        known = [each.name for each in problem.design.bodies]
        if problem.body not in known:
            expected = document.nearest(problem.body, known)
            raise CaseError(f"{where}: problem.body: got {problem.body!r}, expected {expected}")
    return problem
