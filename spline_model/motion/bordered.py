"""Generalised-alpha for the paper's bordered system (Eq 4), clamps enforced by multipliers: plain, readable.

    M a1 + dV/dq(q1) - Psi_q(q1)^T lambda1 = 0,   psi(q1) = 0

The scheme is that of ``spline_model.motion.generalised_alpha``, which gives the same motion on reduced
coordinates; here are potentials in Python, which have no reduced form.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import get_lapack_funcs

from spline_model.compile import System
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import STRAIN, forward, record
from spline_model.motion.records import MOST_GAIN_OF_OTHERS, first_gain
from spline_model.motion.start import Array, Records
from spline_model.operator import evaluate, open_energy

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
            evaluate(self.system, z, 1.0, self.gradient, self.hessian)
            self.gradient[:count] += motion.mass @ acceleration
            norm = np.abs(self.gradient * motion.unit).max() / motion.energy
            if not np.isfinite(norm):
                return False
            if norm <= TOLERANCE:
                return self._accept(z, v, acceleration, pseudo)
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

    def _accept(self, z: Array, v: Array, acceleration: Array, pseudo: Array) -> bool:
        if not forward(z, self.motion.tables):
            return False
        self.z, self.v, self.acceleration, self.pseudo = z, v, acceleration, pseudo
        return True


def carry(stepper: Stepper, step: float, steps: int, every: int) -> Records:
    """Take ``steps`` steps, recording every ``every``-th one."""
    system, motion, z, v = stepper.system, stepper.motion, stepper.z, stepper.v
    strains, totals = np.empty(len(motion.rigidity)), np.zeros(2)
    states, rates, rows, message = [z], [v], [np.empty(7)], ""
    record(z, v, motion, strains, totals, rows[0])
    rows[0][STRAIN] += open_energy(system, z)
    for k in range(1, steps + 1):
        if not stepper.advance(step, step):
            message = f"stopped at {(k - 1) * step:.6g} s: Newton fails at any step"
            break
        if k % every == 0:
            states.append(stepper.z)
            rates.append(stepper.v)
            rows.append(np.empty(7))
            record(stepper.z, stepper.v, motion, strains, totals, rows[-1])
            rows[-1][STRAIN] += open_energy(system, stepper.z)
            if first_gain(np.array((rows[0], rows[-1])), motion.energy, MOST_GAIN_OF_OTHERS) < 2:
                message = f"stopped at {k * step:.6g} s: the energy grows; take a shorter step"
                states, rates, rows = states[:-1], rates[:-1], rows[:-1]
                break
    return Records(
        time=np.arange(0.0, len(states)) * (step * every),
        states=np.array(states),
        velocities=np.array(rates),
        rows=np.array(rows),
        message=message,
        counters=stepper.counters,
    )
