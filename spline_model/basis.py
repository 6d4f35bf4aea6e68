"""Basis of the control points and of the axial force, their Gauss rule, and whether both hold a strip."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from spline_model.errors import require_count

Array = NDArray[np.float64]

SMALLEST = 1e-10
"""Singular values below this part of the largest one are zeros."""


@cache
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return points (P,) and weights (P,) of Gauss and Legendre on [-1, 1]; they are computed once."""
    nodes, weights = legendre.leggauss(points)
    for array in (nodes, weights):
        array.setflags(write=False)
    return nodes, weights


@dataclass(frozen=True, kw_only=True)
class Bezier:
    """Bernstein's polynomials on u in [0, 1]: the basis of a Bezier curve of degree control_points - 1.

    These are Eq 3 of the paper, which calls them B-splines. Exact for: polynomials of the degree; in
    particular control points that are evenly spaced give back u, so that a straight strip has uniform speed.
    Source: Piegl and Tiller, The NURBS Book (1997), section 1.3.
    """

    control_points: int

    def __post_init__(self) -> None:
        require_count("control_points", self.control_points, 1)

    @property
    def degree(self) -> int:
        """Degree of the polynomials."""
        return self.control_points - 1

    def evaluate(self, u: Array, derivative: int = 0) -> Array:
        """Return the derivative of each polynomial at u (P,) [1], shape (P, control_points)."""
        return _bernstein(self.control_points, derivative, np.asarray(u, dtype=float).tobytes())

    def areas(self, u: Array, power: int = 0) -> Array:
        """Return the integrals [1] of u^power times the polynomials from 0 to u (P,), (P, control_points)."""
        return _areas(self.control_points, power, np.asarray(u, dtype=float).tobytes())

    def gauss_rule(self, points: int) -> tuple[Array, Array]:
        """Return points (points,) in 0 to 1 and weights (points,) [1] of Gauss and Legendre.

        The rule is exact for polynomials of degree 2 * points - 1.
        """
        nodes, weights = gauss_legendre(points)
        return (nodes + 1.0) / 2.0, weights / 2.0


@lru_cache(maxsize=1024)
def _bernstein(control_points: int, derivative: int, at: bytes) -> Array:
    """Values of ``Bezier.evaluate`` at the numbers of a buffer; kept, for many ask for the same."""
    u = np.frombuffer(at)[:, None]
    none = np.zeros_like(u)
    values, highest = np.ones((len(u), 1)), control_points - 1
    for degree in range(1, control_points):
        left, right = np.concatenate((none, values), axis=1), np.concatenate((values, none), axis=1)
        rising = degree <= highest - derivative
        values = u * left + (1.0 - u) * right if rising else degree * (left - right)
    if derivative > highest:
        values = np.zeros_like(values)
    values.setflags(write=False)
    return values


@lru_cache(maxsize=256)
def _areas(control_points: int, power: int, at: bytes) -> Array:
    """Values of ``Bezier.areas``; kept. Times u^power they are polynomials of so much higher a degree."""
    count = control_points + power
    above = _bernstein(count + 1, 0, at)
    areas = np.cumsum(above[:, :0:-1], axis=1)[:, ::-1][:, power:] / count
    for k in range(1, power + 1):
        areas = areas * (np.arange(control_points) + k) / (control_points - 1 + k)
    areas = np.ascontiguousarray(areas)
    areas.setflags(write=False)
    return areas


@dataclass(frozen=True, kw_only=True)
class LegendreModes:
    """Legendre polynomials P_0 ... P_(count-1) on u in [0, 1]: the axial force of a strip.

    With count = control_points - 2 they span the second derivatives of the curve,
    the space in which the bent curve's parasitic stretching cannot lock.
    """

    count: int

    def evaluate(self, u: Array) -> Array:
        """Their values, shape (len(u), count)."""
        return _legendre(self.count, np.asarray(u, dtype=float).tobytes())


