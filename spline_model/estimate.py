"""What the moment defect of a static answer says about its torque and energy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

TORQUE_SHARE = 4.5
"""Error of torque and energy over the squared moment defect, at most: 2.3 to 4.3 over crossing ratios
0.05 to 0.95, inclinations 10 to 80 degrees and rotations to 180 degrees, with 4 to 10 control points."""
UNCERTAIN = 0.03
"""Estimated error of the torque from which an answer says that it is not resolved: at the ends of what
designs may be the factor above is exceeded, and no error of 0.05 shall pass in silence."""


def resolution(defect: NDArray[np.float64]) -> str:
    """How uncertain a path of moment defects (S,) is; empty where its torque is resolved.

    The defect (``continuation.resolution``) is the error of the moments in the energy norm,
    and the error of torque and energy goes with its square.
    """
    worst = int(np.argmax(defect))
    error = TORQUE_SHARE * float(defect[worst]) ** 2
    if not error > UNCERTAIN:
        return ""
    return (
        f"the strips' moments differ from balance by {100 * defect[worst]:.2g} % in state {worst}: "
        f"torque and energy are uncertain by some {100 * min(error, 1.0):.2g} %; take more control points"
    )
