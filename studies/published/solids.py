"""What beams idealise, solved apart from both models: a shallow shell that is flattened, and solids.

**A shell**, by Ritz: a wide strip that is bent far between clamps that hold its section flat.

The mid-surface is bent to a curvature k(s) along and departs from that by w(s, y), of zero mean over the
width, while it moves by u, v in its plane. With y across, of width b,

    V = D/2 int (k + w_ss)^2 + w_yy^2 + 2 nu (k + w_ss) w_yy + 2 (1 - nu) w_sy^2
      + 6 D/t^2 int e_s^2 + e_y^2 + 2 nu e_s e_y + (1 - nu)/2 (u_y + v_s)^2,

    e_s = u_s + n - k w,    e_y = v_y,

with n(s) the mean strain; a moment M(s) works on k. It holds both effects that the models know by themselves:
clamps over the width, where k is small (a plate), and suppressed anticlastic bending, far from clamps
(D. G. Ashwell, Journal of the Royal Aeronautical Society 54 (1950) 708). Legendre polynomials in all fields,
times (1 - s^2)^2 or (1 - s^2) where clamps hold them. Leaves out shear over the thickness.

**Solids**: linear elasticity of a strip in three dimensions and of a guide with its stage, both by quadratic
finite elements, for small displacements; nothing of either model is used.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss
from skfem import (
    Basis,
    BilinearForm,
    ElementHex2,
    ElementQuad0,
    ElementQuad2,
    ElementVector,
    MeshHex,
    MeshQuad,
    condense,
    solve,
)
from skfem.helpers import ddot, sym_grad, trace

from studies.kinds import Array

#: Terms along and across of every field, and of the curvature; Gauss points along and across.
TERMS, POINTS = (18, 5, 12), (60, 24)
ITERATIONS, SETTLED = 40, 1e-9
#: 1 - s^2 in Legendre polynomials.
BUBBLE = (2.0 / 3.0, 0.0, -2.0 / 3.0)


@dataclass(frozen=True, kw_only=True)
class _Shell:
    """Values at the quadrature points (Q,) by the unknowns (N,): of bending, of the plane, of their product.

    along, across, twist: k + w_ss, w_yy, w_sy. mean, lateral, shear: u_s + n, v_y, u_y + v_s.
    curvature, rise: k, w. weights: (Q,). load: (N,) work of a moment that is s, from -1 to 1.
    """

    along: Array
    across: Array
    twist: Array
    mean: Array
    lateral: Array
    shear: Array
    curvature: Array
    rise: Array
    weights: Array
    load: Array


def linear_factor(moment: float, *, width: float, thickness: float, nu: float) -> float:
    """Return the secant stiffness over that of a beam [1] under a moment that is linear, with zero mean.

    Args:
        moment: at the ends [EI/L]. width, thickness: over the length [1]. nu: Poisson ratio.
    """
    shell = _shell(width)
    plate = 1.0 / (width * (1.0 - nu**2))  # D, with EI and L of 1
    plane, w = 12.0 * plate / thickness**2, shell.weights[:, None]
    bending = plate * (
        _work(shell.along, shell.along, w)
        + _work(shell.across, shell.across, w)
        + nu * (_work(shell.along, shell.across, w) + _work(shell.across, shell.along, w))
        + 2.0 * (1.0 - nu) * _work(shell.twist, shell.twist, w)
    )
    bending += plane * (
        _work(shell.lateral, shell.lateral, w) + 0.5 * (1.0 - nu) * _work(shell.shear, shell.shear, w)
    )
    force = moment * shell.load
    found = _bent(shell, bending, force, plane, nu)
    return float(moment**2 / 3.0 / (force @ found))


def _bent(shell: _Shell, stiffness: Array, force: Array, plane: float, nu: float) -> Array:
    """Return the unknowns in equilibrium, by Newton's method from rest."""
    found, w = np.zeros(len(force)), shell.weights
    for _ in range(ITERATIONS):
        k, rise = shell.curvature @ found, shell.rise @ found
        strain, lateral = shell.mean @ found - k * rise, shell.lateral @ found
        by = shell.mean - k[:, None] * shell.rise - rise[:, None] * shell.curvature
        stress = w * plane * (strain + nu * lateral)
        residual = stiffness @ found - force + by.T @ stress + shell.lateral.T @ (w * plane * nu * strain)
        mixed = nu * _work(by, shell.lateral, w[:, None])
        tangent = stiffness + plane * (_work(by, by, w[:, None]) + mixed + mixed.T)
        bow = _work(shell.curvature, shell.rise, stress[:, None])
        tangent -= bow + bow.T
        scale = 1.0 / np.sqrt(np.abs(np.diag(tangent)))
        step = scale * np.linalg.lstsq(tangent * np.outer(scale, scale), scale * residual, rcond=1e-13)[0]
        found -= step
        if np.abs(shell.curvature @ step).max() <= SETTLED * np.abs(shell.curvature @ found).max():
            return found
    raise ArithmeticError(f"flattening: Newton's method did not settle in {ITERATIONS} iterations")


