"""The axial forces of a strip: modes orthonormal along it, and what strains it at rest."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes, SlideModes, SplineBasis, all_modes
from spline_model.effects import MixedStretching, Stretching

Array = NDArray[np.float64]

ROUND_OFF = 1e-14
"""Difference of speeds along a strip, in its mean, that is none."""


def len_modes(parts: list[MixedStretching], *, slide: bool) -> int:
    """Number of axial forces of a strip that belong to the stretching, or to the sliding."""
    return sum(e.modes.count for e in parts if isinstance(e.modes, SlideModes) == slide)


def orthonormal_modes(
    parts: list[tuple[AxialModes, ...]], basis: SplineBasis, points: int, speed: Array
) -> tuple[Array, Array]:
    """Modes (S, G, K) orthonormal along strips of a speed (S, G), and the scene's modes from them (S, K, K).

    Those of one distribution of the speed are kept: all straight strips have the same, but for round-off.
    """
    mean = speed.sum(axis=1, keepdims=True) / speed.shape[1]
    alike = np.rint(speed / mean / ROUND_OFF)
    found = [_modes_of(each, basis, points, v.tobytes()) for each, v in zip(parts, alike, strict=True)]
    longer = np.sqrt(mean)[..., None]
    values, back = (np.array(each) / longer for each in zip(*found, strict=True))
    return values, back


@lru_cache(maxsize=64)
def _modes_of(
    parts: tuple[AxialModes, ...], basis: SplineBasis, points: int, speed: bytes
) -> tuple[Array, Array]:
    """The same of one strip of mean speed 1; speed: in ``ROUND_OFF``."""
    u, weight = basis.gauss_rule(points)
    weight = weight * (ROUND_OFF * np.frombuffer(speed))
    values, back = np.zeros((len(u), 0)), np.zeros((0, 0))
    for modes in parts:
        full, to_part = all_modes(modes, u), np.eye(modes.count)
        if not isinstance(modes, SlideModes):  # the mean first
            to_part[:, 0] = np.linalg.lstsq(full, np.ones(len(u)), rcond=None)[0]
            full = full @ to_part
        factor = np.linalg.cholesky(full.T @ (weight[:, None] * full))
        values = np.column_stack((values, np.linalg.solve(factor, full.T).T))
        k, m = len(back), modes.count
        back = np.block([[back, np.zeros((k, m))], [np.zeros((m, k)), to_part @ np.linalg.inv(factor).T]])
    return values, back


def natural_strain(parts: list[MixedStretching], consistent: Stretching | None) -> float:
    """Stress-free strain of a strip."""
    if consistent is not None:
        return consistent.natural_strain
    return parts[0].natural_strain if parts else 0.0
