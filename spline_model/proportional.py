"""A body that is turned under loads: these come on first, with the body held, and stay as it turns; or grow
together with the rotation, in proportion to its size, whatever its sign.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System, compile_scene
from spline_model.effects import DrivenDisplacement
from spline_model.effects.base import Load
from spline_model.effects.boundary import Sized
from spline_model.newton import Laps
from spline_model.path import Progress, follow
from spline_model.scene import Scene
from spline_model.solution import BY_STATE, Later, Path, Status, joined

Array = NDArray[np.float64]

LOADS_FIRST, TOGETHER = ORDERS = ("loads first", "together")


def has_loads(scene: Scene) -> bool:
    """Whether loads act that may come on first: beside a driven displacement all grow together."""
    led = any(isinstance(effect, DrivenDisplacement) for effect in scene.effects)
    return not led and any(isinstance(effect, Load) for effect in scene.effects)


@dataclass(frozen=True, kw_only=True, eq=False)
class Turn:
    """Rotations (R,) [rad] that a body is turned through, under the loads of its scene.

    driven: the scene that is driven to a rotation; increments: those of the loads where they come on first;
    laps: told when the scene is compiled and when the path is solved; branch and method as in
    ``path.follow``.
    """

    driven: Callable[[float], Scene]
    rotations: Array
    increments: int
    laps: Laps
    progress: Progress | None = None
    branch: str = "primary"
    method: str = "condensed"

    def loads_first(self) -> tuple[System, Path]:
        """The scene and its path: the loads in their increments, then the rotations.

        The path's load factors are those of the loads, in critical points too.
        """
        branch, total = self.branch, self.increments + len(self.rotations)
        whole = compile_scene(self.driven(0.0))
        turned = compile_scene(steady(self.driven(self._largest)))
        self.laps.lap("compile")
        factors = np.linspace(0.0, 1.0, self.increments + 1)[1:]
        before = self._part(whole, list(factors), None, branch, 0, total)
        branch = "primary" if before.critical_points else branch
        if before.status is not Status.CONVERGED:
            self.laps.lap("solve")
            return whole, before
        aims = list(self.rotations / self._largest)
        after = self._part(turned, aims, before.states[-1], branch, self.increments, total)
        self.laps.lap("solve")
        loads = whole.loads
        moved = (after.states - after.states[0])[:, loads.coordinate] @ loads.value
        after = replace(
            after,
            load_factor=np.ones(len(after.work)),
            work=after.work + moved,
            critical_points=tuple(replace(point, load_factor=1.0) for point in after.critical_points),
        )
        return whole, _joined(before, after, back=False)

    def together(self) -> tuple[System, Path]:
        """The scene driven to the largest of the rotations, and its path through them, loads together.

        Where the body turns the other way the load factor is below zero and the loads still grow with its
        size: under loads that part is the path of the scene driven the other way, which begins where the
        other one has come back to rest. All rotations zero: loads grow from 0 to 1. The path's load factors
        are signed, critical points' are not.
        """
        branch, largest, count = self.branch, self._largest, len(self.rotations)
        factors = self.rotations / largest if largest else np.linspace(0.0, 1.0, count + 1)[1:]
        path, done, back = None, 0, False
        whole = compile_scene(self.driven(largest))
        self.laps.lap("compile")
        for sign, part_factors, returns in _sides(whole, factors):
            system = whole if sign > 0.0 else compile_scene(self.driven(-largest))
            begin = None if path is None else path.states[-1]
            aims = [sign * factor for factor in part_factors] + [0.0] * returns
            part = self._part(system, aims, begin, branch, done, count)
            if part.critical_points:
                branch = "primary"  # the branch was left, or there was none to follow
            if sign < 0.0:
                part = replace(part, load_factor=-part.load_factor)
            path = part if path is None else _joined(path, part, back)
            if path.status is not Status.CONVERGED:
                break
            done, back = done + len(part_factors), returns
        self.laps.lap("solve")
        assert path is not None, "a path has at least one rotation"
        points = tuple(replace(point, load_factor=abs(point.load_factor)) for point in path.critical_points)
        return whole, replace(path, critical_points=points) if points else path

    @property
    def _largest(self) -> float:
        """The rotation of largest size [rad], with its sign: there the loads act in full."""
        return float(max(self.rotations.tolist(), key=abs))

    def _part(
        self,
        system: System,
        factors: list[float],
        start: Array | None,
        branch: str,
        done: int,
        total: int,
    ) -> Path:
        """The path of a scene through load factors; progress is told with what was done before it."""
        told = None if self.progress is None else _later(self.progress, done, total)
        return follow(system, factors, told, start=start, branch=branch, method=self.method)


def steady(scene: Scene) -> Scene:
    """The scene with loads and driven displacements in full at any load factor."""
    timed = Sized | DrivenDisplacement
    effects = (replace(e, steady=True) if isinstance(e, timed) else e for e in scene.effects)
    return replace(scene, effects=tuple(effects))


def _sides(system: System, factors: Array) -> list[tuple[float, list[float], bool]]:
    """Sign of a side of rest, factors there, and whether they come back to rest; all at once without loads.

    Zero is on the side before it.
    """
    if not system.loads.value.any() and np.count_nonzero(system.drives.target) < 2:
        return [(1.0, factors.tolist(), False)]
    signs = np.sign(factors)
    for i in range(1, len(signs)):
        signs[i] = signs[i] or signs[i - 1]
    first = signs[signs != 0.0][:1]
    signs[signs == 0.0] = first[0] if first.size else 1.0
    cuts = np.flatnonzero(np.diff(signs)) + 1
    parts = np.split(factors, cuts)
    return [
        (float(signs[at]), part.tolist(), bool(i < len(cuts) and part[-1] != 0.0))
        for i, (at, part) in enumerate(zip(np.append(0, cuts), parts, strict=True))
    ]


def _later(progress: Progress, done: int, total: int) -> Progress:
    """The progress of a part, counted with what was done before it."""
    return lambda increments, _: progress(min(done + increments, total), total)


def _joined(before: Path, after: Path, back: bool) -> Path:
    """Two parts of a path, the second begun where the first ends; back: at a rest that nobody asked for."""
    kept = len(before.work) - back
    both = before.rows(slice(kept)), after.rows(slice(1, None))
    parts: dict[str, Any] = {name: np.concatenate([rows[name] for rows in both]) for name in BY_STATE}
    parts["work"][kept:] += before.work[-1]
    parts["unknowns"] = Later(partial(joined, tuple(rows["unknowns"] for rows in both)))
    return replace(
        after,
        message="; ".join(dict.fromkeys(m for m in (before.message, after.message) if m)),
        critical_points=before.critical_points + after.critical_points,
        counters={name: count + after.counters[name] for name, count in before.counters.items()},
        history=before.history + after.history,
        **parts,
    )
