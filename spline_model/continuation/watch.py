"""What a path is watched for, whatever its parameter: sound states, critical points, other branches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch
from spline_model.compile import System
from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.points import BIFURCATION, LIMIT, Crossing, between, booked, directed, reached
from spline_model.effects import AppliedLoad, Driven, DrivenRotation
from spline_model.newton import correct
from spline_model.solution import CriticalPoint, Status
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]

BRANCHES = ("primary", "follow")
AMPLITUDES = (0.1, 0.03, 0.01)
"""How far from the bifurcation the branch is entered, in lengths of a strip or rad: large, because
close to it Newton has two solutions to choose from."""
NO_CROSSING = "the stability changes in a jump, the state lies on another branch"
PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "u", -9: "n"}
"""Prefixes by their powers of ten."""
PLAIN = 1e-2, 1e4
"""Sizes of forces and moments that are readable without one."""


class Watch:
    """The checks of one path, and the critical points that were met on it.

    by_load: whether the load factor is the path's parameter, and only goes one way; leaves:
    whether the path is to leave its branch at the next bifurcation; before: what is to be said of what came
    before the path, and settled: its critical points; grown: share of weight and pre-strain that the path
    begins under.
    """

    def __init__(self, work: Followed, *, leaves: bool, by_load: bool) -> None:
        self.work, self.leaves, self.by_load = work, leaves, by_load
        self.critical: list[CriticalPoint] = []
        self.settled: tuple[CriticalPoint, ...] = ()
        self.before, self.note, self.grown = "", "", 1.0

    def refuse(self, here: Point, predicted: Array, z: Array, load_factor: float) -> str:
        """Return why a converged state is not the next one; empty if it may be.

        here: state before. predicted, z: unknowns (N,) [m, rad, N] of prediction and state. load_factor [1].
        """
        unit = self.work.unit[: self.work.count]
        reason = self.work.refuse(z) or left_the_branch(unit, here.z, predicted, z)
        return reason or self.work.unresolved(z, load_factor)

    def go(self, here: Point, point: Point, step: float) -> tuple[Point, float, str]:
        """Return where a step [1] from here to a sound point ends, int P_lambda d(lambda) on the way [J], and
        why it is no step.

        It ends there or on another branch. The reason is empty for a sound step.
        """
        done, reason = booked(here, point, step, self.work.energy)
        if reason:
            return here, 0.0, reason
        found = between(self.work, here, point, step)
        if found is None:
            return here, 0.0, NO_CROSSING
        crossing = next((c for c in found if c.told.kind == BIFURCATION), None) if self.leaves else None
        if crossing is not None:
            found = found[: found.index(crossing) + 1]
            point, reason = self._leave(crossing, here, step)
            done = point.potential - here.potential  # across a kink, what is gained
        if not reason:
            self.critical += [crossing.told for crossing in found]
        return point, done, reason

    def _leave(self, crossing: Crossing, here: Point, step: float) -> tuple[Point, str]:
        """A point on the branch that crosses, going away from there."""
        at = crossing.told.load_factor
        branched = _leave(self.work, crossing)
        if branched is None:
            return here, f"no other branch was found at load factor {at:.6g}"
        onward = branched.load_factor - at
        if self.by_load and onward * step <= 0.0:
            return here, f"the branch that crosses at load factor {at:.6g} goes back there"
        where = place(self.work, at, crossing.told.rotation)
        self.leaves = False
        self.note = (
            f"{BIFURCATION} at {where}: it buckles, the path goes on along the branch that crosses there"
        )
        if self.by_load:
            return branched, ""
        away = (branched.z - crossing.z) / self.work.unit
        return directed(self.work, branched, away, onward), ""

    def remark(self, inertia: int = 0) -> str:
        """Return where a path that reached its end passed critical points, and whether its end is unstable.

        inertia: negative eigenvalues of the last state. The text is empty if neither is so.
        """
        said, told = [self.before, self.note], () if self.note else self.critical
        for kind in dict.fromkeys(c.kind for c in told):
            places = ", ".join(place(self.work, c.load_factor, c.rotation) for c in told if c.kind == kind)
            said.append(f"{kind} at {places}: {_meaning(self.work.system, kind)}")
        if inertia > 0:
            said.append("the last state is unstable: it buckles unless it is held")
        return "; ".join(filter(None, said))

    def path(
        self, rows: dict[str, Any], message: str, history: Sequence[tuple[float, ...]]
    ) -> StaticSolution:
        """The result: what was followed, by state, ``done`` among it, int P_lambda d(lambda) from the first
        [J]; why it ended early, if it did."""
        system, work, critical = self.work.system, rows.pop("done"), (*self.settled, *self.critical)
        if (loads := system.loads).value.size:
            moved = (rows["unknowns"].array - system.rest)[:, loads.coordinate]
            work = rows["load_factor"] * (moved @ loads.value) + work
        if system.followers.place.size:  # with drives and loads they do what is stored
            moved = (rows["unknowns"].array - system.rest)[:, : system.weight.size]
            work = rows["energies"].sum(axis=1) + system.spring_energy(rows["poses"]) - moved @ system.weight
        if system.scene.turned:  # to whichever side the body turns
            rows["load_factor"] = np.abs(rows["load_factor"])
            critical = tuple(replace(point, load_factor=abs(point.load_factor)) for point in critical)
        return StaticSolution(
            system=system,
            status=Status.NOT_CONVERGED if message else Status.CONVERGED,
            message=message or self.remark(int(rows["inertia"][-1])),
            work=work - work[0],
            critical_points=critical,
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


def place(
    work: Followed, load_factor: float, rotation: float = math.nan, *, last: float | None = None
) -> str:
    """Return what a load factor [1] stands for, in words: rotation, way, force and moment that act there.

    rotation [rad] of the driven body, if it is known better than by the load factor. last: load factor of the
    place before it, where the way from there is meant.
    """
    factors = [load_factor] if last is None else [last, load_factor]
    if work.grows:
        return " and ".join(f"{100 * each:.6g}" for each in factors) + " % of weight and pre-strain"
    effects, system = work.system.scene.effects, work.system
    if any(getattr(effect, "steady", False) for effect in effects):  # and the rotation's alone grows
        return " and ".join(", ".join(_acting(system, each, rotation)) for each in factors)
    if system.scene.driven_row is not None:  # the size of a rotation, to whichever side it goes
        factors = [abs(each) for each in factors]
    acting = ", ".join(_acting(system, load_factor, rotation))
    return (
        "load factor " + " and ".join(f"{each:.6g}" for each in factors) + (f" ({acting})" if acting else "")
    )


def _acting(system: System, load_factor: float, rotation: float) -> list[str]:
    """What drives and loads come to, in words."""
    parts: list[str] = []
    acting: tuple[Any, ...] = system.scene.of(Driven) + system.scene.of(AppliedLoad)
    for effect in acting:
        share = 1.0 if effect.steady else load_factor
        if isinstance(effect, DrivenRotation) and effect.moves:
            known = not (effect.beside or math.isnan(rotation))
            parts.append(f"rotation {math.degrees(rotation if known else share * effect.angle):.5g} deg")
        elif isinstance(effect, Driven) and effect.moves:
            parts.append(f"displacement {1e3 * abs(share) * math.hypot(*effect.parts.values()):.4g} mm")
        if isinstance(effect, AppliedLoad) and any(effect.force):
            parts.append(f"force {_sized(abs(share) * math.hypot(*effect.force))}N")
        if isinstance(effect, AppliedLoad) and effect.moment:
            parts.append(f"moment {_sized(share * effect.moment)}N m")
    return parts


def _sized(value: float) -> str:
    """A number with four digits and the prefix that spares it a power of ten."""
    if value == 0.0 or PLAIN[0] <= abs(value) < PLAIN[1]:
        return f"{value:.4g} "
    power = max(-9, min(9, 3 * math.floor(math.log10(abs(value)) / 3)))
    return f"{value / 10.0**power:.4g} {PREFIXES[power]}"
