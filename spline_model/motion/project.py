"""From the control points of a strip over a step to its reduced coordinates, and the strip condensed.

D and T are those of ``spline_model.motion.strip``: forces are projected by D, their changes follow from
those of the coordinates by T, so that the tangent is not symmetric.
"""

from __future__ import annotations

from spline_model.strip.compiled import called, part


@called()
def _project(x, y, root, tip, roots, tips, out):
    """A covector of the control points in (w, tip, root) by the maps of both ends (8,)."""
    n = x.size
    k = 2 * n - 6
    for i in range(2, n - 2):
        out[2 * i - 4], out[2 * i - 3] = x[i], y[i]
    out[k - 2] = root[0] * x[1] + root[1] * y[1]
    out[k - 1] = tip[0] * x[n - 2] + tip[1] * y[n - 2]
    if tips >= 0:
        out[k], out[k + 1] = x[n - 1] + x[n - 2], y[n - 1] + y[n - 2]
        out[k + 2] = tip[2] * x[n - 2] + tip[3] * y[n - 2] + tip[4] * x[n - 1] + tip[5] * y[n - 1]
        k += 3
    if roots >= 0:
        out[k], out[k + 1] = x[0] + x[1], y[0] + y[1]
        out[k + 2] = root[2] * x[1] + root[3] * y[1] + root[4] * x[0] + root[5] * y[0]


@called()
def _combine(row, inner, outer, half, n, m, size, h):
    """A row of h from those of ``half``: the inner point's by m[0:2], the outer one's by m[2:4]."""
    a, b, c, d = m[0], m[1], m[2], m[3]
    x, y, u, v = half[inner], half[n + inner], half[outer], half[n + outer]
    for j in range(size):
        h[row, j] = a * x[j] + b * y[j] + c * u[j] + d * v[j]


@called()
def _add_turning(row, turn, maps, ends, fx, fy, ox, oy, h):
    """(dD)^T times the forces f of the inner point and o of the outer one of an end that turns."""
    slope, s = maps[7], maps[6]
    h[row, turn] += 0.5 * slope * (ends[2] * fy - ends[3] * fx)
    h[turn, row] += 0.5 * (maps[0] * fy - maps[1] * fx)
    h[turn, turn] -= (
        0.5 * slope * (ends[0] * (fx + ox) + ends[1] * (fy + oy) + s * (ends[2] * fx + ends[3] * fy))
    )


@called()
def _combine_end(row, inner, outer, half, n, maps, size, h, m):
    """The three rows of an end that moves, its inner point with it."""
    m[0], m[1], m[2], m[3] = 1.0, 0.0, 1.0, 0.0
    _combine(row, inner, outer, half, n, m, size, h)
    m[0], m[1], m[2], m[3] = 0.0, 1.0, 0.0, 1.0
    _combine(row + 1, inner, outer, half, n, m, size, h)
    m[0], m[1], m[2], m[3] = maps[2], maps[3], maps[4], maps[5]
    _combine(row + 2, inner, outer, half, n, m, size, h)


@part()
def _project_columns(s, strips, work):
    """The tangent with the inertia by changes of the element coordinates: forces on the control points."""
    n, roots, tips = strips.mass.shape[1], strips.roots[s], strips.tips[s]
    blocks, half, root, tip = work.blocks, work.half, work.maps[s, 0, 8:], work.maps[s, 1, 8:]
    for i in range(n):
        for j in range(n):
            blocks[0, i * n + j] += work.stiff[s, i, j]
            blocks[3, i * n + j] += work.stiff[s, i, j]
    for i in range(n):
        begin, end = i * n, i * n + n
        _project(blocks[0, begin:end], blocks[1, begin:end], root, tip, roots, tips, half[i])
        _project(blocks[2, begin:end], blocks[3, begin:end], root, tip, roots, tips, half[n + i])


@part()
def to_reduced(s, strips, work):
    """Force, tangent and coupling of a strip in its element coordinates; returns their number.

    The inertia is added to the tangent on the way.
    """
    n, own = strips.mass.shape[1], strips.own
    roots, tips, root, tip = strips.roots[s], strips.tips[s], work.maps[s, 0], work.maps[s, 1]
    half, g, h, force, m, k = work.half, work.g[s], work.h[s], work.force[s], work.mix, own
    size = own + (3 if tips >= 0 else 0) + (3 if roots >= 0 else 0)
    _project_columns(s, strips, work)
    for i in range(2, n - 2):
        for j in range(size):
            h[2 * i - 4, j], h[2 * i - 3, j] = half[i, j], half[n + i, j]
    m[2] = m[3] = 0.0
    m[0], m[1] = root[0], root[1]
    _combine(own - 2, 1, 0, half, n, m, size, h)
    m[0], m[1] = tip[0], tip[1]
    _combine(own - 1, n - 2, n - 1, half, n, m, size, h)
    _project(force[0], force[1], root, tip, roots, tips, g)
    if tips >= 0:
        _combine_end(k, n - 2, n - 1, half, n, tip, size, h, m)
        _add_turning(
            own - 1, k + 2, tip, work.ends[s, 1], force[0, n - 2], force[1, n - 2], force[0, n - 1],
            force[1, n - 1], h,
        )  # fmt: skip
        k += 3
    if roots >= 0:
        _combine_end(k, 1, 0, half, n, root, size, h, m)
        _add_turning(
            own - 2, k + 2, root, work.ends[s, 0], force[0, 1], force[1, 1], force[0, 0], force[1, 0], h,
        )  # fmt: skip
    for c in range(strips.compliance.shape[1]):
        pull, along = work.pull[c], work.along[c]
        _project(pull[:n], pull[n:], root, tip, roots, tips, work.left[c])
        _project(along[:n], along[n:], root[8:], tip[8:], roots, tips, work.right[s, c])
    return size


@part()
def condense(s, size, strips, work):
    """Eliminate a strip's inner axial forces and own coordinates from g and h in place; returns its size.

    Outer axial forces follow behind the ends, their rows combined exactly (``spline_model.strip.condense``).
    """
    count, outer, own = strips.compliance.shape[1], strips.outer, strips.own
    g, h, left, right, gap = work.g[s], work.h[s], work.left, work.right[s], work.gap[s]
    for k in range(count):
        gain = strips.gain[s, k]
        push = gain * gap[k]
        for i in range(size):
            share = gain * left[k, i]
            g[i] += push * left[k, i]
            for j in range(size):
                h[i, j] += share * right[k, j]
    for k in range(outer):
        rest = 1.0 - strips.gain[s, k] * strips.compliance[s, k]
        at = size + k
        for i in range(size):
            h[i, at] = rest * left[k, i]
            h[at, i] = right[k, i]
        for j in range(outer):
            h[at, size + j] = 0.0
        h[at, at] = -strips.compliance[s, k]
        g[at] = gap[k]
    size += outer
    for i in range(own):
        inverse = 1.0 / h[i, i]
        for j in range(i + 1, size):
            factor = h[j, i] * inverse
            if factor != 0.0:
                g[j] -= factor * g[i]
                for c in range(i + 1, size):
                    h[j, c] -= factor * h[i, c]
    return size
