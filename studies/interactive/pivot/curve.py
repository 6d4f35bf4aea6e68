"""What a moment alone does to a design: the path of its body, the moment and the largest stress."""

import math
from dataclasses import dataclass

import numpy as np

from spline_model.held import HeldPivot
from spline_model.pivot import Pivot
from studies.interactive.pivot.design import Reader
from studies.kinds import Array

#: Rotation up to which it is known [rad], and at how many places.
REACH, PLACES = 1.8, 25


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A rotations [rad] from 0 on as far as the body goes; the other side is the mirror's picture.

    shift (A, 2): of the centre from rest [m]; moment (A,) [N m]; stress (A,): largest in the strips [Pa].
    """

    rotation: Array
    shift: Array
    moment: Array
    stress: Array

    @classmethod
    def of(cls, pivot: Pivot, reader: Reader) -> "Curve":
        """Return the curve of a design."""
        solver, rows = HeldPivot(pivot), []
        for angle in np.linspace(0.0, REACH, PLACES):
            state = solver.turn(float(angle))
            if not state.solved:
                break
            stress = reader.read(solver.control_points).stress.max()
            rows.append([state.pose[2], *(state.pose[:2] - pivot.centre), state.force[2], stress])
        table = np.array(rows)
        return cls(rotation=table[:, 0], shift=table[:, 1:3], moment=table[:, 3], stress=table[:, 4])

    def gap(self, displacement: Array) -> float:
        """Return the distance [m] of a displacement (3,) from the path; 0 beyond its end."""
        x, y, turn = displacement
        if abs(turn) > self.rotation[-1]:
            return 0.0
        along, across = (float(np.interp(abs(turn), self.rotation, self.shift[:, k])) for k in range(2))
        return math.hypot(x - math.copysign(1.0, turn) * along, y - across)

    def where(self, stress: float) -> tuple[float, float] | None:
        """Return rotation [rad] and moment [N m] at which the largest stress is `stress` [Pa], None where it
        stays below."""
        if self.stress[-1] < stress:
            return None
        turn, moment = (float(np.interp(stress, self.stress, y)) for y in (self.rotation, self.moment))
        return turn, moment
