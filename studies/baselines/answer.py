"""The neutral answers of a baseline, and what every baseline checks and times alike."""

import gc
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.errors import BadInput
from studies.kinds import Array


class BaselineFailed(RuntimeError):
    """A baseline did not reach the end of its path or motion; one line that says where it stopped."""


@dataclass(frozen=True, kw_only=True)
class BaselinePath:
    """A static path by a baseline, S states, the unloaded one first.

    Attributes:
        model: name in `studies.baselines.registry`.
        settings: of the model, complete.
        rotation: (S,) of the body, counter-clockwise [rad].
        centre: (S, 2) centre of mass of the body, origin at A1 [m].
        torque: (S,) driving torque on the body [N m].
        stiffness: (S,) its derivative by the rotation [N m / rad]; NaN where the model does not give it.
        solve_s: median time of the solver alone [s]: without set-up, and without reading the answer.
        work: counters of the solve, by kind; "unknowns" is the size of its system.
    """

    model: str
    settings: Mapping[str, Any]
    rotation: Array
    centre: Array
    torque: Array
    stiffness: Array
    solve_s: float
    work: Mapping[str, int]


@dataclass(frozen=True, kw_only=True)
class BaselineMotion:
    """Motion after a release at rest by a baseline, T records, the start first.

    Attributes:
        model, settings, work: as of `BaselinePath`.
        time: (T,) [s].
        rotation: (T,) of the body [rad].
        solve_s: median time of the integration alone [s]: without the static path to the start.
    """

    model: str
    settings: Mapping[str, Any]
    time: Array
    rotation: Array
    solve_s: float
    work: Mapping[str, int]


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


def median_seconds(prepare: Callable[[], Callable[[], Any]], repeat: int) -> float:
    """Return the median time [s] of what `prepare` returns, each time prepared afresh and untimed.

    Garbage collection is off; a run that does not count comes before when `repeat` is above 1.

    Raises:
        BadInput: `repeat` below 1.
    """
    checked_count("repeat", repeat, 1)
    if repeat > 1:
        prepare()()
    seconds = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        for _ in range(repeat):
            work = prepare()
            begin = time.perf_counter()
            work()
            seconds.append(time.perf_counter() - begin)
    finally:
        if collecting:
            gc.enable()
    return float(np.median(seconds))
