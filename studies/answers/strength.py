"""What an answer bears: stress at the outer fibres, where it is largest, and where it yields."""

from dataclasses import dataclass

import numpy as np

from studies.answers.response import Response
from studies.answers.yielding import Yield, first_yield

#: Part of a strip within which a place is its root, its middle or its tip.
NEAR = 0.02
#: Part of a stress below which two are the same: the strips of a symmetric pivot.
SAME = 1e-9


@dataclass(frozen=True, kw_only=True)
class Strength:
    """The largest stress on a path, and how far it is from yield.

    Attributes:
        stress: at an outer fibre [Pa]. strip: its name. station: arc length from its root over L [1].
        load_factor [1], rotation [rad]: of the state; NaN where no body turns.
        yield_strength: of that strip [Pa], None where none is given; safety: least of all strips, yield
            strength over largest stress [1].
        yields: from which load factor and rotation on some strip yields; None where none does.
    """

    stress: float
    strip: str
    station: float
    load_factor: float
    rotation: float
    yield_strength: float | None
    safety: float | None
    yields: Yield | None

    @property
    def place(self) -> str:
        """Where along the strip it is, in words."""
        for at, word in ((0.0, "at its root"), (0.5, "in its middle"), (1.0, "at its tip")):
            if abs(self.station - at) <= NEAR:
                return word
        return f"at {self.station:.2f} of its length"


def strength(answer: Response) -> Strength:
    """Return the largest stress of an answer, and what of its path the material bears."""
    stress, strips = answer.strip_stress, answer.design.strips
    limits = [strip.yield_strength for strip in strips]
    first = int(np.argmax(stress >= (1.0 - SAME) * stress.max()))
    state, strip = map(int, np.unravel_index(first, stress.shape))
    along = answer.extreme_fibre_stress[state, strip]
    station = int(np.argmax(along >= (1.0 - SAME) * along.max()))
    turns = np.full(len(answer.load_factor), np.nan) if answer.body is None else answer.rotation
    places = np.stack((answer.load_factor, turns), axis=1)
    known = all(limit is not None for limit in limits)
    share = (stress / np.array(limits, dtype=float)).max(axis=1) if known else None
    return Strength(
        stress=float(stress.max()),
        strip=strips[strip].name,
        station=float(answer.stations[station]),
        load_factor=float(places[state, 0]),
        rotation=float(places[state, 1]),
        yield_strength=limits[strip],
        safety=float(1.0 / share.max()) if share is not None and share.max() > 0.0 else None,
        yields=None if share is None else first_yield(answer, share),
    )
