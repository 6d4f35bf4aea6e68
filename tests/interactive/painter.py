"""Pictures of markers with known truth: drawn exactly, blurred, unevenly lit and noisy as a camera's.

Every pixel is the mean of exact black and white over its area, so that the truth holds to a small part of a
pixel.
"""

import math
from dataclasses import dataclass, field
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates  # type: ignore[attr-defined]
from scipy.spatial.transform import Rotation

from studies.interactive.design import SIDE
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.planar import BITS, MARGIN, Camera, cells, project
from studies.kinds import Array

WHITE, BLACK, TABLE, SKIN, WHITEST = 225.0, 25.0, 150.0, 105.0, 255.0
#: Iterations to the points of a raised marker.
RAISED = 8
#: Blocks of the frame counter in the upper left corner: side [px], and how many bits.
BLOCK, COUNTER_BITS = 6, 16


@dataclass(frozen=True, kw_only=True)
class Optics:
    """How the plane is seen.

    Attributes:
        width, height, focal [px]; distance [m] to the point `target` (2,) [m] of the plane; tilt, roll [rad].
        blur, noise: standard deviations [px], [grey levels]; light: change of brightness across the picture;
        k1: of the lens; gamma: light, blurred by the lens, becomes a value by the power 1/gamma;
        exposure: of light, what is brighter than the largest value being clipped.
        shutter: time [s] from the first row of a picture to the last; the middle row is at the frame's time.
    """

    width: int = 640
    height: int = 480
    focal: float = 600.0
    distance: float = 0.48
    target: tuple[float, float] = (0.0, 0.075)
    tilt: float = math.radians(20)
    roll: float = math.radians(3)
    blur: float = 0.8
    noise: float = 4.0
    light: float = 0.25
    k1: float = 0.0
    gamma: float = 2.2
    exposure: float = 1.0
    shutter: float = 0.0

    @property
    def camera(self) -> Camera:
        """The camera's constants."""
        return Camera(
            fx=self.focal, fy=self.focal, cx=(self.width - 1) / 2, cy=(self.height - 1) / 2, k1=self.k1
        )

    @property
    def plane(self) -> Array:
        """Homography (3, 3) from the plane [m] to the picture [px], the lens apart."""
        # picture y runs down
        turn = Rotation.from_euler("xz", (math.pi - self.tilt, self.roll)).as_matrix()
        place = np.array([0.0, 0.0, self.distance]) - turn @ np.array([*self.target, 0.0])
        return np.asarray(self.camera.matrix @ np.column_stack((turn[:, 0], turn[:, 1], place)))


@dataclass(frozen=True, kw_only=True)
class Marker:
    """A square of that id with its centre and turn in the plane (3,) [m, m, rad], and its side [m].

    Attributes:
        height: of the centre above the plane [m]; wedge: tilt about the marker's x axis [rad]; curl:
            curvature of the paper about its y axis [1/m]; velocity (3,) of the pose [m/s, m/s, rad/s].
    """

    number: int
    pose: tuple[float, float, float]
    side: float = SIDE
    height: float = 0.0
    wedge: float = 0.0
    curl: float = 0.0
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def placed(self, own: Array, delay: Array) -> Array:
        """Return where points (..., 2) [sides] of the marker are (..., 3) [m] after a `delay` [s]."""
        x, y = np.moveaxis(self.side * own, -1, 0)
        up = np.zeros_like(x)
        if self.curl:
            x, up = np.sin(self.curl * x) / self.curl, (1.0 - np.cos(self.curl * x)) / self.curl
        y, up = y * math.cos(self.wedge) - up * math.sin(self.wedge), y * math.sin(self.wedge) + up
        at, to, angle = (now + rate * delay for now, rate in zip(self.pose, self.velocity, strict=True))
        cos, sin = np.cos(angle), np.sin(angle)
        turned = at + cos * x - sin * y, to + sin * x + cos * y, up + self.height
        return np.asarray(np.stack(np.broadcast_arrays(*turned), axis=-1), dtype=float)

    def own(self, place: Array, delay: Array) -> Array:
        """Return the points (..., 2) [sides] of a flat marker at places (..., 2) [m] after a `delay` [s]."""
        at, to, angle = (now + rate * delay for now, rate in zip(self.pose, self.velocity, strict=True))
        x, y, cos, sin = place[..., 0] - at, place[..., 1] - to, np.cos(angle), np.sin(angle)
        return np.stack((cos * x + sin * y, cos * y - sin * x), axis=-1) / self.side


@dataclass(frozen=True, kw_only=True)
class Finger:
    """A disc that covers part of the picture: centre and radius in the plane [m], and its grey level."""

    centre: tuple[float, float]
    radius: float = 0.012
    level: float = SKIN


