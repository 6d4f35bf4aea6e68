"""What a path is watched for, whatever its parameter: sound states, critical points, other branches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch, refuse
from spline_model.continuation.balance import jumped
from spline_model.continuation.branch import leave
from spline_model.continuation.critical import BIFURCATION, between
from spline_model.continuation.integration import UNCONFIRMED, Finer
from spline_model.continuation.point import Point, directed
from spline_model.continuation.remark import Place, left, remark
from spline_model.continuation.resolution import Resolution
from spline_model.newton import Workspace
from spline_model.solution import CriticalPoint, Path, Status

Array = NDArray[np.float64]


NO_CROSSING = "the stability changes in a jump, the state lies on another branch"
STEEP = 5.0
"""Rate of a path over its mean rate so far from which on it ends at a limit point, where it is infinite."""


class Watch:
    """The checks of one path, and the critical points that were met on it.

    by_load: whether the load factor is the path's parameter, and only goes one way; leaves:
    whether the path is to leave its branch at the next bifurcation; place: what a load factor is
    called; before: what is to be said of what came before the path.
    """

    def __init__(self, work: Workspace, *, leaves: bool, by_load: bool, place: Place | None = None) -> None:
        self.work, self.leaves, self.by_load = work, leaves, by_load
        self.place, self.before = place or Place(system=work.system), ""
        self.resolution = Resolution(work.system)
        self.critical: list[CriticalPoint] = []
        self.note = ""
        self._finer: Finer | None = None

    def refuse(self, here: Point, predicted: Array, z: Array, load_factor: float) -> str:
        """Why a converged state is not the next one; empty if it may be."""
        system = self.work.system
        reason = refuse(system, z) or left_the_branch(system, here.z, predicted, z)
        return reason or self.resolution.refuse(z, self.work.preload(load_factor))

    def go(self, here: Point, point: Point, step: float) -> tuple[Point, str]:
        """Where a step from here to a sound point ends: there, or on another branch; or why it is no step."""
        reason = jumped(here, point, step, self.work.system.scales.energy)
        if reason:
            return here, reason
        found = between(self.work, here, point, step)
        if found is None:
            return here, NO_CROSSING
        if found and self.resolution.judged and not self._confirmed(here, point, step):
            return here, UNCONFIRMED.format(kind=found[0].kind)
        crossing = next((c for c in found if c.kind == BIFURCATION), None) if self.leaves else None
        if crossing is not None:
            found = found[: found.index(crossing) + 1]
            point, reason = self._leave(crossing, here, step)
        if not reason:
            self.critical += found
        return point, reason

    def _leave(self, crossing: CriticalPoint, here: Point, step: float) -> tuple[Point, str]:
        """A point on the branch that crosses, going away from there."""
        branched = leave(self.work, crossing, self.resolution)
        if branched is None:
            return here, f"no other branch was found at load factor {crossing.load_factor:.6g}"
        onward = branched.load_factor - crossing.load_factor
        if self.by_load and onward * step <= 0.0:
            return here, f"the branch that crosses at load factor {crossing.load_factor:.6g} goes back there"
        self.leaves, self.note = False, left(self.place, crossing)
        if self.by_load:
            return branched, ""
        away = (branched.z - crossing.z) / self.work.system.scales.unit
        return directed(self.work.system, branched, away, onward), ""

    def _confirmed(self, here: Point, point: Point, step: float) -> bool:
        if self._finer is None:
            self._finer = Finer(self.work)
        return self._finer.confirms(self.work, here, point, step)

    def keep_sound(self, points: list[Point]) -> None:
        """Drop the last points that a vanishing stiffness has spoilt, where Gauss points were too few."""
        while self._finer is not None and len(points) > 1 and not self._finer.agrees(points[-1]):
            points.pop()

    def stopped(self, first: Point, here: Point, aim: float, reason: str) -> str:
        """That a path from ``first`` goes no further than ``here`` on its way to a load factor, and why."""
        count, unit = self.work.system.layout.coordinate_count, self.work.system.scales.unit
        went, goes = (np.linalg.norm((change / unit)[:count]) for change in (here.z - first.z, here.rate))
        sound = self._finer is None or self._finer.agrees(here)
        if sound and goes * abs(here.load_factor - first.load_factor) > STEEP * went:
            reason = f"it buckles, a limit point: the stiffness vanishes there ({reason})"
        return f"stopped between {self.place.between(here.load_factor, aim)}: {reason}"

    def remark(self, inertia: int = 0) -> str:
        """What is said of a path that reached its end, at a state of an inertia."""
        unstable = remark(self.work.system, self.place, () if self.note else self.critical, inertia)
        return "; ".join(part for part in (self.before, self.note, unstable) if part)

    def path(
        self,
        points: Sequence[Point],
        done: Sequence[float],
        message: str,
        history: Sequence[tuple[float, ...]],
    ) -> Path:
        """The result: points (S); int P_lambda d(lambda) to each (S) [J]; why it ended early, if it did."""
        rates, slopes = (np.array([getattr(p, name) for p in points]) for name in ("rate", "slope"))
        loads, rest = self.work.system.tables.loads, self.work.system.rest
        states, factors = (np.array([getattr(p, name) for p in points]) for name in ("z", "load_factor"))
        by_loads = factors * ((states - rest)[:, loads.coordinate] @ loads.value)
        return Path(
            status=Status.NOT_CONVERGED if message else Status.CONVERGED,
            message=message or self.remark(points[-1].inertia),
            load_factor=factors,
            states=states,
            rates=rates / slopes[:, None],
            stiffness=np.array([p.stiffness for p in points]),
            energies=np.array([p.energies for p in points]),
            work=by_loads - by_loads[0] + np.array(done),
            inertia=np.array([p.inertia for p in points]),
            moment_defect=np.array([self.resolution.defect(p.z) for p in points]),
            critical_points=tuple(self.critical),
            counters=asdict(self.work.counters),
            history=tuple(history),
        )
