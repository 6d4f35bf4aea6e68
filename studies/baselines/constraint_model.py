"""Strips as one or several beams in closed form: the beam constraint model of Awtar, and its chained form.

Of a beam of length l, with everything over l, EI/l^2 and EI/l, let u be the displacement of its tip along it
and v = (y, theta) that across it and its rotation, in the frame of its root, and c = I / (A l^2). Stiffness
and shortening are those of the beam-column up to the second power of the axial force p,

    (f, m) = (K0 + p K1 + p^2 K2) v,      u = c p - v K1 v / 2 - p v K2 v

    K0 = [12 -6; -6 4],  K1 = [6/5 -1/10; -1/10 2/15],  K2 = [-1/700 1/1400; 1/1400 -11/6300]

which are the derivatives of the energy

    V = v K0 v / 2 + a^2 / (2 b),   a = u + v K1 v / 2,   b = c - v K2 v,   p = a / b

One beam a strip is Awtar's model, for deflections up to about a tenth of the length; several in a row, each
in the frame where it begins, are the chained model, for any. Exact for small displacements at small axial
forces; leaves out that a beam's own rotation is large. In motion a beam is the cubic of its end tangents.

Of a pivot a rotation leaves free the body's place and, in the chained form, the nodes within the strips; they
are solved for from rest on.

Source: S. Awtar, A. H. Slocum, E. Sevincer, Journal of Mechanical Design 129 (2007) 625; F. Ma, G. Chen,
Journal of Mechanisms and Robotics 8 (2016) 021018; the energy is derived here.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from studies.baselines.answer import BaselineFailed, geometry_of
from studies.baselines.one_coordinate import Law, State, Surrogate
from studies.cases.problem import Problem
from studies.kinds import Array

K0 = np.array([[12.0, -6.0], [-6.0, 4.0]])
K1 = np.array([[6.0 / 5.0, -1.0 / 10.0], [-1.0 / 10.0, 2.0 / 15.0]])
K2 = np.array([[-1.0 / 700.0, 1.0 / 1400.0], [1.0 / 1400.0, -11.0 / 6300.0]])
#: Mass matrix of a cubic with the places and slopes of its ends, over mu l / 420.
CUBIC = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]], dtype=float)
#: Tolerance of the residual [EI/L^2], and most iterations of a step.
TOLERANCE, ITERATIONS = 1e-10, 40
#: Beams a strip of the chained model.
CHAINED = 4
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


def _placed(
    start: Array, end: Array, angle: float, length: float, compliance: float
) -> tuple[Array, Array, Array]:
    """Return energy [EI/L], gradient (S, 6) and Hessian (S, 6, 6) by both ends' places and turns.

    Args:
        start, end: (S, 3) x, y over L, turn. angle: of the beam at rest [rad]. length: l over L.
    """
    turn = start[:, 2] + angle
    along = np.stack((np.cos(turn), np.sin(turn)), axis=1)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1)
    apart = (end - start)[:, :2] / length
    x, y = (apart * along).sum(axis=1), (apart * across).sum(axis=1)
    values, gradient, hessian = _element(x - 1.0, np.stack((y, end[:, 2] - start[:, 2]), axis=1), compliance)
    frame = np.stack((along, across), axis=1) / length
    jacobian = np.zeros((len(x), 3, 6))
    jacobian[:, :2, :2], jacobian[:, :2, 3:5] = -frame, frame
    jacobian[:, 0, 2], jacobian[:, 1, 2] = y, -x
    jacobian[:, 2, 2], jacobian[:, 2, 5] = -1.0, 1.0
    whole = np.einsum("ski,skl,slj->sij", jacobian, hessian, jacobian)
    # places in the frame of the root turn with it
    mixed = gradient[:, :1] * frame[:, 1] - gradient[:, 1:2] * frame[:, 0]
    for columns, sign in ((slice(0, 2), -1.0), (slice(3, 5), 1.0)):
        whole[:, 2, columns] += sign * mixed
        whole[:, columns, 2] += sign * mixed
    whole[:, 2, 2] -= gradient[:, 0] * x + gradient[:, 1] * y
    return values / length, np.einsum("sk,ski->si", gradient, jacobian) / length, whole / length


@dataclass(frozen=True, kw_only=True)
class _Strips:
    """Two strips of one length between the ground and a body, with `count` beams each; lengths over L.

    Attributes:
        root: (2, 2) at rest. direction: (2, 2) unit, to the body. centre: (2,) of the body, where forces act.
        compliance: I / (A L^2) [1].
    """

    root: Array
    direction: Array
    centre: Array
    compliance: float
    count: int

    @property
    def unknowns(self) -> int:
        """Coordinates: those of the inner nodes of both strips, the body's place, its rotation last."""
        return 6 * (self.count - 1) + 3

    def rest(self) -> Array:
        """Return the coordinates at rest."""
        inner = np.zeros((2, self.count - 1, 3))
        for strip in range(2):
            inner[strip, :, :2] = self.nodes(strip)[1:-1]
        return np.concatenate((inner.ravel(), self.centre, [0.0]))

    def nodes(self, strip: int) -> Array:
        """Return the nodes of a strip at rest (count + 1, 2)."""
        part = np.linspace(0.0, 1.0, self.count + 1)[:, None]
        return np.asarray(self.root[strip] + part * self.direction[strip])

    def angle(self, strip: int) -> float:
        """Return the angle of a strip at rest [rad]."""
        return math.atan2(self.direction[strip][1], self.direction[strip][0])

    def ends(self, y: Array, strip: int, node: int) -> tuple[Array, Array, Array]:
        """Return a node (S, 3), its Jacobian (S, 3, N) and its place's second derivative by p (S, 2)."""
        states, jacobian = len(y), np.zeros((len(y), 3, self.unknowns))
        curved = np.zeros((states, 2))
        if node == 0:
            return np.tile((*self.root[strip], 0.0), (states, 1)), jacobian, curved
        if node < self.count:
            first = 3 * (strip * (self.count - 1) + node - 1)
            jacobian[:, range(3), range(first, first + 3)] = 1.0
            return y[:, first : first + 3], jacobian, curved
        arm = self.nodes(strip)[-1] - self.centre
        cosine, sine = np.cos(y[:, -1]), np.sin(y[:, -1])
        turned = np.stack((cosine * arm[0] - sine * arm[1], sine * arm[0] + cosine * arm[1]), axis=1)
        jacobian[:, range(2), range(self.unknowns - 3, self.unknowns - 1)] = 1.0
        jacobian[:, 0, -1], jacobian[:, 1, -1], jacobian[:, 2, -1] = -turned[:, 1], turned[:, 0], 1.0
        return np.concatenate((y[:, -3:-1] + turned, y[:, -1:]), axis=1), jacobian, -turned

    def assembled(self, y: Array) -> tuple[Array, Array, Array]:
        """Return V (S,), its gradient (S, N) and Hessian (S, N, N) [EI/L] at coordinates (S, N)."""
        length = 1.0 / self.count
        energy, gradient = np.zeros(len(y)), np.zeros((len(y), self.unknowns))
        hessian = np.zeros((len(y), self.unknowns, self.unknowns))
        for strip, node in itertools.product(range(2), range(self.count)):
            (start, by_start, _), (end, by_end, curved) = (
                self.ends(y, strip, each) for each in (node, node + 1)
            )
            v, g, h = _placed(start, end, self.angle(strip), length, self.compliance / length**2)
            by = np.concatenate((by_start, by_end), axis=1)
            energy += v
            gradient += np.einsum("sk,ski->si", g, by)
            hessian += np.swapaxes(by, 1, 2) @ h @ by
            hessian[:, -1, -1] += (g[:, 3:5] * curved).sum(axis=1)
        return energy, gradient, hessian

    def settle(self, y: Array, free: int, where: str, load: Array | float = 0.0) -> Array:
        """Move the first `free` coordinates of y (S, N) to equilibrium under a load; return the Hessian.

        Raises:
            BaselineFailed: there is none, `where`.
        """
        for _ in range(ITERATIONS):
            _, gradient, hessian = self.assembled(y)
            residual = gradient[:, :free] - load
            if np.abs(residual).max() < TOLERANCE:
                return hessian
            y[:, :free] -= np.linalg.solve(hessian[:, :free, :free], residual[..., None])[..., 0]
        raise BaselineFailed(f"constraint model: no equilibrium {where}")

    def turned(self, p: Array) -> tuple[Array, Array]:
        """Return the coordinates (S, N) at rotations (S,), reached from rest, and the derivative."""
        furthest = float(np.abs(p).max(initial=0.0))
        steps = max(1, math.ceil(furthest / STEP))
        y = np.tile(self.rest(), (len(p), 1))
        slope = np.zeros_like(y)
        for step in range(steps + 1):
            ahead = step / steps * p - y[:, -1]
            y += ahead[:, None] * slope
            y[:, -1] = step / steps * p
            where = f"on the way to {math.degrees(step / steps * furthest):.3g} deg"
            hessian = self.settle(y, self.unknowns - 1, where)
            slope = np.ones_like(y)
            slope[:, :-1] = -np.linalg.solve(hessian[:, :-1, :-1], hessian[:, :-1, -1:])[..., 0]
        return y, slope

    def pushed(self, force: Array, steps: int = 40) -> Array:
        """Return the displacement [L] and turn (3,) of the body under a force [EI/L^2], led there in steps.

        Raises:
            BaselineFailed: no equilibrium on the way.
        """
        rest = self.rest()
        y, load = rest[None].copy(), np.zeros(self.unknowns)
        for step in range(1, steps + 1):
            load[-3:-1] = step / steps * force
            self.settle(y, self.unknowns, f"at {step / steps:.3g} of the force", load)
        return np.asarray((y[0] - rest)[-3:])

    def moving(self, y: Array, slope: Array) -> Array:
        """Return the strips' part of M over mu L^3 (S,): cubics between the nodes."""
        length, total = 1.0 / self.count, np.zeros(len(y))
        for strip in range(2):
            moved = []
            for node in range(self.count + 1):
                place, by, _ = self.ends(y, strip, node)
                rate = np.einsum("ski,si->sk", by, slope)
                turn = place[:, 2] + self.angle(strip)
                tangent = rate[:, 2:] * length * np.stack((-np.sin(turn), np.cos(turn)), axis=1)
                moved.append((rate[:, :2], tangent))
            for one, other in itertools.pairwise(moved):
                rates = np.stack((*one, *other), axis=1)
                total += length / 420.0 * np.einsum("ija,jk,ika->i", rates, CUBIC, rates)
        return total


