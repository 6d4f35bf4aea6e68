"""Relative pose of two squares in one plane: one least-squares fit of both, with its covariance.

Unknowns are the picture of the plane (a homography: 8 numbers, or 6 with a known camera) and x, y, theta of
the second square in the frame of the first; the data are eight corners. No calibration is needed. What no
residual can tell is the printed size.
"""

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from studies.errors import BadInput
from studies.interactive.tracking.edges import INSET
from studies.kinds import Array

#: Corners of a square of side 1 in its own frame (x right, y up), in the detector's order: from the upper
#: left on, clockwise as seen from the front.
CORNERS = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
#: Cells of a marker's side with its black border, and of the white margin around it.
BITS, MARGIN = 8, 1.5
ITERATIONS = 12
#: Steps of the central differences in the unknowns of a plane, of sides and radians.
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
        """Return where points (P, 2) [px] that are so without the lens are seen."""
        rays = cv2.convertPointsToHomogeneous(straight)[:, 0] @ np.linalg.inv(self.matrix).T
        return np.asarray(cv2.projectPoints(rays, np.zeros(3), np.zeros(3), self.matrix, self._lens)[0][:, 0])

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
        pose: x, y, theta (3,) of the second square's centre in the first one's frame, lengths in sides.
        plane: homography (3, 3) from that frame, in sides, to pixels.
        rms: of the corners' residuals [px].
        gap (16,): residuals of the edges' offsets and turns [px], by their trust; jacobian (16, K): by the
            unknowns, those of the pose last; trust (8, 2, 2): in an edge's offset and turn, see `trusted`.
    """

    pose: Array
    plane: Array
    rms: float
    gap: Array
    jacobian: Array
    trust: Array

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
    """Return the pictures (..., 2) [px] of points (..., 2) [m] of the plane by the homography `plane` (3,
    3)."""
    image = points @ plane[:, :2].T + plane[:, 2]
    return np.asarray(image[..., :2] / image[..., 2:])


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
        np.linalg.LinAlgError: corners that are no picture of two squares.
    """
    data = corners if camera is None else camera.undistorted(corners)
    if start is None:
        plane = homography(data[0])
        back = project(np.asarray(np.linalg.inv(plane)), data[1])
        edge = back[[1, 2]].mean(axis=0) - back[[0, 3]].mean(axis=0)
        pose = np.array([*back.mean(axis=0), math.atan2(edge[1], edge[0])])
    else:
        plane, pose = start.plane, start.pose.copy()
    chart, known = (_free, (plane / plane[2, 2]).ravel()[:8]) if camera is None else _seen_by(camera, plane)
    known = np.concatenate((known, pose))
    trust = np.tile(np.eye(2), (8, 1, 1)) if trust is None else trust
    weigh = (trust @ _independent(data).reshape(8, 2, 16)).reshape(16, 16)
    solved, jacobian, gap = _least_squares(chart, known, data, weigh)
    if start is not None and rms(gap) > 1.0:
        return fit(corners, camera, trust=trust)
    plane = chart(solved[:-3])
    return Fit(pose=solved[-3:], plane=plane, rms=rms(gap), gap=gap, jacobian=jacobian, trust=trust)


