"""What is compared: a model of the pivot, and one setting of it, which answers a case."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import count, product
from typing import Any

import numpy as np

from studies.baselines.answer import BaselineFailed, Followed, SolvedMotion, SolvedPath
from studies.errors import BadInput

#: Time that repeats of a solve may take together [s], and their largest number.
AFFORDED, REPEATS = 0.3, 7


def repeats_of(seconds: float) -> int:
    """Return how often what takes so long [s] is timed."""
    return int(min(REPEATS, max(1.0, AFFORDED / max(seconds, 1e-9))))


@dataclass(eq=False, kw_only=True)
class Baseline:
    """A model that is compared; keywords in `settings` are its own.

    Attributes:
        model: its name.
        sheared: whether its strips shear.
    """

    model: str
    sheared: bool = False

    def installed(self) -> bool:
        """Return whether it can be asked, as all that need no other code."""
        return True

    def static_path(self, *args: Any, **settings: Any) -> SolvedPath:
        """Drive the body of a problem through `rotations` (S,) [rad], the first of which is 0.

        Raises:
            BaselineFailed: the path is not reached.
        """
        raise NotImplementedError

    def release(self, *args: Any, **settings: Any) -> SolvedMotion:
        """Let go of the body of a problem at rest at `start` [rad], for `duration` in steps of `step` [s].

        Raises:
            BaselineFailed: the motion stopped early.
        """
        raise NotImplementedError

    def path(self, problem: Any, repeat: int, **settings: Any) -> SolvedPath:
        """Return the path of a case through its own increments, timed so many times [1]."""
        rotations = np.linspace(0.0, problem.rotation, problem.increments + 1)
        return self.static_path(problem, rotations, **settings).timed(repeat)

    def swing(self, problem: Any, duration: float, **settings: Any) -> SolvedMotion:
        """Return the motion of a case from the end of its path for `duration` [s], timed as it affords."""
        motion = self.release(problem, start=problem.rotation, duration=duration, **settings).timed(1)
        repeats = repeats_of(motion.solve_s)
        return motion.timed(repeats) if repeats > 1 else motion


@dataclass(frozen=True, eq=False, kw_only=True)
class Variant:
    """One setting of one model.

    Attributes:
        baseline: the model.
        series: what it is compared under.
        settings: keywords of the model.
    """

    baseline: Baseline
    series: str
    settings: Mapping[str, Any]

    @property
    def theory(self) -> str:
        """What the strips' energies are measured in, which decides on the limit: "material" or "shear"."""
        sheared = self.baseline.sheared or self.settings.get("element") == "reissner"
        return "shear" if sheared else "material"

    @property
    def count(self) -> int:
        """Elements or control points a strip; 1 of a closed form."""
        return int(self.settings.get("elements", self.settings.get("control_points", 1)))

    @property
    def size(self) -> str:
        """The same as a text."""
        texts = {"elements": "{} elements", "control_points": "n = {}", "accuracy": "accuracy {:g}"}
        found = (text.format(self.settings[name]) for name, text in texts.items() if name in self.settings)
        return next(found, "closed form")

    @property
    def steps_alone(self) -> bool:
        """Whether others of its series differ from it in the step alone."""
        return "step" in self.settings and self.size != "closed form"

    @property
    def family(self) -> str:
        """What settings that differ from it in the step alone have in common."""
        return self.size if self.steps_alone else "all"

    @property
    def setting(self) -> str:
        """Its name in its series."""
        return f"{self.size}, {1e6 * self.settings['step']:.3g} µs" if self.steps_alone else self.size

    def path(self, problem: Any, repeat: int) -> Followed:
        """Return the path of a case, timed so many times; what is refused or fails has a status alone."""
        return _answer(partial(self.baseline.path, problem, repeat, **self.settings))

    def swing(self, problem: Any, duration: float) -> Followed:
        """Return the motion of a case; what is refused or fails has a status alone."""
        return _answer(partial(self.baseline.swing, problem, duration, **self.settings))


def _answer(solve: Callable[[], Followed]) -> Followed:
    try:
        return solve()
    except (BaselineFailed, BadInput) as stopped:
        return Followed(status="not_converged", message=str(stopped), work={})


def ranked(variants: Iterable[Variant]) -> list[tuple[int, Variant]]:
    """Return each setting behind its place in its series."""
    places: dict[str, count[int]] = defaultdict(count)
    return [(next(places[each.series]), each) for each in variants]


def grid(baseline: Baseline, series: str, **axes: Sequence[Any]) -> list[Variant]:
    """Return the settings of a model on a grid, the last axis changing fastest."""
    return [
        Variant(baseline=baseline, series=series, settings=dict(zip(axes, values, strict=True)))
        for values in product(*axes.values())
    ]
