"""From a bifurcation to the branch that crosses the path there."""

from __future__ import annotations

import numpy as np

from spline_model.continuation.corrector import correct
from spline_model.continuation.critical import Crossing
from spline_model.continuation.followed import Followed
from spline_model.continuation.point import Point, stand

BRANCHES = ("primary", "follow")
AMPLITUDES = (0.1, 0.03, 0.01)
"""How far from the bifurcation the branch is entered, in lengths of a strip or rad: large, because
close to it Newton has two solutions to choose from."""


def leave(work: Followed, crossing: Crossing) -> Point | None:
    """A state on the other branch, at an amplitude of the critical mode; None if none was found.

    Newton with the amplitude held and the load factor free, so that the primary branch, on
    which the mode has no part, is no solution.
    """
    count = work.count
    normal = np.zeros(len(crossing.z))
    normal[:count] = crossing.mode
    for amplitude in AMPLITUDES:
        z = crossing.z.copy()
        z[:count] += amplitude * work.unit[:count] * crossing.mode
        found = correct(work, z, crossing.told.load_factor, normal, 0.0)
        if found.reason or work.refuse(found.z) or work.unresolved(found.z, found.load_factor):
            continue
        try:
            return stand(work, found.z, found.load_factor, found.energies)
        except np.linalg.LinAlgError:
            continue
    return None
