"""The paths of many designs of a mechanism in one compiled loop."""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.reduced.arrays import Arrays, Route
from spline_model.reduced.equilibrium import ITERATIONS
from spline_model.reduced.numbers import Designs
from spline_model.reduced.path import follow
from spline_model.strip.compiled import called, copy, kernel
from spline_model.strip.element import (
    CURVATURE,
    FORCE_AT,
    MOMENT_AT,
    ON_POINTS,
    POINTS,
    Local,
    Shape,
    Strips,
)
from spline_model.strip.ends import place_points
from spline_model.strip.points import forces_at

Array = NDArray[Any]


class Stations(NamedTuple):
    """P stations along the strips at which strains [1] are computed, in place of the Gauss points.

    along (D, S, P, 11 + K) as in ``Strips``; fibre (D, S, 2): strain of a force and of a moment; strips,
    shape, local: of the stations, the former with the numbers of the design at hand.
    """

    along: Array
    fibre: Array
    strips: Strips
    shape: Shape
    local: Local

    @classmethod
    def none(cls, arrays: Arrays) -> Self:
        """Those of paths of which no strain is asked for."""
        along, fibre = np.zeros((0, 0, 0, 0)), np.zeros((0, 0, 0))
        return cls(along, fibre, arrays.strips, arrays.shape, arrays.local)


class Share(NamedTuple):
    """Part of the designs that one thread solves: every ``stride``-th from ``begin`` on, into ``rows`` (D,).

    growing: the route along which weight and pre-strain grow first, without factors if there are none; place:
    of the reported body's pose; stations: without ``along`` if no strain is computed; results: the
    dimensionless arrays of ``Batch``, states, centre, torque, stiffness, energy, strain, inertia,
    moment_defect, iterations.
    """

    rows: NDArray[np.int64]
    begin: int
    stride: int
    designs: Designs
    stations: Stations
    growing: Route
    place: int
    results: tuple[NDArray[Any], ...]


@called()
def _take_design(i, designs, preload, bodies, strips, route, local):
    """Put the i-th design's numbers where a path takes them from."""
    start, hung, fallen = designs.start[i], 0.0, 0.0
    for d in range(bodies.held.size):
        route.origin[d], route.target[d] = start[bodies.held[d]], designs.target[i, d]
    for k in range(bodies.rest.size):
        bodies.rest[k], bodies.load[k] = start[k], designs.force[i, 0, k]
        bodies.weight[k] = preload.bodies[k] = designs.force[i, 1, k]
        fallen += bodies.weight[k] * start[k]
    for k in range(bodies.springs.shape[0]):
        copy(designs.springs[i, k], bodies.springs[k])
    for f in range(bodies.frames.place.shape[0]):
        copy(designs.levers[i, f], bodies.frames.lever[f])
    modes, own = strips.compliance.shape[1], strips.numbers.shape[1] - ON_POINTS - 6
    for s in range(strips.roots.size):
        for k in range(strips.numbers.shape[1]):
            strips.numbers[s, k] = preload.numbers[s, k] = designs.numbers[i, s, k]
        for k in range(modes):
            strips.compliance[s, k] = designs.compliance[i, s, k]
            if k >= strips.coupled:
                strips.gain[s, k] = 1.0 / designs.compliance[i, s, k]
        for p in range(strips.along.shape[1]):
            copy(designs.along[i, s, p], strips.along[s, p])
            preload.curvature[0, s, p] = designs.rest[i, s, p]
            preload.curvature[1, s, p] = strips.along[s, p, CURVATURE]
        at = bodies.rest.size + s * (own + modes)
        place_points(s, start[at : at + own], start, strips, local)
        for k in range(own + 6):
            hung += strips.numbers[s, ON_POINTS + k] * local.nodal[s, POINTS, k]
    preload.hung[0], preload.hung[1] = hung, hung + fallen


@called()
def _largest_strain(i, y, poses, stations):
    """Largest |N / (EA)| + |M| d / (2 EI) of the i-th design's strips, by parabolas between their stations.

    Plane sections.
    """
    strips, shape, local = stations.strips, stations.shape, stations.local
    modes, count = strips.compliance.shape[1], strips.roots.size
    own = (y.size - poses) // count - modes
    largest = 0.0
    for s in range(count):
        by_force, by_moment = stations.fibre[i, s, 0], stations.fibre[i, s, 1]
        at = poses + s * (own + modes)
        place_points(s, y[at : at + own], y, strips, local)
        forces_at(s, y[at + own : at + own + modes], strips, shape, local)
        strain, moment = local.lanes[s, FORCE_AT], local.lanes[s, MOMENT_AT]
        for p in range(strain.size):
            strain[p] = by_force * abs(strain[p]) + by_moment * abs(moment[p])
            largest = max(largest, strain[p])
        for p in range(1, strain.size - 1):
            bend = strain[p - 1] - 2.0 * strain[p] + strain[p + 1]
            if bend < 0.0 and strain[p] >= max(strain[p - 1], strain[p + 1]):
                largest = max(largest, strain[p] - (strain[p + 1] - strain[p - 1]) ** 2 / (8.0 * bend))
    return largest


@kernel()
def follow_all(share, route, judged, preload, arrays, tolerance, answer):
    """Follow the paths of all designs of a share, as ``follow`` does that of a mechanism."""
    rows, designs, growing, place = share.rows, share.designs, share.growing, share.place
    bodies, strips, local, stations = arrays.bodies, arrays.strips, arrays.local, share.stations
    states, centre, torque, stiffness, energy, strain, inertia, defect, iterations = share.results
    for i in range(share.begin, rows.size, share.stride):
        row = rows[i]
        _take_design(i, designs, preload, bodies, strips, route, local)
        for k in range(answer.counters.size):
            answer.counters[k] = 0
        begin, stands = designs.start[i], True
        if growing.factor.size > 0:
            done = follow(begin, growing, judged, preload, arrays, tolerance, answer)
            stands = done == growing.factor.size
            copy(answer.y[1], begin)
        if stations.along.size > 0:
            for s in range(strips.roots.size):
                for p in range(stations.along.shape[2]):
                    copy(stations.along[i, s, p], stations.strips.along[s, p])
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
            if stations.along.size > 0:
                strain[row, k] = _largest_strain(i, answer.y[k], bodies.rest.size, stations)
