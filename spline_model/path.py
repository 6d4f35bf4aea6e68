"""Following an equilibrium path in the load factor: predict, correct, check, halve."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import asdict

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import left_the_branch, refuse
from spline_model.compile import System
from spline_model.newton import Newton, Workspace, solve
from spline_model.preload import settle
from spline_model.solution import Path, Status

Array = NDArray[np.float64]

KNOWN_STATES = 3
"""States that the predictor looks back on."""
SMALLEST_STEP = 2.0**-10
"""Least fraction of an increment before the path is given up."""


def follow(
    system: System,
    load_factors: Sequence[float],
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Solve the scene at each load factor in turn, from rest at load factor 0.

    An increment whose Newton fails, or whose solution does not pass the checks, is taken
    in halves; when a part below SMALLEST_STEP still fails, the path ends with its last
    good state and the reason.
    """
    work = Workspace.of(system)
    follower = _Follower(work)
    message = ""
    for i, target in enumerate(load_factors):
        message = follower.advance(float(target))
        if message:
            break
        work.counters.increments += 1
        if progress is not None:
            progress(i + 1, len(load_factors))
    return Path(
        status=Status.NOT_CONVERGED if message else Status.CONVERGED,
        message=message,
        load_factor=np.array(follower.load_factors),
        states=np.array(follower.states),
        rates=np.array(follower.rates),
        energies=np.array(follower.energies),
        counters=asdict(work.counters),
        history=tuple(follower.history),
    )


class _Follower:
    """The state of a path while it is followed; the lists hold the states that were asked for."""

    def __init__(self, work: Workspace) -> None:
        self.work = work
        self.force = _load_rate(work.system)
        start = settle(work)
        self.at = 0.0
        self.z = start.z
        self.rate = work.solve(self.force)
        self.known: deque[tuple[float, Array, Array]] = deque([(0.0, self.z, self.rate)], maxlen=KNOWN_STATES)
        self.load_factors = [0.0]
        self.states = [start.z]
        self.rates = [self.rate]
        self.energies = [start.energies]
        self.history = [start.norms]

    def advance(self, target: float) -> str:
        """Go on to ``target`` and keep its state; returns why it failed, or nothing."""
        whole = target - self.at
        if len(self.known) > 1 and whole * (self.at - self.known[-2][0]) < 0:
            self.known = deque([self.known[-1]], maxlen=KNOWN_STATES)  # the path turns back
        step, begin = whole, self.at
        while True:
            last = abs(target - self.at) <= abs(step) * (1 + 1e-9)
            newton, reason = self._try(target if last else self.at + step)
            self.history.append(newton.norms)
            if reason:
                self.work.counters.halved_increments += 1
                step /= 2
                if abs(step) < SMALLEST_STEP * abs(whole):
                    return f"stopped between load factor {self.at:.6g} and {self.at + 2 * step:.6g}: {reason}"
                continue
            if last:
                break
            # after an easy part the next may be twice as long, on the grid of halves
            done = abs(self.at - begin) / abs(whole)
            if (done / abs(step / whole)) % 2 == 0 and abs(step) < abs(whole):
                step *= 2
        self.load_factors.append(target)
        self.states.append(self.z)
        self.rates.append(self.rate)
        self.energies.append(newton.energies)
        return ""

    def _try(self, load_factor: float) -> tuple[Newton, str]:
        """One step to ``load_factor``; on success the follower stands there."""
        predicted = self._predict(load_factor)
        newton = solve(self.work, predicted, load_factor)
        system = self.work.system
        reason = newton.reason or refuse(system, newton.z)
        reason = reason or left_the_branch(system, self.z, predicted, newton.z)
        if reason:
            return newton, reason
        try:
            rate = self.work.solve(self.force)
        except np.linalg.LinAlgError as error:
            return newton, str(error)
        self.at, self.z, self.rate = load_factor, newton.z, rate
        self.known.append((load_factor, newton.z, rate))
        return newton, ""

    def _predict(self, load_factor: float) -> Array:
        """Extrapolate the last states and rates; further than twice their distance, the tangent only."""
        known = list(self.known)
        if len(known) > 1 and abs(load_factor - self.at) > 2 * abs(self.at - known[-2][0]):
            known = known[-1:]
        return hermite_extrapolation(known, load_factor)


def hermite_extrapolation(known: Sequence[tuple[float, Array, Array]], at: float) -> Array:
    """The polynomial through (place, value, slope) triples, evaluated at a place, values (N,).

    Newton's divided differences with every node doubled: degree 2 k - 1 for k triples. Three
    of them halve the Newton iterations of a smooth path against two.
    """
    nodes = [place for place, _, _ in known for _ in range(2)]
    table = [value for _, value, _ in known for _ in range(2)]
    result, weight = table[0], 1.0
    for order in range(1, len(nodes)):
        weight = weight * (at - nodes[order - 1])
        table = [
            known[i // 2][2]
            if nodes[i + order] == nodes[i]
            else (table[i + 1] - table[i]) / (nodes[i + order] - nodes[i])
            for i in range(len(nodes) - order)
        ]
        result = result + weight * table[0]
    return np.asarray(result)


def _load_rate(system: System) -> Array:
    """Minus the derivative of the residual in the load factor, shape (N,)."""
    force = np.zeros(system.layout.size)
    drives, loads = system.tables.drives, system.tables.loads
    force[drives.row] = -drives.target
    np.add.at(force, loads.coordinate, loads.value)
    return force
