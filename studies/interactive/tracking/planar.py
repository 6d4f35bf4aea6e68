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

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from studies.errors import BadInput
from studies.interactive.tracking.edges import INSET
from studies.kinds import Array

#: Corners of a square of side 1 in its own frame (x right, y up), in the detector's order: from the upper
#: left on, clockwise as seen from the front.
CORNERS = np.array([[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]])
#: Cells of a marker's side with its black border.
BITS = 8
ITERATIONS = 12
#: Standard deviation of an edge's offset that is expected before the residuals are seen [px], and how many of
#: them it is worth.
EXPECTED_PX, WORTH = 0.006, 1.5
#: Part of it that comes back in every picture, of a marker that stands still on the grid of pixels [px].
STILL_PX = 0.003
#: Most residuals of the pictures before that the variance of one rests on.
MOST_WORTH = 30.0


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
        """The camera matrix (3, 3)."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def undistorted(self, picture: Array) -> Array:
        """Return where points (..., 2) [px] would be seen without the lens."""
        scale, centre = np.array([self.fx, self.fy]), np.array([self.cx, self.cy])
        seen = (picture - centre) / scale
        straight = seen.copy()
        for _ in range(20):
            square = np.sum(straight**2, axis=-1, keepdims=True)
            straight = seen / (1.0 + square * (self.k1 + square * self.k2))
        return np.asarray(straight * scale + centre)

    @classmethod
    def read(cls, path: Path) -> "Camera":
        """Return the camera of a file that `write` made; BadInput in one line if it is none."""
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            return cls(**{name: float(value) for name, value in values.items()})
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
        rms: of the corners' residuals [px]; sd (3,): standard deviation of the pose.
        size_ratio: side of the second square over the first one's, and its standard deviation, as the corners
            say; rms_sized: residual that would be left with that ratio [px].
        variance: of an edge's offset [px^2], and how many residuals it rests on.
    """

    pose: Array
    plane: Array
    rms: float
    sd: Array
    size_ratio: tuple[float, float]
    rms_sized: float
    variance: tuple[float, float]


@cache
def cells(number: int) -> NDArray[np.bool_]:
    """Return which cells (8, 8) of a marker of the family 36h11 are light, its black border included."""
    import cv2

    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    return np.asarray(cv2.aruco.generateImageMarker(family, number, BITS) > 127)


def project(plane: Array, points: Array) -> Array:
    """Return the pictures (..., 2) of points (..., 2) of the plane."""
    image = points @ plane[:, :2].T + plane[:, 2]
    return np.asarray(image[..., :2] / image[..., 2:])


