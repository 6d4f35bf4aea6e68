"""The tolerance of every quantity of the goldens, and the comparison of an answer with the stored one."""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from fnmatch import fnmatchcase
from itertools import zip_longest
from typing import Any, NamedTuple


class Tolerance(NamedTuple):
    """How far a number may be from the stored one.

    Attributes:
        of: pattern of "command:key.key"; of several that fit the first holds.
        relative: to the number, or to the largest of the list that it stands in [1].
        floor: below which a number is round-off, in EI/L, E or L of the case by the unit of its key [1].
        why: this much.
    """

    of: str
    relative: float
    floor: float
    why: str


#: Measured by asking everything again with inputs moved by 6e-16 of their value, as another processor might.
TOLERANCES = (
    Tolerance("*counters.*", 0.5, 5.0, "counts: round-off at the end of an iteration costs or saves a step"),
    Tolerance("*iterations", 0.5, 5.0, "counts, as above"),
    Tolerance("*paths_solved", 0.5, 5.0, "counts, as above"),
    Tolerance("critical-load:*rotation_error_rad", 2.0, 5e-5, "at a bifurcation, as the rotation below"),
    Tolerance(
        "*rotation_error_rad", 2.0, 1e-8, "difference of two motions whose fast modes are not resolved"
    ),
    Tolerance("*displacement_error_m", 2.0, 1e-8, "as above"),
    Tolerance("*relative_error", 2e-2, 1e-8, "difference of two answers, or their extrapolation"),
    Tolerance("*estimate.*", 2e-2, 1e-8, "difference of two answers"),
    Tolerance("*differences.*", 2e-2, 1e-8, "difference of two answers"),
    Tolerance("converge:*error_*", 1e-3, 1e-8, "difference of two answers"),
    Tolerance(
        "size:*", 1e-2, 1e-4, "the optimiser stops at 1e-6 of the objective, which is flat at its least"
    ),
    Tolerance(
        "audit:*highest_frequency_Hz", 1e-5, 1e-8, "of the stiffest mode, whose matrix is ill-conditioned"
    ),
    Tolerance("audit:*", 1e-4, 1e-6, "difference of two scenes, rounded"),
    Tolerance("*slide_frequency_Hz", 1e-4, 1e-8, "of modes that are almost without stiffness"),
    Tolerance(
        "critical-load:*rotation_rad",
        1e-7,
        5e-5,
        "at a bifurcation it grows with the root of the force's round-off; its own error there is 2e-5",
    ),
    Tolerance("modes:answer.body_shapes", 1e-5, 1e-6, "vectors lose what divides neighbouring frequencies"),
    Tolerance("release:*", 1e-6, 1e-7, "round-off grows over the steps of a motion"),
    Tolerance("*body_stiffness_*", 1e-7, 1e-6, "the axial stiffness, far above EI/L^3, cancels in it"),
    Tolerance("*", 1e-7, 1e-8, "converged to round-off; times ten for another processor's path there"),
)
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
#: Of numbers within the lines of the error stream.
TOLD = 2e-2
#: Names that are of how a long list is stored, no part of the name of a quantity.
STORED = ("count", "norm", "samples")
#: Quantities whose sign is a choice.
SIGNLESS = ("modes:answer.body_shapes",)


class Leaf(NamedTuple):
    """A value of an answer: its quantity, the value, and the largest number of the list that it stands in."""

    quantity: str
    value: Any
    beside: float

    def limit(self, scales: Mapping[str, float]) -> tuple[float, float]:
        """Return the tolerance and the floor of a number, in its unit."""
        found = next(each for each in TOLERANCES if fnmatchcase(self.quantity, each.of))
        scale = next((value for unit, value in scales.items() if self.quantity.endswith(unit)), 1.0)
        floor = found.floor * scale
        return found.relative * max(abs(self.value), self.beside) + floor, floor


class Difference(NamedTuple):
    """Where an answer differs from the stored one; the change is relative to the stored number."""

    where: str
    old: Any
    new: Any
    change: float

    def __str__(self) -> str:
        """Return the difference in a line."""
        return f"{self.where}: {self.old} -> {self.new}" + (f" ({self.change:.2g})" if self.change else "")


def walk(value: Any, leaf: Leaf, visit: Callable[[str, Leaf], Any], place: str = "") -> Any:
    """Return an answer with every value as `visit` makes it of its place and its leaf."""
    quantity, beside = leaf.quantity, leaf.beside
    if isinstance(value, Mapping):
        if set(value) == set(STORED):
            beside = value["norm"] / math.sqrt(value["count"])
        made = {}
        for name, each in value.items():
            inner = quantity if name in STORED else f"{quantity}{'' if quantity.endswith(':') else '.'}{name}"
            made[name] = walk(each, Leaf(inner, None, beside), visit, f"{place}.{name}".lstrip("."))
        return made
    if isinstance(value, list) and value:
        inner = Leaf(quantity, None, max(beside, _largest(value)))
        return [walk(each, inner, visit, f"{place}[{i}]") for i, each in enumerate(value)]
    return visit(place, leaf._replace(value=value))


def _largest(value: Any) -> float:
    """Return the largest number of a list, of lists in it too."""
    if isinstance(value, list):
        return max(map(_largest, value), default=0.0)
    return abs(value) if is_number(value) else 0.0


def is_number(value: Any) -> bool:
    """Return whether a value is a number, no truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _leaves(answer: Any, command: str) -> dict[str, Leaf]:
    """Return every value of an answer by its place."""
    found: dict[str, Leaf] = {}
    walk(answer, Leaf(f"{command}:", None, 0.0), found.__setitem__)
    return found


def differences(old: Any, new: Any, command: str, scales: Mapping[str, float]) -> Iterator[Difference]:
    """Yield where an answer of a command differs from the stored one by more than the tolerances."""
    before, after = _leaves(old, command), _leaves(new, command)
    for place in {**before, **after}:
        was, now = before.get(place), after.get(place)
        if was is None or now is None:
            yield Difference(place, *("nothing" if each is None else each.value for each in (was, now)), 0.0)
        elif is_number(was.value) and is_number(now.value):
            signed = was.quantity not in SIGNLESS
            apart = abs(was.value - now.value) if signed else abs(abs(was.value) - abs(now.value))
            if not apart <= was.limit(scales)[0]:
                yield Difference(place, was.value, now.value, apart / (abs(was.value) or math.inf))
        elif was.value != now.value and not _same_text(place, was.value, now.value):
            yield Difference(place, was.value, now.value, 0.0)


def _same_text(place: str, old: Any, new: Any) -> bool:
    """Return whether two texts have the same words, and error lines nearly the same numbers."""
    if not (isinstance(old, str) and isinstance(new, str)) or NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return False
    pairs = zip_longest(NUMBER.findall(old), NUMBER.findall(new), fillvalue="nan")
    return "says" not in place or all(math.isclose(float(a), float(b), rel_tol=TOLD) for a, b in pairs)


def rounded(answer: Any, command: str, scales: Mapping[str, float]) -> Any:
    """Return an answer as it is stored: digits as the tolerance has them, and zero where round-off is."""

    def kept(place: str, leaf: Leaf) -> Any:
        if not isinstance(leaf.value, float):
            return leaf.value
        apart, floor = leaf.limit(scales)
        if abs(leaf.value) < floor:
            return 0.0
        return float(f"{leaf.value:.{max(2, 2 - math.floor(math.log10(apart / abs(leaf.value))))}g}")

    return walk(answer, Leaf(f"{command}:", None, 0.0), kept)