def _work(one: Array, other: Array, weights: Array) -> Array:
    return (one * weights).T @ other


def _shell(width: float) -> _Shell:
    """Return the values of all fields at the quadrature points of a strip of length 1."""
    (s, by_s), (y, by_y) = leggauss(POINTS[0]), leggauss(POINTS[1])
    half, (along, across, bent) = 0.5 * width, TERMS

    def values(fields: list[tuple[Legendre, Legendre]], over_s: int, over_y: int) -> Array:
        """Return derivatives of products of a polynomial along and one across (Q, F)."""
        scale = 2.0**over_s / half**over_y
        each = [np.outer(f.deriv(over_s)(s), g.deriv(over_y)(y)).ravel() for f, g in fields]
        return scale * np.stack(each, axis=1)

    def products(held: int, orders: list[int]) -> list[tuple[Legendre, Legendre]]:
        bubble = Legendre(BUBBLE) ** held
        return [(bubble * Legendre.basis(i), Legendre.basis(j)) for i in range(along) for j in orders]

    even, odd = [2 * j for j in range(1, across + 1)], [2 * j + 1 for j in range(across)]
    rise, axial, lateral = products(2, even), products(1, even), products(1, odd)
    bends = [(Legendre.basis(2 * i + 1), Legendre.basis(0)) for i in range(bent)]
    mean = [(Legendre.basis(i), Legendre.basis(0)) for i in range(2 * along)]
    starts = np.cumsum([0, *map(len, (bends, rise, axial, lateral, mean))])

    def placed(**parts: Array) -> Array:
        whole = np.zeros((len(s) * len(y), int(starts[-1])))
        for name, values_of in parts.items():
            first = starts[("k", "w", "u", "v", "n").index(name)]
            whole[:, first : first + values_of.shape[1]] = values_of
        return whole

    weights = np.outer(0.5 * by_s, half * by_y).ravel()
    curvature = placed(k=values(bends, 0, 0))
    return _Shell(
        along=placed(k=values(bends, 0, 0), w=values(rise, 2, 0)),
        across=placed(w=values(rise, 0, 2)),
        twist=placed(w=values(rise, 1, 1)),
        mean=placed(u=values(axial, 1, 0), n=values(mean, 0, 0)),
        lateral=placed(v=values(lateral, 0, 1)),
        shear=placed(u=values(axial, 0, 1), v=values(lateral, 1, 0)),
        curvature=curvature,
        rise=placed(w=values(rise, 0, 0)),
        weights=weights,
        load=curvature.T @ (weights * np.repeat(s, len(y))) / width,
    )


#: A place counts as on a line or plane within it, over the length [1].
NEAR = 1e-9
#: Cells along half the strip, over half its thickness and over half its width; along a strip of the guide and
#: over its thickness.
SOLID, PLANE = (32, 2, 16), (80, 8)


@BilinearForm
def _elastic(u, v, w):  # type: ignore[no-untyped-def]
    """Work of stress on strain: `shear` of Lame's constants over E is the second, `first` the first."""
    one, other = sym_grad(u), sym_grad(v)
    return w.modulus * (w.first * trace(one) * trace(other) + 2.0 * w.shear * ddot(one, other))