def homography(points: Array, picture: Array) -> Array:
    """Return the homography (3, 3), last entry 1, that takes four points or more to their pictures (P, 2)."""
    rows, right = [], []
    for (x, y), (u, v) in zip(points.tolist(), picture.tolist(), strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        right += [u, v]
    solved = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    return np.append(solved, 1.0).reshape(3, 3)


def fit(corners: Array, camera: Camera | None = None, start: Fit | None = None) -> Fit:
    """Return the fit to corners (2, 4, 2) [px] of both squares.

    Args:
        camera: if it is known; its lens is taken out of the corners first.
        start: a fit of a picture shortly before.

    Raises:
        np.linalg.LinAlgError: corners that are no picture of two squares.
    """
    data = corners if camera is None else camera.undistorted(corners)
    if start is None:
        plane = homography(CORNERS, data[0])
        back = project(np.asarray(np.linalg.inv(plane)), data[1])
        edge = back[[1, 2]].mean(axis=0) - back[[0, 3]].mean(axis=0)
        pose = np.array([*back.mean(axis=0), math.atan2(edge[1], edge[0])])
    else:
        plane, pose = start.plane, start.pose.copy()
    chart = _Free(plane) if camera is None else _Seen(plane, camera)
    known = np.concatenate((chart.start, pose))
    weigh = _independent(data)
    solved, jacobian, gap = _least_squares(chart, known, data, weigh)
    corner_gap = _residual(chart, solved, data)[0]
    if start is not None and _rms(corner_gap) > 1.0:
        return fit(corners, camera)
    freedom = gap.size - solved.size
    known_variance, worth = (EXPECTED_PX**2, WORTH) if start is None else start.variance
    variance = (worth * known_variance + float(gap @ gap)) / (worth + freedom)
    own = jacobian[:, :-1]
    covariance = np.linalg.inv(own.T @ own) * (variance + STILL_PX**2)
    ratio, left = _size_ratio(jacobian, gap, freedom)
    return Fit(
        pose=solved[-3:],
        plane=chart.plane(solved[:-3]),
        rms=_rms(corner_gap),
        sd=np.sqrt(np.diag(covariance)[-3:]),
        size_ratio=ratio,
        rms_sized=_rms(np.asarray(np.linalg.solve(weigh, left))),
        variance=(variance, min(worth + freedom, MOST_WORTH)),
    )


class _Free:
    """A plane seen by a camera that is not known: any homography."""

    def __init__(self, plane: Array) -> None:
        self.start = (plane / plane[2, 2]).ravel()[:8]

    def plane(self, known: Array) -> Array:
        """The homography of these unknowns."""
        return np.append(known, 1.0).reshape(3, 3)

    def derivative(self, known: Array) -> Array:
        """Its derivative (3, 3, K)."""
        return np.eye(9)[:, :8].reshape(3, 3, 8)


class _Seen:
    """A plane seen by a known camera: rotation vector and place."""

    STEP = 1e-6

    def __init__(self, plane: Array, camera: Camera) -> None:
        self.matrix = camera.matrix
        frame = np.linalg.inv(self.matrix) @ plane
        frame = (
            frame
            / math.sqrt(np.linalg.norm(frame[:, 0]) * np.linalg.norm(frame[:, 1]))
            * np.sign(frame[2, 2])
        )
        turn = np.column_stack((frame[:, 0], frame[:, 1], np.cross(frame[:, 0], frame[:, 1])))
        left, _, right = np.linalg.svd(turn)
        self.turn = left @ right
        self.start = np.array([0.0, 0.0, 0.0, *frame[:, 2]])

    def plane(self, known: Array) -> Array:
        """The homography of these unknowns: a small turn on top of the start, and the place."""
        turn = Rotation.from_rotvec(known[:3]).as_matrix() @ self.turn
        return np.asarray(self.matrix @ np.column_stack((turn[:, 0], turn[:, 1], known[3:6])))

    def derivative(self, known: Array) -> Array:
        """Its derivative (3, 3, K), by central differences."""
        steps = self.STEP * np.eye(6)
        return np.stack(
            [(self.plane(known + s) - self.plane(known - s)) / (2 * self.STEP) for s in steps], axis=-1
        )


def _residual(chart: _Free | _Seen, known: Array, data: Array, ratio: float = 1.0) -> tuple[Array, Array]:
    """Residual (16,) [px] and its Jacobian (16, K + 4) in the plane, the pose and the ratio of the sides."""
    x, y, angle = known[-3:]
    plane, slope = chart.plane(known[:-3]), chart.derivative(known[:-3])
    cos, sin = math.cos(angle), math.sin(angle)
    own = ratio * CORNERS
    turned = own @ np.array([[cos, sin], [-sin, cos]])
    points = np.concatenate((CORNERS, turned + np.array([x, y])))
    homogeneous = np.column_stack((points, np.ones(8)))
    image = homogeneous @ plane.T
    place = image[:, :2] / image[:, 2:]
    by_image = np.zeros((8, 2, 3))
    by_image[:, 0, 0] = by_image[:, 1, 1] = 1.0 / image[:, 2]
    by_image[:, :, 2] = -place / image[:, 2:]
    jacobian = np.zeros((8, 2, slope.shape[-1] + 4))
    jacobian[:, :, :-4] = np.einsum("pab,bck,pc->pak", by_image, slope, homogeneous)
    by_point = by_image[4:] @ plane[:, :2]
    jacobian[4:, :, -4:-2] = by_point
    jacobian[4:, :, -2] = np.einsum("pab,pb->pa", by_point, np.column_stack((-turned[:, 1], turned[:, 0])))
    jacobian[4:, :, -1] = np.einsum("pab,pb->pa", by_point, turned / ratio)
    return (place - data.reshape(8, 2)).ravel(), jacobian.reshape(16, -1)


def _independent(corners: Array) -> Array:
    """Matrix (16, 16) from the corners' residuals to the edges' offsets and turns, whose errors are
    independent.

    A line through stations spread evenly over an edge has a mean offset and a slope with errors of their
    own, so that those of its ends, and with them of neighbouring corners, are not.
    """
    spread = (1.0 - 2.0 * INSET) / math.sqrt(12.0)
    matrix = np.zeros((16, 16))
    for square in range(2):
        for i in range(4):
            j = (i + 1) % 4
            along = corners[square, j] - corners[square, i]
            normal = np.array([along[1], -along[0]]) / math.hypot(*along)
            row, at, to = 8 * square + 2 * i, 8 * square + 2 * i, 8 * square + 2 * j
            matrix[row, at : at + 2] = matrix[row, to : to + 2] = normal / 2.0
            matrix[row + 1, to : to + 2], matrix[row + 1, at : at + 2] = spread * normal, -spread * normal
    return matrix


def _least_squares(
    chart: _Free | _Seen, known: Array, data: Array, weigh: Array
) -> tuple[Array, Array, Array]:
    """Levenberg and Marquardt's method; the solution, its Jacobian and residual."""
    gap, full = (weigh @ part for part in _residual(chart, known, data))
    damping = 1e-6
    for _ in range(ITERATIONS):
        jacobian = full[:, :-1]
        normal = jacobian.T @ jacobian
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -jacobian.T @ gap)
        trial, trial_full = (weigh @ part for part in _residual(chart, known + step, data))
        before, after = float(gap @ gap), float(trial @ trial)
        if not after <= before:
            damping = max(1e-6, 10.0 * damping)
            continue
        known, gap, full, damping = known + step, trial, trial_full, 0.1 * damping
        if before - after <= 1e-9 * before:
            break
    return known, full, gap


def _size_ratio(jacobian: Array, gap: Array, freedom: int) -> tuple[tuple[float, float], Array]:
    """Ratio of the sides with its standard deviation, and the residual left, to first order about equal
    sides."""
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    step = -covariance @ jacobian.T @ gap
    left = gap + jacobian @ step
    variance = (WORTH * EXPECTED_PX**2 + float(left @ left)) / (WORTH + freedom - 1)
    return (1.0 + float(step[-1]), math.sqrt(variance * float(covariance[-1, -1]))), left


def _rms(gap: Array) -> float:
    """Root of the mean square distance of the corners from where they should be [px]."""
    return math.sqrt(2.0 * float(np.mean(gap**2)))
