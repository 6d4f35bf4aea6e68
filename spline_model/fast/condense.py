"""Condensation of a strip: axial forces, then its own coordinates, leave the tip's pose."""

from __future__ import annotations

from spline_model.strip.compiled import part


@part()
def condense(local, compliance, own):
    """Condense in place; returns the number of negative pivots, or -1 for a zero pivot.

    Afterwards h[:W, :W] holds L D L^T, h[W:, W:] the tip's tangent, g[W:] its force, and
    h[:W, W:] and g[:W] are D^-1 L^-1 times their former values (for ``recover``).
    """
    g, h, b, gap = local.g, local.h, local.b, local.gap
    size = own + 3
    for k in range(gap.size):
        stiffness = (2 * k + 1) / compliance[k]
        row = b[k]
        push = stiffness * gap[k]
        for i in range(size):
            left = stiffness * row[i]
            g[i] += push * row[i]
            for j in range(i, size):
                h[i, j] += left * row[j]
    negative = 0
    for i in range(own):  # upper storage: row i becomes D and the transposed column of L times D
        d = h[i, i]
        if d == 0.0:
            return -1
        if d < 0.0:
            negative += 1
        inverse = 1.0 / d
        for j in range(i + 1, size):
            factor = h[i, j] * inverse
            for k in range(j, size):
                h[j, k] -= factor * h[i, k]
            g[j] -= factor * g[i]
    return negative


@part()
def recover(local, compliance, own, change, dw, da):
    """Changes of own coordinates (W,) and axial forces (K,) for a change (3,) of the tip's pose."""
    g, h, b, gap = local.g, local.h, local.b, local.gap
    for i in range(own - 1, -1, -1):
        right = -g[i]
        for j in range(3):
            right -= h[i, own + j] * change[j]
        for j in range(i + 1, own):
            right -= h[i, j] * dw[j]
        dw[i] = right / h[i, i]
    for k in range(gap.size):
        strain = gap[k]
        for i in range(own):
            strain += b[k, i] * dw[i]
        for j in range(3):
            strain += b[k, own + j] * change[j]
        da[k] = strain * (2 * k + 1) / compliance[k]


@part()
def recover_rate(local, compliance, own, change, dw, da):
    """The same along a path of equilibria: no residual, only the rate (3,) of the tip's pose."""
    h, b = local.h, local.b
    for i in range(own - 1, -1, -1):
        right = 0.0
        for j in range(3):
            right -= h[i, own + j] * change[j]
        for j in range(i + 1, own):
            right -= h[i, j] * dw[j]
        dw[i] = right / h[i, i]
    for k in range(b.shape[0]):
        strain = 0.0
        for i in range(own):
            strain += b[k, i] * dw[i]
        for j in range(3):
            strain += b[k, own + j] * change[j]
        da[k] = strain * (2 * k + 1) / compliance[k]
