"""What kernels are given and what they fill: a mechanism, the route of a path along it, and its answer."""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.frames import Frames
from spline_model.strip.element import Local, Shape, Strips

Array = NDArray[np.float64]

BENDING, AXIAL, DEAD, SLOWEST, NEGATIVE = range(5)
"""Places of what ``assemble`` sums up: energies in EI/L, least v / J0, negative pivots of the strips."""
KNOWN = 4
"""States and rates that the next one is predicted from: of five, round-off would outgrow what they add."""
FORCE, RAW, CHANGE, MOVE, REACTION, REACTION_RATE, ENDS, ARMS = range(8)
"""Rows of ``Space.vectors``."""
Y, RATE, PREDICTED, SPARE = range(2 * KNOWN, 2 * KNOWN + 4)
"""Rows of ``Space.states`` behind the known ones."""
FACTORS = 5
"""Place of the known states' factors behind the sums."""
AT, ENERGY, SLOPE, BEND, DONE, DEFECT, SUMS = range(FACTORS + KNOWN, FACTORS + KNOWN + 7)
"""Places behind them of the last state of a path: its factor, the potential with its first and second
derivative in it, the work done so far and the moment defect; and the number of all."""


class Bodies(NamedTuple):
    """B bodies, free strip ends among them, and their loads; coordinates x, y over L [1] and theta [rad].

    rest (3 B,); load (Q,) generalised force at load factor 1; weight (Q,) at any, Q = 3 B and one more
    for each strip whose mean axial force stands beside the bodies; free (F,) and held (D,) of these;
    driven: place among the held ones of the rotation whose torque is asked for, or -1; springs: stiffness
    over the poses of the scene's bodies, or (0, 0); frames: those of them that others carry, which are
    neither free nor held.
    """

    rest: Array
    load: Array
    weight: Array
    free: NDArray[np.int64]
    held: NDArray[np.int64]
    driven: int
    springs: Array
    frames: Frames


class Space(NamedTuple):
    """Working arrays of a path, few as in ``Strips``: the bodies' system and the states.

    tangent (Q, Q), upper; factors (F, F) of its free part; vectors (8, Q or more): FORCE and RAW, the
    residuals with the strips condensed and without, CHANGE (F,), MOVE, REACTION and REACTION_RATE (D,),
    ENDS of a strip, and ARMS of frames;
    states (2 KNOWN + 4, Y): known ones, their rates, Y, RATE, PREDICTED and SPARE; out (SUMS,): what
    ``assemble`` sums up, the factors of the known states, and what is known of the last one.
    """

    tangent: Array
    factors: Array
    vectors: Array
    states: Array
    out: Array

    @classmethod
    def of(cls, bodies: Bodies, size: int, dtype: Any = float) -> Self:
        """Return fresh ones for that many unknowns."""
        q, f = bodies.load.size, bodies.free.size
        shapes = (q, q), (f, f), (8, max(q, 7)), (2 * KNOWN + 4, size), (SUMS,)
        return cls(*(np.zeros(shape, dtype=dtype) for shape in shapes))


class Arrays(NamedTuple):
    """A mechanism as kernels know it: bodies, strips and the shape that these share, and working arrays."""

    bodies: Bodies
    strips: Strips
    shape: Shape
    local: Local
    space: Space


class Route(NamedTuple):
    """Where a path goes: factors (S,), the first one its start; held coordinates are origin + factor
    x target (D,), the load factor is factor x growth, the share of weight and pre-strain the
    factor itself where it ``swells``, and all of it otherwise. Critical points end it, or it ``passes`` them.
    """

    factor: Array
    origin: Array
    target: Array
    growth: float
    swells: bool = False
    passes: bool = False


class Answer(NamedTuple):
    """S states y (S, Y), dimensionless (EI/L, L), of a path.

    reaction (S, D); stiffness (S,) of the driven rotation at fixed loads; energies (S, 2) bending, axial;
    done (S,) the potential's derivative integrated over the factor; inertia, defect (S,); counters (4,).
    """

    y: Array
    reaction: Array
    stiffness: Array
    energies: Array
    done: Array
    inertia: NDArray[np.int64]
    defect: Array
    counters: NDArray[np.int64]

    def rows(self, kept: slice) -> Answer:
        """Return some of the states."""
        if kept == slice(0, len(self.done)):
            return self
        by_state = {name: getattr(self, name)[kept] for name in self._fields if name != "counters"}
        return self._replace(**by_state)

    @classmethod
    def empty(cls, states: int, size: int, held: int) -> Self:
        """Return one of that many states that are not solved yet."""
        return cls(
            y=np.zeros((states, size)),
            reaction=np.zeros((states, held)),
            stiffness=np.full(states, np.nan),
            energies=np.zeros((states, 2)),
            done=np.zeros(states),
            inertia=np.zeros(states, dtype=np.int64),
            defect=np.zeros(states),
            counters=np.zeros(4, dtype=np.int64),
        )
