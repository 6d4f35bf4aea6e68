"""A strip as a plate: its stiffness in the linear range, and the rigidity along the strip that has it.

Factors: how much stiffer a strip is as a plate whose ends are built in over the whole width. Kirchhoff's
plate of length 1 and width r = b/L, its long edges free, both ends moved as rigid bodies:

    w = w0(x) + z(x, y),    w0'' = 1 or x - 1/2,    z = z_x = 0 at both ends,
    a(w, v) = int w_xx v_xx + w_yy v_yy + nu (w_xx v_yy + w_yy v_xx) + 2 (1 - nu) w_xy v_xy,

z makes the energy least, a(z, v) = -a(w0, v), and the factors on EI of a beam are

    f = (1 - a(z, z) / a(w0, w0)) / (1 - nu^2)

of a constant moment and of one that is linear with zero mean. By Ritz: even Legendre polynomials
across the width, splines along one half of the length, whose knots come closer to the clamp in
proportion, where the corners have their singularities. A complex width gives complex factors, by which
the profile has their derivative. Source: Timoshenko and Woinowsky-Krieger,
Theory of Plates and Shells (1959), chapter 10.

Profile: the rigidity along a strip whose clamps hold its section flat.

    R(s) = EI (1 - nu^2 g(s)) / (1 - nu^2),      s in [0, 1] along the strip, u = s - 1/2,

from EI / (1 - nu^2) at a clamp, where the section cannot curl, to about EI inside. g is the share of the
curl that the clamps leave, the double root of the plate theory with one term across the width,
(l^2 d^2 - 1)^2 g = A with g = g' = 0 at both clamps:

    g = A (1 - alpha cosh(u/l) - beta (u/l) sinh(u/l)).

A and l are such that the strip has both factors of its plate in the linear range,

    1 / f_b = int EI/R ds,      1 / f_s = 12 int u^2 EI/R ds,

so that nothing is fitted to an answer. Neglected: all other nonlinear effects of the plate at large
rotations.

Curve: clamps and roots act in layers at the ends of a strip. Their compliance is projected on polynomials
along the strip, as a curve of some degree follows it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.basis import gauss_legendre
from spline_model.strip.laws import TERMS

Array = NDArray[Any]
Profile = tuple[complex, complex]
"""Size A and reach l over L of g(s), both complex for a complex width."""

ACROSS = 12
"""Even polynomials across the width, up to degree 2 ACROSS; factors stand to 1e-5 for b/L of 0.05 to 2."""
CELLS = 20
"""Knot spans from the clamp on, each twice as long as the one before, to three widths or the middle."""
DEGREE = 5
MOST_STEPS = 30
TOLERANCE = 1e-13
"""Of the two compliances, 1 / f; round-off is some 1e-15."""
NARROWEST = 0.005
"""Width over length below which the profile is the same in widths."""
STEP = 1e-40
"""Of derivatives by a complex step: its square is beyond any round-off."""
ROOT_DEGREE = 4
"""Of the polynomial that a root's compliance is projected on: within 3.5e-4 of springs up to 45 degrees."""
LEAST = 0.25
"""Part of the compliance without roots below which that with roots does not fall between their peaks."""


class Factors(NamedTuple):
    """Factors on EI for a constant moment and for one that is linear with zero mean [1]."""

    constant: float
    linear: float


