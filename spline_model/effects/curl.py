"""The rigidity along a strip, and what is left of its curl, as a curve of some degree follows them.

Clamps and roots act in layers at the ends of a strip (``spline_model.effects.plate``). Their compliance is
projected on polynomials along the strip.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.effects.plate import graded, profile_of
from spline_model.strip.laws import TERMS

Array = NDArray[Any]

ROOT_DEGREE = 4
"""Of the polynomial that a root's compliance is projected on: within 3.5e-4 of springs up to 45 degrees."""
LEAST = 0.25
"""Part of the compliance without roots below which that with roots does not fall between their peaks."""


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
    profile, (left, right) = profile_of(filled * ratio, poisson_ratio), reach
    s, weight = graded(filled * ratio.real, reach, 16 + most)
    shares = weight * profile.compliance(s, filled) / (right - left)
    return np.asarray(shares @ legendre.legvander(2.0 * (s - left) / (right - left) - 1.0, most))
