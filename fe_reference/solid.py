"""A geometrically nonlinear solid of one strip, meshed in three dimensions.

The strip is a block L x t x b between rigid end faces. Half of the width is meshed, since the displacement
is symmetric about the plane of motion. With the displacement gradient H, Green's strain is
E = (H + H^T + H^T H) / 2, and the stress S of the material law

    St. Venant-Kirchhoff   S = lambda tr(E) I + 2 mu E
    neo-Hookean            S = lambda ln(J) C^-1 + 2 mu C^-1 E,    C = I + 2 E,  J^2 = det(C)

The forces of the nodes are int S : dE dV over all elements, of all virtual displacements of the nodes.

The solid is exact for the material law and for clamps that hold the end faces rigid. It includes shear,
lateral clamping and anticlastic curvature. Supports deform only if they are meshed. The stress is singular
at the edges of the clamps; therefore the error decreases slowly with the mesh, with an order of about 1.5.

Source: Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis (2008), chapters 6 to 9.

A rigid body on solid strips is led along a prescribed rotation. The root faces of the strips are fixed to the
ground, the tip faces move with the body in the plane. The interior of each strip is condensed to the three
coordinates of the body. Newton's method for the body and for the interiors is one loop: the torque from the
condensed force is then of second order in the error.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from skfem import Basis, ElementHex2, ElementHexS2, MeshHex
from skfem.quadrature import get_quadrature

from . import read
from .arrays import Array, Indices
from .read import ConvergenceError, InvalidParameter

#: Elements with 20 and 27 nodes, the order of the quadrature that each of them needs, and how many times more
#: elements a strip has along its length than over its thickness. With full integration it needs more of them.
ELEMENTS = {"serendipity": (ElementHexS2, 3, 8), "lagrange": (ElementHex2, 5, 16)}
LAWS = ("st-venant-kirchhoff", "neo-hookean")
#: Pairs of axes of the six strains, shear strains twice.
FIRST, SECOND = np.array([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]).T
#: Clustering of nodes towards clamps and edges: lengths differ by a factor of about 6.
CLUSTERED = 0.76


def _lines(cells: int, low: float, high: float) -> Array:
    """Return mesh lines between two places, clustered towards both."""
    s = np.linspace(0.0, 1.0, cells + 1)
    curved = 0.5 * (1.0 - np.cos(np.pi * s))
    return np.asarray(low + (high - low) * ((1.0 - CLUSTERED) * s + CLUSTERED * curved))


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidStrip(read.Checked):
    """A meshed strip: along x from 0 to the length, thickness along y, half of the width along z.

    Parameters
    ----------
    length, width, thickness : float, m
        Sides of the block; the thickness is in the plane of motion.
    youngs_modulus : float, Pa
    poisson_ratio : float
        Between -1 and 0.5.
    law : str
        One of `LAWS`.
    element : str
        "serendipity" (20 nodes, 2 x 2 x 2 points) or "lagrange" (27 nodes, 3 x 3 x 3 points).
    fineness : int, default 4
        Elements over the thickness and over half of the width. The length has 8 times as many, of 27 nodes 16
        times.
    support : float, m, default 0
        Side of the blocks of the same material that carry the ends, as in a pivot cut from one block. The
        far faces of the blocks are rigid. 0: the ends of the strip are rigid faces.

    Raises
    ------
    InvalidParameter
        An unknown law or element, sides that are not positive, or a fineness below 1.

    References
    ----------
    Bonet and Wood (2008), as in ``fe_reference.solid``.

    Examples
    --------
    >>> strip = SolidStrip(
    ...     length=0.03, width=8e-3, thickness=1e-3, youngs_modulus=114e9, poisson_ratio=0.34, fineness=1
    ... )
    >>> strip.elements.shape
    (8, 60)
    """

    length: Annotated[float, read.positive, "m"]
    width: Annotated[float, read.positive, "m"]
    thickness: Annotated[float, read.positive, "m"]
    youngs_modulus: Annotated[float, read.positive, "Pa"]
    poisson_ratio: Annotated[float, read.within, -1.0, 0.5, "1"]
    law: Annotated[str, read.choice, LAWS] = LAWS[0]
    element: Annotated[str, read.choice, tuple(ELEMENTS)] = "serendipity"
    fineness: Annotated[int, read.count] = 4
    support: Annotated[float, read.not_negative, "m"] = 0.0

    @cached_property
    def _basis(self) -> Basis:
        kind, order, longer = ELEMENTS[self.element]
        element, half = kind(), 0.5 * self.thickness
        x = self._supported(_lines(longer * self.fineness, 0.0, self.length))
        y = self._supported(_lines(self.fineness, -half, half))
        z = _lines(2 * self.fineness, -0.5 * self.width, 0.5 * self.width)[self.fineness :]
        mesh = MeshHex.init_tensor(x, y, z)
        along, across, _ = mesh.p[:, mesh.t].mean(axis=1)
        empty = (along > 0.0) & (along < self.length) & (np.abs(across) > half)
        mesh = mesh.remove_elements(np.flatnonzero(empty))
        return Basis(mesh, element, quadrature=get_quadrature(element, order))

    def _supported(self, lines: Array) -> Array:
        """Return mesh lines with those of the blocks on both sides, which are clustered towards the strip."""
        cells = self.fineness + 1 if self.support else 0
        beyond = self.support * (np.arange(1, cells + 1) / max(cells, 1)) ** 2
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
        nodes = np.argsort(self._order)[self._basis.element_dofs.T]
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

    def _stress(self, strain: Array) -> tuple[Array, Array]:
        """Return the stress (..., 3, 3) and its derivative by the six strains (..., 6, 6) [Pa]."""
        mu = self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
        first = 2.0 * mu * self.poisson_ratio / (1.0 - 2.0 * self.poisson_ratio)
        unit: Any = np.eye(3)
        metric, shear = np.broadcast_to(unit, strain.shape), mu
        growth = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
        if self.law == LAWS[1]:
            metric = np.linalg.inv(unit + 2.0 * strain)
            growth = 0.5 * np.log(np.linalg.det(unit + 2.0 * strain))[..., None, None]
            shear = mu - first * growth
        i, j, k, m = FIRST[:, None], SECOND[:, None], FIRST[None], SECOND[None]
        moduli = first * metric[..., i, j] * metric[..., k, m] + shear * (
            metric[..., i, k] * metric[..., j, m] + metric[..., i, m] * metric[..., j, k]
        )
        return first * growth * metric + 2.0 * mu * metric @ strain, moduli

    def assembled(self, u: Array, moves: Array) -> tuple[Array, Array, Array]:
        """Return forces and stiffness at displacements u (N, 3).

        Returns
        -------
        tuple
            Forces of the nodes (3 N,) [N], lower band of the stiffness of the interior, and the stiffness
            times `moves` (3 N, k).
        """
        entries, used, height = self._band
        force, product = np.zeros(u.size), np.zeros_like(moves)
        forces, stiffness = self._of_elements(u)
        np.add.at(force, self.elements, forces)
        np.add.at(product, self.elements, stiffness @ moves[self.elements])
        shape = height, len(self.free)
        band = np.bincount(entries, stiffness.reshape(-1)[used], minlength=shape[0] * shape[1])
        return force, np.asarray(band.reshape(shape), dtype=np.float64), product

    def strained(self, u: Array) -> tuple[Array, Array]:
        """Return displacement gradient and Green's strain (E, Q, 3, 3) [1] at the points of elements.

        Args:
            u: displacements of all nodes [m].
        """
        gradient, own = self.gradients[0], u.reshape(-1)[self.elements]
        slope = np.einsum("eqnj,eni->eqij", gradient, own.reshape(len(own), -1, 3), optimize=True)
        return slope, 0.5 * (slope + slope.swapaxes(2, 3) + slope.swapaxes(2, 3) @ slope)

    def _of_elements(self, u: Array) -> tuple[Array, Array]:
        """Return forces (E, 3 n) and stiffness (E, 3 n, 3 n) of the elements."""
        gradient, volume = self.gradients
        elements, points, nodes, _ = gradient.shape
        slope, strain = self.strained(u)
        stress, moduli = self._stress(strain)
        deformed = np.eye(3) + slope
        rates: Array = np.empty((elements, points, 6, nodes, 3))
        for k, (i, j) in enumerate(zip(FIRST, SECOND, strict=True)):
            rates[:, :, k] = deformed[:, :, None, :, i] * gradient[:, :, :, j, None]
            if i != j:
                rates[:, :, k] += deformed[:, :, None, :, j] * gradient[:, :, :, i, None]
        whole = rates.reshape(elements, points * 6, 3 * nodes)
        weighted = volume[:, :, None, None] * (moduli @ whole.reshape(elements, points, 6, -1))
        stiffness = whole.swapaxes(1, 2) @ weighted.reshape(elements, points * 6, -1)
        pulled = np.moveaxis(volume[:, :, None, None] * (gradient @ stress), 1, 2)
        spread = np.moveaxis(gradient, 1, 2).reshape(elements, nodes, -1)
        along = pulled.reshape(elements, nodes, -1) @ spread.swapaxes(1, 2)
        for i in range(3):
            stiffness[:, i::3, i::3] += along
        six = (stress[:, :, FIRST, SECOND] * volume[:, :, None]).reshape(elements, 1, -1)
        return (six @ whole)[:, 0], stiffness


#: Newton iterations of one state, and its largest last correction in thicknesses, which leaves the square.
ITERATIONS, CORRECTION = 30, 1e-6
#: Rotations that are closer than this are one node of the polynomial that predicts a state [rad].
APART = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class SolidPath:
    """States of a body on solid strips, one for each rotation.

    Attributes
    ----------
    rotation : (S,) rad
    torque : (S,) N m
        Driving torque, counter-clockwise positive.
    centre : (S, 2) m
        Place of the body point that is at `centre` at rest.
    largest_strain : (S,)
        Largest component of Green's strain at the points of all strips.
    """

    rotation: Array
    torque: Array
    centre: Array
    largest_strain: Array


def solve_solids(
    strip: SolidStrip,
    ends: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    rotations: Sequence[float],
    *,
    centre: tuple[float, float],
) -> SolidPath:
    """Rotate a rigid body on equal strips, its translation free.

    Parameters
    ----------
    strip : SolidStrip
        The mesh of each strip.
    ends : sequence of pairs of points, m
        Root and tip of every strip at rest; their distance is the length of the strip.
    rotations : (S,) rad
        Rotations of the states in order. Small first steps (1, 2.5, 5, 9 degrees) help Newton's method.
        A rotation may occur twice.
    centre : (2,) m
        Point of the body whose path is reported.

    Returns
    -------
    SolidPath

    Raises
    ------
    ConvergenceError
        A state that Newton's method does not reach, or one that is unstable.
    InvalidParameter
        A rotation that is not finite, or strips that do not have the length of the mesh.

    References
    ----------
    Bonet and Wood (2008), as in ``fe_reference.solid``.

    Examples
    --------
    >>> strip = SolidStrip(
    ...     length=0.03, width=8e-3, thickness=1e-3, youngs_modulus=114e9, poisson_ratio=0.34, fineness=1
    ... )
    >>> path = solve_solids(strip, [((0.0, 0.0), (0.03, 0.0))], [0.01], centre=(0.03, 0.0))
    >>> bool(path.torque[0] > 0.0)
    True
    """
    from scipy.interpolate import krogh_interpolate  # whose import takes longer than a small solve

    root, tip = (np.asarray(ends, dtype=float) @ [1.0, 1.0j]).T
    axes = (tip - root) / strip.length
    if not np.allclose(np.abs(axes), 1.0, rtol=1e-9):
        raise InvalidParameter("ends", np.asarray(ends).tolist(), "strips of the length of the mesh [m]")
    local = strip.nodes[strip.tip, :2] @ [1.0, 1.0j]
    body = _Body(strip, axes, root[:, None] + np.multiply.outer(axes, local) - complex(*centre))
    at, known = [0.0], [np.zeros(3 + len(axes) * strip.nodes.size)]
    turns, states = [read.finite("rotations", each, "rad") for each in rotations], []
    for rotation in turns:
        guess = krogh_interpolate(at, np.stack(known), rotation) if len(at) > 2 else known[-1]
        state, moment = body.equilibrium(np.asarray(guess), rotation)
        strains = (np.abs(strip.strained(u)[1]).max() for u in body.strips(state))
        states.append((moment, *state[:2], max(strains)))
        if min(abs(rotation - other) for other in at) > APART:
            at, known = [*at, rotation][-4:], [*known, state][-4:]
    torque, *moved, strain = np.array(states).T
    places = np.transpose(moved) + np.asarray(centre)
    return SolidPath(rotation=np.array(turns), torque=torque, centre=places, largest_strain=strain)


@dataclass(frozen=True, eq=False)
class _Body:
    """The body on its strips, whose directions are `axes` (G,), and the nodes of whose tip faces are `arms`
    from the reference point at rest (G, T) [m]; x + i y.

    A state has displacement and rotation of the body (3,) and displacements of the strips (G, N, 3), in the
    axes of each strip.
    """

    strip: SolidStrip
    axes: Any
    arms: Any

    def strips(self, state: Array) -> Array:
        """Return the displacements of the strips (G, N, 3) of a state, a view."""
        return state[3:].reshape(len(self.axes), -1, 3)

    def equilibrium(self, state: Array, rotation: float) -> tuple[Array, float]:
        """Return state and torque at a rotation, from a guess."""
        strip, coordinates = self.strip, 3 * self.strip.tip
        axes = self.axes[:, None]
        self._lead(state)  # a guess between states has the faces nearly there; at once, the interior follows
        for _ in range(ITERATIONS):
            turned = np.exp(1j * state[2]) * self.arms / axes
            rates = np.stack(np.broadcast_arrays(1.0 / axes, 1j / axes, 1j * turned), axis=2)
            moves = np.zeros((len(axes), strip.nodes.size, 3))
            moves[:, coordinates], moves[:, coordinates + 1] = rates.real, rates.imag
            try:
                parts = list(map(self._condensed, self.strips(state), moves, -turned))
            except LinAlgError:  # the stiffness is not positive
                break
            force, stiffness = (np.sum([each[k] for each in parts], axis=0) for k in range(2))
            change = np.array([0.0, 0.0, rotation - state[2]])
            change[:2] = -np.linalg.solve(stiffness[:2, :2], force[:2] + stiffness[:2, 2] * change[2])
            torque, before, state = float(force[2] + stiffness[2] @ change), state, state.copy()
            state[:3] = *(state[:2] + change[:2]), rotation
            for u, (_, _, interior) in zip(self.strips(state), parts, strict=True):
                u.reshape(-1)[strip.free] -= interior @ [1.0, *change]
            self._lead(state)
            if np.abs(state[3:] - before[3:]).max() < CORRECTION * strip.thickness:
                return state, torque
        raise ConvergenceError(f"solids at {math.degrees(rotation):.4g} deg: not stable; use smaller steps")

    def _lead(self, state: Array) -> None:
        """Put the tip faces where the body has them."""
        turn = np.exp(1j * state[2]) - 1.0
        place = (complex(*state[:2]) + turn * self.arms) / self.axes[:, None]
        for u, each in zip(self.strips(state), place, strict=True):
            u[self.strip.tip, 0], u[self.strip.tip, 1] = each.real, each.imag

    def _condensed(self, u: Array, moves: Array, bend: Any) -> tuple[Array, Array, Array]:
        """Return force (3,) and stiffness (3, 3) of a strip on the pose, and the answers of the interior
        (F, 4): to its residual and to each coordinate of the pose."""
        strip, free = self.strip, self.strip.free
        nodal, band, product = strip.assembled(u, moves)
        factor = cholesky_banded(band, lower=True, overwrite_ab=True, check_finite=False)
        right = np.column_stack([nodal[free], product[free]])
        solved = cho_solve_banded((factor, True), right, check_finite=False)
        force = moves.T @ nodal - product[free].T @ solved[:, 0]
        stiffness = moves.T @ product - product[free].T @ solved[:, 1:]
        tip = nodal.reshape(-1, 3)[strip.tip, :2]
        stiffness[2, 2] += (tip[:, 0] * bend.real + tip[:, 1] * bend.imag).sum()
        return force, stiffness, solved
