"""Strips as one beam each in closed form: the beam constraint model of Awtar.

Of a beam of length L, with everything over L, EI/L^2 and EI/L, let u be the displacement of its tip along it
and v = (y, theta) that across it and its rotation, in the frame of its root, and c = I / (A L^2). Stiffness
and shortening are those of the beam-column up to the second power of the axial force p,

    (f, m) = (K0 + p K1 + p^2 K2) v,      u = c p - v K1 v / 2 - p v K2 v

    K0 = [12 -6; -6 4],  K1 = [6/5 -1/10; -1/10 2/15],  K2 = [-1/700 1/1400; 1/1400 -11/6300]

which are the derivatives of the energy

    V = v K0 v / 2 + a^2 / (2 b),   a = u + v K1 v / 2,   b = c - v K2 v,   p = a / b

The model is for deflections up to about a tenth of the length. Exact for small displacements at small axial
forces; neglects large rotations of the beam itself. In motion a beam is the cubic of its end tangents.

A rotation leaves the place of the body free; it is solved for from rest on.

Source: S. Awtar, A. H. Slocum, E. Sevincer, Journal of Mechanical Design 129 (2007) 625; the energy is
derived here.
"""

import math
from dataclasses import dataclass

import numpy as np

from studies.cases.problem import Problem
from studies.cost.model import Law, State, Surrogate, geometry_of
from studies.errors import Unanswered
from studies.kinds import Array

K0 = np.array([[12.0, -6.0], [-6.0, 4.0]])
K1 = np.array([[6.0 / 5.0, -1.0 / 10.0], [-1.0 / 10.0, 2.0 / 15.0]])
K2 = np.array([[-1.0 / 700.0, 1.0 / 1400.0], [1.0 / 1400.0, -11.0 / 6300.0]])
#: Mass matrix of a cubic with the place and slope of its tip, its root at rest, over mu L / 420.
CUBIC = np.array([[156.0, -22.0], [-22.0, 4.0]])
#: Tolerance of the residual [EI/L^2], and most iterations of a step.
TOLERANCE, ITERATIONS = 1e-10, 40
#: Largest turn of a step to a rotation [rad].
STEP = 0.1


def _element(u: Array, v: Array, compliance: float) -> tuple[Array, Array, Array]:
    """Return V (S,), its gradient (S, 3) and its Hessian (S, 3, 3) by (u, y, theta).

    Args:
        u: (S,). v: (S, 2). compliance: c [1].
    """
    k1, k2 = v @ K1, v @ K2
    a = u + 0.5 * np.einsum("si,si->s", v, k1)
    b = compliance - np.einsum("si,si->s", v, k2)
    p = (a / b)[:, None]
    energy = 0.5 * np.einsum("si,ij,sj->s", v, K0, v) + 0.5 * a**2 / b
    gradient = np.concatenate((p, v @ K0 + p * k1 + p**2 * k2), axis=1)
    w = np.concatenate((np.ones_like(p), k1 + 2.0 * p * k2), axis=1)
    hessian = w[:, :, None] * w[:, None, :] / b[:, None, None]
    hessian[:, 1:, 1:] += K0 + p[..., None] * K1 + p[..., None] ** 2 * K2
    return energy, gradient, hessian