@lru_cache(maxsize=256)
def _legendre(count: int, at: bytes) -> Array:
    """Values of ``LegendreModes.evaluate``; kept."""
    values = np.asarray(legendre.legvander(2.0 * np.frombuffer(at) - 1.0, count - 1), dtype=np.float64)
    values.setflags(write=False)
    return values


@dataclass(frozen=True, kw_only=True)
class SlideModes:
    """The strains of a straight strip that its axial modes do not see.

    C' lies in a space of control_points - 1 dimensions; these functions span the part of it
    that is orthogonal to the ``axial`` modes (with n - 2 of them the Legendre polynomial P_(n-2)). In it the
    control points slide along a straight strip without straining any mode.
    """

    basis: Bezier
    axial: LegendreModes

    @property
    def count(self) -> int:
        """Number of unseen strains."""
        return self.basis.degree - self.axial.count

    def evaluate(self, u: Array) -> Array:
        """Their values, shape (len(u), count)."""
        slopes = Bezier(control_points=self.basis.degree)
        return slopes.evaluate(u) @ _unseen(self.basis.degree, self.axial.count)


@lru_cache(maxsize=64)
def _unseen(slopes: int, axial: int) -> Array:
    """Of each slide mode beside ``axial`` modes in the basis of C' of so many slopes, (slopes, count)."""
    basis, modes = Bezier(control_points=slopes), LegendreModes(count=axial)
    u, weight = basis.gauss_rule(slopes + axial)
    overlap = modes.evaluate(u).T @ (weight[:, None] * basis.evaluate(u))
    return np.asarray(np.linalg.svd(overlap)[2][axial:].T)


AxialModes = LegendreModes | SlideModes


@cache
def singular(basis: Bezier, points: int, axial: LegendreModes | None, slides: bool) -> str:
    """Return why the tangent of a straight strip is singular; an empty string if it is regular.

    points: Gauss points; axial: modes of the axial force, None for stretching by quadrature; slides: whether
    the strains that the modes do not see have a stiffness. At rest bending and stretching do not mix: bending
    has to see every shape of C'' and stretching every shape of C', or control points move without resistance;
    and every axial force has to do work on some strain, or it is not determined.
    """
    u, weight = basis.gauss_rule(points)
    strains, bends = (np.sqrt(weight)[:, None] * basis.evaluate(u, order) for order in (1, 2))
    shapes = basis.control_points - 1
    seen = [("bending", bends, shapes - 1)] + [("stretching", strains, shapes)] * (axial is None)
    for what, matrix, count in seen:
        if _rank(matrix) < count:
            told = f"{len(u)} Gauss points see {_rank(matrix)} of {count} shapes of {what}"
            return f"{told}: use more gauss_points"
    if axial is None:
        return ""
    modes: list[AxialModes] = [axial]
    if slides and axial.count < shapes:
        modes.append(SlideModes(basis=basis, axial=axial))
    forces = np.concatenate([part.evaluate(u) for part in modes], axis=1) * np.sqrt(weight)[:, None]
    # orthonormal strains: of Bernstein's the highest polynomial is 2^-n
    rank = _rank(np.linalg.qr(strains)[0].T @ forces)
    if rank < forces.shape[1]:
        work = f"{forces.shape[1]} axial forces work on {rank} strains only"
        return f"{work}: use more gauss_points or fewer axial_modes"
    if rank < shapes:
        free = f"{rank} axial modes leave {shapes - rank} of {shapes} strains free"
        return f"{free}, along which control points slide: use penalty_stiffness > 0 or more axial_modes"
    return ""


def _rank(matrix: Array) -> int:
    """Number of singular values that are not zero, with the columns scaled alike."""
    size = np.linalg.norm(matrix, axis=0)
    sizes = np.linalg.svd(matrix / np.where(size > 0, size, 1.0), compute_uv=False)
    return int((sizes > SMALLEST * sizes[0]).sum())
