"""Relative pose of two squares in one plane: one least-squares fit of both, with its covariance.

Unknowns are the picture of the plane (a homography: 8 numbers, or 6 with a known camera) and x, y, theta of
the second square in the frame of the first; the data are eight corners. No calibration is needed. What no
residual can tell is the printed size.
"""

import json
import math
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import leastsq
from scipy.spatial.transform import Rotation

from studies.errors import BadInput
from studies.interactive.tracking.edges import INSET
from studies.kinds import Array

#: Corners of a square of side 1 in its own frame (x right, y up), in the detector's order: from the upper
#: left on, clockwise as seen from the front.
CORNERS = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
#: Cells of a marker's side with its black border, and of the white margin around it.
BITS, MARGIN = 8, 1.5
#: Step of the central differences in the unknowns.
STEP = 1e-6
#: Root mean square distance of an edge's stations from its middle, over its length.
SPREAD = (1.0 - 2.0 * INSET) / math.sqrt(12.0)


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A pinhole with a radial lens: focal lengths and principal point [px], k1 and k2 of Brown's model."""

    fx: float
    fy: float
    cx: float
    cy: float
    k1: float = 0.0
    k2: float = 0.0

    @property
    def matrix(self) -> Array:
        """The camera matrix (3, 3) [px]."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def _lens(self) -> Array:
        return np.array([self.k1, self.k2, 0.0, 0.0])

    def undistorted(self, picture: Array) -> Array:
        """Return where points (..., 2) [px] would be seen without the lens."""
        rounds = (cv2.TERM_CRITERIA_COUNT, 20, 0.0)
        straight = cv2.undistortImagePoints(picture.reshape(-1, 1, 2), self.matrix, self._lens, arg1=rounds)
        return np.asarray(straight, dtype=float).reshape(picture.shape)

    def distorted(self, straight: Array) -> Array:
        """Return where points (..., 2) [px] that are so without the lens are seen."""
        rays = cv2.convertPointsToHomogeneous(straight.reshape(-1, 2))[:, 0] @ np.linalg.inv(self.matrix).T
        seen = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), self.matrix, self._lens)[0]
        return np.asarray(seen, dtype=float).reshape(straight.shape)

    @classmethod
    def read(cls, path: Path) -> "Camera":
        """Return the camera of a file that `write` made; BadInput in one line if it is none."""
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            camera = cls(**{name: float(value) for name, value in values.items()})
            if not (np.isfinite(list(asdict(camera).values())).all() and min(camera.fx, camera.fy) > 0.0):
                raise ValueError("fx and fy must be positive, all numbers finite")
            return camera
        except (OSError, ValueError, TypeError, AttributeError) as error:
            raise BadInput(f"{path}: got no camera, expected JSON with fx, fy, cx, cy ({error})") from None

    def write(self, path: Path) -> None:
        """Store the camera."""
        path.write_text(json.dumps(asdict(self), indent=2) + "\n", encoding="utf-8")


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """The fitted pose.

    Attributes:
        known (K,): the unknowns, those of the pose last.
        plane: homography (3, 3) from the first square's frame, in sides, to pixels; corners (2, 4, 2): where
            it has those of both squares [px], without the lens.
        gap (16,): residuals of the edges' offsets and turns [px], by their trust; jacobian (16, K): by the
            unknowns; trust (8, 2, 2): in an edge's offset and turn, see `trusted`.
    """

    known: Array
    plane: Array
    corners: Array
    gap: Array
    jacobian: Array
    trust: Array

    @property
    def pose(self) -> Array:
        """x, y, theta (3,) of the second square's centre in the first one's frame, lengths in sides."""
        return self.known[-3:]

    @property
    def rms(self) -> float:
        """Of the corners' residuals [px]."""
        return rms(self.gap)

    @property
    def spare(self) -> int:
        """Residuals less unknowns."""
        return int(2 * self.trust.any(axis=(1, 2)).sum() - self.jacobian.shape[1])

    @property
    def spread(self) -> Array:
        """Standard deviation of the pose (3,) [m, m, rad] over that of an edge's offset [px]."""
        return np.sqrt(np.diag(np.linalg.inv(self.jacobian.T @ self.jacobian))[-3:])


@cache
def cells(number: int) -> NDArray[np.bool_]:
    """Return which cells (8, 8) of a marker of the family 36h11 are light, its black border included; number:
    id."""
    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    return np.asarray(cv2.aruco.generateImageMarker(family, number, BITS) > 127)


def project(plane: Array, points: Array) -> Array:
    """Return the pictures (..., N, 2) [px] of points (..., N, 2) [m] of the plane by the homographies `plane`
    (..., 3, 3)."""
    image = points @ plane[..., :2].swapaxes(-1, -2) + plane[..., None, :, 2]
    return np.asarray(image[..., :2] / image[..., 2:])


def normals(p: Array, q: Array) -> Array:
    """Return the unit normals (..., 2) of the lines from p to q (..., 2) of a picture, whose y is down: to
    the left of the way, out of a square that is seen from the front."""
    along = (q - p) / np.sqrt(np.sum((q - p) ** 2, axis=-1, keepdims=True))
    return np.stack((along[..., 1], -along[..., 0]), axis=-1)


def homography(picture: Array) -> Array:
    """Return the homography (3, 3), last entry 1, that maps CORNERS [m] to their pictures (4, 2) [px]."""
    return np.asarray(cv2.getPerspectiveTransform(CORNERS.astype(np.float32), picture.astype(np.float32)))


