"""What a path is watched for, whatever its parameter: sound states, critical points, other branches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch
from spline_model.compile import System
from spline_model.continuation.critical import BIFURCATION, LIMIT, Bracket, Crossing, between, corrected
from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.place import Place
from spline_model.continuation.point import directed, jumped, reached
from spline_model.newton import correct
from spline_model.solution import CriticalPoint, Path, Status

Array = NDArray[np.float64]

BRANCHES = ("primary", "follow")
AMPLITUDES = (0.1, 0.03, 0.01)
"""How far from the bifurcation the branch is entered, in lengths of a strip or rad: large, because
close to it Newton has two solutions to choose from."""
UNCONFIRMED = "a {kind} that is not found with twice the Gauss points (use more gauss_points)"
LARGEST_CHANGE = 0.02
"""Largest relative change of stiffness with twice the Gauss points of a state that is kept."""
NO_CROSSING = "the stability changes in a jump, the state lies on another branch"


class Watch:
    """The checks of one path, and the critical points that were met on it.

    Too few Gauss points do not see a bend between them. The tangent then loses its stiffness there while all
    else still looks sound, and ends in a critical point that the strips do not have: the same system with
    twice the points, whose unknowns are the same ones, has to agree.

    by_load: whether the load factor is the path's parameter, and only goes one way; leaves:
    whether the path is to leave its branch at the next bifurcation; place: what a load factor is
    called; before: what is to be said of what came before the path, and settled: its critical points;
    grown: share of weight and pre-strain that the path begins under.
    """

    def __init__(self, work: Followed, *, leaves: bool, by_load: bool) -> None:
        self.work, self.leaves, self.by_load = work, leaves, by_load
        self.place, self.before = Place(system=None if work.grows else work.system), ""
        self.critical: list[CriticalPoint] = []
        self.settled: tuple[CriticalPoint, ...] = ()
        self.note, self.grown = "", 1.0
        self._finer: Followed | None = None

    def refuse(self, here: Point, predicted: Array, z: Array, load_factor: float) -> str:
        """Return why a converged state is not the next one; empty if it may be.

        here: state before. predicted, z: unknowns (N,) [m, rad, N] of prediction and state. load_factor [1].
        """
        unit = self.work.unit[: self.work.count]
        reason = self.work.refuse(z) or left_the_branch(unit, here.z, predicted, z)
        return reason or self.work.unresolved(z, load_factor)

    def go(self, here: Point, point: Point, step: float) -> tuple[Point, str]:
        """Return where a step [1] from here to a sound point ends, and why it is no step.

        It ends there or on another branch. The reason is empty for a sound step.
        """
        reason = jumped(here, point, step, self.work.energy)
        if reason:
            return here, reason
        found = between(self.work, here, point, step)
        if found is None:
            return here, NO_CROSSING
        if found and self.work.judged and not self._confirmed(here, point, step):
            return here, UNCONFIRMED.format(kind=found[0].told.kind)
        crossing = next((c for c in found if c.told.kind == BIFURCATION), None) if self.leaves else None
        if crossing is not None:
            found = found[: found.index(crossing) + 1]
            point, reason = self._leave(crossing, here, step)
        if not reason:
            self.critical += [crossing.told for crossing in found]
        return point, reason

    def _leave(self, crossing: Crossing, here: Point, step: float) -> tuple[Point, str]:
        """A point on the branch that crosses, going away from there."""
        at = crossing.told.load_factor
        branched = _leave(self.work, crossing)
        if branched is None:
            return here, f"no other branch was found at load factor {at:.6g}"
        onward = branched.load_factor - at
        if self.by_load and onward * step <= 0.0:
            return here, f"the branch that crosses at load factor {at:.6g} goes back there"
        where = self.place.at(at, crossing.told.rotation)
        self.leaves = False
        self.note = (
            f"{BIFURCATION} at {where}: it buckles, the path goes on along the branch that crosses there"
        )
        if self.by_load:
            return branched, ""
        away = (branched.z - crossing.z) / self.work.unit
        return directed(self.work, branched, away, onward), ""

    def _confirmed(self, here: Point, point: Point, step: float) -> bool:
        """Whether a critical point lies between two states with twice the Gauss points as well."""
        self._finer = self._finer or self.work.finer()
        plane = Bracket(work=self.work, before=here, after=point, step=step).plane()
        ends = [corrected(self._finer, p.z, p.load_factor, *plane) for p in (here, point)]
        if ends[0] is None or ends[1] is None:
            return False
        return bool(between(self._finer, ends[0], ends[1], step))

    def is_resolved(self, point: Point) -> bool:
        """Whether a point near a vanishing stiffness, the rate of what does work on the load factor, keeps it
        with twice the Gauss points."""
        if self._finer is None:
            return True
        other = corrected(self._finer, point.z, point.load_factor, 0.0 * point.z, 1.0)
        if other is None:
            return False
        change = abs(other.conjugate_rate * point.slope - point.conjugate_rate)
        return change <= LARGEST_CHANGE * abs(other.conjugate_rate * point.slope)

    def remark(self, inertia: int = 0) -> str:
        """Return where a path that reached its end passed critical points, and whether its end is unstable.

        inertia: negative eigenvalues of the last state. The text is empty if neither is so.
        """
        said, told = [self.before, self.note], () if self.note else self.critical
        for kind in dict.fromkeys(c.kind for c in told):
            places = ", ".join(self.place.at(c.load_factor, c.rotation) for c in told if c.kind == kind)
            said.append(f"{kind} at {places}: {_meaning(self.work.system, kind)}")
        if inertia > 0:
            said.append("the last state is unstable: it buckles unless it is held")
        return "; ".join(filter(None, said))

    def path(self, rows: dict[str, Any], message: str, history: Sequence[tuple[float, ...]]) -> Path:
        """The result: what was followed, by state, ``done`` among it, int P_lambda d(lambda) from the first
        [J]; why it ended early, if it did."""
        system, work = self.work.system, rows.pop("done")
        if (loads := system.loads).value.size:
            moved = (rows["unknowns"].array - system.rest)[:, loads.coordinate]
            work = rows["load_factor"] * (moved @ loads.value) + work
        if system.followers.place.size:  # with drives and loads they do what is stored
            moved = (rows["unknowns"].array - system.rest)[:, : system.weight.size]
            work = rows["energies"].sum(axis=1) + system.spring_energy(rows["poses"]) - moved @ system.weight
        return Path(
            status=Status.NOT_CONVERGED if message else Status.CONVERGED,
            message=message or self.remark(int(rows["inertia"][-1])),
            work=work - work[0],
            critical_points=(*self.settled, *self.critical),
            counters=dict(vars(self.work.counters)),
            history=tuple(history),
            grown=self.grown,
            **rows,
        )


def _leave(work: Followed, crossing: Crossing) -> Point | None:
    """A state on the other branch, at an amplitude of the critical mode; None if none was found.

    Newton with the amplitude held and the load factor free, so that the primary branch, on
    which the mode has no part, is no solution.
    """
    count = work.count
    normal = np.zeros(len(crossing.z))
    normal[:count] = crossing.mode
    for amplitude in AMPLITUDES:
        z = crossing.z.copy()
        z[:count] += amplitude * work.unit[:count] * crossing.mode
        found = correct(work, z, crossing.told.load_factor, normal, 0.0)
        if found.reason or work.refuse(found.z) or work.unresolved(found.z, found.load_factor):
            continue
        point, _ = reached(work, found)
        if point is not None:
            return point
    return None


def _meaning(system: System, kind: str) -> str:
    """What a critical point is to the design."""
    if kind == BIFURCATION:
        return "it buckles there, the path stays on the primary branch (branch='follow' leaves it)"
    if kind != LIMIT:
        return "the drive turns back there"
    if system.scene.driven_row is None:
        return "the load is the largest or least around, under a dead load it snaps through"
    return "the driven body's own stiffness vanishes: released, it tips over"
