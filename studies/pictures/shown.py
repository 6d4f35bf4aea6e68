"""What a picture shows of an answer: its fields, and what follows from them."""

from dataclasses import dataclass

import numpy as np

from studies.answers.fields import Fields
from studies.cases.keys import GROUND
from studies.kinds import Array

#: What answers over one another are called beside their curves: as many as there may be.
LETTERS = "ABCDE"
#: Turn below which a path is not one of a rotation [rad].
TURNED = 1e-9


@dataclass(frozen=True, kw_only=True)
class Shown:
    """What a picture shows of one design: what it is called, its fields, and its yield strength, if known."""

    name: str
    fields: Fields
    yield_strength: float | None = None

    @property
    def rotation(self) -> Array | None:
        """(S,) of the driven body [rad]; None without bodies."""
        return self.fields.bodies[:, self.fields.driven, 2] if self.fields.blocks else None

    @property
    def turns(self) -> bool:
        """Whether its path is one of a driven rotation."""
        driven = self.fields.torque is not None and self.rotation is not None
        return driven and float(np.ptp(np.asarray(self.rotation))) > TURNED

    @property
    def shift(self) -> Array | None:
        """(S,) distance that the body's point in the crossing of the strips moves [m].

        None of a design that is not one body on two strips from the ground whose chords cross.
        """
        crossing, fields = _crossing_of(self.fields), self.fields
        if crossing is None:
            return None
        x, y = crossing - fields.rest_bodies[0]
        cosine, sine = np.cos(fields.bodies[:, 0, 2]), np.sin(fields.bodies[:, 0, 2])
        arm = np.stack((cosine * x - sine * y, sine * x + cosine * y), axis=-1)
        return np.asarray(np.hypot(*(fields.bodies[:, 0, :2] + arm - crossing).T))


def _crossing_of(fields: Fields) -> Array | None:
    """Return where the two strips of a pivot cross at rest (2,) [m]; None of what is no such pivot."""
    carried = [{part.root, part.tip} for part in fields.parts]
    if len(fields.blocks) != 1 or carried != 2 * [{GROUND, fields.blocks[0].name}]:
        return None
    (a, b), (c, d) = fields.rest_shape[:, [0, -1]]
    matrix = np.stack((b - a, c - d), axis=1)
    if abs(np.linalg.det(matrix)) < 1e-9 * np.linalg.norm(b - a) * np.linalg.norm(d - c):
        return None
    along = np.linalg.solve(matrix, c - a)
    return np.asarray(a + along[0] * (b - a)) if 0.0 < min(along) <= max(along) < 1.0 else None