def trusted(good: Array, least: float) -> Array:
    """Return the trust (8, 2, 2) in the offsets and turns of edges with `good` stations (2, 4, 3), as
    `squares.refine` tells them: that in all stations is one, that in a share below `least` nought.

    A line through some stations has independent errors of its offset at their mean place and of its turn.
    """
    share, middle, spread = np.moveaxis(good.reshape(8, 3), 1, 0)
    rows = np.stack((np.ones(8), middle, np.zeros(8), spread), axis=-1).reshape(8, 2, 2)
    return np.asarray(np.sqrt(np.where(share >= least, share, 0.0))[:, None, None] * rows)


def fit(
    corners: Array, camera: Camera | None = None, start: Fit | None = None, trust: Array | None = None
) -> Fit:
    """Return the fit to corners (2, 4, 2) [px] of both squares.

    Args:
        camera: if it is known; its lens is taken out of the corners first.
        start: a fit of a picture shortly before.
        trust: (8, 2, 2) in each edge, in all alike if it is not given.

    Raises:
        np.linalg.LinAlgError, ValueError: corners that are no picture of two squares.
    """
    data = corners if camera is None else camera.undistorted(corners)
    trust = np.tile(np.eye(2), (8, 1, 1)) if trust is None else trust
    weigh = (trust @ _independent(data)).reshape(16, 16)

    def gap(known: Array) -> Array:
        return np.asarray(weigh @ (_drawn(known, camera) - data).ravel())

    def slope(known: Array) -> Array:
        steps = STEP * np.eye(len(known))
        ahead, back = _drawn(known + np.stack((steps, -steps)), camera)
        return np.asarray(weigh @ (ahead - back).reshape(len(known), 16).T / (2.0 * STEP))

    known = _guess(data, camera) if start is None else start.known
    known, _ = leastsq(gap, known, Dfun=slope)
    if start is not None and rms(gap(known)) > 1.0:
        return fit(corners, camera, trust=trust)
    seen = {"plane": _plane(known[:-3], camera), "corners": _drawn(known, camera)}
    return Fit(known=known, **seen, gap=gap(known), jacobian=slope(known), trust=trust)


def rms(gap: Array) -> float:
    """Return the root mean square distance [px] of corners whose edges have residuals `gap` (16,)."""
    edges = max(1, int(np.count_nonzero(gap)) // 2)
    return math.sqrt(4.0 / (1.0 + 4.0 * SPREAD**2) * float(gap @ gap) / edges)


def _guess(data: Array, camera: Camera | None) -> Array:
    """Return unknowns near those of corners (2, 4, 2) [px]: by the picture of the first square."""
    plane = homography(data[0])
    back = project(np.asarray(np.linalg.inv(plane)), data[1])
    edge = back[[1, 2]].mean(axis=0) - back[[0, 3]].mean(axis=0)
    pose = (*back.mean(axis=0), math.atan2(edge[1], edge[0]))
    if camera is None:
        return np.array([*plane.ravel()[:8], *pose])
    flat = np.column_stack((CORNERS, np.zeros(4)))
    places = np.concatenate((flat, np.column_stack((back, np.zeros(4)))))
    _, rotated, place = cv2.solvePnP(places, data.reshape(8, 2), camera.matrix, None, flags=cv2.SOLVEPNP_IPPE)
    return np.array([*np.ravel(rotated), *np.ravel(place), *pose])


def _plane(known: Array, camera: Camera | None) -> Array:
    """Return homographies (..., 3, 3): by their first eight entries (..., 8), or by the turn and the place
    (..., 6) of the plane before a known camera."""
    if camera is None:
        last = np.ones((*known.shape[:-1], 1))
        return np.concatenate((known, last), axis=-1).reshape(*known.shape[:-1], 3, 3)
    frame = Rotation.from_rotvec(known[..., :3]).as_matrix()
    frame[..., 2] = known[..., 3:]
    return np.asarray(camera.matrix @ frame)


def _drawn(known: Array, camera: Camera | None) -> Array:
    """Return the corners (..., 2, 4, 2) [px] of both squares, without the lens, of unknowns (..., K)."""
    plane, (x, y, angle) = _plane(known[..., :-3], camera), np.moveaxis(known[..., -3:, None], -2, 0)
    cos, sin, (right, up) = np.cos(angle), np.sin(angle), CORNERS.T
    moving = np.stack((x + cos * right - sin * up, y + sin * right + cos * up), axis=-1)
    places = np.stack((np.broadcast_to(CORNERS, moving.shape), moving), axis=-3)
    return project(plane[..., None, :, :], places)


def _independent(corners: Array) -> Array:
    """Matrices (8, 2, 16) from the corners' residuals to the offset and turn of each edge, whose errors are
    independent.

    A line through stations spread evenly over an edge has a mean offset and a slope with errors of their
    own, so that those of its ends, and with them of neighbouring corners, are not.
    """
    normal = normals(corners, np.roll(corners, -1, axis=1)).reshape(8, 2)
    matrix, edge = np.zeros((8, 2, 8, 2)), np.arange(8)
    after = np.roll(edge.reshape(2, 4), -1, axis=1).ravel()
    matrix[edge, 0, edge] = matrix[edge, 0, after] = normal / 2.0
    matrix[edge, 1, after] = SPREAD * normal
    matrix[edge, 1, edge] = -SPREAD * normal
    return matrix.reshape(8, 2, 16)