@dataclass(frozen=True, kw_only=True)
class _Strips:
    """Two strips of one length between the ground and a body; lengths over L.

    The coordinates of a state are the place of the body and its rotation.

    Attributes:
        root: (2, 2) ground ends. direction: (2, 2) unit vectors from there to the body.
        centre: (2,) of the body at rest. compliance: I / (A L^2) [1].
    """

    root: Array
    direction: Array
    centre: Array
    compliance: float

    def _arm(self, strip: int, p: Array) -> Array:
        """Return the way from the body's centre to the tip of a strip at rotations (S,), (S, 2)."""
        x, y = self.root[strip] + self.direction[strip] - self.centre
        cosine, sine = np.cos(p), np.sin(p)
        return np.stack((cosine * x - sine * y, sine * x + cosine * y), axis=1)

    def assembled(self, y: Array) -> tuple[Array, Array, Array]:
        """Return V (S,), its gradient (S, 3) and Hessian (S, 3, 3) [EI/L] at coordinates (S, 3)."""
        energy, gradient, hessian = np.zeros(len(y)), np.zeros((len(y), 3)), np.zeros((len(y), 3, 3))
        for strip, along in enumerate(self.direction):
            frame = np.stack((along, _quarter_turned(along)))
            arm = self._arm(strip, y[:, 2])
            tip = (y[:, :2] + arm - self.root[strip]) @ frame.T
            v, g, h = _element(tip[:, 0] - 1.0, np.stack((tip[:, 1], y[:, 2]), axis=1), self.compliance)
            jacobian = np.tile(np.eye(3), (len(y), 1, 1))
            jacobian[:, :2, :2], jacobian[:, :2, 2] = frame, _quarter_turned(arm) @ frame.T
            energy += v
            gradient += np.einsum("sk,ski->si", g, jacobian)
            hessian += np.swapaxes(jacobian, 1, 2) @ h @ jacobian
            hessian[:, 2, 2] -= (g[:, :2] * (arm @ frame.T)).sum(axis=1)
        return energy, gradient, hessian

    def turned(self, p: Array) -> tuple[Array, Array]:
        """Return the coordinates (S, 3) at rotations (S,), reached from rest, and the derivative.

        Raises:
            Unanswered: there is no equilibrium on the way.
        """
        furthest = float(np.abs(p).max(initial=0.0))
        steps = max(1, math.ceil(furthest / STEP))
        y = np.tile((*self.centre, 0.0), (len(p), 1))
        slope = np.zeros_like(y)
        for step in range(steps + 1):
            ahead = step / steps * p - y[:, 2]
            y += ahead[:, None] * slope
            y[:, 2] = step / steps * p
            hessian = self._settle(y, step / steps * furthest)
            slope = np.ones_like(y)
            slope[:, :2] = -np.linalg.solve(hessian[:, :2, :2], hessian[:, :2, 2:])[..., 0]
        return y, slope

    def _settle(self, y: Array, furthest: float) -> Array:
        """Move the body's place in y (S, 3) to equilibrium; return the Hessian.

        Raises:
            Unanswered: there is none, `furthest` being the largest rotation [rad].
        """
        for _ in range(ITERATIONS):
            _, gradient, hessian = self.assembled(y)
            if np.abs(gradient[:, :2]).max() < TOLERANCE:
                return hessian
            y[:, :2] -= np.linalg.solve(hessian[:, :2, :2], gradient[:, :2, None])[..., 0]
        raise Unanswered(f"constraint model: no equilibrium on the way to {math.degrees(furthest):.3g} deg")

    def moving(self, y: Array, slope: Array) -> Array:
        """Return the strips' part of M over mu L^3 (S,): a cubic each."""
        total = np.zeros(len(y))
        for strip, along in enumerate(self.direction):
            arm = self._arm(strip, y[:, 2])
            turn = y[:, 2] + math.atan2(along[1], along[0])
            tangent = np.stack((-np.sin(turn), np.cos(turn)), axis=1)
            rates = np.stack((slope[:, :2] + _quarter_turned(arm), tangent), axis=1)
            total += np.einsum("ija,jk,ika->i", rates, CUBIC, rates) / 420.0
        return total


def _quarter_turned(vectors: Array) -> Array:
    """Return vectors (..., 2) turned counter-clockwise by 90 degrees."""
    return np.stack((-vectors[..., 1], vectors[..., 0]), axis=-1)


def _law_of(problem: Problem) -> Law:
    """Return the law of a pivot."""
    at_rest, length = geometry_of(problem), problem.length
    strips = _Strips(
        root=at_rest.root / length,
        direction=at_rest.direction,
        centre=at_rest.centre / length,
        compliance=problem.second_moment_of_area / (problem.area * length**2),
    )
    scale = problem.youngs_modulus * problem.second_moment_of_area / length
    mass, turning = problem.density * problem.area * length, problem.body_moment_of_inertia / length**2

    def law(p: Array) -> State:
        y, slope = strips.turned(p)
        energy, gradient, hessian = strips.assembled(y)
        speed = np.einsum("si,si->s", slope[:, :2], slope[:, :2])
        inertia = turning + problem.body_mass * speed + mass * strips.moving(y, slope)
        return State(
            centre=y[:, :2] * length,
            energy=scale * energy,
            torque=scale * gradient[:, 2],
            stiffness=scale * np.einsum("si,si->s", hessian[:, 2], slope),
            inertia=inertia * length**2,
        )

    return law


constraint_model = Surrogate(name="beam constraint model", law_of=_law_of)
