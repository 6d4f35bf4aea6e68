"""Systematic errors of a seen pose: their causes, estimated from the residuals of many pictures.

A lens, paper that is not flat or not in one plane, a shutter that reads row after row, and markers of two
sizes each move the edges in a pattern of their own. The fit of the pose takes up one part of the pattern, as
an error; the other part is left as a residual. The residuals of the last pictures give the size of each
cause, and with it the error. A model of the residuals is noise, or noise and one cause, or noise and all
causes. The models are averaged with their evidence as weight.

Source: Hoeting et al., Bayesian model averaging, Statistical Science 14 (1999) 382.
"""

import math
from dataclasses import dataclass

import numpy as np

from studies.interactive.design import turn
from studies.interactive.tracking.edges import INSET
from studies.interactive.tracking.planar import CORNERS, SPREAD, Camera, Fit, normals
from studies.kinds import Array

#: Parameters of the causes and their expected sizes, at which their patterns are computed: k1 of the lens;
#: height [sides] and two slopes of marker 1; curvatures of each marker along x and y, up and down [1/side];
#: time from the first row to the last [s]; side of marker 1 over that of marker 0, less 1.
EXPECTED = np.array([0.1, 0.03, 0.05, 0.05, *([0.3, -0.3] * 4), 0.02, 0.02])
#: Models: the name of the cause, and the parameters. The first explains nothing; the last has all.
MODELS = (
    *(("", []), ("lens", [0]), ("shutter", [12]), ("sizes", [13]), ("tilted", [1]), ("tilted", [1, 2, 3])),
    *(("curled", [k]) for k in range(4, 12)),
    *(("curled", [k, k + 4]) for k in range(4, 8)),
    ("not-flat", list(range(14))),
)
#: The same as a table (M, K): expected sizes, 0 of what a model has not.
_SIZES = np.array([np.isin(np.arange(14), places) * EXPECTED for _, places in MODELS])
#: All models of curled paper together are, before any picture, as likely as so many models of other causes.
CURLED = 4
_NAMES = [name for name, _ in MODELS]
_LIKELY = np.array([-math.log(max(1.0, _NAMES.count(name) / CURLED)) for name in _NAMES])
#: Standard deviation of an edge's offset that is expected before the residuals are seen [px], and how many
#: residuals it is worth.
EXPECTED_PX, WORTH = 0.006, 1.5
#: Part of it that comes back in every picture, of a marker that stands still on the grid of pixels [px].
STILL_PX = 0.003
#: Pictures after which the weight of a residual has decreased to 1/e; iterations for the variance. After
#: MEMORY pictures, the models are computed in one picture of EVERY: they take a tenth of its time.
MEMORY, ROUNDS, EVERY = 50, 2, 5
#: Focal length over the longer side of the picture where the camera is not known.
FOCAL = 0.9
#: Weight of the models of a cause from which on it is named.
SURE = 0.9
#: Places along an edge, from -1/2 to 1/2, at which mean and slope are taken, and their weights.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3) * np.array([[0.5 - INSET], [0.5]])
#: Those of all edges of a marker (12, 2) [sides].
_AFTER = np.roll(CORNERS, -1, axis=0)
_OWN = ((CORNERS + _AFTER)[:, None] / 2.0 + _NODES[:, None] * (_AFTER - CORNERS)[:, None]).reshape(12, 2)


@dataclass(frozen=True, kw_only=True, eq=False)
class View:
    """The fit of one picture, and what causes of unit size do to it.

    Attributes:
        pattern (16, K): residuals of the edges by the causes [px]; error (3, K): of the pose.
    """

    fit: Fit
    pattern: Array
    error: Array


def view(fit: Fit, size: tuple[int, ...], velocity: Array, camera: Camera | None) -> View:
    """Return the view of a fitted picture of a `size` (width, height) [px], whose corners move by `velocity`
    (2, 4, 2) [px/s]."""
    sizes = np.vstack((np.zeros(len(EXPECTED)), np.diag(EXPECTED)))
    seen = _seen(fit, size, velocity, camera, sizes).reshape(len(sizes), 2, 4, 3, 2)
    moved = (seen[1:] - seen[0]) / EXPECTED[:, None, None, None, None]
    across = np.einsum("ksepi,sei->sepk", moved, normals(seen[0][:, :, 0], seen[0][:, :, 2]))
    tables = np.stack((_WEIGHTS, _WEIGHTS * _NODES / SPREAD))
    pattern = (fit.trust @ np.einsum("sepk,tp->setk", across, tables).reshape(8, 2, -1)).reshape(16, -1)
    taken = np.linalg.lstsq(fit.jacobian, pattern)[0]
    left = pattern - fit.jacobian @ taken
    return View(fit=fit, pattern=left, error=taken[-3:])


