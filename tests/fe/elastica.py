"""Closed forms of a cantilever under a tip force normal to its undeformed axis."""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


def by_elliptic_integrals(load: float) -> tuple[float, float, float]:
    """Return tip rotation [rad] and tip position x/L, y/L of the inextensible elastica at P L^2/EI = `load`.

    With k^2 = (1 + sin theta_L)/2, sin phi = 1/(k sqrt 2): sqrt(load) = K(k) - F(phi, k),
    x/L = sqrt(2 sin theta_L / load), y/L = 1 - 2 (E(k) - E(phi, k)) / sqrt(load).
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
    """Return the same for a strip that stretches and shears, EI/(EA L^2) = `stretch`, EI/(kGA L^2) = `shear`.

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
