"""Where pictures come from when the page's own camera does not send them: a drawn film, the demo film among
them, a film file, a camera of this machine."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import cycle
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from studies.errors import BadInput
from studies.interactive.design import SIDE, turn
from studies.interactive.mechanics import Mechanics
from studies.interactive.presets import PRESETS
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.planar import BITS, cells
from studies.interactive.tracking.squares import GAMMA
from studies.kinds import Array

#: One picture: its grey levels, and the JPEG that the page shows.
Shot = tuple[Picture, bytes]
#: Pictures a second of films that do not say.
RATE = 25.0
#: Length of the demo film, its turns.
FRAMES = 300
TURN = math.radians(52)
#: Its camera: size and focal length [px], distance [m] and angles to the plane, and places that it draws in a
#: pixel, in each direction; light of the table, of ink and paper, over that of white.
WIDTH, HEIGHT, FOCAL, DISTANCE, TILT, ROLL, FINE = 640, 480, 600.0, 0.48, math.radians(20), math.radians(3), 2
#: Texels of a bit of a marker: about one for a fine pixel, so that edges between them have no steps.
TEXELS = 16
TABLE, BLACK, WHITE = 0.31, 0.006, 0.76


def encoded(picture: Picture, quality: int = 90) -> bytes:
    """Return a grey picture as a JPEG."""
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert done
    return bytes(data.tobytes())


@dataclass(frozen=True, kw_only=True)
class Film:
    """Frames by number, drawn when they are first shown, and kept as JPEG.

    Attributes:
        draw: gives the picture of frame k.
        rate: of frames [1/s]; lock_step: each stands for a frame of the session, whatever the clock says.
    """

    draw: Callable[[int], Picture]
    frames: int
    rate: float = RATE
    lock_step: bool = True
    _kept: dict[int, bytes] = field(default_factory=dict, init=False)

    def picture(self, k: int) -> Picture:
        """Return frame k, from 0."""
        return self.draw(k % self.frames)

    def __iter__(self) -> Iterator[Picture]:
        return (self.picture(k) for k in range(self.frames))

    def shots(self) -> Iterator[Shot]:
        """Yield the film again and again."""
        for k in cycle(range(self.frames)):
            if k not in self._kept:
                self._kept[k] = encoded(self.picture(k))
            kept = np.frombuffer(self._kept[k], dtype=np.uint8)
            yield np.asarray(cv2.imdecode(kept, cv2.IMREAD_GRAYSCALE), dtype=np.uint8), self._kept[k]


def demo_film() -> Film:
    """Return the demo film: the body follows the pivot's own path, the hand pushes nothing else."""
    mechanics = Mechanics(PRESETS["polymer"])
    poses = [mechanics.marker_at(rotation(k)) for k in range(FRAMES)]
    axes = Rotation.from_euler("xz", (math.pi - TILT, ROLL)).as_matrix()
    place = np.array([0.0, 0.0, DISTANCE]) - 0.075 * axes[:, 1]
    lens = np.array([[FOCAL, 0.0, WIDTH / 2], [0.0, FOCAL, HEIGHT / 2], [0.0, 0.0, 1.0 / FINE]])
    plane = FINE * lens @ np.column_stack((axes[:, :2], place))
    shade = (1.0 - 0.4 * np.arange(WIDTH) / WIDTH).astype(np.float32)
    ground = np.full((FINE * HEIGHT, FINE * WIDTH), TABLE, dtype=np.float32)
    _lay(ground, plane, 0, np.zeros(3))

    def draw(k: int) -> Picture:
        light = ground.copy()
        _lay(light, plane, 1, poses[k])
        small = cv2.resize(light, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
        seen = 255.0 * (shade * cv2.GaussianBlur(small, (0, 0), 0.8)) ** (1.0 / GAMMA)
        noise = np.random.default_rng(k).standard_normal(seen.shape, dtype=np.float32)
        return np.asarray(np.clip(np.rint(seen + 4.0 * noise), 0, 255), dtype=np.uint8)

    return Film(draw=draw, frames=FRAMES)


def _lay(light: NDArray[np.float32], plane: Array, number: int, pose: Array) -> None:
    """Lay a marker with its white margin at `pose` (3,) into the picture of the plane, float32."""
    bits = cells(number).repeat(TEXELS, axis=0).repeat(TEXELS, axis=1)
    paper = np.where(np.pad(bits, 3 * TEXELS // 2, constant_values=True), WHITE, BLACK).astype(np.float32)
    size, middle = SIDE / (TEXELS * BITS), (paper.shape[0] - 1) / 2
    own = size * np.array([[1.0, 0.0, -middle], [0.0, -1.0, middle], [0.0, 0.0, 1.0 / size]])
    laid = np.column_stack((np.vstack((turn(pose[2]), np.zeros(2))), (*pose[:2], 1.0)))
    place = plane @ laid @ own
    how = {"flags": cv2.INTER_LINEAR, "borderMode": cv2.BORDER_TRANSPARENT}
    cv2.warpPerspective(paper, place, light.shape[::-1], light, **how)


def rotation(k: int) -> float:
    """Return the body's rotation in frame k [rad]: there, back, to the other side, still for the last
    second."""
    u = min(1.0, k / (FRAMES - 25))
    return TURN * math.sin(2.0 * math.pi * u) * math.sin(math.pi * u) ** 2 * 1.3


class Video:
    """A film file, played again and again, or a camera of this machine by its number."""

    def __init__(self, place: Path | int) -> None:
        self._place = place
        self.lock_step = isinstance(place, Path)
        video = self._opened()
        good, picture = video.read()
        rate = video.get(cv2.CAP_PROP_FPS)
        video.release()
        if not good or picture is None:
            film = "--film", "demo, or a film file that OpenCV reads"
            camera = "--camera", "the number of a camera that is connected and that no other program uses"
            option, expected = film if self.lock_step else camera
            raise BadInput(f"{option}: got {place}, expected {expected}")
        self.rate = rate if 1.0 <= rate <= 120.0 else RATE

    def _opened(self) -> cv2.VideoCapture:
        return cv2.VideoCapture(str(self._place) if isinstance(self._place, Path) else self._place)

    def once(self) -> Iterator[Picture]:
        """Yield the grey pictures of a film to its end, or of a camera until it fails."""
        video = self._opened()
        try:
            while True:
                good, picture = video.read()
                if not good or picture is None:
                    return
                flat = picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
                yield np.array(flat, dtype=np.uint8)
        finally:
            video.release()

    def shots(self) -> Iterator[Shot]:
        """Yield the pictures; a film starts again at its end, a camera stops when it fails."""
        found = True
        while found:
            found = False
            for grey in self.once():
                yield grey, encoded(grey)
                found = self.lock_step


Source = Film | Video
