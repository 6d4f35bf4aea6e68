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


@dataclass(kw_only=True, eq=False)
class Samples:
    """States of a motion in the reduced coordinates at the sampled instants, the start first.

    Attributes:
        time [s], y (size,), v (size,): instants, coordinates and velocities.
        kinetic, strain: energies [J].
        unstable: whether the motion was stopped because its energy blew up.
        message: why and when the motion stopped early ("" if it did not).
    """

    time: list[float] = field(default_factory=list)
    y: list[Array] = field(default_factory=list)
    v: list[Array] = field(default_factory=list)
    kinetic: list[float] = field(default_factory=list)
    strain: list[float] = field(default_factory=list)
    counters: Counter[str] = field(default_factory=Counter)
    history: list[tuple[float, ...]] = field(default_factory=list)
    unstable: bool = False
    message: str = ""

    def keep(self, time: float, y: Array, v: Array, kinetic: float, strain: float) -> bool:
        """Keep a state if its energy is sound; otherwise note when it was lost and return False."""
        energy = kinetic + strain
        start = self.kinetic[0] + self.strain[0] if self.time else energy
        if not np.isfinite(energy) or energy > (1.0 + BLOW_UP) * start:
            self.unstable = True
            self.message = (
                f"the energy grew from {start:.6g} J to {energy:.6g} J"
                f" between {self.time[-1]:.6g} s and {time:.6g} s"
            )
            return False
        self.time.append(time)
        self.y.append(y.copy())
        self.v.append(v.copy())
        self.kinetic.append(kinetic)
        self.strain.append(strain)
        return True


def sampling(steps: int, samples: int) -> list[int]:
    """Return the numbers of steps between samples: equal ones, the last perhaps shorter."""
    every = -(-steps // samples)
    whole, rest = divmod(steps, every)
    return [every] * whole + ([rest] if rest else [])
