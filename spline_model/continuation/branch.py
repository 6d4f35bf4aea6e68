"""From a bifurcation to the branch that crosses the path there."""

from __future__ import annotations

import numpy as np

from spline_model.checks import refuse
from spline_model.continuation.corrector import correct
from spline_model.continuation.point import Point, stand
from spline_model.continuation.resolution import Resolution
from spline_model.newton import Workspace
from spline_model.solution import CriticalPoint

BRANCHES = ("primary", "follow")
AMPLITUDES = (0.1, 0.03, 0.01)
"""How far from the bifurcation the branch is entered, in lengths of a strip or rad: large, because
close to it Newton has two solutions to choose from."""


def leave(work: Workspace, crossing: CriticalPoint, resolution: Resolution) -> Point | None:
    """A state on the other branch, at an amplitude of the critical mode; None if none was found.

    Newton with the amplitude held and the load factor free, so that the primary branch, on
    which the mode has no part, is no solution.
    """
    system = work.system
    count = len(crossing.mode)
    normal = np.zeros(system.layout.size)
    normal[:count] = crossing.mode / system.scales.unit[:count]
    for amplitude in AMPLITUDES:
        z = crossing.z.copy()
        z[:count] += amplitude * crossing.mode
        found = correct(work, z, crossing.load_factor, normal, 0.0)
        if found.reason or refuse(system, found.z) or resolution.refuse(found.z):
            continue
        try:
            return stand(work, found.z, found.load_factor, found.energies)
        except np.linalg.LinAlgError:
            continue
    return None
