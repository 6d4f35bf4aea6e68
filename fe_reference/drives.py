"""Drives of a motion: what leads which coordinates of a body, when and how fast.

Histories are linear between their instants, so that a motion falls into spans on which every led coordinate
goes at a constant rate. Held like that they need no multiplier: the body is reduced about the point that is
led (`mass.about_mass_centre`), the led rows have no equation of motion, and what resists them is what the
drive exerts. At the beginning of a span velocities change at once, by impulses of the drives alone.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated

from . import read
from .arrays import Array, Flags
from .effects import ALWAYS, ALWAYS_FULL, Prescribed, factor_of
from .mass import mass_matrix
from .model import Model
from .structure import Structure

#: Instants nearer than this part of the motion are the same.
SAME = 1e-12


@dataclass(frozen=True, kw_only=True)
class DrivenRotation(read.Checked):
    """The rotation of a body prescribed as an angle times the change of a history, from the current rotation.

    A body that is re-clamped loses the velocity that the drive does not have.

    Parameters
    ----------
    body : str, default None
        None: the only one.
    angle : float, rad
    history : pairs of s and 1, default ((0, 1),)
        Times and factors of the angle.
    held : (2,) s, default (0, inf)
        Begin and end of the drive.

    Raises
    ------
    InvalidParameter
        A value outside its domain.

    References
    ----------
    Valentini and Pezzuti (2013), Eq 7.

    Examples
    --------
    >>> DrivenRotation(angle=0.1, history=((0.0, 1.0), (0.01, 0.0)), held=(0.0, 0.02)).angle
    0.1
    """

    body: str | None = None
    angle: Annotated[float, read.finite, "rad"]
    history: Annotated[read.History, read.history] = ALWAYS_FULL
    held: tuple[float, float] = ALWAYS

    def __post_init__(self) -> None:
        super().__post_init__()
        begin, end = self.held
        read.refuse(not begin < end, "held", self.held, "two instants, the first before the second [s]")

    @property
    def ends(self) -> tuple[None, None, float]:
        """The turn [rad] that the body is led to (3,), None where it is free."""
        return None, None, self.angle

    @property
    def leads(self) -> read.History:
        """How it goes on in a motion."""
        return self.history


@dataclass(frozen=True, kw_only=True)
class Span:
    """A part of a motion, `begin` to `end` [s], on which all drives go at constant rates.

    Attributes:
        rates: of coordinate k of body b, under 3 b + k [m/s, rad/s].
        begins: whether a drive takes hold at its beginning.
    """

    begin: float
    end: float
    rates: Mapping[int, float]
    begins: bool

    @property
    def led(self) -> tuple[int, ...]:
        """The bodies whose centres are led."""
        return tuple(sorted({at // 3 for at in self.rates if at % 3 < 2}))

    def held(self, structure: Structure) -> Flags:
        """Return which coordinates of a structure are led (size,)."""
        return structure.flags([structure.first_body + at for at in self.rates])

    def caught(self, structure: Structure, y: Array, v: Array) -> Array:
        """Return velocities (size,) with the rates of the drives, all others as impulses of these leave them.

        The mass of a body may be off the point that is led: an impulse there turns it.

        Args:
            structure: reduced model in whose coordinates the motion is.
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s] before the impulse.
        """
        after, mass = v.copy(), mass_matrix(structure, y, "lumped")
        for at, rate in self.rates.items():
            after[structure.first_body + at] = rate
        held = self.held(structure) | (mass.data[mass.pattern.diagonal] == 0.0)
        # free coordinates take what keeps their momentum
        after -= mass.factors(held).solve(mass.times(after - v))
        return after

    def pieces(self, step: float, chunks: Sequence[int]) -> Iterator[tuple[float, float, int, bool]]:
        """Yield the pieces of a motion whose samples are `chunks` of steps [s] apart.

        Of each piece: begin and step [s], number of steps, and whether a sample is at its end.
        Chunks within which a span begins or ends are cut there, in whole steps of their own.
        """
        close, done = SAME * step * sum(chunks), 0
        for many in chunks:
            low, high = step * done, step * (done + many)
            done += many
            begin, end = max(low, self.begin), min(high, self.end)
            if end - begin >= high - low - close:
                yield low, step, many, True
            elif end - begin > close:
                steps = max(1, math.ceil((end - begin) / step * (1.0 - SAME)))
                yield begin, (end - begin) / steps, steps, end >= high - close


def drive_spans(model: Model, drive: DrivenRotation | None, duration: float) -> list[Span]:
    """Return the spans of a motion of `duration` [s], in order; without a drive, one free span.

    Raises:
        InvalidParameter: two drives of one coordinate.
    """
    every = [*model.every(Prescribed), *([drive] if drive else [])]
    drives = {at: led for at, led in model.prescribed(None, every).items() if led[1].leads}
    times = {duration}
    for _, effect in drives.values():
        times |= {*effect.held, *(time for time, _ in effect.leads)}
    instants = [0.0]
    for time in sorted(times):
        if instants[-1] + SAME * duration < time <= duration:
            instants.append(time)
    spans: list[Span] = []
    for begin, end in pairwise([*instants[:-1], duration]):
        rates = {
            at: (factor_of(led.leads, end) - factor_of(led.leads, begin)) / (end - begin) * target
            for at, (target, led) in drives.items()
            if led.held[0] < 0.5 * (begin + end) < led.held[1]
        }
        before = spans[-1].rates if spans else {}
        spans.append(Span(begin=begin, end=end, rates=rates, begins=bool(rates.keys() - before.keys())))
    return spans