@dataclass(eq=False)
class Painter:
    """Draws pictures (H, W) of markers through fixed optics; noise depends on `seed` and the frame's number.

    samples: in each direction of a pixel, whose mean it becomes.
    """

    optics: Optics
    seed: int = 1
    samples: int = 5
    _ground: Array = field(init=False)

    def __post_init__(self) -> None:
        rng = np.random.default_rng(self.seed)
        height, width = self.optics.height, self.optics.width
        coarse = rng.normal(0.0, 10.0, (height // 40 + 2, width // 40 + 2))
        places = np.meshgrid(np.arange(height) / 40.0, np.arange(width) / 40.0, indexing="ij")
        texture = map_coordinates(coarse, places, order=1)
        self._ground = WHITEST * ((TABLE + texture) / WHITEST) ** self.optics.gamma

    def draw(self, markers: list[Marker], number: int = 0, fingers: tuple[Finger, ...] = ()) -> Picture:
        """Return the picture (height, width) of the markers and fingers; `number` seeds the noise."""
        optics = self.optics
        picture = self._ground.copy()
        for marker in markers:
            _mix(picture, *_patch(optics, self.samples, marker))
        for finger in fingers:
            self._finger(picture, finger)
        if optics.blur > 0:
            picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), optics.blur), dtype=float)
        ramp = 1.0 - optics.light * np.arange(optics.width) / optics.width  # never brighter than white
        light = np.asarray(optics.exposure * picture * ramp**optics.gamma / WHITEST, dtype=np.float32)
        seen = WHITEST * np.clip(light, 0.0, None) ** np.float32(1.0 / optics.gamma)
        rng = np.random.default_rng((self.seed, number))
        noise = rng.standard_normal(picture.shape, dtype=np.float32) * np.float32(optics.noise)
        done = np.clip(np.rint(seen + noise), 0, 255).astype(np.uint8)
        _burn_in(done, number)
        return done

    def _finger(self, picture: Array, finger: Finger) -> None:
        angle = np.linspace(0, 2 * math.pi, 33)
        edge = np.array(finger.centre) + finger.radius * np.column_stack((np.cos(angle), np.sin(angle)))
        where, _, seen = _area(self.optics, self.samples, project(self.optics.plane, edge))
        gap = project(np.asarray(np.linalg.inv(self.optics.plane)), seen) - finger.centre
        inside = np.hypot(gap[..., 0], gap[..., 1]) < finger.radius
        values = np.full(inside.shape, finger.level)
        _mix(picture, where, *_means(self.optics, self.samples, values, inside))


@lru_cache(maxsize=256)
def _patch(optics: Optics, samples: int, marker: Marker) -> tuple[tuple[slice, slice], Array, Array]:
    """Return the pixels of a marker, which part of each it covers, and its light there.

    Kept, as films of the same optics show the same markers, and all frames the one that stands still.
    """
    half = 0.5 + MARGIN / BITS
    late = 0.5 * optics.shutter * np.array([[-1.0], [1.0]])
    ends = marker.placed(half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]), late).reshape(-1, 3)
    where, rows, seen = _area(optics, samples, _projected(optics, ends))
    delay = optics.shutter * (rows / optics.height - 0.5)
    plane = np.asarray(np.linalg.inv(optics.plane))
    places = marker.own(project(plane, seen), delay)
    if marker.height or marker.wedge or marker.curl:  # the points whose pictures are there, by iteration
        for _ in range(RAISED):
            at = project(plane, _projected(optics, marker.placed(places, delay)))
            places += marker.own(project(plane, seen), delay) - marker.own(at, delay)
    inside = np.abs(places).max(axis=-1) < half
    j, i = np.moveaxis(np.floor((places * [1.0, -1.0] + 0.5) * BITS), -1, 0)
    i, j = (np.clip(each, -1, BITS).astype(int) + 1 for each in (i, j))
    values = np.pad(np.where(cells(marker.number), WHITE, BLACK), 1, constant_values=WHITE)[i, j]
    return where, *_means(optics, samples, values, inside)


def _projected(optics: Optics, places: Array) -> Array:
    """Pictures (..., 2) of places (..., 3) [m], the lens apart."""
    plane, matrix = optics.plane, optics.camera.matrix
    up = matrix @ np.cross(*(np.linalg.inv(matrix) @ plane[:, :2]).T)
    seen = places @ np.column_stack((plane[:, :2], up)).T + plane[:, 2]
    return np.asarray(seen[..., :2] / seen[..., 2:])


def _area(optics: Optics, samples: int, outline: Array) -> tuple[tuple[slice, slice], Array, Array]:
    """Pixels around an outline (P, 2) [px], the lens apart, the rows of their samples, and where (..., 2)
    they would be without the lens."""
    camera, size = optics.camera, (optics.width, optics.height)
    seen = camera.distorted(outline) if optics.k1 else outline
    left, top = np.clip(np.floor(seen.min(axis=0)).astype(int) - 1, 0, size)
    right, bottom = np.clip(np.ceil(seen.max(axis=0)).astype(int) + 2, 0, size)
    inner = (np.arange(samples) + 0.5) / samples - 0.5
    x, y = ((np.arange(*ends)[:, None] + inner).ravel() for ends in ((left, right), (top, bottom)))
    places = np.stack(np.meshgrid(x, y), axis=-1)
    where, rows = (slice(top, bottom), slice(left, right)), places[..., 1]
    return where, rows, camera.undistorted(places) if optics.k1 else places


def _means(optics: Optics, samples: int, values: Array, inside: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return the part of each pixel whose samples are inside, and the mean light of the values there."""
    light = WHITEST * (values / WHITEST) ** optics.gamma
    rows, columns = inside.shape
    shape = (rows // samples, samples, columns // samples, samples)
    cover = inside.reshape(shape).mean(axis=(1, 3))
    return cover, (light * inside).reshape(shape).mean(axis=(1, 3))


def _mix(picture: Array, where: tuple[slice, slice], cover: Array, light: Array) -> None:
    """Put that light over the pixels, as far as it covers them."""
    picture[where] = picture[where] * (1.0 - cover) + light


def _burn_in(picture: Picture, number: int) -> None:
    """Write `number` into the upper left corner as white and black blocks."""
    for bit in range(COUNTER_BITS):
        value = 255 if number >> bit & 1 else 0
        picture[0 : 2 * BLOCK, bit * BLOCK : (bit + 1) * BLOCK] = value
