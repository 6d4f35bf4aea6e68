"""Generalised-alpha for the paper's bordered system (Eq 4), clamps enforced by multipliers: plain, readable.

    M a1 + dV/dq(q1) - Psi_q(q1)^T lambda1 = 0,   psi(q1) = 0

The scheme is that of ``spline_model.motion.generalised_alpha``, which gives the same motion on reduced
coordinates; here are potentials in Python, which have no reduced form.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import get_lapack_funcs

from spline_model.bordered import evaluate, open_energy
from spline_model.checks import refuse
from spline_model.motion.moves import Unreduced
from spline_model.motion.records import MOST_GAIN_OF_OTHERS
from spline_model.motion.start import Array, Start
from spline_model.motion.step import FACTORISATIONS, NEWTON, STEPS

(gesv,) = get_lapack_funcs(("gesv",))  # without the checks and warnings of scipy.linalg.solve

TOLERANCE = 1e-10
MOST_ITERATIONS = 15


class Stepper(Unreduced):
    """One system's arrays and the scheme's constants; holds the state while it is advanced."""

    most_gain = MOST_GAIN_OF_OTHERS

    def __init__(self, start: Start, constants: Array) -> None:
        self.alpha_m, self.alpha_f, self.gamma, self.beta = constants
        self.motion, self.system, self.z, self.v = start.motion, start.motion.system, start.z, start.v
        self.acceleration = self.pseudo = start.acceleration
        size, scales = len(self.z), self.system.scales
        self.unknown, self.energy = scales.unit, scales.energy
        self.gradient, self.hessian = np.empty(size), np.empty((size, size))
        self.energies = evaluate(self.system, self.z, 1.0, self.gradient, self.hessian)
        self.counters = np.zeros(6, dtype=np.int64)
        self.width = size + len(self.v) + 3

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails; at any time, as nothing that acts has a history."""
        for number in range(begin, end):
            if not self._try(step):
                return number
            self.counters[STEPS] += 1
            if (number + 1) % every == 0:
                records[(number + 1) // every - begin // every - 1] = self.record()
        return end

    def _try(self, h: float) -> bool:
        count, motion = len(self.v), self.motion
        z, acceleration = self.z.copy(), np.zeros(count)
        pseudo = (self.alpha_f * self.acceleration - self.alpha_m * self.pseudo) / (1 - self.alpha_m)
        z[:count] += h * self.v + h**2 * ((0.5 - self.beta) * self.pseudo + self.beta * pseudo)
        v = self.v + h * ((1 - self.gamma) * self.pseudo + self.gamma * pseudo)
        rate = (1 - self.alpha_m) / (self.beta * h**2 * (1 - self.alpha_f))
        for _ in range(MOST_ITERATIONS):
            energies = evaluate(self.system, z, 1.0, self.gradient, self.hessian)
            self.gradient[:count] += motion.mass @ acceleration
            norm = np.abs(self.gradient * self.unknown).max() / self.energy
            if not np.isfinite(norm):
                return False
            if norm <= TOLERANCE:
                if refuse(self.system, z):
                    return False
                self.z, self.v, self.acceleration, self.pseudo = z, v, acceleration, pseudo
                self.energies = energies
                return True
            self.hessian[:count, :count] += rate * motion.mass
            change = self._solve()
            if change is None:
                return False
            z += change
            v += self.gamma / (self.beta * h) * change[:count]
            acceleration += rate * change[:count]
            pseudo += change[:count] / (self.beta * h**2)
        return False

    def _solve(self) -> Array | None:
        unit, energy = self.unknown, self.energy
        self.counters[[NEWTON, FACTORISATIONS]] += 1
        matrix = self.hessian * (unit[:, None] * unit / energy)
        _, _, change, failed = gesv(matrix, self.gradient * unit / energy)
        return None if failed else np.asarray(-unit * change)

    def record(self) -> Array:
        """The present state's record (W,); the axial forces are those that its strains give."""
        strain = sum(self.energies) + open_energy(self.system, self.z)
        return np.concatenate((self.z, self.v, (strain, 0.0, 0.0)))

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        angles = [f"{math.degrees(self.z[at]):.3g}" for at in self.motion.turns]
        return (
            f"no step, however short, goes on from {' and '.join(angles)} degrees; take more control points"
        )
