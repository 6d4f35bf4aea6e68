"""What a path is watched for, whatever its parameter: sound states, critical points, other branches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch
from spline_model.compile import System
from spline_model.continuation.critical import BIFURCATION, Bracket, Crossing, between, corrected
from spline_model.continuation.followed import Followed, correct
from spline_model.continuation.point import Point, directed, jumped, stand
from spline_model.continuation.remark import Place, left, remark
from spline_model.sections import centre_lines
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
STEEP = 5.0
"""Rate of a path over its mean rate so far from which on it ends at a limit point, where it is infinite."""


class Watch:
    """The checks of one path, and the critical points that were met on it.

    by_load: whether the load factor is the path's parameter, and only goes one way; leaves:
    whether the path is to leave its branch at the next bifurcation; place: what a load factor is
    called; before: what is to be said of what came before the path; first: load factor and z of its
    first state.
    """

    def __init__(self, work: Followed, *, leaves: bool, by_load: bool, place: Place | None = None) -> None:
        self.work, self.leaves, self.by_load = work, leaves, by_load
        self.place, self.before = place or Place(system=work.system), ""
        self.critical: list[CriticalPoint] = []
        self.note, self.first = "", None  # type: str, tuple[float, Array] | None
        self._finer: _Finer | None = None

    def refuse(self, here: Point, predicted: Array, z: Array, load_factor: float) -> str:
        """Why a converged state is not the next one; empty if it may be."""
        unit = self.work.unit[: self.work.count]
        reason = self.work.refuse(z) or left_the_branch(unit, here.z, predicted, z)
        return reason or self.work.unresolved(z, load_factor)

    def go(self, here: Point, point: Point, step: float) -> tuple[Point, str]:
        """Where a step from here to a sound point ends: there, or on another branch; or why it is no step."""
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
        branched = leave(self.work, crossing)
        if branched is None:
            return here, f"no other branch was found at load factor {at:.6g}"
        onward = branched.load_factor - at
        if self.by_load and onward * step <= 0.0:
            return here, f"the branch that crosses at load factor {at:.6g} goes back there"
        self.leaves, self.note = False, left(self.place, crossing.told)
        if self.by_load:
            return branched, ""
        away = (branched.z - crossing.z) / self.work.unit
        return directed(self.work, branched, away, onward), ""

    def _confirmed(self, here: Point, point: Point, step: float) -> bool:
        if self._finer is None:
            self._finer = _Finer(self.work)
        return self._finer.confirms(self.work, here, point, step)

    def is_resolved(self, point: Point) -> bool:
        """Whether a point near a vanishing stiffness is not spoilt by too few Gauss points."""
        return self._finer is None or self._finer.agrees(point)

    def stopped(self, here: Point, aim: float, reason: str) -> str:
        """That a path goes no further than ``here`` on its way to a load factor, and why."""
        assert self.first is not None, "set with the first state"
        factor, first = self.first
        count, unit = self.work.count, self.work.unit
        went, goes = (np.linalg.norm((change / unit)[:count]) for change in (here.z - first, here.rate))
        if self.is_resolved(here) and goes * abs(here.load_factor - factor) > STEEP * went:
            reason = f"it buckles, a limit point: the stiffness vanishes there ({reason})"
        return f"stopped between {self.place.between(here.load_factor, aim)}: {reason}"

    def remark(self, inertia: int = 0) -> str:
        """What is said of a path that reached its end, at a state of an inertia."""
        unstable = remark(self.work.system, self.place, () if self.note else self.critical, inertia)
        return "; ".join(part for part in (self.before, self.note, unstable) if part)

    def path(self, rows: dict[str, Any], message: str, history: Sequence[tuple[float, ...]]) -> Path:
        """The result: what was followed, by state; why it ended early, if it did."""
        told = message or self.remark(int(rows["inertia"][-1]))
        counters = dict(vars(self.work.counters))
        path = _path_of(self.work.system, rows, told, counters, tuple(self.critical), tuple(history))
        return replace(path, status=Status.NOT_CONVERGED) if message else path


def _path_of(
    system: System,
    rows: dict[str, Any],
    message: str,
    counters: dict[str, int],
    critical: tuple[CriticalPoint, ...] = (),
    history: tuple[tuple[float, ...], ...] = (),
) -> Path:
    """A converged path of rows by state, ``done`` among them: int P_lambda d(lambda) from the first [J]."""
    loads, work = system.loads, rows["done"]
    if loads.value.size:
        moved = (centre_lines(system, rows["unknowns"].array) - system.rest)[
            :, loads.coordinate
        ] @ loads.value
        work = rows["load_factor"] * moved + work
    return Path(
        status=Status.CONVERGED,
        message=message,
        work=work - work[0],
        critical_points=critical,
        counters=counters,
        history=history,
        **{name: values for name, values in rows.items() if name != "done"},
    )


def leave(work: Followed, crossing: Crossing) -> Point | None:
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
        try:
            return stand(work, found.z, found.load_factor, found.energies)
        except np.linalg.LinAlgError:
            continue
    return None


class _Finer:
    """A system with twice the Gauss points: its unknowns are the same ones.

    Too few points do not see a bend between them. The tangent then loses its stiffness there
    while all else still looks sound, and ends in a critical point that the strips do not have.
    """

    def __init__(self, work: Followed) -> None:
        self.work = work.finer()

    def confirms(self, work: Followed, before: Point, after: Point, step: float) -> bool:
        """Whether a critical point lies between two states here as well."""
        plane = Bracket(work=work, before=before, after=after, step=step).plane()
        ends = [corrected(self.work, p.z, p.load_factor, *plane) for p in (before, after)]
        if ends[0] is None or ends[1] is None:
            return False
        return bool(between(self.work, ends[0], ends[1], step))

    def agrees(self, point: Point) -> bool:
        """Whether a state keeps its stiffness, the rate of what does work on the load factor."""
        normal = 0.0 * point.z
        other = corrected(self.work, point.z, point.load_factor, normal, 1.0)
        if other is None:
            return False
        change = abs(other.conjugate_rate * point.slope - point.conjugate_rate)
        return change <= LARGEST_CHANGE * abs(other.conjugate_rate * point.slope)
