"""Implicit integration with the same elements and the same lumped masses: the generalised-alpha scheme.

    M ((1 - am) a_{n+1} + am a_n) + (1 - af) f(q_{n+1}) + af f(q_n) = 0
    q_{n+1} = q_n + h v_n + h^2 ((1/2 - b) a_n + b a_{n+1}),    v_{n+1} = v_n + h ((1 - g) a_n + g a_{n+1})

with am = (2 r - 1)/(r + 1), af = r/(r + 1), g = 1/2 - am + af, b = (1 - am + af)^2 / 4 and spectral radius r
at infinite frequency: second order, and high frequencies that the step does not resolve are damped if r < 1.
Energy is not conserved exactly in large motion; it is recorded. About the common centre of mass M is diagonal
and constant.

Source: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import SuperLU, splu

from .compiled import CompiledForces
from .mass import RigidBody, lumped_diagonal
from .motion import Progress, Samples
from .newton import round_off
from .structure import Structure

Array = NDArray[np.float64]

#: Iterations of one step. The tangent of an earlier step serves until the residual falls less than tenfold.
ITERATIONS = 20
SLOW = 0.1
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) where round-off allows it.
TOLERANCE = 1e-9
#: A step that fails is halved at most so often.
HALVINGS = 6


@dataclass(frozen=True, kw_only=True, eq=False)
class Instant:
    """Coordinates, velocities and accelerations (size,), internal force [N, N m] and strain energy [J]."""

    y: Array
    v: Array
    a: Array
    force: Array
    energy: float


class Implicit:
    """The scheme for one structure, reduced about the centre of mass of its `body`, at a spectral radius."""

    def __init__(self, structure: Structure, body: RigidBody, spectral_radius: float) -> None:
        r = spectral_radius
        self.structure = structure
        self.mass = lumped_diagonal(structure, body)
        self.am, self.af = (2.0 * r - 1.0) / (r + 1.0), r / (r + 1.0)
        self.gamma = 0.5 - self.am + self.af
        self.beta = 0.25 * (1.0 - self.am + self.af) ** 2
        self.tolerance = max(TOLERANCE, round_off(structure))

        self.compiled = CompiledForces(structure)
        self._factor: SuperLU | None = None
        self._factor_step = 0.0

    def start(self, y: Array, v: Array) -> Instant:
        """Return the initial instant with its consistent acceleration."""
        force, energy = self.compiled.forces(y)
        return Instant(y=y, v=v, a=-force / self.mass, force=force, energy=energy)

    def step(self, now: Instant, h: float, samples: Samples, depth: int = 0) -> Instant | None:
        """Return the instant after h [s], in halved steps where needed; None if those fail too."""
        after = self._single(now, h, samples)
        if after is not None:
            return after
        samples.counters["halvings"] += 1
        if depth == HALVINGS:
            return None
        middle = self.step(now, 0.5 * h, samples, depth + 1)
        return None if middle is None else self.step(middle, 0.5 * h, samples, depth + 1)

    def _single(self, now: Instant, h: float, samples: Samples) -> Instant | None:
        """Return the instant after one step of h [s], or None if the iteration does not converge."""
        mass, scale = self.mass, self.structure.scale
        coasting = now.y + h * now.v + h**2 * (0.5 - self.beta) * now.a
        held = self.am * mass * now.a + self.af * now.force
        reach = self.beta * h**2
        # the unknown is the acceleration: taken from differences of positions it would drown in round-off
        a, norms = now.a.copy(), [np.inf]
        for _ in range(ITERATIONS):
            y = coasting + reach * a
            force, energy = self.compiled.forces(y)
            residual = (1.0 - self.am) * mass * a + (1.0 - self.af) * force + held
            norms.append(float(np.abs(residual / scale).max()))
            samples.counters["force_evaluations"] += 1
            if norms[-1] <= self.tolerance:
                v = now.v + h * ((1.0 - self.gamma) * now.a + self.gamma * a)
                return Instant(y=y, v=v, a=a, force=force, energy=energy)
            if not np.isfinite(norms[-1]):
                break
            samples.counters["iterations"] += 1
            factor = self._factor
            if factor is None or h != self._factor_step or norms[-1] > SLOW * norms[-2]:
                factor = self._factorise(y, h, samples)
            a -= factor.solve(residual) / reach
        samples.history.append(tuple(norms[1:]))
        self._factor = None
        return None

    def _factorise(self, y: Array, h: float, samples: Samples) -> SuperLU:
        """Factorise the tangent of a step of h [s] at y, and keep the factors for the steps that follow."""
        inertia = diags_array((1.0 - self.am) / (self.beta * h**2) * self.mass)
        tangent = (1.0 - self.af) * self.structure.tangent_stiffness(y) + inertia
        self._factor, self._factor_step = splu(tangent.tocsc(), options={"SymmetricMode": True}), h
        samples.counters["factorisations"] += 1
        return self._factor

    def run(self, y: Array, v: Array, step: float, chunks: list[int], progress: Progress | None) -> Samples:
        """Integrate from coordinates y and velocities v over chunks of steps; keep a sample after each."""
        samples, now, done = Samples(), self.start(y, v), 0
        self._keep(samples, now, 0.0)
        for number, steps in enumerate(chunks, start=1):
            for _ in range(steps):
                after = self.step(now, step, samples)
                if after is None:
                    samples.message = f"no solution of the step of {step:.3g} s at {done * step:.6g} s"
                    return samples
                now, done = after, done + 1
                samples.counters["steps"] += 1
            if not self._keep(samples, now, done * step):
                break
            if progress is not None:
                progress(number, len(chunks))
        return samples

    def _keep(self, samples: Samples, now: Instant, time: float) -> bool:
        kinetic = 0.5 * float(self.mass @ now.v**2)
        return samples.keep(time, now.y, now.v, kinetic, now.energy)
