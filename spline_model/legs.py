"""The legs of a static path: loads come on before a rotation and stay, or grow with its size."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.effects import AppliedLoad, Driven
from spline_model.effects.base import Load
from spline_model.errors import InvalidParameter
from spline_model.path import Progress, follow
from spline_model.scene import Scene
from spline_model.solution import BY_STATE, Later, Path, Status, joined
from spline_model.tables import LoadTable

Array = NDArray[np.float64]

LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")


class _Leg(NamedTuple):
    """A part of a path: a system that is followed through load factors.

    steady: loads that act in full all along it, whatever its own load factor.
    """

    system: System
    factors: list[float]
    steady: LoadTable | None = None


def has_loads(scene: Scene) -> bool:
    """Whether loads act that may come on first: beside a driven displacement all grow together."""
    return bool(scene.of(Load)) and not any(drive.moves for drive in scene.of(Driven) if drive.beside)


def steady(scene: Scene) -> Scene:
    """Return the scene with loads and driven displacements in full at any load factor."""
    effects = (
        replace(e, steady=True) if isinstance(e, AppliedLoad) or (isinstance(e, Driven) and e.beside) else e
        for e in scene.effects
    )
    return replace(scene, effects=tuple(effects))


def growing(system: System, increments: int, end: float = 1.0) -> _Leg:
    """Return the leg on which all loads and drives of a system grow from 0 to the load factor ``end`` [1]."""
    return _Leg(system, np.linspace(0.0, end, increments + 1)[1:].tolist())


def turning(
    driven: Callable[[float], System], rotations: Sequence[float], increments: int, order: str
) -> list[_Leg]:
    """Return the legs of a body that is turned through R rotations [rad] under the loads of its scene.

    driven: the system that is driven to a rotation; increments: those of the loads where they come on first.
    Without any rotation loads grow from 0 to 1.

    Raises
    ------
    InvalidParameter
        Rotations to both sides, while loads or displacements grow with their size.
    """
    largest = max(rotations, key=abs)
    if largest == 0.0:
        return [growing(driven(0.0), len(rotations))]
    whole, factors = driven(largest), [rotation / largest for rotation in rotations]
    if order == LOADS_FIRST and has_loads(whole.scene):
        first = growing(driven(0.0), increments)
        return [first, _Leg(compile_scene(steady(whole.scene)), factors, steady=first.system.loads)]
    grows = whole.acting.value.any() or np.count_nonzero(whole.drives.target) > 1
    if grows and min(factors) < 0.0:
        told = [round(end, 6) for end in (min(rotations), max(rotations))]
        expected = "turns to one side of rest [rad], with which loads and displacements grow"
        raise InvalidParameter("rotation", told, expected)
    return [_Leg(whole, factors)]


def follow_legs(
    legs: Sequence[_Leg], branch: str = "primary", method: str = "condensed", progress: Progress | None = None
) -> Path:
    """Return the path through all legs, each from where the one before ends; branch and method as in
    ``follow``."""
    path, done, total = None, 0, sum(len(leg.factors) for leg in legs)
    for leg in legs:
        told = None if progress is None else partial(_tell, progress, done, total)
        start = None if path is None else path.states[-1]
        part = follow(leg.system, leg.factors, told, start=start, branch=branch, method=method)
        if part.critical_points:
            branch = "primary"  # the branch was left, or there was none to follow
        if leg.steady is not None:
            part = _loaded(part, leg.steady)
        path = part if path is None else _joined(path, part)
        if path.status is not Status.CONVERGED:
            break
        done += len(leg.factors)
    assert path is not None, "there is a leg"
    return path


def _tell(progress: Progress, done: int, total: int, increments: int, _: int) -> None:
    """The progress of a leg, counted with what was done before it."""
    progress(min(done + increments, total), total)


def _loaded(path: Path, loads: LoadTable) -> Path:
    """A path along which loads act in full: its load factor is theirs, and their work is in its own."""
    moved = (path.states - path.states[0])[:, loads.coordinate] @ loads.value
    points = tuple(replace(point, load_factor=1.0) for point in path.critical_points)
    return replace(path, load_factor=np.ones(len(path.work)), work=path.work + moved, critical_points=points)


def _joined(before: Path, after: Path) -> Path:
    """Two parts of a path, the second begun where the first ends."""
    both = before.rows(slice(None)), after.rows(slice(1, None))
    parts: dict[str, Any] = {name: np.concatenate([rows[name] for rows in both]) for name in BY_STATE}
    parts["work"][len(before.work) :] += before.work[-1]
    parts["unknowns"] = Later(partial(joined, tuple(rows["unknowns"] for rows in both)))
    return replace(
        after,
        message="; ".join(dict.fromkeys(m for m in (before.message, after.message) if m)),
        critical_points=before.critical_points + after.critical_points,
        counters={name: count + after.counters[name] for name, count in before.counters.items()},
        history=before.history + after.history,
        **parts,
    )
