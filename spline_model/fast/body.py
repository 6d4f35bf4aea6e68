"""The strips under one body: their tips' tangents and forces gathered at the body."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.fast.condense import condense
from spline_model.fast.strip import evaluate
from spline_model.strip.compiled import part


class Frame(NamedTuple):
    """G strips from the ground to one body, in SI units.

    root (G, 2) clamped points; axis (G, 2) the clamp directions at rest; length (G,);
    rigidity (G,) EI; arm (G, 2) tips from the body's centre at rest; compliance (G, K) of
    the axial modes in L^2/EI; centre (2,) of the body at rest.
    """

    root: NDArray[np.float64]
    axis: NDArray[np.float64]
    length: NDArray[np.float64]
    rigidity: NDArray[np.float64]
    arm: NDArray[np.float64]
    compliance: NDArray[np.float64]
    centre: NDArray[np.float64]


class Space(NamedTuple):
    """Working arrays of one path: body (3, 4) tangent and force, change (3,) of a tip, known states."""

    body: NDArray[np.float64]
    change: NDArray[np.float64]
    known_at: NDArray[np.float64]
    known_y: NDArray[np.float64]
    known_rate: NDArray[np.float64]
    y: NDArray[np.float64]
    rate: NDArray[np.float64]
    predicted: NDArray[np.float64]
    out: NDArray[np.float64]


@part()
def assemble(y, theta, frame, grid, locals_, space, out):
    """Condense all strips at y; the body's tangent and force in space.body, energies in out (3,).

    Returns the largest residual in EI/L^2 and L (first strip's), or inf for a singular strip.
    Places of out: bending, axial, smallest |C'| / L, negative pivots.
    """
    strips, modes = frame.length.size, frame.compliance.shape[1]
    own = (y.size - 2) // strips - modes
    length0, unit = frame.length[0], frame.rigidity[0] / frame.length[0] ** 2
    body = space.body
    body[:] = 0.0
    out[:] = 0.0
    out[2] = np.inf
    x, z = y[0] * length0, y[1] * length0
    cos_t, sin_t = math.cos(theta), math.sin(theta)
    norm = fx = fy = 0.0
    for s in range(strips):
        local, at = locals_[s], 2 + s * (own + modes)
        length, scale = frame.length[s], frame.rigidity[s] / frame.length[s]
        ax = cos_t * frame.arm[s, 0] - sin_t * frame.arm[s, 1]
        ay = sin_t * frame.arm[s, 0] + cos_t * frame.arm[s, 1]
        c, d = frame.axis[s, 0], frame.axis[s, 1]
        rx, ry = (x + ax - frame.root[s, 0]) / length, (z + ay - frame.root[s, 1]) / length
        bending, axial, slowest = evaluate(
            y[at : at + own],
            y[at + own : at + own + modes],
            c * rx + d * ry,
            c * ry - d * rx,
            cos_t,
            sin_t,
            frame.compliance[s],
            grid,
            local,
        )
        out[0] += scale * bending
        out[1] += scale * axial
        out[2] = min(out[2], slowest)
        g, h = local.g, local.h
        relative = scale / length / unit
        for i in range(own):
            norm = max(norm, abs(g[i]) * relative)
        for k in range(modes):
            norm = max(norm, abs(local.gap[k]))
        fx += scale / length * (c * g[own] - d * g[own + 1])
        fy += scale / length * (d * g[own] + c * g[own + 1])
        negative = condense(local, frame.compliance[s], own)
        if negative < 0:
            return np.inf
        out[3] += negative
        px, py = c * g[own] - d * g[own + 1], d * g[own] + c * g[own + 1]
        # e = R(-angle) (r + arm(theta) - root) / L, phi = theta
        hxx, hxy, hyy = h[own, own], h[own, own + 1], h[own + 1, own + 1]
        kxx = c * c * hxx - 2 * c * d * hxy + d * d * hyy
        kxy = c * d * (hxx - hyy) + (c * c - d * d) * hxy
        kyy = d * d * hxx + 2 * c * d * hxy + c * c * hyy
        kxt = c * h[own, own + 2] - d * h[own + 1, own + 2]
        kyt = d * h[own, own + 2] + c * h[own + 1, own + 2]
        a, b = -ay / length, ax / length  # d(tip)/d(theta) over L
        body[0, 0] += scale / length**2 * kxx
        body[0, 1] += scale / length**2 * kxy
        body[1, 1] += scale / length**2 * kyy
        body[0, 2] += scale / length * (kxx * a + kxy * b + kxt)
        body[1, 2] += scale / length * (kxy * a + kyy * b + kyt)
        body[2, 2] += scale * (
            kxx * a * a + 2 * kxy * a * b + kyy * b * b + 2 * (kxt * a + kyt * b) + h[own + 2, own + 2]
        ) - scale / length * (px * ax + py * ay)
        body[0, 3] += scale / length * px
        body[1, 3] += scale / length * py
        body[2, 3] += scale * (px * a + py * b + g[own + 2])
    return max(norm, max(abs(fx), abs(fy)) / unit)


@part()
def turn_into(frame, s, cos_t, sin_t, dx, dy, dtheta, change):
    """Change of a strip's tip pose (3,) for a change of the body's pose."""
    ax = cos_t * frame.arm[s, 0] - sin_t * frame.arm[s, 1]
    ay = sin_t * frame.arm[s, 0] + cos_t * frame.arm[s, 1]
    rx, ry = (dx - ay * dtheta) / frame.length[s], (dy + ax * dtheta) / frame.length[s]
    c, d = frame.axis[s, 0], frame.axis[s, 1]
    change[0], change[1], change[2] = c * rx + d * ry, c * ry - d * rx, dtheta
