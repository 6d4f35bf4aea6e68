"""Weight and pre-strain as they grow: what acts at a share of them, and what a little more of it does."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import Bending
from spline_model.reduced.assembly import AXIAL, BENDING, Bodies, move_strips, place_of, solve_free
from spline_model.reduced.model import Reduced
from spline_model.strip.compiled import kernel
from spline_model.strip.element import Strips, to_ends
from spline_model.strip.laws import MATERIAL
from spline_model.strip.points import visit_points

Array = NDArray[np.float64]


class Preload(NamedTuple):
    """All of the weight and pre-strain of a mechanism, and scratch for their derivatives.

    rest (S, G) curvature at rest; curvature, strain, dead, weight as in ``Strips``, bodies (Q,) as in
    ``Bodies``; hung: energy of ``dead`` at rest, to be subtracted, and fallen: with that of the bodies;
    gradient (S, 2 n) and gap (S, K): derivatives of those in the share; push (Y,): that of the residual
    in w, a and the poses; out (5,).
    """

    rest: Array
    curvature: Array
    strain: Array
    dead: Array
    weight: Array
    bodies: Array
    hung: float
    fallen: float
    gradient: Array
    gap: Array
    push: Array
    out: Array


def preload_of(model: Reduced) -> Preload:
    """What the mechanism is preloaded by."""
    strips, bodies, system = model.strips, model.bodies, model.system
    gauss, place = len(model.shape.weight), {e.strip: i for i, e in enumerate(system.scene.of(Bending))}
    rows = [np.arange(place[s.name] * gauss, (place[s.name] + 1) * gauss) for s in system.scene.strips]
    points = np.array([s.control_points[model.shape.order].ravel() for s in system.scene.strips])
    hung = float((strips.dead * points).sum() / model.length)
    return Preload(
        rest=system.rest_curvature[np.array(rows)] * model.length,
        curvature=strips.curvature,
        strain=strips.strain,
        dead=strips.dead,
        weight=strips.weight,
        bodies=bodies.weight,
        hung=hung,
        fallen=hung + float(bodies.weight[: len(bodies.rest)] @ bodies.rest),
        gradient=np.zeros_like(strips.dead),
        gap=np.zeros(strips.compliance.shape),
        push=np.zeros(model.size),
        out=np.zeros(5),
    )


def apart(model: Reduced) -> tuple[Bodies, Strips]:
    """Bodies and strips whose weight and pre-strain may be overwritten by ``act``."""
    strips = model.strips
    own = {name: getattr(strips, name).copy() for name in ("curvature", "strain", "dead", "weight")}
    return model.bodies._replace(weight=model.bodies.weight.copy()), strips._replace(**own)


@kernel()
def act(share, preload, bodies, strips):
    """Let a share of weight and pre-strain act."""
    for s in range(strips.roots.size):
        for p in range(strips.curvature.shape[1]):
            rest = preload.rest[s, p]
            strips.curvature[s, p] = rest + share * (preload.curvature[s, p] - rest)
        for i in range(strips.dead.shape[1]):
            strips.dead[s, i] = share * preload.dead[s, i]
        strips.strain[s] = share * preload.strain[s]
        strips.weight[s, 0] = share * preload.weight[s, 0]
        strips.weight[s, 1] = share * preload.weight[s, 1]
    for i in range(bodies.weight.size):
        bodies.weight[i] = share * preload.bodies[i]


@kernel()
def forward(own, last, end, coupled, outer, gain, h, b, gap, g):
    """Eliminate a right-hand side, g of w and the ends and gap of a, as the strip was condensed."""
    for k in range(gap.size):
        for i in range(end):
            if i < own or i >= last:
                g[i] += gain[k] * gap[k] * b[k, i]
    for k in range(coupled):
        g[end if k < outer else own + k - outer] = gap[k]
    for i in range(last):
        factor = g[i] / h[i, i]
        for j in range(i + 1, end + outer):
            g[j] -= factor * h[i, j]


@kernel()
def swell(y, share, preload, bodies, strips, shape, local, space):
    """Rate of a state, just solved, in the share, in ``space``; first and second derivative of its potential.

    Energies are squares of the share, so that differences over a whole share are exact. The state is
    condensed as ``assemble`` left it, its gradients are overwritten.
    """
    n, modes, poses = shape.order.size, strips.compliance.shape[1], bodies.rest.size
    own, inner = 2 * n - 6, strips.coupled - strips.outer
    push, gap, out = preload.push, preload.gap, preload.out
    slope, bend = preload.hung, -8.0 * (space.out[BENDING] + space.out[AXIAL])
    for side in range(2):
        sign = 1.0 - 2.0 * side
        act(share + 0.5 * sign, preload, bodies, strips)
        out[:] = 0.0
        for s in range(strips.roots.size):
            at = poses + s * (own + modes) + own
            visit_points(s, y[at : at + modes], n, shape, strips, local, out)
            for i in range(2 * n):
                former = 0.0 if side == 0 else preload.gradient[s, i]
                preload.gradient[s, i] = former + sign * local.gradient[s, i]
            for k in range(modes):
                gap[s, k] = (0.0 if side == 0 else gap[s, k]) + sign * local.gap[s, k]
        slope += sign * (out[0] + out[1] + out[2])
        bend += 4.0 * (out[0] + out[1])
    act(share, preload, bodies, strips)
    for i in range(space.force.size):
        space.force[i] = -preload.bodies[i]
    for i in range(poses):
        push[i] = -preload.bodies[i]
        slope += push[i] * (y[i] - bodies.rest[i])
    for s in range(strips.roots.size):
        at, first = poses + s * (own + modes), 2 * n - 8
        tip, root = strips.tips[s] >= 0, strips.roots[s] >= 0
        last, g, given = own + inner, local.g[s], preload.gradient[s]
        for i in range(first):
            g[i] = given[i]
        to_ends(given, first, local.map[s], tip, root, g, first, last)
        for i in range(own):
            push[at + i] = g[i]
        for i in range(3 * tip):
            push[3 * strips.tips[s] + i] += g[last + i]
        for i in range(3 * root):
            push[3 * strips.roots[s] + i] += g[last + 3 * tip + i]
        for k in range(modes):
            push[at + own + k] = local.gap[s, k] = gap[s, k]
            if strips.measure == MATERIAL:
                slope += y[at + own + k] * gap[s, k]
        end = last + 3 * tip + 3 * root
        forward(
            own, last, end, strips.coupled, strips.outer, strips.gain[s], local.h[s], local.b[s], gap[s], g
        )
        for i in range(last, end + strips.outer):
            space.force[place_of(i - last, strips.tips[s], strips.roots[s], poses + s)] += g[i]
    space.move[:] = 0.0
    for i in range(bodies.free.size):
        space.change[i] = -space.force[bodies.free[i]]
    solve_free(space.factors, space.change)
    for i in range(bodies.free.size):
        space.move[bodies.free[i]] = space.change[i]
    for i in range(poses):
        space.rate[i] = space.move[i]
    move_strips(1.0, bodies, strips, shape, local, space, space.rate)
    for i in range(y.size):
        bend += push[i] * space.rate[i]
    return slope, bend
