"""Estimated errors of answers, and what the moment defect of a static one says about torque and energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

ERRORS = ("trajectory", "torque", "stiffness", "section_forces", "stress")
"""What an accuracy of a static path is about."""
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


@dataclass(frozen=True, kw_only=True)
class ErrorEstimate:
    """Estimated error of a static path that was solved to an ``accuracy``, all relative [1].

    trajectory: largest error of a body's place over the largest displacement, and of its turn where that is
    not driven; torque, stiffness, section_forces, stress (the largest over a strip of the rectangular section
    that A and I imply): largest error over the largest magnitude on the path.
    control_points that were chosen; trials: numbers of control points that were tried.
    Leaves out what more control points do not mend: the theory's own simplifications.
    """

    accuracy: float
    trajectory: float
    torque: float
    stiffness: float
    section_forces: float
    stress: float
    control_points: int
    trials: tuple[int, ...]

    @property
    def largest(self) -> float:
        """The largest of the errors, which ``accuracy`` is about."""
        return max(float(getattr(self, name)) for name in ERRORS)

    @property
    def remark(self) -> str:
        """Empty, or what is more uncertain than the accuracy."""
        missed = [name for name in ERRORS if not getattr(self, name) <= self.accuracy]
        if not missed:
            return ""
        errors = ", ".join(f"{name.replace('_', ' ')} {getattr(self, name):.1e}" for name in missed)
        return f"estimated error above {self.accuracy:g} with {self.control_points} control points: {errors}"


@dataclass(frozen=True, kw_only=True)
class FrequencyEstimate:
    """Estimated error of natural frequencies that were solved to an ``accuracy``, relative [1].

    frequency: the largest of all modes; control_points and trials as of ``ErrorEstimate``.
    """

    accuracy: float
    frequency: float
    control_points: int
    trials: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class MotionEstimate:
    """Estimated error of the rotation of a motion that was solved to an ``accuracy`` [rad].

    rotation: its largest error over the motion, of the steps (``time``) and of the control points
    (``space``) together, which may cancel in part; control_points that were chosen; runs that
    it took.
    """

    accuracy: float
    rotation: float
    time: float
    space: float
    control_points: int
    runs: int