def _seen(fit: Fit, size: tuple[int, ...], velocity: Array, camera: Camera | None, causes: Array) -> Array:
    """Return where the places along all edges are seen (N, 24, 2) [px] with causes (N, K)."""
    lens, height, *slopes = np.moveaxis(causes[:, :4, None], 1, 0)
    late, grown = np.moveaxis(causes[:, 12:, None], 1, 0)
    curl = causes[:, 4:12].reshape(-1, 2, 1, 2, 2).sum(axis=-1)  # of each marker along x and y
    own = _OWN - curl**2 * _OWN**3 / 6.0
    up = np.sum(curl * _OWN**2 / 2.0, axis=-1)
    up[:, 1] += height + slopes[0] * _OWN[:, 0] + slopes[1] * _OWN[:, 1]
    moving = (1.0 + grown[..., None]) * (own[:, 1] @ turn(fit.pose[2]).T) + fit.pose[:2]
    places, up = np.concatenate((own[:, 0], moving), axis=1), up.reshape(-1, 24)
    middle = (np.array(size) - 1.0) / 2.0
    focal = FOCAL * max(size) if camera is None else camera.fx
    matrix = np.array([[focal, 0.0, middle[0]], [0.0, focal, middle[1]], [0.0, 0.0, 1.0]])
    rays = np.linalg.inv(matrix) @ fit.plane[:, :2]
    normal = matrix @ np.cross(*rays.T) / math.sqrt(math.prod(np.linalg.norm(rays, axis=0)))
    image = places @ fit.plane[:, :2].T + fit.plane[:, 2] + up[..., None] * normal
    image = image[..., :2] / image[..., 2:]
    away = (image - middle) / focal
    bent = lens[..., None] * np.sum(away**2, axis=-1, keepdims=True) * (image - middle) * (camera is None)
    speed = np.stack((velocity, np.roll(velocity, -1, axis=1)), axis=2)  # at both ends of each edge
    speed = np.einsum("seci,pc->sepi", speed, np.column_stack((0.5 - _NODES, 0.5 + _NODES))).reshape(24, 2)
    return np.asarray(image + bent + late[..., None] * speed * (away[..., 1:] * focal / size[1]))


class Causes:
    """Sums over the views of the last pictures, and what follows from them.

    Attributes:
        sizes (K,): mean of the causes' sizes; variance: of an edge's offset [px^2].
        weights: of the models of each cause, by its name; none: of the model without causes.
    """

    def __init__(self) -> None:
        count = len(EXPECTED)
        self._square, self._count = WORTH * EXPECTED_PX**2, WORTH
        self._matrix, self._vector = np.zeros((count, count)), np.zeros(count)
        self.sizes, self._moment = np.zeros(count), np.zeros((count, count))
        self.variance, self.none, self._views = EXPECTED_PX**2, 1.0, 0
        self.weights = {"": 1.0}

    def add(self, seen: View, weight: float = 1.0) -> None:
        """Take one more view into account, of a picture that was not seen before."""
        kept = 1.0 - 1.0 / MEMORY
        self._square = kept * self._square + weight * float(seen.fit.gap @ seen.fit.gap)
        self._count = kept * self._count + weight * seen.fit.spare
        self._matrix = kept * self._matrix + weight * seen.pattern.T @ seen.pattern
        self._vector = kept * self._vector - weight * seen.pattern.T @ seen.fit.gap
        self._views += 1
        if self._views > MEMORY and self._views % EVERY:
            return
        share, means, moments, variances = self._models()
        self.sizes, self._moment = share @ means, np.tensordot(share, moments, 1)
        self.variance, self.none = float(share @ variances), float(share[0])
        self.weights = {name: float(share[np.equal(_NAMES, name)].sum()) for name in _NAMES}

    def _models(self) -> tuple[Array, Array, Array, Array]:
        """Return the weights (M,) of the models, means (M, K) and second moments (M, K, K) of the causes'
        sizes, and variances (M,) of an edge's offset [px^2]."""
        both = _SIZES[:, :, None] * _SIZES[:, None]
        matrix, vector = self._matrix * both, self._vector * _SIZES
        variance, one = np.full(len(_SIZES), self._square / self._count), np.eye(len(EXPECTED))
        for _ in range(ROUNDS):
            inverse = np.linalg.inv(matrix / variance[:, None, None] + one)
            mean = np.einsum("mij,mj->mi", inverse, vector) / variance[:, None]
            explained = np.einsum("mi,mi->m", mean, 2.0 * vector - np.einsum("mij,mj->mi", matrix, mean))
            variance = np.maximum(self._square - explained, 1e-6 * self._square) / self._count
        # a few residuals tell the variance badly: the mean of what it may be is larger (inverse gamma)
        expected = variance * self._count / max(self._count - 2.0, 1.0)
        penalty = np.sum(mean**2, axis=1) - np.linalg.slogdet(inverse)[1]
        evidence = -0.5 * (self._count * np.log(variance) + penalty) + _LIKELY
        share = np.exp(evidence - evidence.max())
        moments = both * (inverse + mean[:, :, None] * mean[:, None])
        return share / share.sum(), _SIZES * mean, moments, expected

    def name(self, least: float = SURE) -> str:
        """Return the cause of the largest weight, empty where that is below `least`."""
        best = max(self.weights, key=self.weights.__getitem__)
        return best if self.weights[best] > least else ""

    def unexplained(self, seen: View) -> Array:
        """Return the residual (16,) [px] without the patterns of the causes."""
        return np.asarray(seen.fit.gap + seen.pattern @ self.sizes)

    def spread_of(self, seen: View, *, own: bool) -> float:
        """Return the variance of an edge's offset [px^2]; of a view that is not among the others, `own`, with
        what its residual tells."""
        left = self.unexplained(seen)
        now = (WORTH * self.variance + float(left @ left)) / (WORTH + seen.fit.spare)
        return max(now, self.variance) if own else self.variance

    def error(self, seen: View) -> Array:
        """Return the systematic error (3,) of the pose [m, m, rad], in root mean square."""
        return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", seen.error, self._moment, seen.error)))
