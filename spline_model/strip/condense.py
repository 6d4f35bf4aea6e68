"""Condensation of a strip to its ends: axial forces and own coordinates are eliminated.

Where a compliance is large enough to divide by, an axial force goes first. Where it is too small
(inextensible strips) its row is combined with those of w exactly: with the congruence a = a' + G B w,
G any gain,

    [ H   B^T ]          [ H + B^T G (B + E)   E^T ]
    [ B   -C  ]   --->   [ E                   -C  ],    E = (I - C G) B,

so that w can be eliminated before a' and nothing is penalised. Inertias of a block and of its
Schur complement add up (Haynsworth 1968), and each a' has one negative pivot of its own.
"""

from __future__ import annotations

from spline_model.strip.compiled import called, part

SINGULAR = -1000
"""What ``condense`` returns for a zero pivot."""


@part()
def eliminate(count, size, g, h):
    """Eliminate the leading ``count`` coordinates; returns their negative pivots, or SINGULAR."""
    negative = 0
    for i in range(count):  # upper storage: row i becomes D and the transposed column of L times D
        d = h[i, i]
        if d == 0.0:
            return SINGULAR
        if d < 0.0:
            negative += 1
        inverse = 1.0 / d
        for j in range(i + 1, size):
            factor = h[i, j] * inverse
            for k in range(j, size):
                h[j, k] -= factor * h[i, k]
            g[j] -= factor * g[i]
    return negative


@called()
def condense(own, size, coupled, outer, compliance, gain, g, h, b, gap):
    """Condense a strip in place; returns its number of negative pivots, or SINGULAR.

    own: W; size of the element's coordinates in use; coupled: axial forces beside w, the first ``outer`` of
    them left with the ends. Afterwards the leading block of h holds L D L^T, the rest the tangent of the
    ends, g their force, and the leading part of g and the block beside it are D^-1 L^-1 times their former
    values (for ``recover``).
    """
    last, end = own + coupled - outer, size - outer
    for k in range(gap.size):
        row, rest = b[k], 1.0 - compliance[k] * gain[k]
        push, twice = gain[k] * gap[k], gain[k] * (1.0 + rest)
        for i in range(end):
            left = twice * row[i]
            g[i] += push * row[i]
            for j in range(i, end):
                h[i, j] += left * row[j]
    for k in range(coupled):
        row, rest = b[k], 1.0 - compliance[k] * gain[k]
        at = end if k < outer else own + k - outer
        g[at] = gap[k]
        for i in range(own):
            h[i, at] = rest * row[i]
        for j in range(last, end):
            if k < outer:
                h[j, at] = rest * row[j]
            else:
                h[at, j] = rest * row[j]
        for j in range(k, coupled):
            other = end if j < outer else own + j - outer
            h[min(at, other), max(at, other)] = -compliance[k] if j == k else 0.0
    negative = eliminate(last, size, g, h)
    return negative if negative == SINGULAR else negative + outer - coupled


@called()
def recover(own, size, share, coupled, outer, gain, g, h, b, gap, change, dw, da):
    """Changes of own coordinates (W,) and axial forces (K,) for a change of the ends' poses.

    change: of the ends' coordinates in use, and of the outer axial force; share: 1 with the residual,
    0 along a path of equilibria.
    """
    last, end = own + coupled - outer, size - outer
    if outer:
        da[0] = change[end - last]
    for i in range(last - 1, -1, -1):
        right = -share * g[i]
        for j in range(last, size):
            right -= h[i, j] * change[j - last]
        for j in range(i + 1, own):
            right -= h[i, j] * dw[j]
        for j in range(max(i + 1, own), last):
            right -= h[i, j] * da[j - own + outer]
        if i < own:
            dw[i] = right / h[i, i]
        else:
            da[i - own + outer] = right / h[i, i]
    for k in range(gap.size):
        strain = share * gap[k] if k >= coupled else 0.0
        for i in range(own):
            strain += b[k, i] * dw[i]
        for j in range(last, end):
            strain += b[k, j] * change[j - last]
        strain *= gain[k]
        da[k] = da[k] + strain if k < coupled else strain
