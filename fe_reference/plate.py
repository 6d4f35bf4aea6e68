"""A strip between built-in ends as a linear Kirchhoff plate: how much stiffer it is than a beam.

A beam's section is free to curl across its width (anticlastic bending); ends that are built in over their
whole width hold it flat. With the deflection of the beam w_0(x), prescribed by the ends' motion, and
w = w_0 + z, the plate's part z is clamped at both ends and minimises

    1/2 a(z, z) + a(w_0, z),   a(u, v) = int (1 - nu) u_ij v_ij + nu u_ii v_jj

over the width b and the length 1, and the stiffness over the beam's EI is

    f = (1 - a(z, z) / a(w_0, w_0)) / (1 - nu^2)  <=  1 / (1 - nu^2).

Conforming elements (Argyris) give a(z, z) from below, so f from above. Strips are symmetric about both
their middle lines: a quarter is meshed, with elements that shrink towards the corner of clamp and free edge,
where curvatures are unbounded. Lengths are taken in widths, and the quintics of every triangle about its own
centre: about a common origin they lose the digits that the smallest triangles need.

Source: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), articles 21 and 22; Argyris,
Fried and Scharpf, Aeronaut J 72 (1968) 701.

The rigidity of a straight strip along its length, between ends that are clamped over their whole width.

A clamp holds the section flat, and the strip curls freely again within about its width from there. With
g(s) the share of the curl that is left at s in [0, 1], u = s - 1/2 and a length l,

    EI(s) = EI (1 - nu^2 g(s)) / (1 - nu^2),    (l^2 d^2/ds^2 - 1)^2 g = A,    g = g' = 0 at both clamps,

the double root being that of the plate's equation with one shape across the width. A and l are the numbers
with which a beam of this rigidity has both stiffnesses of the plate above, exactly and at any width:

    1 / f_b = int EI / EI(s) ds,    1 / f_s = 12 int u^2 EI / EI(s) ds.

It is a rigidity of the section, and so one that holds in large rotations.

A strip of large curvature keeps its curl at the margins alone (`law`): the part f of the width. Clamps
hold this curl like that of a strip of width f b, so that nu^2 g(s, b/L) becomes

    P(s, f) = nu^2 f g(s, f b/L).

It is exact for f = 1 and for strips whose clamps are far away. Deviation from a shell between clamps: at most
0.1 % up to b/L = 1.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from skfem import Basis, BilinearForm, ElementTriArgyris, LinearForm, MeshTri, condense, solve
from skfem.element import DiscreteField
from skfem.helpers import dd, ddot, trace

from . import read
from .arrays import Array
from .law import TERMS
from .read import InvalidParameter

#: Halvings of the elements towards the corner, and elements a width along the rest of a narrow strip.
LAYERS, ALONG = 6, 2
#: Rule that is exact for squares of second derivatives of quintics.
QUADRATURE = 6
#: Gauss points of the strip and of an element: layers at clamps are as thin as a tenth of the width.
STRIP_POINTS, ELEMENT_POINTS = 400, 60
#: Width over length below which the clamps do not see each other: the layers are the same, in widths. What A
#: differs from 1 by stands for a part of them, and so falls with the width as well.
NARROW = 0.05
#: f in place of 0: a layer at a clamp that no place lies in.
NOTHING = 1e-9
#: Largest residual of the plate's factors, in parts of the square of Poisson's ratio.
FITTED = 1e-12


@dataclass(frozen=True, kw_only=True)
class PlateFactors:
    """Stiffness of a strip between built-in ends over that of the beam with EI = E b t^3 / 12.

    Attributes:
        constant: of a moment that is constant along the strip, f_b [1].
        linear: of a moment that is linear with zero mean, f_s [1].
        unknowns: of the finite elements.

    Examples
    --------
    >>> factors = plate_factors(0.25, 0.3)
    >>> print(f"{factors.constant:.3f} {factors.linear:.3f}")
    1.019 1.044
    """

    constant: float
    linear: float
    unknowns: int


def plate_factors(width_ratio: float, poisson_ratio: float, *, halvings: int = 0) -> PlateFactors:
    """Return the factors of a strip between built-in ends on the stiffness of a beam.

    For small deflections of a thin strip. The stiffness of a cross-axis pivot at rest is
    sum EI/L (f_b + 12 (lambda - 1/2)^2 f_s), that of a parallel guide is f_s times that of the beam.

    Parameters
    ----------
    width_ratio : float, 1
        Width over length b/L.
    poisson_ratio : float, 1
        In [0, 0.5].
    halvings : int, default 0
        Of all elements, to measure the error of the mesh.

    Returns
    -------
    PlateFactors
        f_b of a constant moment and f_s of a linear one [1].

    Raises
    ------
    InvalidParameter
        A ratio that is not positive, a Poisson ratio outside [0, 0.5].

    References
    ----------
    Of the element: ``fe_reference.plate``.

    Examples
    --------
    >>> factors = plate_factors(0.25, 0.3)
    >>> print(f"{factors.constant:.4f} {factors.linear:.4f}")
    1.0188 1.0445
    """
    read.positive("width_ratio", width_ratio, "1")
    read.refuse(not 0.0 <= poisson_ratio <= 0.5, "poisson_ratio", poisson_ratio, "a number between 0 and 0.5")
    mesh = MeshTri.init_tensor(*_lines(0.5 / width_ratio)).refined(halvings)
    basis = Basis(mesh, _Argyris(), intorder=QUADRATURE)
    energy = BilinearForm(_energy).assemble(basis, nu=poisson_ratio)
    flat = 1.0 / (1.0 - poisson_ratio**2)
    constant, linear = (
        flat * (1.0 - _released(basis, energy, poisson_ratio, antisymmetric))
        for antisymmetric in (False, True)
    )
    return PlateFactors(constant=constant, linear=linear, unknowns=int(basis.N))


def _lines(half: float) -> tuple[Array, Array]:
    """Return the mesh lines of a quarter in widths: x from the clamp to `half` the length, y from the middle
    to the free edge."""
    near = 1.0 if half > 1.5 else half
    halves = 0.5 ** np.arange(LAYERS, -1, -1)
    rest = np.linspace(near, half, 1 + math.ceil(ALONG * (half - near)))[1:]
    return np.concatenate([[0.0], near * halves, rest]), 0.5 * (1.0 - np.concatenate([[0.0], halves])[::-1])


class _Centred(NamedTuple):
    """A mapping of the triangles that counts places from their centres (2, T)."""

    mesh: MeshTri
    mapping: Any
    centres: Array

    def F(self, X: Array, tind: Any) -> Array:
        places: Array = self.mapping.F(X, tind=tind) - self.centres[:, tind, None]
        return places


class _Argyris(ElementTriArgyris):
    """Argyris triangles whose quintics are powers of the distance from the centre of each."""

    def gdof(self, F: Any, w: dict[str, Array], i: int) -> Any:
        """Return what the degree of freedom i is of functions F, at vertices and edges about the centres."""
        centre = w["v"].mean(axis=0)
        return super().gdof(F, {**w, "v": w["v"] - centre, "e": w["e"] - centre}, i)

    def gbasis(self, mapping: Any, X: Array, i: int, tind: Any = None) -> Any:
        """Return the basis function i at the points, which a basis asks for from the first to the last."""
        if i == 0:
            mesh = mapping.mesh
            centred = _Centred(mesh, mapping, mesh.p[:, mesh.t].mean(axis=1))
            super().gbasis(centred, X, 0, tind)  # makes the powers and their coefficients V
            each = np.arange(mesh.t.shape[1]) if tind is None else tind
            x, coefficients = centred.F(X, each), np.asarray(self.V)[each, :, :, None]
            # of all functions at once: one by one the powers would be raised again for each
            self._all = {
                order: sum(coefficients[:, k] * power(*x)[:, None] for k, power in enumerate(powers))
                for order, powers in self._pbasis.items()
            }
        value, *slopes = (self._all[order][:, i] for order in ((), (0,), (1,)))
        bends = [[self._all[j, k][:, i] for k in (0, 1)] for j in (0, 1)]
        return (DiscreteField(value=value, grad=np.stack(slopes), hess=np.array(bends)),)


def _energy(u, v, w):  # type: ignore[no-untyped-def]
    """The integrand of a(u, v)."""
    return (1.0 - w.nu) * ddot(dd(u), dd(v)) + w.nu * trace(dd(u)) * trace(dd(v))


def _released(basis: Basis, energy: Any, nu: float, antisymmetric: bool) -> float:
    """Return a(z, z) / a(w_0, w_0) where the ends turn against one another, or together (antisymmetric)."""
    half = float(basis.mesh.p[0].max())

    @LinearForm
    def load(v, w):  # type: ignore[no-untyped-def]
        bent = 1.0 - w.x[0] / half if antisymmetric else 1.0  # w_0''
        return -bent * (dd(v)[0][0] + nu * dd(v)[1][1])

    def held(at: Callable[[Array], Any], *names: str) -> Array:
        edge = basis.get_dofs(basis.mesh.facets_satisfying(at, boundaries_only=True))
        return np.asarray(edge.all(list(names)))

    middle = ("u", "u_y", "u_yy") if antisymmetric else ("u_x", "u_xy", "u_n")
    fixed = np.unique(
        np.concatenate(
            [
                held(lambda x: np.isclose(x[0], 0.0), "u", "u_x", "u_y", "u_xy", "u_yy", "u_n"),
                held(lambda x: np.isclose(x[0], half), *middle),
                held(lambda x: np.isclose(x[1], 0.0), "u_y", "u_xy", "u_n"),
            ]
        )
    )
    z = solve(*condense(energy, load.assemble(basis), D=fixed))
    beam = 0.5 * half * (1 / 3 if antisymmetric else 1.0)  # int w_0''^2 over the quarter
    return float(z @ (energy @ z) / beam)


def left_in_elements(
    width_ratio: float, poisson_ratio: float, ends: Array, flattens: bool, points: int
) -> Array:
    """Return P [1] at the points of elements between the places `ends` (E + 1,) [1]: (E, points, TERMS).

    Coefficients of f, f^2, ...; of the first alone if the strip never `flattens`, so that f = 1.

    One point has the mean compliance of its element. Two Gauss points have its first moment as well: the
    response to a linear moment is then that of the strip to second order, even with a thin layer at a clamp.

    Args:
        width_ratio: width over length b/L. poisson_ratio: [1]. points: 1 or 2.

    Raises:
        InvalidParameter: a width or a Poisson ratio that no such strip has.
    """
    x, weights = np.polynomial.legendre.leggauss(ELEMENT_POINTS)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    places = middle[:, None] + half[:, None] * x
    at = np.array([[0.0]] if points == 1 else [[-1.0, 1.0]]) / np.sqrt(3.0)

    found = np.zeros((len(middle), points, TERMS))
    if poisson_ratio == 0.0:
        return found

    def left(f: float) -> Array:
        """Return P over f."""
        g = _profile(*_layers(f * width_ratio, poisson_ratio), places - 0.5)
        compliance = 1.0 / (1.0 - poisson_ratio**2 * f * g)
        mean, slope = 0.5 * compliance @ weights, 1.5 * compliance @ (weights * x)
        return np.asarray(1.0 - 1.0 / (mean[:, None] + slope[:, None] * at)) / f

    if not flattens:
        found[..., 0] = left(1.0)
        return found
    # through the values at the extrema of Chebyshev's polynomial, of which f = 1 is one: P is proportional to
    # f before f = 0
    nodes = 0.5 + 0.5 * np.cos(np.pi * np.arange(TERMS) / (TERMS - 1))
    nodes[-1] = NOTHING
    values = np.stack([left(float(f)) for f in nodes])
    powers = np.linalg.solve(np.vander(nodes, increasing=True), values.reshape(TERMS, -1))
    found[:] = np.moveaxis(powers.reshape(values.shape), 0, -1)
    return found


@lru_cache(maxsize=256)
def _layers(width_ratio: float, poisson_ratio: float) -> tuple[float, float]:
    """Return A and l."""
    if width_ratio < NARROW:
        size, length = _layers(NARROW, poisson_ratio)
        part = width_ratio / NARROW
        return 1.0 + (size - 1.0) * part, length * part
    factors = plate_factors(width_ratio, poisson_ratio)
    x, weights = np.polynomial.legendre.leggauss(STRIP_POINTS)
    u, weights, square = 0.5 * x, 0.5 * weights, poisson_ratio**2
    known = np.array([factors.constant, factors.linear])

    def residual(logarithms: Array) -> Array:
        size, length = np.exp(logarithms)
        compliance = (1.0 - square) / (1.0 - square * _profile(size, length, u))
        found = 1.0 / np.array([weights @ compliance, 12.0 * (weights * u * u) @ compliance])
        gap: Array = (found - known) / square
        return gap

    from scipy.optimize import root  # whose import takes longer than a small solve

    fit = root(residual, [0.0, np.log(min(0.2 * width_ratio, 0.25))], tol=1e-14)
    if not np.abs(residual(fit.x)).max() <= FITTED:
        raise InvalidParameter("clamped_width", width_ratio, "a width over length up to 30 [1]")
    size, length = np.exp(fit.x)
    return float(size), float(length)


def _profile(size: float, length: float, u: Array) -> Array:
    """Return A [1 - alpha cosh(u/l) - beta (u/l) sinh(u/l)], all relative to the exponential of the ends."""
    end, e = 0.5 / length, np.abs(u) / length

    def even_and_odd(e: Array) -> tuple[Array, Array]:
        near, far = 0.5 * np.exp(e - end), 0.5 * np.exp(-e - end)
        return near + far, near - far

    (cosh, sinh), (cosh_end, sinh_end) = even_and_odd(e), even_and_odd(np.array(end))
    whole = cosh_end * sinh_end + end * np.exp(-2.0 * end)
    alpha, beta = (sinh_end + end * cosh_end) / whole, -sinh_end / whole
    profile: Array = size * (1.0 - alpha * cosh - beta * e * sinh)
    return profile
