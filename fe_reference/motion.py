"""Samples of a motion, kept while it is computed, and its course: from span to span, whatever the scheme."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .actions import Actions, Resistance
from .drives import Leg, Span, legs
from .mass import RigidBodies, carried_over
from .structure import Structure

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
#: Keeps a sample: an instant [s], coordinates, velocities and what resists there; whether to go on.
Keep = Callable[[float, Array, Array, Resistance], bool]
#: Relative gain of energy above which a motion is called unstable: a sound one keeps within a thousandth.
BLOW_UP = 0.1
#: Part of EI/L that is at stake in any motion.
FLOOR = 1e-12


@dataclass(frozen=True, kw_only=True)
class Energy:
    """Energies of a state and what loads and dampers did until then [J].

    What is conserved is kinetic + strain + gravity - work + dissipated.
    """

    kinetic: float
    strain: float
    gravity: float = 0.0
    work: float = 0.0
    dissipated: float = 0.0

    @property
    def balance(self) -> float:
        """The conserved sum."""
        return self.kinetic + self.strain + self.gravity - self.work + self.dissipated

    @property
    def scale(self) -> float:
        """The energy that is at stake."""
        return max(self.kinetic + self.strain, abs(self.gravity), abs(self.work), self.dissipated)


@dataclass(kw_only=True, eq=False)
class Samples:
    """States of a motion in the reduced coordinates at the sampled instants, the start first.

    Attributes:
        time [s], y (size,), v (size,), energy: instants, coordinates, velocities, energies.
        unstable: whether the motion was stopped because its energy blew up.
        message: why and when the motion stopped early ("" if it did not).
        floor: energy that is at stake in any motion [J]: what loads put into a rest at first is held against
            it. blow_up: relative gain of energy that stops the motion. remarks: on what it leaves unresolved.
        books: work of loads and drives, and what dampers took, until now [J]. content: sums of a.M a and
            v.M v over implicit steps.
    """

    time: list[float] = field(default_factory=list)
    y: list[Array] = field(default_factory=list)
    v: list[Array] = field(default_factory=list)
    energy: list[Energy] = field(default_factory=list)
    counters: Counter[str] = field(default_factory=Counter)
    history: list[tuple[float, ...]] = field(default_factory=list)
    unstable: bool = False
    message: str = ""
    floor: float = 0.0
    blow_up: float = BLOW_UP
    remarks: list[str] = field(default_factory=list)
    books: Array = field(default_factory=lambda: np.zeros(2))
    content: Array = field(default_factory=lambda: np.zeros(2))
    _stake: float = 0.0

    def keep(self, time: float, y: Array, v: Array, energy: Energy) -> bool:
        """Keep a state if its energy is sound; otherwise note when it was lost and return False.

        The gain is measured against the largest energy at stake before this sample.
        """
        start = self.energy[0] if self.time else energy
        self._stake = max(self._stake, (self.energy[-1] if self.time else energy).scale)
        at_stake = max(self._stake, abs(energy.work), abs(energy.gravity), self.floor)
        if not np.isfinite(energy.balance) or energy.balance - start.balance > self.blow_up * at_stake:
            self.unstable = True
            self.message = (
                f"the energy grew from {start.balance:.6g} J to {energy.balance:.6g} J"
                f" between {self.time[-1]:.6g} s and {time:.6g} s"
            )
            return False
        self.time.append(time)
        self.y.append(y.copy())
        self.v.append(v.copy())
        self.energy.append(energy)
        return True

    def lost(self) -> float:
        """Return the part of the energy at stake that is gone at the end, neither work nor dissipation."""
        at_stake = max(self._stake, self.floor)
        return (self.energy[0].balance - self.energy[-1].balance) / at_stake if at_stake > 0.0 else 0.0

    def energies(self, name: str) -> Array:
        """Return one part of the energies over the samples (T,) [J]."""
        return np.array([getattr(each, name) for each in self.energy])


def sampling(steps: int, samples: int) -> list[int]:
    """Return the numbers of steps between samples: equal ones, the last perhaps shorter."""
    every = -(-steps // samples)
    whole, rest = divmod(steps, every)
    return [every] * whole + ([rest] if rest else [])


class Scheme(Protocol):
    """A way to integrate the motion of a structure reduced about points of its bodies.

    blow_up: relative gain of energy that stops a motion. bodies: about these points. mass (size,): lumped.
    """

    blow_up: float
    structure: Structure
    bodies: RigidBodies
    mass: Array
    actions: Actions

    def go(
        self, leg: Leg, y: Array, v: Array, held: NDArray[np.bool_], samples: Samples, keep: Keep
    ) -> tuple[Array, Array] | None:
        """Return coordinates and velocities after a leg, or None where the motion stopped."""

    def remarks(self, samples: Samples, step: float) -> list[str]:
        """Return what the step [s] leaves unresolved."""


def course(
    scheme_of: Callable[[tuple[int, ...]], Scheme],
    spans: Sequence[Span],
    y: Array,
    v: Array,
    step: float,
    chunks: list[int],
    progress: Progress | None = None,
) -> Samples:
    """Integrate from coordinates y and velocities v through the spans of a motion.

    Args:
        scheme_of: the scheme for the bodies whose centres are led; of none it is that of y, v and the
            samples.
        step: [s]. chunks: steps between samples.
        progress: called as progress(done, total) after every sample.
    """
    home = scheme = scheme_of(())
    samples = Samples(floor=FLOOR * home.structure.moment_unit, blow_up=home.blow_up)
    own, rates = y, v

    def kinetic(y: Array, v: Array) -> float:
        return 0.5 * float(home.mass @ carried_over(scheme.structure, y, home.structure, v) ** 2)

    def beside(y: Array, v: Array) -> float:
        """Kinetic energy that a body has beside the scheme's, as its mass is off the point that is led."""
        return kinetic(y, v) - 0.5 * float(scheme.mass @ v**2)

    def keep(time: float, y: Array, v: Array, acting: Resistance) -> bool:
        work, dissipated = samples.books
        energy = Energy(
            kinetic=kinetic(y, v),
            strain=acting.strain,
            gravity=acting.gravity,
            work=float(work) + beside(y, v) - apart,  # at constant rates drives do that work as well
            dissipated=float(dissipated),
        )
        place, speed = (carried_over(scheme.structure, y, home.structure, *rate) for rate in ((), (v,)))
        sound = samples.keep(time, place, speed, energy)
        if progress is not None and sound and time > 0.0:
            progress(len(samples.time) - 1, len(chunks))
        return sound

    for span in spans:
        before = scheme.structure
        scheme = scheme_of(span.led)
        own, rates = (carried_over(before, own, scheme.structure, *rate) for rate in ((), (rates,)))
        caught = span.caught(scheme.structure, scheme.bodies, own, rates)
        gained = kinetic(own, caught) - kinetic(own, rates)
        samples.books += (0.0, -gained) if span.begins else (gained, 0.0)
        rates, held = caught, span.held(scheme.structure)
        apart = beside(own, rates)
        if not samples.time:
            keep(0.0, own, rates, scheme.actions.resist(own, rates, 0.0))
        for leg in legs(span, step, chunks):
            after = scheme.go(leg, own, rates, held, samples, keep)
            if after is None:
                samples.remarks += home.remarks(samples, step)
                return samples
            own, rates = after
        samples.books[0] += beside(own, rates) - apart
    samples.remarks += home.remarks(samples, step)
    return samples