def guide(apart: float, slenderness: float, count: int) -> _Strips:
    """Return the strips of a parallelogram along x, pushed where they end.

    Args:
        apart: [L]. slenderness: L over the thickness [1]. count: beams a strip.
    """
    return _Strips(
        root=np.array([[0.0, 0.5 * apart], [0.0, -0.5 * apart]]),
        direction=np.array([[1.0, 0.0], [1.0, 0.0]]),
        centre=np.array([1.0, 0.0]),
        compliance=1.0 / (12.0 * slenderness**2),
        count=count,
    )


def with_beams(count: int) -> Callable[[Problem], Law]:
    """Return what makes the law of a pivot with so many beams a strip."""

    def law_of(problem: Problem) -> Law:
        at_rest, length = geometry_of(problem), problem.length
        strips = _Strips(
            root=at_rest.root / length,
            direction=at_rest.direction,
            centre=at_rest.centre / length,
            compliance=problem.second_moment_of_area / (problem.area * length**2),
            count=count,
        )
        return partial(_state, problem, strips)

    return law_of


def _state(problem: Problem, strips: _Strips, p: Array) -> State:
    """Return the pivot at rotations (S,)."""
    y, slope = strips.turned(p)
    energy, gradient, hessian = strips.assembled(y)
    scale = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    speed = np.einsum("si,si->s", slope[:, -3:-1], slope[:, -3:-1])
    mass = problem.density * problem.area * problem.length
    turning = problem.body_moment_of_inertia / problem.length**2
    inertia = turning + problem.body_mass * speed + mass * strips.moving(y, slope)
    return State(
        centre=y[:, -3:-1] * problem.length,
        energy=scale * energy,
        torque=scale * gradient[:, -1],
        stiffness=scale * np.einsum("si,si->s", hessian[:, -1], slope),
        inertia=inertia * problem.length**2,
    )


constraint_model = Surrogate(model="beam constraint model", law_of=with_beams(1))
chained_constraint_model = Surrogate(model="chained constraint model", law_of=with_beams(CHAINED))