def solid_factor(width: float, thickness: float, nu: float, *, cells: tuple[int, int, int] = SOLID) -> float:
    """Return the stiffness of a strip whose ends slide past each other without turning, over 12 EI/L^3 [1].

    The ends are held in all directions. An eighth is solved for: half the length, thickness and width.

    Args:
        width, thickness: over the length [1]. nu: Poisson ratio.
    """
    length, over, across = (np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, n + 1)) for n in cells)
    mesh = MeshHex.init_tensor(0.5 * (1.0 - length[::-1]), 0.5 * thickness * over, 0.5 * width * across)
    basis = Basis(mesh, ElementVector(ElementHex2()), intorder=4)
    stiffness = _elastic.assemble(
        basis, modulus=1.0, first=nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), shear=0.5 / (1.0 + nu)
    )

    def on(axis: int, place: float, *moved: int) -> Array:
        found: Any = basis.get_dofs(lambda x: np.abs(x[axis] - place) < NEAR)
        return np.concatenate([found.all(f"u^{i}") for i in moved])

    middle = on(0, 0.5, 2)
    held = np.concatenate((on(0, 0.0, 1, 2, 3), on(1, 0.0, 1, 3), on(2, 0.0, 3), on(0, 0.5, 3), middle))
    given = np.zeros(basis.N)
    given[middle] = 0.5
    moved: Any = solve(*condense(stiffness, x=given, D=np.unique(held)))
    energy = 8.0 * 0.5 * moved @ (stiffness @ moved)
    return float(2.0 * energy / (width * thickness**3))


def guide_compliance(
    *,
    slenderness: float,
    apart: float,
    stage: float,
    stiffer: float,
    nu: float,
    cells: tuple[int, int] = PLANE,
) -> float:
    """Return the displacement of a guide's stage under a force across, over that of two beams [1].

    In plane stress; the strips end flush with the stage, and the force acts where it is read, in the middle
    of its face towards them.

    Args:
        slenderness: of the strips, length over thickness. apart, stage: distance of the strips and length of
            the stage over the strips' length. stiffer: modulus of the stage over theirs. nu: of both.
    """
    basis, inside = _guide(1.0 / slenderness, apart, stage, *cells)
    modulus = np.where(inside, stiffer, 1.0)
    of_cells = basis.with_element(ElementQuad0())
    stiffness = _elastic.assemble(
        basis,
        modulus=of_cells.interpolate(modulus),
        first=nu / (1.0 - nu**2),
        shear=0.5 / (1.0 + nu),
    )
    places = basis.mesh.p
    node = int(np.argmin(np.hypot(places[0] - 1.0, places[1])))
    across = int(basis.nodal_dofs[1, node])
    force = np.zeros(basis.N)
    force[across] = 1.0
    held: Any = basis.get_dofs(lambda x: np.abs(x[0]) < NEAR)
    moved: Any = solve(*condense(stiffness, force, D=held.all()))
    return float(moved[across] * 2.0 / slenderness**3)


def _guide(thickness: float, apart: float, stage: float, along: int, over: int) -> tuple[Basis, Array]:
    """Return the basis of two strips and their stage, and which of its cells are in the stage."""
    graded = 0.5 * (1.0 - np.cos(np.pi * np.linspace(0.0, 1.0, along + 1)))
    beyond = 1.0 + stage * np.linspace(0.0, 1.0, 13) ** 2
    strip = thickness * np.linspace(-0.5, 0.5, over + 1)
    gap = (apart - thickness) * 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, 4 * over + 1))
    x = np.unique(np.concatenate((graded, beyond)).round(12))
    y = np.unique(np.concatenate((0.5 * apart + strip, -0.5 * apart + strip, gap)).round(12))
    whole: Any = MeshQuad.init_tensor(x, y)
    centre = whole.p[:, whole.t].mean(axis=1)
    kept = (centre[0] > 1.0) | (np.abs(np.abs(centre[1]) - 0.5 * apart) < 0.5 * thickness)
    mesh = whole.restrict(np.nonzero(kept)[0])
    inside = mesh.p[0, mesh.t].mean(axis=0) > 1.0
    return Basis(mesh, ElementVector(ElementQuad2()), intorder=4), inside
