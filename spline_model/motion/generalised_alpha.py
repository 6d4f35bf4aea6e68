"""Generalised-alpha on reduced coordinates, compiled; equal to the scheme with multipliers.

    M a1 + dV/dq(q1) - Psi_q(q1)^T lambda1 = 0,   psi(q1) = 0
    q1 = q0 + h v0 + h^2 ((1/2 - beta) p0 + beta p1),   v1 = v0 + h ((1 - gamma) p0 + gamma p1)
    (1 - alpha_m) p1 + alpha_m p0 = (1 - alpha_f) a1 + alpha_f a0

a1 is linear in q1, so that q1 = q(y1) and the first line times dq/dy remain: a step is an equilibrium with
springs of the stiffness (1 - alpha_m) / ((1 - alpha_f) beta h^2) M. Its forces and tangent are those of
``spline_model.motion.step`` between a state and itself: a discrete gradient there is the gradient, and its
derivative half the Hessian.

Second order; ``spectral_radius`` rho at infinite frequency sets the numerical damping (1 none, 0 most):
alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 + alpha_f - alpha_m,
beta = (gamma + 1/2)^2 / 4. Energy is not conserved, and far above the resolved frequencies the nonlinear
scheme may fail. Source: Arnold and Bruls, Multibody Syst Dyn 18 (2007) 185.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.errors import InvalidParameter
from spline_model.motion import bordered, energy_consistent
from spline_model.motion.energy_consistent import clamp_forces, forward, store
from spline_model.motion.moves import Moves
from spline_model.motion.records import MOST_GAIN_OF_OTHERS
from spline_model.motion.start import Start
from spline_model.motion.step import (
    FACTORISATIONS,
    FOLDS,
    NEWTON,
    REFUSED,
    STEPS,
    assemble,
    guess_step,
    improve,
)
from spline_model.motion.strip import set_points
from spline_model.strip.compiled import copy, kernel, part

Array = NDArray[np.float64]

MOST_ITERATIONS = 15
SPECTRAL_RADIUS = 0.8
TOLERANCE = 1e-10
"""Residual of a step, in EI/L^2, EI/L and L."""


class _Alpha(NamedTuple):
    """The scheme's constants (4,) alpha_m, alpha_f, gamma, beta, and its own state.

    q, v, a, p (C,): coordinates of bodies and control points, their velocities, accelerations,
    pseudo-accelerations; moved, target (C,): q1 - q0, and the same without a1: a1 follows from a difference
    that would drown in the coordinates' own round-off; y (Y,) at the step's start. places, rates, pushes (C,)
    are the state's own: of bodies and control points one after the other.
    """

    constants: Array
    q: Array
    v: Array
    a: Array
    p: Array
    moved: Array
    target: Array
    y: Array
    places: Array
    rates: Array
    pushes: Array


def constants(spectral_radius: float) -> Array:
    """alpha_m, alpha_f, gamma, beta."""
    rho = spectral_radius
    alpha_m, alpha_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 + alpha_f - alpha_m
    return np.array([alpha_m, alpha_f, gamma, (gamma + 0.5) ** 2 / 4])


@part()
def _begin(h, alpha, state, strips, masses, work):
    """The step's target, and a first guess of y."""
    alpha_m, alpha_f, beta = alpha.constants[0], alpha.constants[1], alpha.constants[3]
    for i in range(alpha.q.size):
        pseudo = (alpha_f * alpha.a[i] - alpha_m * alpha.p[i]) / (1.0 - alpha_m)
        mean = (0.5 - beta) * alpha.p[i] + beta * pseudo
        alpha.pushes[i] = 2.0 * mean
        alpha.target[i] = h * alpha.v[i] + 0.5 * h * h * alpha.pushes[i]
    copy(alpha.v, alpha.rates)
    guess_step(h, state, strips, masses, work)
    modes, own = strips.compliance.shape[1], strips.own
    for i in range(masses.inertia.size):
        alpha.moved[i] = 2.0 * math.atan(0.5 * work.dy[i]) if i % 3 == 2 else work.dy[i]
        state.y[i] += alpha.moved[i]
    for s in range(strips.roots.size):
        at = masses.inertia.size + s * (own + modes)
        for i in range(at, at + own):
            state.y[i] += work.dy[i]


@part()
def _equilibrium(stiffness, h, alpha, state, strips, masses, work):
    """Residual and tangent at y, with the inertia of a1 = stiffness (q1 - target); the largest residual."""
    n, modes, poses = strips.mass.shape[1], strips.compliance.shape[1], masses.inertia.size
    own = strips.own
    set_points(state, strips, masses)
    for i in range(poses):  # so that 2 m / h (0 - rate) is the inertia
        state.rate[i] = -0.5 * h * stiffness * (alpha.moved[i] - alpha.target[i])
        work.dy[i] = work.load[i] = 0.0
    for s in range(strips.roots.size):
        at, place = poses + s * (own + modes), poses + 2 * n * s
        for i in range(own):
            work.dy[at + i] = 0.0
        for k in range(modes):
            work.dy[at + own + k] = state.y[at + own + k]
        for k in range(2):
            for i in range(n):
                alpha.moved[place + k * n + i] = state.points[s, k, i] - alpha.q[place + k * n + i]
        for i in range(n):
            for k in range(2):
                total = 0.0
                for j in range(n):
                    c = place + k * n + j
                    total += strips.mass[s, i, j] * (alpha.moved[c] - alpha.target[c])
                work.steady[s, k, i] = stiffness * total - strips.dead[s, k, i]
            for j in range(n):
                work.stiff[s, i, j] = 0.5 * stiffness * strips.mass[s, i, j]
    return assemble(h, state, strips, masses, work)


