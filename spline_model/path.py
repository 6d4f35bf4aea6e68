"""An equilibrium path through given load factors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Point
from spline_model.continuation.follower import Follower, equilibrium, first_point
from spline_model.continuation.point import stand
from spline_model.continuation.watch import BRANCHES, Watch
from spline_model.errors import InvalidParameter, require_choice
from spline_model.reduced.elements import Elements, followed
from spline_model.reduced.model import Reduced, at_rest
from spline_model.reduced.states import by_state
from spline_model.solution import Later, Path, joined

Array = NDArray[np.float64]

Progress = Callable[[int, int], None]
"""What is called with the increments done and the increments in all."""


def follow(
    system: System,
    load_factors: Sequence[float],
    progress: Progress | None = None,
    *,
    start: Array | None = None,
    branch: str = "primary",
    method: str = "condensed",
) -> Path:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    method: "condensed" takes the strips' elements, where they know the scene; "multipliers" the
    bordered system of the paper. Both agree to 1e-10.
    An increment whose Newton fails, or whose solution does not pass the checks, is taken
    in halves; when a part below SMALLEST_STEP still fails, the path ends with its last
    good state and the reason. start: unknowns (N,) of an equilibrium at load factor 0 to go
    on from instead of rest. branch: "primary" stays on the branch it is on where another one
    crosses; "follow" leaves it there, along the critical mode.
    """
    require_choice("branch", branch, BRANCHES)
    work = followed(system, method)
    watch = Watch(work, leaves=branch == "follow", by_load=True)
    track = _Track(watch, np.array([0.0, *load_factors]), progress)
    track.begin(start)
    message = ""
    while track.states < len(track.factors) and not message:
        message = track.advance()
    return track.path(message)


class _Track:
    """The states of a path: on the elements compiled while nothing happens, in steps where something does.

    pieces: rows by state, and their z (S, N); waiting: points that are not rows yet, with ``done`` of
    each; last: model and y (Y,) of the last state, if compiled; given: unknowns (N,) of the first state,
    where they were given and are an equilibrium.
    """

    def __init__(self, watch: Watch, factors: Array, progress: Progress | None) -> None:
        self.watch, self.work, self.factors, self.progress = watch, watch.work, factors, progress
        self.pieces: list[tuple[dict[str, Any], Later]] = []
        self.waiting: list[tuple[Point, float]] = []
        self.states, self.done = 0, 0.0
        self.follower: Follower | None = None
        self.history: list[tuple[float, ...]] = []
        self.given: Array | None = None
        self.last: tuple[Reduced, Array] | None = None

    def begin(self, start: Array | None) -> None:
        """The first state, and on the elements all those up to where something happens."""
        if isinstance(self.work, Elements):
            if start is not None:
                newton = equilibrium(self.work, start)
                self.given = start if len(newton.norms) == 1 else None
                self._run(self.work, self.work.y(newton.z))
            elif not self.work.system.is_preloaded:
                self.given = self.work.system.rest  # reactions at rest are none, not their round-off
                self._run(self.work, at_rest(self.work.model))
            elif (y := self.work.grown()) is not None:
                self._run(self.work, y)
        if self.states == 0:
            point, norms = first_point(self.watch, start)
            self.follower = Follower(self.watch, point, norms)
            self._keep([point], [0.0])
            if isinstance(self.work, Elements):
                self._run(self.work, self.work.y(point.z))

    def advance(self) -> str:
        """One increment in steps, and on the elements on from there; returns why it failed, or nothing."""
        if self.follower is None:
            self.follower = Follower(self.watch, self._point(self.states - 1), ())
        follower, known, before = self.follower, len(self.follower.points), self.done - self.follower.done[-1]
        message = follower.advance(float(self.factors[self.states]))
        self._keep(follower.points[known:], [before + done for done in follower.done[known:]])
        if message:
            while self.states > 1 and not self.watch.is_resolved(self._point(self.states - 1)):
                self.states -= 1
        else:
            self.work.counters.increments += 1
            if isinstance(self.work, Elements):
                self._run(self.work, self.work.y(follower.here.z))
        return message

    def _run(self, work: Elements, y: Array) -> None:
        """Go on from a state (Y,) of the first row or the last one, compiled."""
        known = min(self.states, 1)
        factors = self.factors[self.states - known :]
        answer = work.run(factors, y)
        count = len(answer.y)
        if count <= known:
            return
        self._flush()
        answer = answer.rows(slice(known, count))
        rows = by_state(work.model, factors[known:count], answer._replace(done=answer.done + self.done))
        self.pieces.append((rows, Later(partial(work.z, answer.y, answer.reaction))))
        self.done += float(answer.done[-1])
        self.last = work.model, answer.y[-1]
        work.counters.increments += count - 1
        self._count(count - known)
        if self.follower is not None:
            self.history += self.follower.history
            self.follower = None

    def _keep(self, points: Sequence[Point], done: Sequence[float]) -> None:
        self.waiting += zip(points, done, strict=True)
        self.last = None
        self.done = done[-1] if done else self.done
        self._count(len(points))

    def _count(self, more: int) -> None:
        """More states, those of the increments told to the progress."""
        if self.progress is not None:
            for state in range(max(self.states, 1), self.states + more):
                self.progress(state, len(self.factors) - 1)
        self.states += more

    def _flush(self) -> None:
        if self.waiting:
            points, done = zip(*self.waiting, strict=True)
            self.pieces.append((self.work.rows(points, done), Later(np.array([p.z for p in points]).copy)))
            self.waiting.clear()

    def _z(self) -> Array:
        """z of all states (S, N)."""
        self._flush()
        return joined([z for _, z in self.pieces])

    def _rows(self, name: str) -> Array:
        """What a ``Path`` has by state, of that name."""
        parts = [rows[name] for rows, _ in self.pieces]
        return (parts[0] if len(parts) == 1 else np.concatenate(parts))[: self.states]

    def _point(self, state: int) -> Point:
        """A state as a point to go on from."""
        z, factor = self._z()[state], float(self._rows("load_factor")[state])
        try:
            return stand(self.work, z, factor, self.work.evaluate(z, factor))
        except np.linalg.LinAlgError as error:
            raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error

    def path(self, message: str) -> Path:
        """What was followed, told what it is watched for."""
        self._flush()
        names = self.pieces[0][0].keys() - {"unknowns"}
        rows: dict[str, Any] = {name: self._rows(name) for name in names}
        pieces = [rows["unknowns"] for rows, _ in self.pieces]
        rows["unknowns"] = Later(partial(_states, pieces, self.states, self.given), self.last)
        if self.given is not None:
            system = self.work.system
            rows["reactions"][0] = self.given[system.drives.row]
            rows["poses"][0] = self.given[system.layout.poses]
        history = [*self.history, *([] if self.follower is None else self.follower.history)]
        return self.watch.path(rows, message, [norms for norms in history if norms])


def _states(pieces: Sequence[Later], count: int, given: Array | None) -> Array:
    """The unknowns of the first ``count`` states of several pieces, the very first as it was given."""
    states = joined(pieces)[:count]
    if given is not None:
        states[0] = given
    return states
