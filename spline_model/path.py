"""An equilibrium path through given load factors, or in its arc length.

It begins at rest, weight and pre-strain grown from nothing, or at a state that is given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.followed import Followed, Point
from spline_model.continuation.follower import LARGEST_STEP, ArcFollower, Follower
from spline_model.continuation.points import reached, stand
from spline_model.continuation.watch import BRANCHES, Watch
from spline_model.errors import InvalidParameter, require_choice
from spline_model.newton import Newton, solve
from spline_model.reduced.elements import Elements, followed
from spline_model.solution import Later
from spline_model.static_answers import StaticSolution

Array = NDArray[np.float64]

MOST_STEPS = 2000
"""Steps of an arc length."""


def follow(
    system: System,
    load_factors: Sequence[float],
    *,
    start: Array | None = None,
    branch: str = "primary",
    method: str = "condensed",
) -> StaticSolution:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    method: "condensed" uses the strips' elements, if they support the scene; "multipliers" the bordered
    system of the paper. The methods agree to 1e-10. An increment whose Newton fails, or whose solution does
    not pass the checks, is taken in halves; if a part below SMALLEST_STEP still fails, the path ends with its
    last good state and the reason. start: unknowns (N,) of an equilibrium at load factor 0 from which the
    path starts instead of rest. branch: "primary" stays on the branch where another one crosses; "follow"
    leaves it there, along the critical mode.

    Raises
    ------
    InvalidParameter
        An unknown branch or method, or a scene that nothing holds.
    """
    require_choice("branch", branch, BRANCHES)
    work = followed(system, method)
    watch = Watch(work, leaves=branch == "follow", by_load=True)
    track = _Track(watch, np.array([0.0, *load_factors]))
    message = track.begin(start)
    while track.states < len(track.factors) and not message:
        message = track.advance()
    return track.path(message)


def follow_arc(
    system: System,
    end: float = 1.0,
    *,
    increments: int = 20,
    branch: str = "primary",
    method: str = "condensed",
) -> StaticSolution:
    """Return the path from rest until its load factor is ``end`` [1].

    The first step changes the load factor by 1 / increments of the way; later ones adapt to the convergence
    of Newton's method. The result has every accepted state. The load factor may decrease and increase again;
    ``end`` is where it is first reached. branch, method and errors as in ``follow``.
    """
    require_choice("branch", branch, BRANCHES)
    watch = Watch(followed(system, method), leaves=branch == "follow", by_load=False)
    point, norms, message = _first_point(watch)
    if message:
        rows = _first_rows(watch.work, point, message)
        return _path(watch, rows, message, [norms])
    way = abs(end - point.load_factor) / increments
    follower, message = ArcFollower(watch, point, norms, end, way), ""
    follower.first = follower.step = min(LARGEST_STEP, follower.step)
    for _ in range(MOST_STEPS):
        if follower.here.load_factor == end or message:
            break
        message = follower.go_on()
    else:
        message = f"load factor {end:g} is not reached in {MOST_STEPS} steps"
    rows = watch.work.rows(follower.points, follower.done)
    return _path(watch, rows, message, follower.history)


class _Track:
    """The states of a path: on the elements compiled while nothing happens, in steps where something does.

    pieces: rows by state; follower: of steps, None where the last states were compiled; given: unknowns (N,)
    of the first state, where they were given and are an equilibrium.
    """

    def __init__(self, watch: Watch, factors: Array) -> None:
        self.watch, self.work, self.factors = watch, watch.work, factors
        self.pieces: list[dict[str, Any]] = []
        self.states, self.done = 0, 0.0
        self.follower: Follower | None = None
        self.history: list[tuple[float, ...]] = []
        self.given: Array | None = None

    def begin(self, start: Array | None) -> str:
        """The first state, and on the elements all those up to where something happens; why it is none."""
        if (work := self._compiled) is not None:
            if start is not None:
                newton = equilibrium(work, start)
                self.given = start if len(newton.norms) == 1 else None
                self._run(work, work.y(newton.z))
            elif not work.system.is_preloaded:
                self.given = work.system.rest  # reactions at rest are none, not their round-off
                self._run(work, work.model.start)
            elif (y := work.grown()) is not None:
                self._run(work, y)
        if self.states == 0:
            point, norms, message = _first_point(self.watch, start)
            self.follower = Follower(self.watch, point, norms)
            self._keep(_first_rows(self.work, point, message), 0.0)
            if work is not None and not message:
                self._run(work, work.y(point.z))
            return message
        return ""

    def advance(self) -> str:
        """One increment in steps, and on the elements on from there; returns why it failed, or nothing."""
        if self.follower is None:
            self.follower = Follower(self.watch, self._point(self.states - 1), ())
        follower, known, before = self.follower, len(self.follower.points), self.done - self.follower.done[-1]
        message = follower.advance(float(self.factors[self.states]))
        if more := follower.points[known:]:
            done = [before + each for each in follower.done[known:]]
            self._keep(self.work.rows(more, done), done[-1])
        if not message:
            self.work.counters.increments += 1
            if (work := self._compiled) is not None:
                self._run(work, work.y(follower.here.z))
        return message

    @property
    def _compiled(self) -> Elements | None:
        """The elements, where kernels follow a path on them."""
        return self.work if isinstance(self.work, Elements) and self.work.compiled else None

    def _run(self, work: Elements, y: Array) -> None:
        """Go on from a state (Y,) of the first row or the last one, compiled."""
        known = min(self.states, 1)
        factors = self.factors[self.states - known :]
        answer = work.run(factors, y)
        count = len(answer.y)
        if count <= known:
            return
        answer = answer.rows(slice(known, count))
        answer = answer._replace(done=answer.done + self.done)
        self._keep(work.compiled_rows(factors[known:count], answer), float(answer.done[-1]))
        work.counters.increments += count - 1
        if self.follower is not None:
            self.history += self.follower.history
            self.follower = None

    def _keep(self, rows: dict[str, Any], done: float) -> None:
        """More states; done: work up to the last."""
        self.pieces.append(rows)
        self.done = done
        self.states += len(rows["done"])

    def _rows(self, name: str) -> Array:
        """What is known by state, of that name."""
        parts = [rows[name] for rows in self.pieces]
        return (parts[0] if len(parts) == 1 else np.concatenate(parts))[: self.states]

    def _point(self, state: int) -> Point:
        """A state as a point to go on from."""
        z, factor = self._rows("z")[state], float(self._rows("load_factor")[state])
        try:
            return stand(self.work, z, factor, self.work.evaluate(z, factor))
        except np.linalg.LinAlgError as error:
            raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error

    def path(self, message: str) -> StaticSolution:
        """What was followed, told what it is watched for."""
        rows = {name: self._rows(name) for name in self.pieces[0]}
        history = [*self.history, *([] if self.follower is None else self.follower.history)]
        return _path(self.watch, rows, message, [norms for norms in history if norms], self.given)