def rms(gap: Array) -> float:
    """Return the root mean square distance [px] of corners whose edges have residuals `gap` (16,)."""
    edges = max(1, int(np.count_nonzero(gap)) // 2)
    return math.sqrt(4.0 / (1.0 + 4.0 * SPREAD**2) * float(gap @ gap) / edges)


#: From the unknowns (..., K) of a plane to its homographies (..., 3, 3).
_Chart = Callable[[Array], Array]


def _free(known: Array) -> Array:
    """The planes seen by a camera that is not known: any homographies, by their first eight entries."""
    last = np.ones((*known.shape[:-1], 1))
    return np.concatenate((known, last), axis=-1).reshape(*known.shape[:-1], 3, 3)


def _seen_by(camera: Camera, plane: Array) -> tuple[_Chart, Array]:
    """The chart of a plane seen by a known camera, by a small turn on top of that of `plane` and the place,
    and the unknowns of `plane`."""
    matrix = camera.matrix
    frame = np.linalg.inv(matrix) @ plane
    size = math.sqrt(np.linalg.norm(frame[:, 0]) * np.linalg.norm(frame[:, 1]))
    frame *= np.sign(frame[2, 2]) / size
    left, _, right = np.linalg.svd(np.column_stack((frame[:, :2], np.cross(frame[:, 0], frame[:, 1]))))
    start = left @ right

    def chart(known: Array) -> Array:
        turn = Rotation.from_rotvec(known[..., :3]).as_matrix() @ start
        return np.asarray(matrix @ np.stack((turn[..., 0], turn[..., 1], known[..., 3:]), axis=-1))

    return chart, np.array([0.0, 0.0, 0.0, *frame[:, 2]])


def _residual(chart: _Chart, known: Array, data: Array) -> tuple[Array, Array]:
    """Residual (16,) [px] and its Jacobian (16, K + 3) in the plane and the pose."""
    x, y, angle = known[-3:]
    steps = STEP * np.eye(known.size - 3)
    plane, (ahead, back) = chart(known[:-3]), chart(known[:-3] + np.stack((steps, -steps)))
    slope = (ahead - back) / (2.0 * STEP)
    turned = CORNERS @ turn(angle).T
    points = np.concatenate((CORNERS, turned + np.array([x, y])))
    homogeneous = np.column_stack((points, np.ones(8)))
    image = homogeneous @ plane.T
    place = image[:, :2] / image[:, 2:]
    by_image = np.zeros((8, 2, 3))
    by_image[:, 0, 0] = by_image[:, 1, 1] = 1.0 / image[:, 2]
    by_image[:, :, 2] = -place / image[:, 2:]
    jacobian = np.zeros((8, 2, known.size))
    jacobian[:, :, :-3] = np.einsum("pab,kbc,pc->pak", by_image, slope, homogeneous)
    by_point = by_image[4:] @ plane[:, :2]
    jacobian[4:, :, -3:-1] = by_point
    jacobian[4:, :, -1] = np.einsum("pab,pb->pa", by_point, np.column_stack((-turned[:, 1], turned[:, 0])))
    return (place - data.reshape(8, 2)).ravel(), jacobian.reshape(16, -1)


def turn(angle: float) -> Array:
    """Return the matrix (2, 2) that turns by an angle [rad]."""
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([[cos, -sin], [sin, cos]])


def _independent(corners: Array) -> Array:
    """Matrix (16, 16) from the corners' residuals to the edges' offsets and turns, whose errors are
    independent.

    A line through stations spread evenly over an edge has a mean offset and a slope with errors of their
    own, so that those of its ends, and with them of neighbouring corners, are not.
    """
    matrix = np.zeros((16, 16))
    for square in range(2):
        for i in range(4):
            j = (i + 1) % 4
            along = corners[square, j] - corners[square, i]
            normal = np.array([along[1], -along[0]]) / math.hypot(*along)
            row, at, to = 8 * square + 2 * i, 8 * square + 2 * i, 8 * square + 2 * j
            matrix[row, at : at + 2] = matrix[row, to : to + 2] = normal / 2.0
            matrix[row + 1, to : to + 2], matrix[row + 1, at : at + 2] = SPREAD * normal, -SPREAD * normal
    return matrix


def _least_squares(chart: _Chart, known: Array, data: Array, weigh: Array) -> tuple[Array, Array, Array]:
    """Levenberg and Marquardt's method; the solution, its Jacobian and residual."""
    gap, jacobian = (weigh @ part for part in _residual(chart, known, data))
    damping = 1e-6
    for _ in range(ITERATIONS):
        normal = jacobian.T @ jacobian
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -jacobian.T @ gap)
        trial, slope = (weigh @ part for part in _residual(chart, known + step, data))
        before, after = float(gap @ gap), float(trial @ trial)
        if not after <= before:
            damping = max(1e-6, 10.0 * damping)
            continue
        known, gap, jacobian, damping = known + step, trial, slope, 0.1 * damping
        if before - after <= 1e-9 * before:
            break
    return known, jacobian, gap
