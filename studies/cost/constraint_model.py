"""Strips as one beam each in closed form: the beam constraint model of Awtar.

Of a beam of length L, with everything over L, EI/L^2 and EI/L, let u be the displacement of its tip along it
and v = (y, theta) that across it and its rotation, in the frame of its root, and c = I / (A L^2). Stiffness
and shortening are those of the beam-column up to the second power of the axial force p,

    (f, m) = (K0 + p K1 + p^2 K2) v,      u = c p - v K1 v / 2 - p v K2 v

    K0 = [12 -6; -6 4],  K1 = [6/5 -1/10; -1/10 2/15],  K2 = [-1/700 1/1400; 1/1400 -11/6300]

which are the derivatives of the energy

    V = v K0 v / 2 + a^2 / (2 b),   a = u + v K1 v / 2,   b = c - v K2 v,   p = a / b

The model is for deflections up to about a tenth of the length. Exact for small displacements at small axial
forces; neglects large rotations of the beam itself.

A rotation leaves the place of the body free; it is solved for from where a pin at the crossing would have it.

Source: S. Awtar, A. H. Slocum, E. Sevincer, Journal of Mechanical Design 129 (2007) 625; the energy is
derived here.
"""

import math

import numpy as np
from scipy.optimize import root

from studies.cases.problem import Problem
from studies.cost.model import Geometry, State, Surrogate, geometry_of
from studies.errors import Unanswered
from studies.kinds import Array

K0 = np.array([[12.0, -6.0], [-6.0, 4.0]])
K1 = np.array([[6.0 / 5.0, -1.0 / 10.0], [-1.0 / 10.0, 2.0 / 15.0]])
K2 = np.array([[-1.0 / 700.0, 1.0 / 1400.0], [1.0 / 1400.0, -11.0 / 6300.0]])
#: Relative change of the body's place below which it is found.
TOLERANCE = 1e-13


def _element(u: float, v: Array, compliance: float) -> tuple[Array, Array]:
    """Return the gradient (3,) and the Hessian (3, 3) of V by (u, y, theta); v: (2,), compliance: c [1]."""
    k1, k2 = K1 @ v, K2 @ v
    b = compliance - v @ k2
    p = (u + 0.5 * v @ k1) / b
    along = np.append(1.0, k1 + 2.0 * p * k2)
    hessian = np.outer(along, along) / b
    hessian[1:, 1:] += K0 + p * K1 + p**2 * K2
    return np.append(p, K0 @ v + p * k1 + p**2 * k2), hessian


def _assembled(problem: Problem, at_rest: Geometry, place: Array, turn: float) -> tuple[Array, Array]:
    """Return the gradient (3,) and the Hessian (3, 3) of the energy of both strips over EI/L by the body's
    place (2,) [m] and its rotation [rad]."""
    compliance = problem.second_moment_of_area / (problem.area * problem.length**2)
    gradient, hessian = np.zeros(3), np.zeros((3, 3))
    for ground, along, end in zip(at_rest.root, at_rest.direction, at_rest.tip, strict=True):
        frame = np.stack((along, _quarter_turned(along))) / problem.length
        arm = _turned(end - at_rest.centre, turn)
        tip = frame @ (place + arm - ground)
        g, h = _element(tip[0] - 1.0, np.array([tip[1], turn]), compliance)
        jacobian = np.eye(3)
        jacobian[:2, :2], jacobian[:2, 2] = frame, frame @ _quarter_turned(arm)
        gradient += g @ jacobian
        hessian += jacobian.T @ h @ jacobian
        hessian[2, 2] -= g[:2] @ frame @ arm
    return gradient, hessian


def _turned(vector: Array, angle: float) -> Array:
    """Return a vector (2,) turned counter-clockwise by an angle [rad]."""
    return math.cos(angle) * vector + math.sin(angle) * _quarter_turned(vector)


def _quarter_turned(vector: Array) -> Array:
    """Return a vector (2,) turned counter-clockwise by 90 degrees."""
    return np.array([-vector[1], vector[0]])


def _law(problem: Problem, turns: Array) -> State:
    """Return a pivot at rotations (S,).

    Raises:
        Unanswered: there is no equilibrium at one of them.
    """
    at_rest = geometry_of(problem)
    states = [_equilibrium(problem, at_rest, float(turn)) for turn in turns]
    place, torque, stiffness = (np.array(each) for each in zip(*states, strict=True))
    unit = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    return State(place, unit * torque, unit * stiffness)


def _equilibrium(problem: Problem, at_rest: Geometry, turn: float) -> tuple[Array, float, float]:
    """Return the body's place (2,) [m], and torque and stiffness over EI/L; errors as of `_law`."""

    def forces(place: Array) -> tuple[Array, Array]:
        gradient, hessian = _assembled(problem, at_rest, place, turn)
        return gradient[:2], hessian[:2, :2]

    pinned = at_rest.crossing + _turned(at_rest.centre - at_rest.crossing, turn)
    found = root(forces, pinned, jac=True, tol=TOLERANCE)
    if not found.success:
        raise Unanswered(f"constraint model: no equilibrium at {math.degrees(turn):.3g} deg")
    gradient, hessian = _assembled(problem, at_rest, found.x, turn)
    free = np.linalg.solve(hessian[:2, :2], hessian[:2, 2])
    return found.x, gradient[2], hessian[2, 2] - hessian[2, :2] @ free


constraint_model = Surrogate(name="beam constraint model", law=_law)
