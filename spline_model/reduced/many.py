"""The paths of many designs of a mechanism in one compiled loop."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.frames import Frames
from spline_model.reduced.arrays import Arrays, Bodies, Route
from spline_model.reduced.equilibrium import ITERATIONS
from spline_model.reduced.numbers import Designs
from spline_model.reduced.path import follow
from spline_model.reduced.preload import Preload
from spline_model.strip.compiled import called, copy, kernel
from spline_model.strip.element import FORCE_AT, MOMENT_AT, Local, Shape, Strips
from spline_model.strip.ends import place_points
from spline_model.strip.points import forces_at

Array = NDArray[Any]


class Stations(NamedTuple):
    """P stations along the strips at which strains [1] are computed, in place of the Gauss points.

    along (D, S, P, 11 + K) as in ``Strips``, D = 0 if no strain is asked for; fibre (D, S, 2): strain of a
    force and of a moment; shape, local: of the stations.
    """

    along: Array
    fibre: Array
    shape: Shape
    local: Local


class Share(NamedTuple):
    """Part of the designs that one thread solves: every ``stride``-th from ``begin`` on, into ``rows`` (D,).

    force (D, 2, Q) load and weight, gain (D, S, K), as in ``Bodies`` and ``Strips``; preload: that of all
    designs, with D in front of curvature, numbers, bodies and hung; growing: the route along which weight and
    pre-strain grow first, without factors if there are none; place: of the reported body's pose; results: the
    dimensionless arrays of ``Batch``, states, centre, torque, stiffness, energy, strain, inertia,
    moment_defect, iterations.
    """

    rows: NDArray[np.int64]
    begin: int
    stride: int
    designs: Designs
    force: Array
    gain: Array
    preload: Preload
    stations: Stations
    growing: Route
    place: int
    results: tuple[NDArray[Any], ...]


@called()
def _strips_of(i, along, share, strips):
    """Strips of the i-th design, with what is along them."""
    designs = share.designs
    return Strips(
        along, designs.compliance[i], share.gain[i], designs.numbers[i], strips.roots, strips.tips,
        strips.split, strips.coupled, strips.outer, strips.measure,
    )  # fmt: skip


@called()
def _arrays_of(i, share, route, arrays):
    """The mechanism of the i-th design, and where it stands at the begin of the route."""
    designs, same = share.designs, arrays.bodies
    start = designs.start[i]
    for d in range(same.held.size):
        route.origin[d], route.target[d] = start[same.held[d]], designs.target[i, d]
    bodies = Bodies(
        start[: same.rest.size], share.force[i, 0], share.force[i, 1], same.free, same.held, same.driven,
        designs.springs[i], Frames(same.frames.place, designs.levers[i]),
    )  # fmt: skip
    strips = _strips_of(i, designs.along[i], share, arrays.strips)
    return Arrays(bodies, strips, arrays.shape, arrays.local, arrays.space)


@called()
def _largest_strain(i, y, poses, strips, stations):
    """Largest |N / (EA)| + |M| d / (2 EI) of the i-th design's strips, by parabolas between their stations.

    Plane sections.
    """
    shape, local = stations.shape, stations.local
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
def follow_all(share, route, judged, arrays, tolerance, answer):
    """Follow the paths of all designs of a share, as ``follow`` does that of a mechanism."""
    rows, designs, growing, place, stations = (
        share.rows, share.designs, share.growing, share.place, share.stations
    )  # fmt: skip
    states, centre, torque, stiffness, energy, strain, inertia, defect, iterations = share.results
    driven, poses, whole = arrays.bodies.driven, arrays.bodies.rest.size, share.preload
    for i in range(share.begin, rows.size, share.stride):
        row, own = rows[i], _arrays_of(i, share, route, arrays)
        preload = Preload(
            whole.curvature[i], whole.numbers[i], whole.bodies[i], whole.hung[i], whole.change, whole.push,
            whole.out,
        )  # fmt: skip
        for k in range(answer.counters.size):
            answer.counters[k] = 0
        copy(designs.start[i], answer.y[0])  # what is at rest stays with the bodies
        done, stands = 0, True
        for grows in (True, False):
            leg = growing if grows else route
            if stands and leg.factor.size > 0:
                done = follow(answer.y[0], leg, judged, preload, own, tolerance, answer)
                if grows:
                    stands, done = done == leg.factor.size, 0
                    copy(answer.y[1], answer.y[0])
        states[row] = done
        iterations[row] = answer.counters[ITERATIONS]
        length, unit = designs.length[i], designs.energy[i]
        for k in range(done):
            centre[row, k, 0] = answer.y[k, place] * length
            centre[row, k, 1] = answer.y[k, place + 1] * length
            torque[row, k] = answer.reaction[k, driven] * unit
            stiffness[row, k] = answer.stiffness[k] * unit
            inertia[row, k], defect[row, k] = answer.inertia[k], answer.defect[k]
            energy[row, k] = (answer.energies[k, 0] + answer.energies[k, 1]) * unit
            if stations.along.size > 0:
                strips = _strips_of(i, stations.along[i], share, arrays.strips)
                strain[row, k] = _largest_strain(i, answer.y[k], poses, strips, stations)
