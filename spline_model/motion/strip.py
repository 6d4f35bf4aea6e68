"""One strip over a time step: forces on its reduced coordinates and their derivatives.

The step's changes dy of the reduced coordinates move the control points by exactly D dy (a discrete
null space of the clamps: Betsch, CMAME 194 (2005) 5159), with rotations by the Cayley variable
c = 2 tan(dphi / 2):

    P_end = X + R(phi) r:          dP_end = dX + c mean(R' r)
    P_inner - P_end = s t(phi):    d(P_inner - P_end) = mean(s) c mean(t') + ds mean(t)

so that D^T times the forces on the control points is free of the clamps' reactions, and no energy is
lost. The tangent is D^T (K T) with T = dP/d(dy) at the step's end, and (dD)^T times the forces.
"""

from __future__ import annotations

import math

from spline_model.strip.compiled import called, kernel, part
from spline_model.strip.laws import bending_law, stretching_law
from spline_model.strip.two_states import (
    bending_between,
    bending_strain,
    stretching_between,
)


@called()
def _end_frame(body, frame, reach, pose, out):
    """Arm from the body's centre and s-direction of a clamped end: out (4,)."""
    out[0] = out[1] = 0.0
    angle = 0.0
    if body >= 0:
        angle = pose[3 * body + 2]
        c, d = math.cos(angle), math.sin(angle)
        out[0], out[1] = c * frame[0] - d * frame[1], d * frame[0] + c * frame[1]
    out[2], out[3] = reach * math.cos(angle + frame[2]), reach * math.sin(angle + frame[2])


@called()
def _move_end(body, end, inner, s0, ds, dy, e0, e1, points, move, maps):
    """Move an end and its inner point by D dy, and fill D and T of it.

    A map has eight numbers: directions in which the inner point moves with s and with c, the outer one
    with c, and mean(s). e0, e1: frames before and after; D in maps[:8], T in maps[8:].
    """
    c = slope = 0.0
    ux = uy = 0.0
    tx, ty = 0.5 * (e0[2] + e1[2]), 0.5 * (e0[3] + e1[3])
    s, s1 = s0 + 0.5 * ds, s0 + ds
    move[0, end] = move[1, end] = 0.0
    if body >= 0:
        c = dy[3 * body + 2]
        slope = 1.0 / (1.0 + 0.25 * c * c)
        ux, uy = -0.5 * (e0[1] + e1[1]), 0.5 * (e0[0] + e1[0])
        move[0, end], move[1, end] = dy[3 * body] + c * ux, dy[3 * body + 1] + c * uy
    maps[12], maps[13] = -slope * e1[1], slope * e1[0]
    move[0, inner] = move[0, end] - s * c * ty + ds * tx
    move[1, inner] = move[1, end] + s * c * tx + ds * ty
    maps[0], maps[1] = tx, ty
    maps[2], maps[3], maps[4], maps[5], maps[6], maps[7] = ux - s * ty, uy + s * tx, ux, uy, s, slope
    maps[8], maps[9] = e1[2], e1[3]
    maps[10], maps[11] = slope * (-e1[1] - s1 * e1[3]), slope * (e1[0] + s1 * e1[2])


@part()
def move_strip(s, at, state, strips, work):
    """Control points at the step's end, their changes, and the maps of both ends, from dy and y + dy."""
    n, own = strips.mass.shape[1], strips.own
    y, dy, move, points = state.y, work.dy, work.move[s], work.points[s]
    ends = work.ends[s]
    _end_frame(strips.roots[s], strips.root[s], strips.reach[s, 0], work.pose, ends[0])
    _end_frame(strips.tips[s], strips.tip[s], -strips.reach[s, 1], work.pose, ends[1])
    root, tip = at + own - 2, at + own - 1
    _move_end(
        strips.roots[s], 0, 1, y[root], dy[root], dy, state.ends[s, 0], ends[0], points, move,
        work.maps[s, 0],
    )  # fmt: skip
    _move_end(
        strips.tips[s], n - 1, n - 2, y[tip], dy[tip], dy, state.ends[s, 1], ends[1], points, move,
        work.maps[s, 1],
    )  # fmt: skip
    for i in range(2, n - 2):
        move[0, i], move[1, i] = dy[at + 2 * i - 4], dy[at + 2 * i - 3]
    for k in range(2):
        for i in range(n):
            points[k, i] = state.points[s, k, i] + move[k, i]


