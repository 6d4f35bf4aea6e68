"""The Gauss points of a scene in one flat table."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MEASURES, Bending, MixedStretching, Stretching, StripDamping
from spline_model.scene import Scene, Strip
from spline_model.strip.laws import TERMS, curl_factors

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FIRST, WIDTH, MODE, MODES, MEASURE = range(5)
"""Columns of ``PointTable.place``."""
WEIGHT, SPEED, REST, CURVATURE, RIGIDITY, STRAIN, STRETCHING, COMPLIANCE, RELAXATION, CURL, DROP = range(11)
"""Columns of ``PointTable.numbers``."""


class PointTable(NamedTuple):
    """One row a Gauss point, P in all; those of bending come first, strip by strip.

    place (P, 5): index in z of the strip's first x and its number of control points; index in z of its
    first axial force, and their number; code of the measure. basis (2, P, S):
    first and second derivatives, S the most control points. modes (P, M): values of the axial forces' modes.
    numbers (P, 17): Gauss weight; J0 [m]; curvature at rest and stress-free [1/m]; EI [N m^2]; natural
    strain; EA of stretching by quadrature [N]; compliance 1/EA of the axial forces [1/N]; relaxation time
    [s]; the numbers of ``curl_law`` [m, 1]. What does not act is zero.
    """

    place: Indices
    basis: Array
    modes: Array
    numbers: Array

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Return the Gauss points of bending and stretching; those that two effects share stand there once.

        The stress-free curvature is the one at rest and the natural one.
        """
        groups = _groups(scene)
        widest = max((scene.strip(e.strip).basis.control_points for e, *_ in groups), default=0)
        most = max((at.modes.count for _, at, _ in groups if isinstance(at, MixedStretching)), default=0)
        parts = [_rows(scene, *group, widest, most) for group in groups]
        if not parts:
            none = np.zeros((0, DROP + TERMS))
            return cls(np.zeros((0, 5), np.int64), np.zeros((2, 0, 0)), none[:, :0], none)
        place, basis, modes, numbers = zip(*parts, strict=True)
        joined = np.ascontiguousarray(np.concatenate(basis, axis=1))
        return cls(np.concatenate(place), joined, np.concatenate(modes), np.concatenate(numbers))

    @property
    def speed(self) -> Array:
        """J0 (P,) [m]."""
        return self.numbers[:, SPEED]

    @property
    def curvature(self) -> Array:
        """Stress-free curvature (P,) [1/m]."""
        return self.numbers[:, CURVATURE]

    @property
    def rigidity(self) -> Array:
        """EI (P,) [N m^2]."""
        return self.numbers[:, RIGIDITY]

    def moments(self, strain: Array) -> Array:
        """Return bending moments (P,) [N m] of curvatures from the stress-free ones (P,) [1/m]."""
        drop, curl = self.numbers[:, DROP:], self.numbers[:, CURL]
        factor = curl_factors(strain, drop, curl)[1] if curl.any() else 1.0
        return np.asarray(self.rigidity * strain * factor)

    def derivatives(self, z: Array) -> Array:
        """Return x', y', x'', y'' by u at the unknowns z (N,), shape (4, P) [m]."""
        behind = np.minimum(np.arange(self.basis.shape[2]), self.place[:, WIDTH, None] - 1)
        columns = self.place[:, FIRST, None] + 2 * behind
        return np.array([np.einsum("pa,pa->p", d, z[columns + i]) for d in self.basis for i in range(2)])

    def with_share(self, share: float) -> PointTable:
        """The table with a share of the pre-strain."""
        numbers = self.numbers.copy()
        numbers[:, CURVATURE] = (1.0 - share) * numbers[:, REST] + share * numbers[:, CURVATURE]
        numbers[:, STRAIN] *= share
        return self._replace(numbers=numbers)


def _groups(scene: Scene) -> list[tuple[Any, Any, int]]:
    """Effects that act at the same points: bending or else stretching, stretching, its first axial force."""
    groups: list[tuple[Any, Any, int]] = [(bending, None, 0) for bending in scene.of(Bending)]
    axial: list[tuple[Stretching | MixedStretching, int]] = [(e, 0) for e in scene.of(Stretching)]
    axial += [(e, at) for e, (at, _) in zip(scene.of(MixedStretching), scene.layout.modes, strict=True)]
    for effect, at in axial:
        grid = effect.strip, effect.gauss_points, effect.measure
        alone = [(e.strip, e.gauss_points, e.measure) if other is None else () for e, other, _ in groups]
        if grid in alone:
            found = alone.index(grid)
            groups[found] = groups[found][0], effect, at
        else:
            groups.append((effect, effect, at))
    return groups


def _rows(
    scene: Scene, effect: Any, axial: Any, mode: int, widest: int, most: int
) -> tuple[Indices, Array, Array, Array]:
    """Rows of a group, as wide as the most control points and the most modes of the scene."""
    strip = scene.strip(effect.strip)
    u, weight = strip.basis.gauss_rule(effect.gauss_points)
    basis = np.array([strip.basis.evaluate(u, order) for order in (1, 2)])
    count, width = len(weight), basis.shape[2]
    place, numbers = np.zeros((count, 5), dtype=np.int64), np.zeros((count, DROP + TERMS))
    modes = np.zeros((count, most))
    place[:, FIRST] = scene.layout.strips[strip.name][0]
    place[:, WIDTH], place[:, MEASURE] = width, MEASURES.index(effect.measure)
    numbers[:, WEIGHT] = weight
    numbers[:, SPEED], numbers[:, REST] = _rest_of(strip, effect.gauss_points)
    numbers[:, CURVATURE] = numbers[:, REST]
    damping = {e.strip: e.relaxation_time for e in scene.of(StripDamping)}
    numbers[:, RELAXATION] = damping.get(strip.name, 0.0)
    if isinstance(effect, Bending):
        numbers[:, CURVATURE] += effect.natural_curvature
        numbers[:, RIGIDITY] = effect.rigidity_at(strip.basis.degree, u)
        if effect.curl is not None:
            numbers[:, DROP:] = effect.curl.drop(strip.basis.degree, u)
            numbers[:, CURL] = effect.curl.flattening
    if axial is not None:
        numbers[:, STRAIN] = axial.natural_strain
    if isinstance(axial, Stretching):
        numbers[:, STRETCHING] = axial.axial_rigidity
    if isinstance(axial, MixedStretching):
        numbers[:, COMPLIANCE] = axial.compliance_at(u)
        place[:, MODE], place[:, MODES] = mode, axial.modes.count
        modes[:, : axial.modes.count] = axial.modes.evaluate(u)
    if width < widest:
        basis = np.pad(basis, ((0, 0), (0, 0), (0, widest - width)))
    return place, basis, modes, numbers


@lru_cache(maxsize=256)
def _rest_of(strip: Strip, count: int) -> tuple[Array, Array]:
    """Speed and curvature (P,) at rest at ``count`` Gauss points; kept."""
    u = strip.basis.gauss_rule(count)[0]
    tangent, bend = (strip.basis.evaluate(u, order) @ strip.control_points for order in (1, 2))
    speed = np.hypot(tangent[:, 0], tangent[:, 1])
    return speed, (tangent[:, 0] * bend[:, 1] - tangent[:, 1] * bend[:, 0]) / speed**3
