"""Whether a discretisation can hold a strip at all: the rank of its tangent at rest, form by form."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, HatModes, LegendreModes, SlideModes, SplineBasis, all_modes

Array = NDArray[np.float64]

SMALLEST = 1e-10
"""Singular values below this part of the largest one are zeros."""


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