@called()
def place_strip(s, y, at, strips, points, ends):
    """Control points (2, n) and end frames (2, 4) of a strip in the state y."""
    n = strips.mass.shape[1]
    root, tip = at + strips.own - 2, at + strips.own - 1
    _end_frame(strips.roots[s], strips.root[s], strips.reach[s, 0], y, ends[0])
    _end_frame(strips.tips[s], strips.tip[s], -strips.reach[s, 1], y, ends[1])
    for k in range(2):
        for e in range(2):
            body = strips.roots[s] if e == 0 else strips.tips[s]
            fixed = strips.root[s, k] if e == 0 else strips.tip[s, k]
            end, inner = (0, 1) if e == 0 else (n - 1, n - 2)
            points[k, end] = y[3 * body + k] + ends[e, k] if body >= 0 else fixed
            points[k, inner] = points[k, end] + y[root if e == 0 else tip] * ends[e, 2 + k]
        for i in range(2, n - 2):
            points[k, i] = y[at + 2 * i - 4 + k]


@called()
def curve_at(p, points, d1, d2, out):
    """C', C'' and |C'| at a Gauss point: out (5,)."""
    x1 = y1 = x2 = y2 = 0.0
    for i in range(d1.shape[1]):
        x, y = points[0, i], points[1, i]
        x1 += d1[p, i] * x
        y1 += d1[p, i] * y
        x2 += d2[p, i] * x
        y2 += d2[p, i] * y
    out[0], out[1], out[2], out[3], out[4] = x1, y1, x2, y2, math.sqrt(x1 * x1 + y1 * y1)


@kernel()
def set_points(state, strips, masses):
    """What a state's coordinates y make of its control points, end frames and curve."""
    modes = strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = masses.inertia.size + s * (strips.own + modes)
        place_strip(s, state.y, at, strips, state.points[s], state.ends[s])
        for p in range(strips.weight.size):
            curve_at(p, state.points[s], strips.d1, strips.d2, state.at[s, p])


@called()
def _add_products(pairs, h0, h1, h2, h3, block):
    """Add one component's h (C', C'') to its block of the tangent, (n n,) by rows."""
    p0, p1, p2, p3 = pairs[0], pairs[1], pairs[2], pairs[3]
    for c in range(p0.size):
        block[c] += h0 * p0[c] + h1 * p1[c] + h2 * p2[c] + h3 * p3[c]


@part()
def _clear_points(s, a, strips, work):
    """Set what the Gauss points add to to zero, and the gaps to what axial forces do to their own strains."""
    for q in range(4):
        for c in range(work.blocks.shape[1]):
            work.blocks[q, c] = 0.0
    for k in range(a.size):
        work.gap[s, k] = -strips.compliance[s, k] * a[k]
        for c in range(work.pull.shape[1]):
            work.pull[k, c] = work.along[k, c] = 0.0


@part()
def _add_axial(weight, rate, mean, dx, dy, tx, ty, modes, d1, a, gap, pull, along):
    """Add one Gauss point to gaps, pulls and their derivatives, of axial forces a (K,); returns their sum N.

    mean: of the strain over the step; dx, dy: its discrete gradient; tx, ty: the tangent at the end.
    """
    tension, n = 0.0, pull.shape[1] // 2
    share = weight * (0.5 + rate)
    for k in range(a.size):
        mode = modes[k]
        tension += mode * a[k]
        gap[k] += weight * mode * mean
        px, py = weight * mode * dx, weight * mode * dy
        qx, qy = share * mode * tx, share * mode * ty
        for i in range(d1.size):
            u = d1[i]
            pull[k, i] += px * u
            pull[k, n + i] += py * u
            along[k, i] += qx * u
            along[k, n + i] += qy * u
    return tension


