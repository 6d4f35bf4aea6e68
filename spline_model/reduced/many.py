"""Many pivots of one kind, one path each, in one compiled loop; and the largest strain of a state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.reduced.equilibrium import ITERATIONS
from spline_model.reduced.model import Reduced, values_at
from spline_model.reduced.path import follow
from spline_model.strip.compiled import kernel
from spline_model.strip.element import place_points

Array = NDArray[np.float64]


class Designs(NamedTuple):
    """What tells D pivots of S straight strips from one another.

    length (D,) [m] and energy (D,) [J], their units; root, tip (D, S, 3) as in ``Strips``; compliance (D,)
    of the strips, EI / (EA L^2); centre (D, 2) of the body over the length; rotation (D,) [rad].
    """

    length: Array
    energy: Array
    root: Array
    tip: Array
    compliance: Array
    centre: Array
    rotation: Array


class Stations(NamedTuple):
    """Derivatives of the basis at P stations, d1, d2 (n, P), in the order of elimination; axial modes (K, P).

    work (5, P): what a strip's evaluation fills.
    """

    d1: Array
    d2: Array
    modes: Array
    work: Array


def stations_of(model: Reduced, stations: Array) -> Stations:
    """Tables at the stations u in [0, 1], with working arrays of their own."""
    scene, order = model.system.scene, model.shape.order
    basis, mine = scene.strips[0].basis, scene.strips[0].name
    parts = [values_at(e.modes, stations) for e in scene.of(MixedStretching) if e.strip == mine]
    modes = np.column_stack(parts)
    d1, d2 = (np.ascontiguousarray(basis.evaluate(stations, k)[:, order].T) for k in (1, 2))
    axial = np.ascontiguousarray((modes @ model.to_modes[0]).T)
    return Stations(d1=d1, d2=d2, modes=axial, work=np.zeros((5, len(stations))))


@kernel()
def take_design(i, designs, soft, bodies, strips, route, start):
    """Put the i-th design's numbers into the bodies, strips and route, and its rest into start (Y,).

    soft (K,): which axial forces are the stretching's, the others keep their compliance.
    """
    modes = strips.compliance.shape[1]
    count = strips.roots.size
    own = (start.size - 3) // count - modes
    points = own // 2 + 3
    for k in range(2):
        bodies.rest[k] = start[k] = designs.centre[i, k]
    route.target[0] = designs.rotation[i]
    for s in range(count):
        at = 3 + s * (own + modes)
        for k in range(3):
            strips.root[s, k], strips.tip[s, k] = designs.root[i, s, k], designs.tip[i, s, k]
        for k in range(soft.size):
            if soft[k]:
                strips.compliance[s, k] = designs.compliance[i]
                if strips.coupled == 0:
                    strips.gain[s, k] = 1.0 / designs.compliance[i]
        for p in range(points - 4):
            u = (p + 2) / (points - 1)
            for k in range(2):
                end = designs.centre[i, k] + designs.tip[i, s, k]
                start[at + 2 * p + k] = designs.root[i, s, k] + u * (end - designs.root[i, s, k])


@kernel()
def largest_strain(y, depth, strips, local, stations):
    """Largest |N / (EA)| + |M| d / (2 EI) over the strips' stations; depth d of the sections over L.

    Plane sections: M = EI theta' / L, N the mixed form's axial force, slide modes included, as in
    ``sections``.
    """
    modes, count = strips.compliance.shape[1], strips.roots.size
    own = (y.size - 3) // count - modes
    x1, y1, x2, y2, force = stations.work
    largest = 0.0
    for s in range(count):
        at = 3 + s * (own + modes)
        place_points(s, y[at : at + own], y, strips, local)
        for p in range(force.size):
            x1[p] = y1[p] = x2[p] = y2[p] = force[p] = 0.0
        for i in range(stations.d1.shape[0]):
            d1, d2 = stations.d1[i], stations.d2[i]
            px, py = local.points[s, 2 * i], local.points[s, 2 * i + 1]
            for p in range(force.size):
                x1[p] += d1[p] * px
                y1[p] += d1[p] * py
                x2[p] += d2[p] * px
                y2[p] += d2[p] * py
        for k in range(modes):
            mode, a = stations.modes[k], y[at + own + k] * strips.compliance[s, 0]
            for p in range(force.size):
                force[p] += mode[p] * a
        for p in range(force.size):
            turning = (x1[p] * y2[p] - y1[p] * x2[p]) / (x1[p] * x1[p] + y1[p] * y1[p])
            largest = max(largest, abs(force[p]) + 0.5 * depth * abs(turning))
    return largest


@kernel()
def follow_share(
    begin, stride, rows, designs, soft, depth, stations, route, judged, preload, start, bodies, strips, shape,
    local, space, tolerance, answer, results,
):  # fmt: skip
    """Follow every ``stride``-th of the designs from ``begin`` on, filling ``rows`` (D,) of the results.

    judged and the rest as of ``follow``; depth (D,) of the sections over L, or (0,): no strain is asked for;
    results are the arrays of
    ``Batch``: states, centre, torque, stiffness, energy, strain, inertia, moment_defect, iterations.
    """
    states, centre, torque, stiffness, energy, strain, inertia, defect, iterations = results
    for i in range(begin, rows.size, stride):
        row = rows[i]
        take_design(i, designs, soft, bodies, strips, route, start)
        for k in range(answer.counters.size):
            answer.counters[k] = 0
        done = follow(start, route, judged, preload, bodies, strips, shape, local, space, tolerance, answer)
        states[row] = done
        iterations[row] = answer.counters[ITERATIONS]
        length, unit = designs.length[i], designs.energy[i]
        for k in range(done):
            centre[row, k, 0] = answer.y[k, 0] * length
            centre[row, k, 1] = answer.y[k, 1] * length
            torque[row, k], stiffness[row, k] = answer.reaction[k, 0] * unit, answer.stiffness[k] * unit
            inertia[row, k], defect[row, k] = answer.inertia[k], answer.defect[k]
            energy[row, k] = (answer.energies[k, 0] + answer.energies[k, 1]) * unit
            if depth.size > 0:
                strain[row, k] = largest_strain(answer.y[k], depth[i], strips, local, stations)
