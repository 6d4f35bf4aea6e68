"""Weight and pre-strain as they grow: what acts at a share of them, and what a little more of it does."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.reduced.arrays import AXIAL, BENDING, FORCE, RATE, Bodies
from spline_model.reduced.assembly import place_of
from spline_model.reduced.beside import respond
from spline_model.reduced.model import Reduced
from spline_model.reduced.numbers import Designs, in_order
from spline_model.strip.compiled import called, kernel
from spline_model.strip.element import CURVATURE, GRADIENT, LAST, ON_POINTS, PER_U, STRAIN, Strips
from spline_model.strip.ends import to_coordinates
from spline_model.strip.points import evaluate_residual

Array = NDArray[np.float64]


class Preload(NamedTuple):
    """All of the weight and pre-strain of a mechanism, and scratch for their derivatives.

    curvature (2, S, G) at rest and stress-free; numbers (S, 15 + 2 n) as in ``Strips``, bodies (Q,) as in
    ``Bodies``; hung (2,): energy of the dead load at rest, to be subtracted, and that with the bodies' own;
    change (S, 2 n + K): derivatives of gradient and gap in the share; push (Y,): that of the residual
    in w, a and the poses; out (5,).
    """

    curvature: Array
    numbers: Array
    bodies: Array
    hung: Array
    change: Array
    push: Array
    out: Array

    @classmethod
    def of(cls, model: Reduced) -> Self:
        """What a mechanism is preloaded by."""
        strips, bodies, system = model.strips, model.bodies, model.system
        hung, (count, modes) = 0.0, strips.compliance.shape
        if system.weight.size:
            given = [in_order(s.control_points, model.shape).ravel() for s in system.scene.strips]
            points = np.array(given)
            hung = float((strips.numbers[:, ON_POINTS:] * points).sum() / model.length)
        return cls(
            curvature=np.array((model.rest, strips.along[..., CURVATURE])),
            numbers=strips.numbers,
            bodies=bodies.weight,
            hung=np.array([hung, hung + float(bodies.weight[: len(bodies.rest)] @ bodies.rest)]),
            change=np.zeros((count, 2 * len(model.shape.order) + modes)),
            push=np.zeros(model.size),
            out=np.zeros(5),
        )

    @classmethod
    def of_designs(cls, model: Reduced, designs: Designs, weight: Array, points: Array) -> Self:
        """The same of D designs, by weight (D, Q) and points at rest (D, S, n, 2) [m]; all arrays but
        scratch have D in front."""
        poses, numbers = designs.start[:, : len(model.bodies.rest)], designs.numbers.copy()
        given = in_order(points, model.shape).reshape(*points.shape[:2], -1)
        hung = (numbers[..., ON_POINTS:] * given).sum(axis=(1, 2)) / designs.length
        fallen = (weight[:, : poses.shape[1]] * poses).sum(axis=1)
        return cls.of(model)._replace(
            curvature=np.stack((designs.rest, designs.along[..., CURVATURE]), axis=1),
            numbers=numbers,
            bodies=weight.copy(),
            hung=np.stack((hung, hung + fallen), axis=1),
        )


def apart(model: Reduced) -> tuple[Bodies, Strips]:
    """Return the bodies and strips whose weight and pre-strain may be overwritten by ``act``."""
    strips = model.strips._replace(along=model.strips.along.copy(), numbers=model.strips.numbers.copy())
    return model.bodies._replace(weight=model.bodies.weight.copy()), strips


@kernel()
def act(share, preload, bodies, strips):
    """Let a share of weight and pre-strain act."""
    for s in range(strips.roots.size):
        for p in range(strips.along.shape[1]):
            rest, whole = preload.curvature[0, s, p], preload.curvature[1, s, p]
            strips.along[s, p, CURVATURE] = rest + share * (whole - rest)
        strips.numbers[s, STRAIN] = share * preload.numbers[s, STRAIN]
        for i in range(PER_U, strips.numbers.shape[1]):
            strips.numbers[s, i] = share * preload.numbers[s, i]
    for i in range(bodies.weight.size):
        bodies.weight[i] = share * preload.bodies[i]


@called()
def swell(y, share, preload, arrays):
    """Return the rate of a state, just solved, in the share, in ``space``; first and second derivative of its
    potential.

    Energies are squares of the share, so that differences over a whole share are exact. The state is
    condensed as ``assemble`` left it, its gradients are overwritten.
    """
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    n, modes, poses = shape.order.size, strips.compliance.shape[1], bodies.rest.size
    own, last = 2 * n - 6, 2 * n - 6 + strips.coupled - strips.outer
    push, out, vectors, rate = preload.push, preload.out, space.vectors, space.states[RATE]
    force, slope, bend = vectors[FORCE], preload.hung[0], -8.0 * (space.out[BENDING] + space.out[AXIAL])
    for side in range(2):
        sign = 1.0 - 2.0 * side
        act(share + 0.5 * sign, preload, bodies, strips)
        out[:] = 0.0
        for s in range(strips.roots.size):
            at = poses + s * (own + modes) + own
            evaluate_residual(s, y[at : at + modes], n, shape, strips, local, out)
            total = preload.change[s]
            for i in range(2 * n + modes):
                total[i] *= side
                total[i] += sign * (local.nodal[s, GRADIENT, i] if i < 2 * n else local.gap[s, i - 2 * n])
        slope += sign * (out[0] + out[1] + out[2])
        bend += 4.0 * (out[0] + out[1])
    act(share, preload, bodies, strips)
    for i in range(bodies.load.size):
        force[i] = -preload.bodies[i]
    for i in range(poses):
        push[i] = -preload.bodies[i]
        slope += push[i] * (y[i] - bodies.rest[i])
    for s in range(strips.roots.size):
        at, tip, root = poses + s * (own + modes), strips.tips[s], strips.roots[s]
        given, g, gap = preload.change[s], local.reduced[s, LAST], local.gap[s]
        to_coordinates(s, given[: 2 * n], last, local.map[s], strips, g)
        for i in range(own):
            push[at + i] = g[i]
        for i in range(last, last + 3 * (tip >= 0) + 3 * (root >= 0)):
            push[place_of(i - last, tip, root, 0)] += g[i]
        for k in range(modes):
            push[at + own + k] = gap[k] = given[2 * n + k]
            slope += y[at + own + k] * gap[k]
    respond(arrays, rate)
    for i in range(y.size):
        bend += push[i] * rate[i]
    return slope, bend
