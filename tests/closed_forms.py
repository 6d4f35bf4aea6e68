"""Closed forms of a cantilever, of one continuum theory for both models: elastica, followers, frequencies."""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

#: First roots z = beta L of a clamped-free beam.
CANTILEVER_ROOTS = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349, 14.1371683910])


def end_body_roots(eta: float, zeta: float, wanted: int) -> np.ndarray:
    """Return the first roots z = beta L with an end body of mass eta mu L and inertia zeta mu L^3."""

    def equation(z: float) -> float:
        c, s, ch, sh = np.cos(z), np.sin(z), np.cosh(z), np.sinh(z)
        mass, inertia = eta * z * (c * sh - s * ch), -zeta * z**3 * (c * sh + s * ch)
        return float((1.0 + c * ch + mass + inertia + eta * zeta * z**4 * (1.0 - c * ch)) / ch)

    grid = np.linspace(0.1, 12.0, 2000)
    values = [equation(z) for z in grid]
    brackets = [(a, b) for a, b, p, q in zip(grid, grid[1:], values, values[1:], strict=False) if p * q < 0.0]
    return np.array([brentq(equation, *bracket, xtol=1e-14) for bracket in brackets[:wanted]])


def elastica_tip(load: float) -> tuple[float, float, float]:
    """Return rotation [rad] and place x/L, y/L of the tip of an inextensible cantilever under `load` EI/L^2.

    The force is normal to the undeformed axis. With k^2 = (1 + sin theta_L)/2, sin phi = 1/(k sqrt 2):
    sqrt(load) = K(k) - F(phi, k), x/L = sqrt(2 sin theta_L / load),
    y/L = 1 - 2 (E(k) - E(phi, k)) / sqrt(load).
    Source: K. E. Bisshopp, D. C. Drucker, Q. Appl. Math. 3 (1945) 272-275.
    """

    def parts(rotation: float) -> tuple[float, float]:
        m = 0.5 * (1.0 + np.sin(rotation))
        return m, np.arcsin(1.0 / np.sqrt(2.0 * m))

    def mismatch(rotation: float) -> float:
        m, phi = parts(rotation)
        return float(ellipk(m) - ellipkinc(phi, m) - np.sqrt(load))

    rotation = brentq(mismatch, 1e-6, 0.5 * np.pi - 1e-6, xtol=1e-15, rtol=1e-14)
    m, phi = parts(rotation)
    y = 1.0 - 2.0 * (ellipe(m) - ellipeinc(phi, m)) / np.sqrt(load)
    return rotation, float(np.sqrt(2.0 * np.sin(rotation) / load)), float(y)


def by_quadrature(load: float, *, stretch: float, shear: float) -> tuple[float, float, float]:
    """Return rotation and place where the strip stretches and shears too.

    EI/(EA L^2) = `stretch`, EI/(kGA L^2) = `shear`.

    Lengths in L, forces in EI/L^2. With N = P sin(theta), V = P cos(theta) the quantity
    theta'^2/2 + N + stretch N^2/2 + shear V^2/2 is constant along the strip and known at the tip, where
    theta' = 0. With s = sin(theta) = s_L (1 - u^2) the integrals lose their singularity at the tip.
    """
    nodes, weights = np.polynomial.legendre.leggauss(120)
    u, weight = 0.5 * (nodes + 1.0), 0.5 * weights

    def integrals(rotation: float) -> tuple[float, float, float]:
        tip = np.sin(rotation)
        s = tip * (1.0 - u * u)
        cosine = np.sqrt(1.0 - s * s)
        slope = np.sqrt(2.0 * load * (1.0 + 0.5 * load * (stretch - shear) * (tip + s)))
        step = weight * 2.0 * np.sqrt(tip) / (cosine * slope)
        elongation, sliding = 1.0 + stretch * load * s, shear * load * cosine
        x = np.sum(step * (elongation * cosine - sliding * s))
        y = np.sum(step * (elongation * s + sliding * cosine))
        return float(np.sum(step)), float(x), float(y)

    rotation = brentq(lambda r: integrals(r)[0] - 1.0, 1e-6, 0.5 * np.pi - 1e-3, xtol=1e-15, rtol=1e-14)
    _, x, y = integrals(rotation)
    return rotation, x, y


def followed(load: float) -> np.ndarray:
    """Return x/L, y/L and turn of a tip under a force across its section [EI/L^2], integrated from there."""

    def rates(_: float, state: np.ndarray) -> tuple[float, ...]:
        _, _, turn, curvature = state
        return -math.cos(turn), -math.sin(turn), -curvature, load * math.cos(turn)

    x, y, turn, _ = solve_ivp(rates, (0.0, 1.0), np.zeros(4), rtol=1e-12, atol=1e-13).y[:, -1]
    cos, sin = math.cos(turn), math.sin(turn)
    return np.array([-cos * x - sin * y, sin * x - cos * y, -turn])
