"""A geometrically nonlinear solid of one strip, meshed in three dimensions.

The strip is a block L x t x b between rigid end faces. Half of the width is meshed, since the displacement
is symmetric about the plane of motion. With the displacement gradient H, Green's strain is
E = (H + H^T + H^T H) / 2, and the stress S of the material law

    St. Venant-Kirchhoff   S = lambda tr(E) I + 2 mu E
    neo-Hookean            S = mu (I - C^-1) + lambda ln(J) C^-1,    C = I + 2 E

The forces of the nodes are int S : dE dV over all elements, of all virtual displacements of the nodes.

The solid is exact for the material law and for clamps that hold the end faces rigid. It includes shear,
lateral clamping and anticlastic curvature. Supports deform only if they are meshed. The stress is singular
at the edges of the clamps; therefore the error decreases slowly with the mesh, with an order of about 1.5.

Source: Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis (2008), chapters 6 to 9.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skfem import Basis, ElementHex2, ElementHexS2, MeshHex
from skfem.quadrature import get_quadrature

from .arrays import Array, Indices
from .errors import InvalidParameter

#: Elements with 20 and 27 nodes, and the order of the quadrature that each of them needs.
ELEMENTS = {"serendipity": (ElementHexS2, 3), "lagrange": (ElementHex2, 5)}
LAWS = ("st-venant-kirchhoff", "neo-hookean")
#: Pairs of axes of the six strains, shear strains twice.
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))
#: Clustering of nodes towards clamps and edges: lengths differ by a factor of about 6.
CLUSTERED = 0.76
#: Elements that are assembled at once.
CHUNK = 400


def _lines(count: int, low: float, high: float, *, both: bool = True) -> Array:
    """Return mesh lines between two places, clustered towards both ends or towards the upper one."""
    s = np.linspace(0.0, 1.0, count + 1)
    curved = 0.5 * (1.0 - np.cos(np.pi * s)) if both else np.sin(0.5 * np.pi * s)
    lines: Array = low + (high - low) * ((1.0 - CLUSTERED) * s + CLUSTERED * curved)
    return lines


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidStrip:
    """A meshed strip: along x from 0 to the length, thickness along y, half of the width along z.

    Parameters
    ----------
    length, width, thickness : float, m
        Sides of the block; the thickness is in the plane of motion.
    youngs_modulus : float, Pa
    poisson_ratio : float
        From 0 to below 0.5.
    law : str
        One of `LAWS`.
    element : str
        "serendipity" (20 nodes, 2 x 2 x 2 points) or "lagrange" (27 nodes, 3 x 3 x 3 points).
    mesh : tuple of int
        Elements along the length, the thickness and half of the width.
    support : float, m, default 0
        Side of the blocks of the same material that carry the ends, as in a pivot cut from one block. The
        far faces of the blocks are rigid. 0: the ends of the strip are rigid faces.

    Raises
    ------
    InvalidParameter
        An unknown law or element, sides that are not positive, or an empty mesh.

    References
    ----------
    Bonet and Wood (2008), as in ``fe_reference.solid``.

    Examples
    --------
    >>> SolidStrip(
    ...     length=0.03, width=8e-3, thickness=1e-3, youngs_modulus=114e9, poisson_ratio=0.34, mesh=(6, 1, 1)
    ... ).mesh
    (6, 1, 1)
    """

    length: float
    width: float
    thickness: float
    youngs_modulus: float
    poisson_ratio: float
    law: str = LAWS[0]
    element: str = "serendipity"
    mesh: tuple[int, int, int] = (32, 4, 3)
    support: float = 0.0

    def __post_init__(self) -> None:
        for name in ("length", "width", "thickness", "youngs_modulus"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise InvalidParameter(name, value, "a positive number")
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise InvalidParameter("poisson_ratio", self.poisson_ratio, "a number from 0 to below 0.5")
        for name, known in (("law", LAWS), ("element", tuple(ELEMENTS))):
            if getattr(self, name) not in known:
                raise InvalidParameter(name, getattr(self, name), "one of " + ", ".join(known))
        if min(self.mesh) < 1:
            raise InvalidParameter("mesh", self.mesh, "at least one element in each direction")
        if not (np.isfinite(self.support) and self.support >= 0.0):
            raise InvalidParameter("support", self.support, "a number of at least 0")

    @cached_property
    def _basis(self) -> Basis:
        kind, order = ELEMENTS[self.element]
        x = self._supported(_lines(self.mesh[0], 0.0, self.length))
        y = self._supported(_lines(self.mesh[1], -0.5 * self.thickness, 0.5 * self.thickness))
        mesh = MeshHex.init_tensor(x, y, _lines(self.mesh[2], 0.0, 0.5 * self.width, both=False))
        along, across, _ = mesh.p[:, mesh.t].mean(axis=1)
        empty = (along > 0.0) & (along < self.length) & (np.abs(across) > 0.5 * self.thickness)
        element = kind()
        mesh = mesh.remove_elements(np.flatnonzero(empty))
        return Basis(mesh, element, quadrature=get_quadrature(element, order))

    def _supported(self, lines: Array) -> Array:
        """Return mesh lines with those of the blocks on both sides, which are clustered towards the strip."""
        if not self.support:
            return lines
        count = self.mesh[1] + 1
        beyond = self.support * (np.arange(1, count + 1) / count) ** 2
        return np.concatenate([lines[0] - beyond[::-1], lines, lines[-1] + beyond])

    @cached_property
    def _order(self) -> Indices:
        """Nodes sorted along the strip, which makes the band of the stiffness narrow."""
        return np.lexsort(self._basis.doflocs[::-1].round(12))

    @cached_property
    def nodes(self) -> Array:
        """Places of the nodes at rest (N, 3) [m]."""
        return np.ascontiguousarray(self._basis.doflocs[:, self._order].T)

    @cached_property
    def elements(self) -> Indices:
        """Coordinates of the elements (E, 3 n), displacement components of a node next to each other."""
        place = np.argsort(self._order)
        nodes = place[self._basis.element_dofs.T]
        return np.asarray((3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), -1))

    @cached_property
    def gradients(self) -> tuple[Array, Array]:
        """Gradients of the shape functions (E, Q, n, 3) [1/m], and volumes of the points for the whole width
        (E, Q) [m^3]."""
        fields: list[Any] = [each[0].grad for each in self._basis.basis]
        return np.ascontiguousarray(np.moveaxis(np.stack(fields), (0, 1), (2, 3))), 2.0 * self._basis.dx

    @cached_property
    def tip(self) -> Indices:
        """Nodes of the tip face, or of the far face of its block."""
        return np.flatnonzero(np.isclose(self.nodes[:, 0], self.length + self.support))

    @cached_property
    def free(self) -> Indices:
        """Coordinates of the interior, in order along the strip."""
        free = np.ones((len(self.nodes), 3), dtype=bool)
        free[np.isclose(self.nodes[:, 2], 0.0), 2] = False
        free[np.isclose(self.nodes[:, 0], -self.support)] = free[self.tip] = False
        return np.flatnonzero(free)

    @cached_property
    def _band(self) -> tuple[Indices, Indices, int]:
        """Places of the used entries of all element matrices in the lower band, which entries these are, and
        the height of the band."""
        number = np.full(3 * len(self.nodes), -1)
        number[self.free] = np.arange(len(self.free))
        own = number[self.elements]
        row, column = own[:, :, None], own[:, None, :]
        used = (column >= 0) & (row >= column)
        below = np.where(used, row - column, 0)
        return (below * len(self.free) + column)[used], np.flatnonzero(used), int(below.max()) + 1

    @cached_property
    def _sections(self) -> tuple[Indices, Array]:
        """Section of every node, sections having one x, and the number of nodes of each."""
        _, section = np.unique(self.nodes[:, 0].round(12), return_inverse=True)
        return section, np.bincount(section).astype(float)

    @property
    def unknowns(self) -> int:
        """Free displacements of the interior."""
        return len(self.free)

    def moved(self, u: Array, change: Array) -> Array:
        """Return displacements (N, 3) after a change (N, 3), with the mean turn of each section finite."""
        section, count = self._sections
        here = self.nodes[:, :2] + u[:, :2]

        def mean(values: Array) -> Array:
            found: Array = (np.bincount(section, values) / count)[section]
            return found

        def means(values: Array) -> Array:
            return np.stack([mean(values[:, 0]), mean(values[:, 1])], axis=1)

        middle, shift = means(here), means(change[:, :2])
        arm, rest = here - middle, change[:, :2] - shift
        turn = mean(arm[:, 0] * rest[:, 1] - arm[:, 1] * rest[:, 0]) / mean((arm**2).sum(axis=1))
        arm = arm + rest - np.stack([-turn * arm[:, 1], turn * arm[:, 0]], axis=1)
        cos, sin = np.cos(turn), np.sin(turn)
        turned = np.stack([cos * arm[:, 0] - sin * arm[:, 1], sin * arm[:, 0] + cos * arm[:, 1]], axis=1)
        return np.column_stack([middle + shift + turned - self.nodes[:, :2], u[:, 2] + change[:, 2]])

    def _stress(self, strain: Array) -> tuple[Array, Array]:
        """Return the stress (..., 3, 3) and its derivative by the six strains (..., 6, 6) [Pa]."""
        mu = self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
        first = 2.0 * mu * self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio)
        one = np.eye(3)
        if self.law == LAWS[0]:
            trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
            return first * trace * one + 2.0 * mu * strain, _moduli(one, first, mu)
        inverse = np.asarray(np.linalg.inv(one + 2.0 * strain), dtype=np.float64)
        volume = 0.5 * np.log1p(_dilation(2.0 * strain))[..., None, None]
        return 2.0 * mu * inverse @ strain + first * volume * inverse, _moduli(
            inverse, first, mu - first * volume
        )

    def assembled(self, u: Array, moves: Array) -> tuple[Array, Array, Array]:
        """Return forces and stiffness at displacements u (N, 3).

        Returns
        -------
        tuple
            Forces of the nodes (3 N,) [N], lower band of the stiffness of the interior, and the stiffness
            times `moves` (3 N, k).
        """
        gradients, volumes = self.gradients
        entries, used, height = self._band
        flat, force, product = u.reshape(-1), np.zeros(u.size), np.zeros_like(moves)
        matrices = np.empty((len(self.elements), self.elements.shape[1] ** 2))
        for begin in range(0, len(self.elements), CHUNK):
            chunk = slice(begin, begin + CHUNK)
            own = self.elements[chunk]
            local, stiffness = self._chunk(gradients[chunk], volumes[chunk], flat[own])
            np.add.at(force, own, local)
            np.add.at(product, own, stiffness @ moves[own])
            matrices[chunk] = stiffness.reshape(len(own), -1)
        count = len(self.free)
        band = np.bincount(entries, matrices.reshape(-1)[used], minlength=height * count)
        return force, np.asarray(band.reshape(height, count), dtype=np.float64), product

    def _chunk(self, gradient: Array, volume: Array, u: Array) -> tuple[Array, Array]:
        """Return forces (E, 3 n) and stiffness (E, 3 n, 3 n) of elements with displacements (E, 3 n)."""
        count, points, nodes, _ = gradient.shape
        slope = np.einsum("eqnj,eni->eqij", gradient, u.reshape(count, nodes, 3), optimize=True)
        strain = 0.5 * (slope + slope.swapaxes(2, 3) + slope.swapaxes(2, 3) @ slope)
        stress, moduli = self._stress(strain)
        deformed = np.eye(3) + slope
        rates: Array = np.empty((count, points, 6, nodes, 3))
        for k, (i, j) in enumerate(PAIRS):
            rates[:, :, k] = deformed[:, :, None, :, i] * gradient[:, :, :, j, None]
            if i != j:
                rates[:, :, k] += deformed[:, :, None, :, j] * gradient[:, :, :, i, None]
        whole = rates.reshape(count, points * 6, 3 * nodes)
        weighted = volume[:, :, None, None] * (moduli @ whole.reshape(count, points, 6, -1))
        stiffness = whole.swapaxes(1, 2) @ weighted.reshape(count, points * 6, -1)
        pulled = volume[:, :, None, None] * (gradient @ stress)
        along = np.moveaxis(pulled, 1, 2).reshape(count, nodes, -1) @ np.moveaxis(gradient, 1, 2).reshape(
            count, nodes, -1
        ).swapaxes(1, 2)
        for i in range(3):
            stiffness[:, i::3, i::3] += along
        six = np.stack([stress[:, :, i, j] for i, j in PAIRS], axis=2) * volume[:, :, None]
        return np.einsum("ep,epn->en", six.reshape(count, -1), whole, optimize=True), stiffness


def _dilation(a: Array) -> Array:
    """Return det(I + a) - 1 of symmetric a (..., 3, 3) without the round-off of the difference."""
    trace = np.trace(a, axis1=-2, axis2=-1)
    found: Array = trace + 0.5 * (trace**2 - (a * a).sum(axis=(-2, -1))) + np.linalg.det(a)
    return found


def _moduli(metric: Array, first: float, second: Any) -> Array:
    """Return first M_ij M_kl + second (M_ik M_jl + M_il M_jk) of a symmetric M, for the six strains."""
    found = np.empty((*metric.shape[:-2], 6, 6))
    second = np.asarray(second)[..., 0, 0] if np.ndim(second) else second
    for a, (i, j) in enumerate(PAIRS):
        for b, (k, m) in enumerate(PAIRS):
            both = metric[..., i, k] * metric[..., j, m] + metric[..., i, m] * metric[..., j, k]
            found[..., a, b] = first * metric[..., i, j] * metric[..., k, m] + second * both
    return found