@part()
def add_points(s, a, h, state, strips, work):
    """Forces on the control points, their tangent in the new ones, gaps and their derivatives."""
    force, blocks = work.force[s], work.blocks
    rate, strain, stretching = strips.relaxation[s] / h, strips.strain[s], strips.stretching[s]
    points, gap, pull, along = work.points[s], work.gap[s], work.pull, work.along
    _clear_points(s, a, strips, work)
    for p in range(strips.weight.size):
        weight, speed = strips.weight[p], strips.speed[s, p]
        old, new, d1, d2 = state.at[s, p], work.at[s, p], strips.d1[p], strips.d2[p]
        curve_at(p, points, strips.d1, strips.d2, new)
        x1, y1, v0, v1 = new[0], new[1], old[4], new[4]
        (
            g0, g1, g2, g3,
            h00, h01, h02, h03, h10, h11, h12, h13, h20, h21, h22, h23, h30, h31, h32, h33,
        ) = bending_between(
            old[0], old[1], old[2], old[3], v0, x1, y1, new[2], new[3], v1,
            speed, strips.curvature[s, p], strips.rigidity[s, p], strips.curl[s, p, 0],
            strips.curl[s, p, 1], rate,
        )  # fmt: skip
        inverse, w, tension, stiffness = 1.0 / v1, 2.0 / (v0 + v1), 0.0, 0.0
        dx, dy = 0.5 * (old[0] + x1) * w, 0.5 * (old[1] + y1) * w
        tx, ty = x1 * inverse, y1 * inverse
        if a.size > 0:
            mean, modes = 0.5 * (v0 + v1) - (1.0 + strain) * speed + rate * (v1 - v0), strips.modes[s, p]
            tension = _add_axial(weight, rate, mean, dx, dy, tx, ty, modes, d1, a, gap, pull, along)
        if stretching > 0.0:
            tension, stiffness = stretching_between(v0, v1, speed, strain, stretching, rate)
        turn = 0.5 * tension * w
        grow = stiffness - turn
        g0, g1 = weight * (g0 + tension * dx), weight * (g1 + tension * dy)
        g2, g3 = weight * g2, weight * g3
        for i in range(d1.size):
            force[0, i] += d1[i] * g0 + d2[i] * g2
            force[1, i] += d1[i] * g1 + d2[i] * g3
        pairs = strips.pairs[p]
        xx, xy = weight * (h00 + grow * dx * tx + turn), weight * (h01 + grow * dx * ty)
        yx, yy = weight * (h10 + grow * dy * tx), weight * (h11 + grow * dy * ty + turn)
        _add_products(pairs, xx, weight * h02, weight * h20, weight * h22, blocks[0])
        _add_products(pairs, xy, weight * h03, weight * h21, weight * h23, blocks[1])
        _add_products(pairs, yx, weight * h12, weight * h30, weight * h32, blocks[2])
        _add_products(pairs, yy, weight * h13, weight * h31, weight * h33, blocks[3])


@part()
def look_at(s, old, new, step, strips, out):
    """Energies of a strip at its Gauss points: out[0] += strain energy of the new state; out[1] += what
    bending and consistent stretching dissipate over the step (0: none)."""
    for p in range(strips.weight.size):
        speed, weight, rigidity = strips.speed[s, p], strips.weight[p], strips.rigidity[s, p]
        curvature, stretching, v, v0 = strips.curvature[s, p], strips.stretching[s], new[p, 4], old[p, 4]
        c = new[p, 0] * new[p, 3] - new[p, 1] * new[p, 2]
        out[0] += weight * bending_law(
            c / (v * v), v, speed, curvature, rigidity, strips.curl[s, p, 0], strips.curl[s, p, 1],
            strips.measure,
        )[0]  # fmt: skip
        if stretching > 0.0:
            out[0] += weight * stretching_law(v, speed, strips.strain[s], stretching, strips.measure)[0]
        if strips.relaxation[s] > 0.0 and step > 0.0:
            rate = strips.relaxation[s] / step * weight
            c0 = old[p, 0] * old[p, 3] - old[p, 1] * old[p, 2]
            change = bending_strain(c, v, speed, curvature) - bending_strain(c0, v0, speed, curvature)
            out[1] += rate * rigidity * speed * change**2
            out[1] += rate * stretching * speed * ((v - v0) / speed) ** 2
    for k in range(strips.compliance.shape[1]):
        if strips.compliance[s, k] > 0.0:
            strain = change = 0.0
            for p in range(strips.weight.size):
                share = strips.weight[p] * strips.modes[s, p, k]
                strain += share * (new[p, 4] - (1.0 + strips.strain[s]) * strips.speed[s, p])
                change += share * (new[p, 4] - old[p, 4])
            out[0] += 0.5 * strain * strain / strips.compliance[s, k]
            if strips.relaxation[s] > 0.0 and step > 0.0:
                out[1] += strips.relaxation[s] / step * change * change / strips.compliance[s, k]
