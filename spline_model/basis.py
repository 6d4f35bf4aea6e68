"""Bases of the control points and of the axial force, their Gauss rules, and whether both hold a strip."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from spline_model.errors import require_count

Array = NDArray[np.float64]

SMALLEST = 1e-10
"""Singular values below this part of the largest one are zeros."""


@cache
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Points and weights of Gauss and Legendre on [-1, 1]; kept, for each is an eigenvalue problem."""
    nodes, weights = legendre.leggauss(points)
    for array in (nodes, weights):
        array.setflags(write=False)
    return nodes, weights


@cache
def _spline_functions(control_points: int, degree: int) -> BSpline:
    """All functions of a clamped uniform basis as one vector-valued spline; kept, for building it is slow."""
    basis = SplineBasis(control_points=control_points, degree=degree)
    return BSpline(basis.knots, np.eye(control_points), degree)


@dataclass(frozen=True, kw_only=True)
class SplineBasis:
    """Clamped B-spline basis with uniform knots on u in [0, 1].

    With ``degree = control_points - 1`` there is one knot span and the basis is
    Bernstein's: a Bezier curve (Eq 3 of the paper, whose "B-spline" it is). With
    degree 3 and more control points it is the cubic B-spline.

    Exact for: polynomials of its degree; in particular the Greville abscissae as
    control points give back u, so that a straight strip has uniform speed.
    Source: Piegl and Tiller, The NURBS Book (1997), sections 1.3 and 2.2.
    """

    control_points: int
    degree: int

    def __post_init__(self) -> None:
        require_count("control_points", self.control_points, 1)
        require_count("degree", self.degree, 0, self.control_points - 1)

    @cached_property
    def breakpoints(self) -> Array:
        """Ends of the knot spans, shape (spans + 1,)."""
        return np.linspace(0.0, 1.0, self.control_points - self.degree + 1)

    @cached_property
    def knots(self) -> Array:
        """Knot vector with (degree + 1)-fold ends, shape (control_points + degree + 1,)."""
        return np.concatenate((np.zeros(self.degree), self.breakpoints, np.ones(self.degree)))

    @cached_property
    def greville(self) -> Array:
        """Greville abscissae (knot averages), shape (control_points,); degree >= 1."""
        return np.array([self.knots[i + 1 : i + 1 + self.degree].mean() for i in range(self.control_points)])

    def evaluate(self, u: Array, derivative: int = 0) -> Array:
        """Values of the derivative of each basis function, shape (len(u), control_points)."""
        if derivative > self.degree:
            return np.zeros((len(u), self.control_points))
        return np.asarray(_spline_functions(self.control_points, self.degree)(u, nu=derivative))

    def areas(self, u: Array) -> Array:
        """Integrals of the basis functions from 0 to u, (len(u), control_points)."""
        whole = _spline_functions(self.control_points, self.degree).antiderivative()
        return np.asarray(whole(u) - whole(0.0))

    def first_of_support(self, u: Array) -> NDArray[np.int64]:
        """Index of the first of the degree + 1 functions that do not vanish at u, shape (len(u),)."""
        span = np.searchsorted(self.breakpoints, u, side="right") - 1
        return np.clip(span, 0, len(self.breakpoints) - 2).astype(np.int64)

    def gauss_rule(self, points: int) -> tuple[Array, Array]:
        """Gauss-Legendre points and weights, ``points`` in every knot span.

        Exact for polynomials of degree 2 * points - 1 in each span.
        """
        nodes, weights = gauss_legendre(points)
        left, width = self.breakpoints[:-1, None], np.diff(self.breakpoints)[:, None]
        return (left + width * (nodes + 1) / 2).ravel(), (width * weights / 2).ravel()


@cache
def bezier(control_points: int) -> SplineBasis:
    """Bezier curve: degree control_points - 1 in one span."""
    return SplineBasis(control_points=control_points, degree=control_points - 1)


@cache
def cubic_bspline(control_points: int) -> SplineBasis:
    """Cubic B-spline with control_points - 3 uniform spans."""
    return SplineBasis(control_points=control_points, degree=3)