def plate_factors(ratio: complex, poisson_ratio: float) -> Factors:
    """Return the factors of a plate on the stiffness of a beam.

    Parameters
    ----------
    ratio : float, 1
        Width over length, above 0; complex for derivatives by a complex step.
    poisson_ratio : float, 1

    Returns
    -------
    Factors
        Of a constant moment, and of one that is linear with zero mean [1]; upper bounds, by about 1e-6.

    References
    ----------
    Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), ch. 10; the Ritz method of
    ``spline_model.effects.plate``.

    Examples
    --------
    >>> print(f"{plate_factors(0.25, 0.3).constant:.4f}")
    1.0188
    """
    nu, (x, weight, along), (mass, bent, cross, sheared, area) = poisson_ratio, _along(ratio), _across(ratio)
    found: list[Any] = []
    inner = [values[:, 2:] for values in along]  # the first two do not vanish at the clamp
    # functions whose slope vanishes at the middle, the last two as one; those that vanish there themselves
    even = [np.column_stack((values[:, :-2], values[:, -2] + values[:, -1])) for values in inner]
    odd = [values[:, :-1] for values in inner]
    for (value, slope, curvature), moment in ((even, np.ones_like(x)), (odd, x - 0.5)):
        mixed = np.kron(curvature.T @ (weight[:, None] * value), cross)
        stiffness = nu * (mixed + mixed.T)
        stiffness += np.kron(curvature.T @ (weight[:, None] * curvature), mass)
        stiffness += np.kron(value.T @ (weight[:, None] * value), bent)
        stiffness += 2.0 * (1.0 - nu) * np.kron(slope.T @ (weight[:, None] * slope), sheared)
        pull = np.kron((weight * moment) @ curvature, mass[0]) + nu * np.kron(
            (weight * moment) @ value, cross[0]
        )
        saved = pull @ np.linalg.solve(stiffness, pull) / (weight @ moment**2 * area)
        found.append((1.0 - saved).item() / (1.0 - nu * nu))
    return Factors(*found)


def _along(ratio: complex) -> tuple[Array, Array, list[Array]]:
    """Points and weights on half the length, and there the splines with two derivatives."""
    near = 3.0 * ratio if 3.0 * ratio.real < 0.5 else 0.5
    breaks = [0.0, *near * 0.5 ** np.arange(CELLS - 1, -1, -1)]
    if near != 0.5:
        breaks += [0.5 * (near + 0.5), 0.5]
    nodes, weights = gauss_legendre(DEGREE + 1)
    width = np.diff(breaks)[:, None]
    x = (np.array(breaks[:-1])[:, None] + width * (nodes + 1.0) / 2.0).ravel()
    knots = np.concatenate((np.zeros(DEGREE), breaks, np.full(DEGREE, 0.5)))
    span = DEGREE + np.repeat(np.arange(len(width)), len(nodes))
    return x, (width * weights / 2.0).ravel(), [_splines(knots, x, span, order) for order in range(3)]


def _splines(knots: Array, x: Array, span: NDArray[np.int64], order: int) -> Array:
    """That derivative of all splines at x in the spans (P,), by Cox and de Boor: knots may be complex."""
    values: Array = np.eye(len(knots) - 1)[span]
    for degree in range(1, DEGREE + 1):
        gap = knots[degree:] - knots[:-degree]
        over = np.divide(1.0, gap, out=np.zeros_like(gap), where=gap != 0.0)
        if degree <= DEGREE - order:
            left, right = (x[:, None] - knots[:-degree]) * over, (knots[degree:] - x[:, None]) * over
            values = left[:, :-1] * values[:, :-1] + right[:, 1:] * values[:, 1:]
        else:
            values = degree * (over[:-1] * values[:, :-1] - over[1:] * values[:, 1:])
    return values


def _across(ratio: complex) -> tuple[Array, Array, Array, Array, complex]:
    """int Y Y, Y'' Y'', Y Y'' and Y' Y' of the polynomials over the width, and the width; Y_0 = 1."""
    nodes, weights = gauss_legendre(2 * ACROSS + 2)
    even = np.eye(2 * ACROSS + 1)[:, ::2]
    y, dy, ddy = (legendre.legval(nodes, legendre.legder(even, k) if k else even) for k in range(3))
    half = ratio / 2.0
    w = weights * half
    return (
        (y * w) @ y.T,
        (ddy * w) @ ddy.T / half**4,
        (y * w) @ ddy.T / half**2,
        (dy * w) @ dy.T / half**2,
        w.sum(),
    )


def _compliance(profile: Profile, poisson_ratio: float, s: Array, filled: float = 1.0) -> Array:
    """EI / R at s (P,) of a profile; filled: part of the width that curls."""
    (size, reach), square = profile, poisson_ratio**2
    share = size * (1.0 - _decay(s, reach))
    return np.asarray((1.0 - square) / (1.0 - square * filled * share))


