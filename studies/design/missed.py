"""Which constraints of a sizing question a design misses, and by how much, in the words of design."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from studies.design.evaluate import STRESS, Answers
from studies.design.task import Sizing, Task
from studies.kinds import Array

#: Part of a limit below which it is met [1].
MET = 1e-6
#: From so many times a limit on it is told as times, not as percent above.
TIMES = 2.0
#: Part of a limit up to which it is told as times below, not as percent.
SMALL = 1e-3


class _Held(NamedTuple):
    """A quantity that is held against a limit: its name, value and unit, times `factor` in that unit; and
    what the limit is, which may be missed to the sides of these signs."""

    name: str
    got: float
    limit: float
    what: str
    sides: tuple[int, ...]
    unit: str = ""
    factor: float = 1.0

    @property
    def excess(self) -> float:
        """How far it is beyond the limit, of what is below it by its logarithm; 0 where it is met."""
        ratio = self.got / self.limit
        far = ratio - 1.0 if ratio >= 1.0 else -math.log(ratio) if ratio > 0.0 else math.inf
        side = 1 if ratio >= 1.0 else -1
        return far if side in self.sides and far > MET else 0.0

    @property
    def told(self) -> str:
        """What it is, and how far from its limit."""
        ratio = self.got / self.limit
        far = f"{100.0 * abs(ratio - 1.0):.3g} % {'above' if ratio > 1.0 else 'below'}"
        if ratio >= TIMES:
            far = f"{ratio:.3g} times"
        elif 0.0 < ratio <= SMALL:
            far = f"{1.0 / ratio:.3g} times below"
        elif ratio < 0.0:
            far = "of the other sign than"
        got, limit = (f"{self.factor * value:.4g}{self.unit}" for value in (self.got, self.limit))
        return f"{self.name} {got}, {far} {self.what} {limit}"


def missed(task: Sizing, values: Array, found: Answers) -> str:
    """Return a phrase for each constraint that a design with these variables (N,) misses, the worst first."""
    held = sorted(_held(task, values, found), key=lambda each: -each.excess)
    return "; ".join(each.told for each in held if each.excess)


def _held(task: Sizing, values: Array, found: Answers) -> Iterator[_Held]:
    unit, factor = (" mm", 1e3) if task.held == "travel" else (" N m/rad", 1.0)
    yield _Held(task.held, found.stiffness, task.stiffness, "the wanted", (-1, 1), unit, factor)
    largest = found.largest(STRESS)
    yield _Held("stress", largest, task.allowable_stress, "the allowable", (1,), " MPa", 1e-6)
    if isinstance(task, Task):
        length, _, _, thickness, width = values
        slender = task.least_slenderness
        yield _Held("length over thickness", length / thickness, slender, "the case's, the least,", (-1,))
        yield _Held("width over length", width / length, task.largest_aspect, "the --aspect of", (1,))