@dataclass(frozen=True, kw_only=True)
class LegendreModes:
    """Legendre polynomials P_0 ... P_(count-1) on u in [0, 1]: the axial force of a Bezier strip.

    With count = control_points - 2 they span the second derivatives of the curve,
    the space in which the bent curve's parasitic stretching cannot lock.
    """

    count: int

    @property
    def width(self) -> int:
        """Number of modes that do not vanish at a point."""
        return self.count

    def evaluate(self, u: Array) -> tuple[NDArray[np.int64], Array]:
        """First mode of the support and the values, shapes (len(u),) and (len(u), width)."""
        values = legendre.legvander(2 * np.asarray(u) - 1, self.count - 1)
        return np.zeros(len(u), dtype=np.int64), np.asarray(values, dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class HatModes:
    """Piecewise linear hats on uniform spans of u in [0, 1]: the axial force of a B-spline strip.

    With count = control_points - 2 the kinks are the knots of the cubic B-spline and the
    hats span its second derivatives, as Legendre's modes do for the Bezier curve. One
    hat is the constant.
    """

    count: int

    @property
    def width(self) -> int:
        """Number of modes that do not vanish at a point."""
        return min(self.count, 2)

    def evaluate(self, u: Array) -> tuple[NDArray[np.int64], Array]:
        """First mode of the support and the values, shapes (len(u),) and (len(u), width)."""
        hats = SplineBasis(control_points=self.count, degree=self.width - 1)
        first = hats.first_of_support(u)
        return first, np.take_along_axis(hats.evaluate(u), first[:, None] + np.arange(self.width), axis=1)


@dataclass(frozen=True, kw_only=True)
class SlideModes:
    """The strains of a straight strip that its axial modes do not see.

    C' lies in a space of control_points - 1 dimensions; these functions span the part of it
    that is orthogonal to the ``axial`` modes (for a Bezier curve with n - 2 modes, the
    Legendre polynomial P_(n-2)). In it the control points slide along a straight strip
    without straining any mode.
    """

    basis: SplineBasis
    axial: LegendreModes | HatModes

    @property
    def count(self) -> int:
        """Number of unseen strains."""
        return self.basis.control_points - 1 - self.axial.count

    @property
    def width(self) -> int:
        """All of them reach over the whole strip."""
        return self.count

    @cached_property
    def _slopes(self) -> SplineBasis:
        return SplineBasis(control_points=self.basis.control_points - 1, degree=self.basis.degree - 1)

    @cached_property
    def _coefficients(self) -> Array:
        """Of each function in the basis of C', shape (control_points - 1, count)."""
        u, weight = self._slopes.gauss_rule(self._slopes.degree + self.axial.width + 1)
        first, values = self.axial.evaluate(u)
        axial = np.zeros((len(u), self.axial.count))
        np.put_along_axis(axial, first[:, None] + np.arange(self.axial.width), values, axis=1)
        overlap = axial.T @ (weight[:, None] * self._slopes.evaluate(u))
        return np.asarray(np.linalg.svd(overlap)[2][self.axial.count :].T)

    def evaluate(self, u: Array) -> tuple[NDArray[np.int64], Array]:
        """First mode of the support and the values, shapes (len(u),) and (len(u), count)."""
        return np.zeros(len(u), dtype=np.int64), self._slopes.evaluate(u) @ self._coefficients


AxialModes = LegendreModes | HatModes | SlideModes


def all_modes(modes: AxialModes, u: Array) -> Array:
    """Values of all axial modes at points u, those without support among them, (len(u), count)."""
    first, shown = modes.evaluate(np.asarray(u))
    full = np.zeros((len(u), modes.count))
    np.put_along_axis(full, first[:, None] + np.arange(shown.shape[1]), shown, axis=1)
    return full


@cache
def singular(basis: SplineBasis, points: int, axial: LegendreModes | HatModes | None, slides: bool) -> str:
    """Why the tangent of a straight strip is singular; empty if it is not.

    points: Gauss points a knot span; axial: modes of the axial force, None for stretching by
    quadrature; slides: whether the strains that the modes do not see have a stiffness. At rest
    bending and stretching do not mix: bending has to see every shape of C'' and stretching
    every shape of C', or control points move without resistance; and every axial force has to
    do work on some strain, or it is not determined.
    """
    u, weight = basis.gauss_rule(points)
    bends = np.sqrt(weight)[:, None] * basis.evaluate(u, 2)
    shapes = basis.control_points - 2
    if _rank(bends) < shapes:
        seen = f"{len(u)} Gauss points see {_rank(bends)} of {shapes} shapes of bending"
        return f"{seen}: use more gauss_points"
    strains = np.sqrt(weight)[:, None] * basis.evaluate(u, 1)
    shapes = basis.control_points - 1
    if axial is None:
        if _rank(strains) < shapes:
            seen = f"{len(u)} Gauss points see {_rank(strains)} of {shapes} shapes of stretching"
            return f"{seen}: use more gauss_points"
        return ""
    modes: list[AxialModes] = [axial]
    if slides and axial.count < shapes:
        modes.append(SlideModes(basis=basis, axial=axial))
    forces = np.concatenate([all_modes(part, u) for part in modes], axis=1) * np.sqrt(weight)[:, None]
    # orthonormal strains: of Bernstein's the highest polynomial is 2^-n
    rank = _rank(np.linalg.qr(strains)[0].T @ forces)
    if rank < forces.shape[1]:
        work = f"{forces.shape[1]} axial forces work on {rank} strains only"
        return f"{work}: use more gauss_points or fewer axial_modes"
    if rank < shapes:
        free = f"{rank} axial modes leave {shapes - rank} of {shapes} strains free"
        return f"{free}, along which control points slide: use slide_stiffness > 0 or more axial_modes"
    return ""


def _rank(matrix: Array) -> int:
    """Number of singular values that are not zero, with the columns scaled alike."""
    size = np.linalg.norm(matrix, axis=0)
    sizes = np.linalg.svd(matrix / np.where(size > 0, size, 1.0), compute_uv=False)
    return int((sizes > SMALLEST * sizes[0]).sum())
