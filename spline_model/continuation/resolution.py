"""Whether the control points resolve a state: bending moments by the law against those by balance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import Bezier
from spline_model.compile import System
from spline_model.effects import Bending
from spline_model.quadrature import MEASURE, WEIGHT

Array = NDArray[np.float64]

LARGEST_DEFECT = 0.155
"""Largest moment defect of a state that is accepted: no formulation of the map of control points
exceeds it at a quarter turn. On the pivot of Table 1 it is reached near 108 degrees with four control
points and 197 with six, where the torque is wrong by 2 to 4 % and the stiffness by more; with four
a torque limit that the pivot has not follows at 137 degrees, and then another branch."""
SMALLEST_MOMENT = 1e-2
"""Root mean square moment below which strips count as unloaded, EI/L."""


def moment_defect(system: System, z: Array, share: float = 1.0) -> float:
    """Return the root of the energy of the moment defect over the bending energy at z (N,); share: of the
    preload.

    The constitutive moment M = EI (kappa - kappa_0) satisfies the balance M_b, of the root's reaction and the
    weight, in the mean only; M - M_b is the discretisation error. Zero for the exact solution. Strips that
    are not clamped at their root are skipped. Source: Prager and Synge, Q Appl Math 5 (1947) 241: the error
    in energy of two dual fields.
    """
    table = system.points if share == 1.0 else system.points.with_share(share)
    x1, y1, x2, y2 = table.derivatives(z)
    square = x1**2 + y1**2
    speed = np.where(table.place[:, MEASURE] == 0, table.speed, np.sqrt(square))
    moment = table.moments((x1 * y2 - y1 * x2) / square / speed - table.curvature)
    wrong, stored = 0.0, SMALLEST_MOMENT**2 * system.scales.energy
    for rows, points, clamp, (values, where), load in system.once("strips in balance", _in_balance):
        ds = table.numbers[rows, WEIGHT] * table.speed[rows] / table.rigidity[rows]
        held = balance(z[points].reshape(-1, 2), values, where, z[clamp], share * load)
        wrong += float(ds @ (moment[rows] - held) ** 2)
        stored += float(ds @ moment[rows] ** 2)
    return math.sqrt(wrong / stored)


def balance(points: Array, values: Array, where: tuple[Bezier, Array], reaction: Array, load: Array) -> Array:
    """Return the bending moment (..., P) that holds the balance of a strip up to u (P,) [N m].

    points (..., n, 2); values (P, n): basis functions; where: basis and u; reaction (..., 3) of the clamp at
    the root; load (3, 2): parts of the weight per du with 1, u and u^2 [N].
    """
    here = values @ points
    arm, (x, y, moment) = here - points[..., :1, :], np.moveaxis(reaction, -1, 0)[..., None]
    held = arm[..., 0] * y - arm[..., 1] * x - moment
    basis, u = where
    for power, (x, y) in enumerate(load):
        if x or y:
            whole = u[:, None] ** (power + 1) / (power + 1)
            weighed = whole * here - basis.areas(u, power) @ points
            held += weighed[..., 0] * y - weighed[..., 1] * x
    return np.asarray(held)


def _in_balance(system: System) -> list[tuple[slice, slice, slice, tuple[Array, Any], Array]]:
    """Of each strip that is clamped at its root: rows in the table of points, places of its control points
    and of the clamp's multipliers, basis there as ``balance`` takes it, and weight per du (3, 2) [N]."""
    scene, found, at = system.scene, [], 0
    for bending in scene.of(Bending):
        strip = scene.strip(bending.strip)
        u = strip.basis.gauss_rule(bending.gauss_points)[0]
        rows, clamp = slice(at, at + len(u)), scene.clamps.get((strip.name, "start"))
        at = rows.stop
        if clamp is not None and bending.flexural_rigidity != 0.0:
            basis = strip.basis.evaluate(u), (strip.basis, u)
            points, load = system.layout.strip(strip.name), scene.weight_of(strip.name)
            found.append((rows, points, clamp, basis, load))
    return found