def _path(
    watch: Watch,
    rows: dict[str, Any],
    message: str,
    history: Sequence[tuple[float, ...]],
    given: Array | None = None,
) -> StaticSolution:
    """The result from rows by state, and why it ended early; given: unknowns (N,) of the first state."""
    work, z = watch.work, rows.pop("z")
    known = (work.model, work.y(z)) if isinstance(work, Elements) else ()
    rows["unknowns"] = Later(partial(_unknowns, work, z, given), *known)
    if given is not None:
        rows["reactions"][0] = given[work.system.drives.row]
        rows["poses"][0] = given[work.system.layout.poses]
    return watch.path(rows, message, history)


def _unknowns(work: Followed, z: Array, given: Array | None) -> Array:
    """The scene's unknowns (S, N) of all states, the first one as it was given."""
    states = work.unknowns(z)
    if given is not None:
        states[0] = given
    return states


def _first_rows(work: Followed, point: Point, message: str) -> dict[str, Any]:
    """What is known of a first state; with a message it is one without weight."""
    return (replace(work, grows=True) if message else work).rows([point], [0.0])


def equilibrium(work: Followed, unknowns: Array) -> Newton:
    """Return the equilibrium at load factor 0 that Newton finds from unknowns (N,) [m, rad, N], if it is
    valid.

    Raises
    ------
    InvalidParameter
        The unknowns lead to no such state.
    """
    newton = solve(work, work.state(unknowns), 0.0)
    reason = newton.reason or work.refuse(newton.z) or work.unresolved(newton.z, 0.0)
    if reason:
        raise InvalidParameter("start", reason, "a state from which Newton finds an equilibrium")
    return newton


def _first_point(watch: Watch, start: Array | None = None) -> tuple[Point, tuple[float, ...], str]:
    """Return the first point of a path, its residual norms [1], and a reason if weight cannot act in full.

    start: unknowns (N,) [m, rad, N]; None is rest. Weight and pre-strain grow from nothing, and the path is
    checked like any other. If they cannot act in full, the point is the shape at rest without them.

    Raises
    ------
    InvalidParameter
        There is no such point, or nothing holds the scene.
    """
    work, message = watch.work, ""
    if start is not None:
        newton = equilibrium(work, start)
        return _held(work, newton), newton.norms, ""
    z = work.state(work.system.rest)
    if work.system.is_preloaded:
        grown, message = _grown(watch)
        if message:
            return grown.points[0], grown.history[0], message
        z = grown.here.z
    newton = solve(work, z, 0.0)
    if newton.reason:
        raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")
    return _held(work, newton), newton.norms, ""


def _held(work: Followed, newton: Newton) -> Point:
    """The point where Newton ended; refused where nothing holds the scene."""
    point, reason = reached(work, newton)
    if point is None:
        raise InvalidParameter("scene", reason, "strips that can move, but not freely")
    return point


def _grown(watch: Watch) -> tuple[Follower, str]:
    """The path to full weight and pre-strain, and why it stopped; what it met is told to ``watch``."""
    growing = replace(watch.work, grows=True)
    own = Watch(growing, leaves=watch.leaves, by_load=True)
    newton = solve(growing, growing.state(growing.system.rest), 0.0)
    follower = Follower(own, _held(growing, newton), newton.norms)
    message = follower.advance(1.0)
    watch.settled = tuple(
        replace(each, load_factor=0.0, rotation=0.0 * each.rotation, preload=each.load_factor)
        for each in own.critical
    )
    watch.leaves, watch.before, watch.grown = own.leaves, own.remark(), follower.at
    return follower, message