@part()
def _solve(stiffness, alpha, state, strips, masses, work, counters):
    """Newton for y; True if the residual came below TOLERANCE."""
    modes, own = strips.compliance.shape[1], strips.own
    poses, h, before = masses.inertia.size, 2.0 / math.sqrt(stiffness), math.inf
    for _ in range(MOST_ITERATIONS):
        norm = _equilibrium(stiffness, h, alpha, state, strips, masses, work)
        if not norm < 1e12:
            return False
        if norm <= TOLERANCE or (norm <= 1e3 * TOLERANCE and norm > 0.5 * before):
            return True
        before = norm
        if not improve(strips, masses, work):
            return False
        counters[NEWTON] += 1
        counters[FACTORISATIONS] += 1
        for i in range(state.y.size):
            if i < poses or (i - poses) % (own + modes) < own:  # of half the tangent
                state.y[i] += 0.5 * work.dy[i]
                if i < poses:
                    alpha.moved[i] += 0.5 * work.dy[i]
            else:
                state.y[i] = work.dy[i]
    return False


@part()
def _accept(h, stiffness, alpha, state, strips, work):
    """Velocities, accelerations and pseudo-accelerations of a step that was solved, and clamp forces."""
    alpha_m, alpha_f = alpha.constants[0], alpha.constants[1]
    gamma, beta = alpha.constants[2], alpha.constants[3]
    for i in range(state.rate.size):
        alpha.places[i] = state.y[i]
    copy(alpha.places, alpha.q)
    for i in range(alpha.q.size):
        change = alpha.moved[i] - alpha.target[i]
        pseudo = (alpha_f * alpha.a[i] - alpha_m * alpha.p[i]) / (1.0 - alpha_m)
        alpha.v[i] += h * ((1.0 - gamma) * alpha.p[i] + gamma * pseudo) + gamma / (beta * h) * change
        alpha.a[i], alpha.p[i] = stiffness * change, pseudo + change / (beta * h * h)
    copy(state.y, alpha.y)
    for s in range(strips.roots.size):
        clamp_forces(s, state, strips, work)


@kernel()
def _run(step, first, end, every, alpha, state, strips, masses, work, counters, records):
    """Take the steps ``first`` ... ``end`` - 1; returns the first that fails, or end.

    records: filled at the ends of steps whose number ``every`` divides.
    """
    alpha_m, alpha_f, beta = alpha.constants[0], alpha.constants[1], alpha.constants[3]
    stiffness = (1.0 - alpha_m) / (beta * step * step * (1.0 - alpha_f))
    for number in range(first, end):
        _begin(step, alpha, state, strips, masses, work)
        solved = _solve(stiffness, alpha, state, strips, masses, work, counters)
        if not solved or not forward(state, strips, masses, work):
            copy(alpha.y, state.y)
            set_points(state, strips, masses)
            counters[REFUSED] = FOLDS if solved else 0
            return number
        _accept(step, stiffness, alpha, state, strips, work)
        counters[STEPS] += 1
        if (number + 1) % every == 0:
            copy(alpha.v, alpha.rates)
            store(state, strips, masses, work, records[(number + 1) // every - first // every - 1])
    return end


def _joined(bodies: Array, points: Array) -> tuple[Array, Array, Array]:
    """Numbers of bodies (Q,) and of control points (S, 2, n) in one array (C,), and its views of either."""
    both = np.concatenate((bodies, points.ravel()))
    return both, both[: bodies.size], both[bodies.size :].reshape(points.shape)


class _Stepper(energy_consistent.Stepper):
    """A free scene that the scheme advances."""

    most_gain = MOST_GAIN_OF_OTHERS

    def __init__(self, start: Start, constants: Array) -> None:
        super().__init__(start)
        state, bodies = self._state, self._state.rate.size
        places, _, points = _joined(state.y[:bodies], state.points)
        rates, rate, velocity = _joined(state.rate, state.velocity)
        pushes, push, acceleration = _joined(state.push, state.acceleration)
        self._state = state._replace(
            points=points, rate=rate, velocity=velocity, push=push, acceleration=acceleration
        )
        self._alpha = _Alpha(
            constants=constants,
            q=places.copy(),
            v=rates.copy(),
            a=pushes.copy(),
            p=pushes.copy(),
            moved=np.zeros_like(places),
            target=np.zeros_like(places),
            y=state.y.copy(),
            places=places,
            rates=rates,
            pushes=pushes,
        )

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The number of the first step that fails; at any time, as nothing that acts has a history."""
        model = self._model
        given = self._alpha, self._state, model.strips, model.masses, self._work, self.counters
        return int(_run(step, begin, end, every, *given, records))


def stepper(start: Start, spectral_radius: float = SPECTRAL_RADIUS) -> Moves:
    """What advances a free scene by the scheme.

    Potentials in Python, which the element does not know, ask for the scheme with multipliers.
    """
    start.motion.require_conservative("generalised-alpha")
    if not 0.0 <= spectral_radius <= 1.0:
        raise InvalidParameter("spectral_radius", spectral_radius, "a number from 0 to 1")
    form = bordered.Stepper if start.motion.system.open_potentials else _Stepper
    return form(start, constants(spectral_radius))
