"""Samples of a motion, kept while it is computed, and what both integrators share."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Progress = Callable[[int, int], None]
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
