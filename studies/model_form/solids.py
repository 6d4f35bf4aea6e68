"""Linear elasticity of what beams and plates idealise: a strip in three dimensions, a guide with its stage.

Both by quadratic finite elements, for small displacements; nothing of either model is used.
"""

from typing import Any

import numpy as np
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