def _decay(s: Array, reach: complex) -> Array:
    """alpha cosh(u/l) + beta (u/l) sinh(u/l): 1 with zero slope at both ends; relative to e^(1/2l)."""
    half, u = 0.5 / reach, np.abs(s - 0.5) / reach
    small, grown = np.exp(-2.0 * half), 0.5 * np.exp(u - half)
    cosh, sinh = grown * (1.0 + np.exp(-2.0 * u)), grown * (1.0 - np.exp(-2.0 * u))
    cosh_end, sinh_end = 0.5 * (1.0 + small), 0.5 * (1.0 - small)
    determinant = cosh_end * sinh_end + half * (cosh_end**2 - sinh_end**2)
    alpha, beta = (sinh_end + half * cosh_end) / determinant, -sinh_end / determinant
    return np.asarray(alpha * cosh + beta * u * sinh)


@lru_cache(maxsize=256)
def _profile_of(ratio: complex, poisson_ratio: float) -> Profile:
    """Return the profile of a strip of width over length ``ratio`` [1]; it is computed once.

    Newton's method in log A and log l; of a complex ratio in the real part, and their rates for the rest.
    """
    if abs(ratio) < NARROWEST:
        (size, reach), share = _profile_of(NARROWEST, poisson_ratio), ratio / NARROWEST
        return 1.0 + (size - 1.0) * share, reach * share
    aim = 1.0 / np.array(plate_factors(ratio, poisson_ratio))
    logs = np.log([1.0, 0.2 * ratio.real])
    if poisson_ratio != 0.0:
        for _ in range(MOST_STEPS):
            off = aim.real - _compliances(logs, ratio.real, poisson_ratio)
            if np.abs(off).max() < TOLERANCE:
                break
            change = np.linalg.solve(_rates(logs, ratio.real, poisson_ratio), off)
            logs += change * min(1.0, 0.5 / np.abs(change).max())
        else:
            raise AssertionError(f"no profile for b/L = {ratio:g}, nu = {poisson_ratio:g}")
        if ratio.imag != 0.0:
            logs = logs + 1j * np.linalg.solve(_rates(logs, ratio.real, poisson_ratio), aim.imag)
    size, reach = np.exp(logs)
    return size, reach


def _rates(logs: Array, ratio: float, poisson_ratio: float) -> Array:
    """Derivatives (2, 2) of both compliances by log A and log l."""
    moved = [_compliances(logs + 1j * STEP * e, ratio, poisson_ratio).imag / STEP for e in np.eye(2)]
    return np.transpose(moved)


def _compliances(logs: Array, ratio: float, poisson_ratio: float) -> Array:
    """1 / f_b and 1 / f_s of a profile."""
    s, weight = _graded(ratio, (0.0, 1.0), 16)
    size, reach = np.exp(logs)
    c = _compliance((size, reach), poisson_ratio, s)
    return np.array([weight @ c, 12.0 * weight @ (c * (s - 0.5) ** 2)])


@lru_cache(maxsize=256)
def _graded(ratio: float, reach: tuple[float, float], points: int) -> tuple[Array, Array]:
    """Return points (points,) and weights (points,) on a reach of [0, 1], graded towards its ends.

    They resolve layers of about 0.1 of the width; ratio: width over length [1].
    """
    layers = [min(0.5, part * ratio) for part in (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)]
    edges = np.array([*reach, *layers, *(1.0 - part for part in layers)])
    edges = np.unique(edges[(edges >= reach[0]) & (edges <= reach[1])])
    nodes, weights = gauss_legendre(points)
    width = np.diff(edges)[:, None]
    return (edges[:-1, None] + width * (nodes + 1.0) / 2.0).ravel(), (width * weights / 2.0).ravel()


