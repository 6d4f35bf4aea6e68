"""Generalised-alpha for the paper's bordered system (Eq 4), clamps enforced by multipliers: plain, readable.

    M a1 + dV/dq(q1) - Psi_q(q1)^T lambda1 = 0,   psi(q1) = 0

The scheme is that of ``spline_model.motion.generalised_alpha``, which gives the same motion on reduced
coordinates; here are potentials in Python, which have no reduced form.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import get_lapack_funcs

from spline_model.bordered import evaluate, open_energy
from spline_model.checks import refuse
from spline_model.compile import System
from spline_model.motion.records import MOST_GAIN_OF_OTHERS, Records, first_gain, records_of, rows_of
from spline_model.motion.start import Array, Motion

(gesv,) = get_lapack_funcs(("gesv",))  # without the checks and warnings of scipy.linalg.solve

TOLERANCE = 1e-10
MOST_ITERATIONS = 15
SMALLEST_STEP = 2.0**-8


class Stepper:
    """One system's arrays and the scheme's constants; holds the state while it is advanced."""

    def __init__(
        self, system: System, motion: Motion, z: Array, v: Array, acceleration: Array, constants: Array
    ) -> None:
        self.alpha_m, self.alpha_f, self.gamma, self.beta = constants
        self.system, self.motion, self.z, self.v = system, motion, z.copy(), v.copy()
        self.acceleration, self.pseudo = acceleration.copy(), acceleration.copy()
        size = len(z)
        self.gradient, self.hessian = np.empty(size), np.empty((size, size))
        self.energies = evaluate(system, self.z, 1.0, self.gradient, self.hessian)
        self.counters = {"steps": 0, "halved_steps": 0, "newton_iterations": 0, "factorisations": 0}

    def advance(self, duration: float, step: float) -> bool:
        """Advance by ``duration``; steps whose Newton fails are halved; False if none succeeds."""
        done, h = 0.0, step
        while duration - done > 1e-9 * duration:
            h = min(h, duration - done)
            if self._try(h):
                self.counters["steps"] += 1
                done += h
                h = min(2 * h, step)
                continue
            self.counters["halved_steps"] += 1
            h /= 2
            if h < SMALLEST_STEP * step:
                return False
        return True

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
            norm = np.abs(self.gradient * motion.unit).max() / motion.energy
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
        unit, energy = self.motion.unit, self.motion.energy
        self.counters["newton_iterations"] += 1
        self.counters["factorisations"] += 1
        matrix = self.hessian * (unit[:, None] * unit / energy)
        _, _, change, failed = gesv(matrix, self.gradient * unit / energy)
        return None if failed else np.asarray(-unit * change)

    def row(self) -> Array:
        """The row of the present state (5,); the axial forces are those that its strains give."""
        strain = sum(self.energies) + open_energy(self.system, self.z)
        rows = rows_of(self.motion, self.z[None], self.v[None], np.array([[strain, 0.0, 0.0]]))
        return np.asarray(rows[0])


def carry(stepper: Stepper, step: float, steps: int, every: int) -> Records:
    """Take ``steps`` steps, recording every ``every``-th one."""
    states, rates, rows, message = [stepper.z], [stepper.v], [stepper.row()], ""
    for k in range(1, steps + 1):
        if not stepper.advance(step, step):
            message = f"stopped at {(k - 1) * step:.6g} s: Newton fails at any step"
            break
        if k % every == 0:
            states.append(stepper.z)
            rates.append(stepper.v)
            rows.append(stepper.row())
            if first_gain(np.array((rows[0], rows[-1])), stepper.motion.energy, MOST_GAIN_OF_OTHERS) < 2:
                message = f"stopped at {k * step:.6g} s: the energy grows; take a shorter step"
                states, rates, rows = states[:-1], rates[:-1], rows[:-1]
                break
    z, v, energies = (np.array(each) for each in (states, rates, rows))
    return records_of(stepper.motion, step * every, z, v, energies, message, stepper.counters)
