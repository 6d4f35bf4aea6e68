"""The neutral answers of a baseline, the pivot as it is given one, and what all check and time alike."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np

from studies.answers.motion import Motion
from studies.answers.response import Response
from studies.cases.problem import Problem
from studies.errors import BadInput
from studies.kinds import Array
from studies.record.progress import measure


class BaselineFailed(RuntimeError):
    """A baseline did not reach the end of its path or motion; one line that says where it stopped."""


@dataclass(frozen=True, kw_only=True)
class Followed:
    """What path and motion of any model say of how they came about.

    Attributes:
        work: counters of the solve, by kind; "unknowns" is the size of its system.
        again: solves once more and returns the time of the increments or steps alone [s]: without set-up,
            without the static path to a release, and without reading the answer.
        solve_s: median of such times [s], NaN of what was not timed; repeats: how many these are [1].
        wall_s: time of the whole answer [s], NaN if unknown.
        status: "converged" or how it ended; message: why and where or when it stopped.
    """

    work: Mapping[str, float]
    again: Callable[[], float] = lambda: math.nan
    solve_s: float = math.nan
    repeats: int = 0
    wall_s: float = math.nan
    status: str = "converged"
    message: str = ""

    @classmethod
    def of(cls, answer: Response | Motion, **more: Any) -> Self:
        """Return what one of the suite's own models answered, with `more` beside it or in place of it."""
        own = {each.name for each in fields(cls) if hasattr(answer, each.name)} - more.keys()
        return cls(**{name: getattr(answer, name) for name in own}, **more)

    @property
    def converged(self) -> bool:
        """Whether it was followed to its end."""
        return self.status == "converged"

    def seconds(self, repeat: int) -> tuple[float, ...]:
        """Return times of so many solves [s]; one that does not count comes before when there are several.

        Raises:
            BadInput: `repeat` below 1.
        """
        checked_count("repeat", repeat, 1)
        return measure(self.again, repeat=repeat, warm_up=1 if repeat > 1 else 0, part=float).parts

    def timed(self, repeat: int) -> Self:
        """Return the same with its median time."""
        return replace(self, solve_s=float(np.median(self.seconds(repeat))), repeats=repeat)


@dataclass(frozen=True, kw_only=True)
class SolvedPath(Followed):
    """A static path, S states, the unloaded one first.

    Attributes:
        rotation: (S,) of the body, counter-clockwise [rad].
        centre: (S, 2) centre of mass of the body, origin at A1 [m].
        torque: (S,) driving torque on the body [N m].
        stiffness: (S,) its derivative by the rotation [N m / rad]; NaN where the model does not give it.
        max_stress: (S,) largest at the strips' outer fibres [Pa]; None where the model does not give it.
    """

    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    max_stress: Array | None = None


@dataclass(frozen=True, kw_only=True)
class SolvedMotion(Followed):
    """Motion after a release at rest, T records, the start first.

    Attributes:
        time: (T,) [s].
        rotation: (T,) of the body [rad].
    """

    time: Array
    rotation: Array


def checked_rotations(rotations: Any) -> Array:
    """Return the rotations of a path as an array.

    Raises:
        BadInput: fewer than two, one that is not finite, or a path that does not begin at rest.
    """
    turns = np.asarray(rotations, dtype=float)
    if turns.ndim != 1 or len(turns) < 2 or not np.isfinite(turns).all() or turns[0] != 0.0:
        raise BadInput(f"rotations: got {rotations!r}, expected two or more angles from 0 on [rad]")
    return turns


def checked_release(start: float, duration: float, step: float) -> int:
    """Return the number of steps of a release.

    Raises:
        BadInput: a start that is not finite, or a step that is not positive or longer than the duration.
    """
    if not np.isfinite(start):
        raise BadInput(f"start: got {start}, expected a finite angle [rad]")
    if not 0.0 < step <= duration < np.inf:
        raise BadInput(f"step: got {step} for {duration} s, expected a positive part of the duration [s]")
    return max(1, round(duration / step))


def checked_choice(name: str, value: Any, choices: tuple[Any, ...]) -> None:
    """Raise BadInput unless `value` is one of `choices`."""
    if value not in choices:
        raise BadInput(f"{name}: got {value!r}, expected one of {', '.join(map(repr, choices))}")


def checked_count(name: str, value: Any, least: int) -> None:
    """Raise BadInput unless `value` is a whole number of at least `least`."""
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise BadInput(f"{name}: got {value!r}, expected a whole number of at least {least}")


def clocked(prepare: Callable[[], Callable[[], Any]]) -> Callable[[], float]:
    """Return what times [s] what `prepare` returns, each time prepared afresh and untimed."""

    def again() -> float:
        prepared = prepare()
        begin = time.perf_counter()
        prepared()
        return time.perf_counter() - begin

    return again


#: The effects of a scene that baselines can stand for: what they leave out of these is their error.
EFFECTS = ("bending", "stretching", "strip_inertia", "body_inertia")


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """The pivot at rest: origin at the ground end of strip 1, x along the ground plate.

    Attributes:
        root: (2, 2) ground ends of the strips [m].
        direction: (2, 2) unit vectors from there to the body.
        tip: (2, 2) body ends [m].
        crossing: (2,) where the strips cross [m].
        centre: (2,) centre of mass of the body [m].
    """

    root: Array
    direction: Array
    tip: Array
    crossing: Array
    centre: Array


def geometry_of(problem: Problem) -> Geometry:
    """Return the pivot at rest.

    Raises:
        BadInput: a scene of other effects.
    """
    if set(problem.effects.names) != set(EFFECTS):
        raise BadInput(
            f"baseline: got the effects {', '.join(problem.effects.names)}, expected {', '.join(EFFECTS)}"
        )
    cosine, sine = math.cos(problem.inclination), math.sin(problem.inclination)
    crossing = np.array(problem.crossing_point)
    direction = np.array([[cosine, sine], [-cosine, sine]])
    root = crossing - problem.crossing_ratio * problem.length * direction
    tip = root + problem.length * direction
    return Geometry(
        root=root,
        direction=direction,
        tip=tip,
        crossing=crossing,
        centre=tip.mean(axis=0) + np.array(problem.centre_offset),
    )