@lru_cache(maxsize=256)
def rigidity_of(
    ratio: complex,
    poisson_ratio: float,
    degree: int,
    at: bytes,
    reach: tuple[float, float],
    roots: tuple[complex, complex],
) -> Array:
    """Return R / EI of a piece of a strip, as a curve of a degree follows it; it is computed once.

    Parameters
    ----------
    ratio : width over length b/L; 0 where no clamp holds the section flat.
    poisson_ratio : of the material.
    degree : degree of the curve.
    at : places u along the piece (P,), 0 to 1, as bytes.
    reach : where the piece begins and ends, in parts of the strip's length.
    roots : lengths of the roots at both ends over the strip's length. Their compliance stands there as delta
        functions.

    Returns
    -------
    R / EI at u (P,), read-only.

    Notes
    -----
    The compliance EI / R is projected on polynomials. Their degree is one less than that of the curvature
    under a linear moment, so that the strip can take its own curvature M EI / R and has both factors exactly,
    however thin the layers are. With more control points the result tends to R. Roots are projected up to
    ROOT_DEGREE, and as far as the compliance stays above LEAST of the compliance without them.
    """
    u = np.frombuffer(at)
    if not ratio and not any(roots):
        return np.ones(len(u))
    most = max(2, degree - 3)
    count, sign = 2.0 * np.arange(most + 1) + 1.0, (-1.0) ** np.arange(most + 1)
    plate = count * (_projected(ratio, poisson_ratio, most, reach) if ratio else np.eye(1, most + 1)[0])
    peaks = count * (roots[0] * sign + roots[1])
    values, fine = (legendre.legvander(2.0 * x - 1.0, most) for x in (u, np.linspace(0.0, 1.0, 65)))
    compliance = plate
    for highest in range(min(most, ROOT_DEGREE), -1, -1):
        compliance = plate + np.where(np.arange(most + 1) <= highest, peaks, 0.0)
        if ((fine @ compliance).real >= LEAST * (fine @ plate).real).all():
            break
    rigidity = 1.0 / (values @ compliance)
    rigidity.setflags(write=False)
    return np.asarray(rigidity)


@lru_cache(maxsize=256)
def curl_terms(
    ratio: complex, poisson_ratio: float, degree: int, at: bytes, reach: tuple[float, float]
) -> Array:
    """Return the reduction of a plate's rigidity by the curl at u (P,) of a piece, as a curve follows it.

    Coefficients (P, TERMS) of f, f^2, ..., with f the share of the curl that curvature leaves. They take
    1 - (1 - nu^2) R / EI of clamps of a strip of width f b/L at TERMS values of f, which are Chebyshev's.
    Parameters are as of ``rigidity_of``; the array is read-only.
    """
    most, u = max(2, degree - 3), np.frombuffer(at)
    if not ratio:
        return np.eye(1, TERMS)[np.zeros(len(u), dtype=int)] * poisson_ratio**2
    filled = 0.5 * (1.0 - np.cos(np.pi * np.arange(TERMS) / (TERMS - 1)))
    values = legendre.legvander(2.0 * u - 1.0, most) * (2.0 * np.arange(most + 1) + 1.0)
    taken = [np.full(len(u), poisson_ratio**2 + 0.0 * ratio)]
    for part in filled[1:]:
        stiffer = 1.0 / (values @ _projected(ratio, poisson_ratio, most, reach, part))
        taken.append((1.0 - (1.0 - poisson_ratio**2) * stiffer) / part)
    terms = np.linalg.solve(np.vander(filled, increasing=True), taken).T
    terms.setflags(write=False)
    return np.asarray(terms)


def _projected(
    ratio: complex, poisson_ratio: float, most: int, reach: tuple[float, float], filled: float = 1.0
) -> Array:
    """int EI / R P_k over a piece (most + 1,), of Legendre's polynomials; filled: part f of the width."""
    profile, (left, right) = _profile_of(filled * ratio, poisson_ratio), reach
    s, weight = _graded(filled * ratio.real, reach, 16 + most)
    shares = weight * _compliance(profile, poisson_ratio, s, filled) / (right - left)
    return np.asarray(shares @ legendre.legvander(2.0 * (s - left) / (right - left) - 1.0, most))
