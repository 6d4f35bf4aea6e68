"""What a sweep is, once DESIGNS.toml has been read: frozen values that go to workers as they are."""

from dataclasses import dataclass, field
from typing import Any

from studies.cases.rules import Rule
from studies.sweep.keys import Names

METHODS = ("grid", "list", "latin-hypercube", "sobol")
KINDS = ("static", "modes", "release")


@dataclass(frozen=True, kw_only=True)
class Axis:
    """One key that is varied: over listed values, or from `low` to `high` in the file's unit.

    Attributes:
        key: as in DESIGNS.toml. rule: for its values.
        values: listed; None for a range.
        points: of a range in a grid [1]. log: even steps of the logarithm.
    """

    key: str
    rule: Rule | Names
    values: tuple[Any, ...] | None = None
    low: float = 0.0
    high: float = 0.0
    points: int = 0
    log: bool = False

    @property
    def count(self) -> int:
        """Values of the axis in a grid or list."""
        return self.points if self.values is None else len(self.values)


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Which designs: a method over axes; `points` in all, `seed` of the random methods."""

    method: str
    axes: tuple[Axis, ...]
    points: int
    seed: int


@dataclass(frozen=True, kw_only=True)
class Analysis:
    """What is asked of each design.

    Attributes:
        kind: "static", "modes" or "release".
        both_sides: a static path to the rotation and one to its opposite.
        options: of modes (`rotation` [rad], `held`, `count`) or of a release (`duration` [s], ...).
    """

    kind: str
    both_sides: bool = False
    options: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Task:
    """What every chunk of a sweep needs to know.

    Attributes:
        where: file that refusals name. case: document of the case with what is fixed by the sweep.
        model: as on the command line. settings: keywords of its settings.
        keys: that are varied. quantities: names of what is stored.
        batch: whether the compiled paths of many pivots at once take the designs.
    """

    where: str
    case: dict[str, Any]
    model: str
    settings: dict[str, Any]
    analysis: Analysis
    keys: tuple[str, ...]
    quantities: tuple[str, ...]
    batch: bool


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A sweep: the task, the sample, designs a chunk, and all that it was made from, to be kept beside it."""

    task: Task
    sample: Sample
    chunk: int
    content: dict[str, Any]

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.sample.points // self.chunk)

    def span(self, number: int) -> tuple[int, int]:
        """Return the first point of a chunk and the one behind its last."""
        return number * self.chunk, min((number + 1) * self.chunk, self.sample.points)
