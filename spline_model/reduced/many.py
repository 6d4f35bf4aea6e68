"""Paths as Python asks for them: that of a mechanism, or of many designs of it in one compiled loop."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.reduced.arrays import Route
from spline_model.reduced.equilibrium import ITERATIONS
from spline_model.reduced.model import Reduced
from spline_model.reduced.numbers import in_order
from spline_model.reduced.path import follow
from spline_model.strip.compiled import called, copy, kernel
from spline_model.strip.element import CURVATURE, MODES, ON_POINTS, POINTS, SPEED
from spline_model.strip.ends import place_points

Array = NDArray[np.float64]


class Designs(NamedTuple):
    """What tells D designs from one another, over the length (D,) [m] and energy (D,) [J] of each.

    factor (D, S, 6): of J0, stress-free curvature, EI, the numbers of ``curl_law`` and modes; numbers (D, S,
    15 + 2 n) and compliance (D, S, K) as in ``Strips``; start (D, Y): at rest; force (D, 2, 3 B): load and
    weight as in ``Bodies``; target (D, H): change of the held coordinates.
    """

    length: Array
    energy: Array
    factor: Array
    numbers: Array
    compliance: Array
    start: Array
    force: Array
    target: Array


class Stations(NamedTuple):
    """Derivatives of the basis at P stations, d1, d2 (n, P), in the order of elimination; axial modes (K, P).

    work (5, P): what a strip's evaluation fills.
    """

    d1: Array
    d2: Array
    modes: Array
    work: Array

    @classmethod
    def of(cls, model: Reduced, stations: Array) -> Self:
        """Tables at the stations u in [0, 1], with working arrays of their own."""
        scene = model.system.scene
        basis, mine = scene.strips[0].basis, scene.strips[0].name
        parts = [e.modes.evaluate(stations) for e in scene.of(MixedStretching) if e.strip == mine]
        modes = np.column_stack(parts) if parts else np.zeros((len(stations), 0))
        tables = (in_order(basis.evaluate(stations, k)[..., None], model.shape)[..., 0] for k in (1, 2))
        d1, d2 = (np.ascontiguousarray(table.T) for table in tables)
        axial = np.ascontiguousarray((modes @ model.to_modes[0]).T)
        return cls(d1=d1, d2=d2, modes=axial, work=np.zeros((5, len(stations))))


class Share(NamedTuple):
    """What one thread does of many designs: every ``stride``-th from ``begin`` on, into ``rows`` (D,).

    growing: the route along which weight and pre-strain come on first, without factors where there are none;
    place: of the reported body's pose; depth (D,) of the sections over L, or (0,): no strain is asked for;
    along, curved: of the mechanism itself; results: the arrays of ``Batch``, states, centre, torque,
    stiffness, energy, strain, inertia, moment_defect, iterations.
    """

    rows: NDArray[np.int64]
    begin: int
    stride: int
    designs: Designs
    depth: Array
    stations: Stations
    growing: Route
    place: int
    along: Array
    curved: Array
    results: tuple[NDArray[Any], ...]

    @classmethod
    def none(cls) -> Self:
        """That of a path without any design but the mechanism itself."""
        line, table, block = (np.zeros((0,) * axes) for axes in (1, 2, 3))
        places, inertia = np.zeros(0, dtype=np.int64), np.zeros((0, 0), dtype=np.int64)
        results = places, block, table, table, table, table, inertia, table, places
        designs = Designs(line, line, block, block, block, table, block, table)
        stations, growing = Stations(table, table, table, table), Route(line, line, line, 0.0)
        return cls(places, 0, 1, designs, line, stations, growing, 0, block, block, results)


@called()
def _take_design(i, designs, along, curved, preload, bodies, strips, route, local):
    """Put the i-th design's numbers where a path takes them from; along, curved: of the mechanism itself.

    curved (2, S, G): its curvatures as in ``Preload``.
    """
    start, hung, fallen = designs.start[i], 0.0, 0.0
    for d in range(bodies.held.size):
        route.origin[d], route.target[d] = start[bodies.held[d]], designs.target[i, d]
    for k in range(bodies.rest.size):
        bodies.rest[k], bodies.load[k] = start[k], designs.force[i, 0, k]
        bodies.weight[k] = preload.bodies[k] = designs.force[i, 1, k]
        fallen += bodies.weight[k] * start[k]
    modes, own = strips.compliance.shape[1], strips.numbers.shape[1] - ON_POINTS - 6
    for s in range(strips.roots.size):
        factor = designs.factor[i, s]
        for k in range(strips.numbers.shape[1]):
            strips.numbers[s, k] = preload.numbers[s, k] = designs.numbers[i, s, k]
        for k in range(modes):
            strips.compliance[s, k] = designs.compliance[i, s, k]
            if k >= strips.coupled:
                strips.gain[s, k] = 1.0 / designs.compliance[i, s, k]
        for p in range(strips.along.shape[1]):
            for k in range(2):
                preload.curvature[k, s, p] = curved[k, s, p] * factor[CURVATURE]
            for k in range(strips.along.shape[2]):
                strips.along[s, p, k] = along[s, p, k] * factor[min(k, MODES)]
        at = bodies.rest.size + s * (own + modes)
        place_points(s, start[at : at + own], start, strips, local)
        for k in range(own + 6):
            hung += strips.numbers[s, ON_POINTS + k] * local.nodal[s, POINTS, k]
    preload.hung[0], preload.hung[1] = hung, hung + fallen


@called()
def _largest_strain(y, poses, depth, along, strips, local, stations):
    """Largest |N / (EA)| + |M| d / (2 EI) of straight strips, by parabolas between their stations; depth d of
    the sections over L.

    Plane sections: M = EI (theta' / J0 - kappa_0), N the mixed form's axial force, slide modes included, as
    in ``sections``. along: of the mechanism, whose first strip the stations' modes belong to.
    """
    modes, count = strips.compliance.shape[1], strips.roots.size
    own = (y.size - poses) // count - modes
    x1, y1, x2, y2, force = stations.work
    largest = 0.0
    for s in range(count):
        at, speed = poses + s * (own + modes), strips.along[s, 0, SPEED]
        natural, shorter = strips.along[s, 0, CURVATURE], math.sqrt(along[0, 0, SPEED] / speed)
        place_points(s, y[at : at + own], y, strips, local)
        for p in range(force.size):
            x1[p] = y1[p] = x2[p] = y2[p] = force[p] = 0.0
        for i in range(stations.d1.shape[0]):
            d1, d2 = stations.d1[i], stations.d2[i]
            px, py = local.nodal[s, POINTS, 2 * i], local.nodal[s, POINTS, 2 * i + 1]
            for p in range(force.size):
                x1[p] += d1[p] * px
                y1[p] += d1[p] * py
                x2[p] += d2[p] * px
                y2[p] += d2[p] * py
        for k in range(modes):
            mode, a = stations.modes[k], y[at + own + k] * strips.compliance[s, 0] * shorter
            for p in range(force.size):
                force[p] += mode[p] * a
        for p in range(force.size):
            turning = (x1[p] * y2[p] - y1[p] * x2[p]) / (x1[p] * x1[p] + y1[p] * y1[p])
            force[p] = abs(force[p]) + 0.5 * depth * abs(turning / speed - natural)
            largest = max(largest, force[p])
        for p in range(1, force.size - 1):
            bend = force[p - 1] - 2.0 * force[p] + force[p + 1]
            if bend < 0.0 and force[p] >= max(force[p - 1], force[p + 1]):
                largest = max(largest, force[p] - (force[p + 1] - force[p - 1]) ** 2 / (8.0 * bend))
    return largest


@kernel()
def follow_all(share, start, route, judged, preload, arrays, tolerance, answer):
    """Follow a path, as ``follow`` does; or those of all designs of a share, where it has any."""
    rows, designs, growing, depth, place = share.rows, share.designs, share.growing, share.depth, share.place
    if rows.size == 0:
        return follow(start, route, judged, preload, arrays, tolerance, answer)
    bodies, strips, local = arrays.bodies, arrays.strips, arrays.local
    states, centre, torque, stiffness, energy, strain, inertia, defect, iterations = share.results
    for i in range(share.begin, rows.size, share.stride):
        row = rows[i]
        _take_design(i, designs, share.along, share.curved, preload, bodies, strips, route, local)
        for k in range(answer.counters.size):
            answer.counters[k] = 0
        begin, stands = designs.start[i], True
        if growing.factor.size > 0:
            done = follow(begin, growing, judged, preload, arrays, tolerance, answer)
            stands = done == growing.factor.size
            copy(answer.y[1], begin)
        done = 0
        if stands:
            done = follow(begin, route, judged, preload, arrays, tolerance, answer)
        states[row] = done
        iterations[row] = answer.counters[ITERATIONS]
        length, unit = designs.length[i], designs.energy[i]
        for k in range(done):
            centre[row, k, 0] = answer.y[k, place] * length
            centre[row, k, 1] = answer.y[k, place + 1] * length
            torque[row, k] = answer.reaction[k, bodies.driven] * unit
            stiffness[row, k] = answer.stiffness[k] * unit
            inertia[row, k], defect[row, k] = answer.inertia[k], answer.defect[k]
            energy[row, k] = (answer.energies[k, 0] + answer.energies[k, 1]) * unit
            if depth.size > 0:
                poses = bodies.rest.size
                strain[row, k] = _largest_strain(
                    answer.y[k], poses, depth[i], share.along, strips, local, share.stations
                )
    return 0
