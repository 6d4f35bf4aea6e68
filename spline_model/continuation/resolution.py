"""Whether the control points resolve a state: bending moments by the law against those by balance."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Bending, Clamp
from spline_model.effects.base import Constraint
from spline_model.quadrature import MEASURE, WEIGHT

Array = NDArray[np.float64]

LARGEST_DEFECT = 0.155
"""Largest moment defect of a state that is accepted: no formulation of the map of control points
exceeds it at a quarter turn. On the pivot of Table 1 it is reached near 108 degrees with four control
points and 197 with six, where the torque is wrong by 2 to 4 % and the stiffness by more; with four
a torque limit that the pivot has not follows at 137 degrees, and then another branch."""
SMALLEST_MOMENT = 1e-2
"""Root mean square moment below which strips count as unloaded, EI/L."""


@dataclass(frozen=True, kw_only=True, eq=False)
class _Span:
    """One strip's rows of the table of points: where its points, its root and its weight stand.

    values (G, n) basis and areas (G, n) its integrals from the root, at the Gauss points;
    clamp: the multipliers at its root; load (2,) weight per du [N].
    """

    rows: slice
    points: slice
    values: Array
    areas: Array
    clamp: slice
    u: Array
    load: Array


class Resolution:
    """The moment defect of the states of a system.

    The constitutive moment M = EI (kappa - kappa_0) satisfies the balance M_b, of the root's
    reaction and the weight, in the mean only; M - M_b is what the discretisation leaves
    out. Zero for the exact solution. Strips that are not clamped at their root are left out.
    Source: Prager and Synge, Q Appl Math 5 (1947) 241: the error in energy of two dual fields.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.length = system.points.numbers[:, WEIGHT] * system.points.speed
        self.spans = tuple(_spans(system))

    def defect(self, z: Array, share: float = 1.0) -> float:
        """Root of the energy of the moment defect over the bending energy; share: of the preload."""
        table = self.system.points if share == 1.0 else self.system.points.with_share(share)
        x1, y1, x2, y2 = table.derivatives(z)
        square = x1**2 + y1**2
        speed = np.where(table.place[:, MEASURE] == 0, table.speed, np.sqrt(square))
        moment = table.moments((x1 * y2 - y1 * x2) / square / speed - table.curvature)
        wrong, stored = 0.0, SMALLEST_MOMENT**2 * self.system.scales.energy
        for span in self.spans:
            ds = self.length[span.rows] / table.rigidity[span.rows]
            mine = moment[span.rows]
            wrong += float(ds @ (mine - self._balance(span, z, share)) ** 2)
            stored += float(ds @ mine**2)
        return math.sqrt(wrong / stored)

    def _balance(self, span: _Span, z: Array, share: float) -> Array:
        points = z[span.points].reshape(-1, 2)
        return balance(points, span.values, span.areas, span.u, z[span.clamp], share * span.load)


def balance(points: Array, values: Array, areas: Array, u: Array, reaction: Array, load: Array) -> Array:
    """Bending moment (..., P) that holds the balance of a strip up to u (P,) [N m].

    points (..., n, 2); values, areas (P, n): basis functions and their integrals from the root; reaction
    (..., 3) of the clamp there; load (2,): weight per du [N].
    """
    here = values @ points
    arm, (x, y, moment) = here - points[..., :1, :], np.moveaxis(reaction, -1, 0)[..., None]
    held = arm[..., 0] * y - arm[..., 1] * x - moment
    if load.any():
        weighed = u[:, None] * here - areas @ points
        held += weighed[..., 0] * load[1] - weighed[..., 1] * load[0]
    return np.asarray(held)


def _spans(system: System) -> list[_Span]:
    scene, layout = system.scene, system.layout
    roots = {
        clamp.strip: layout.rows(i)
        for i, clamp in enumerate(scene.of(Constraint))
        if isinstance(clamp, Clamp) and clamp.end == "start"
    }
    spans, at = [], 0
    for bending in scene.of(Bending):
        strip = scene.strip(bending.strip)
        u = strip.basis.gauss_rule(bending.gauss_points)[0]
        rows = slice(at, at + len(u))
        at += len(u)
        if bending.strip not in roots or bending.flexural_rigidity == 0.0:
            continue
        spans.append(
            _Span(
                rows=rows,
                points=layout.strip(bending.strip),
                values=strip.basis.evaluate(u),
                areas=strip.basis.areas(u),
                clamp=roots[bending.strip],
                u=u,
                load=scene.weight_of(bending.strip),
            )
        )
    return spans
