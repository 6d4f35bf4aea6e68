"""Where pictures come from when the page's own camera does not send them: a drawn film, the demo film among
them, a film file, a camera of this machine."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

import cv2
import numpy as np

from studies.errors import BadInput
from studies.interactive.design import turned
from studies.interactive.mechanics import Mechanics
from studies.interactive.presets import PRESETS
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.painter import Finger, Marker, Optics, Painter
from studies.kinds import Array

#: Pictures a second of films that do not say.
RATE = 25.0
#: Length of the demo film, its turns and the frames in which a finger covers a corner and a hand a marker.
FRAMES = 300
TURN = math.radians(52)
FINGER = range(150, 168)
HIDDEN = range(235, 247)


def _decoded(data: bytes) -> Picture:
    """Return the grey picture of a JPEG."""
    picture = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
    return np.asarray(picture, dtype=np.uint8)


def encoded(picture: Picture, quality: int = 90) -> bytes:
    """Return a grey picture as a JPEG."""
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert done
    return bytes(data.tobytes())


@dataclass(frozen=True, kw_only=True)
class Shot:
    """One picture: its number in the film, its time [s], its grey levels and the JPEG that the page shows."""

    number: int
    time: float
    picture: Picture
    jpeg: bytes


@dataclass(frozen=True, kw_only=True)
class Film:
    """Frames by number, drawn when they are first shown, and kept as JPEG.

    Attributes:
        scene: gives the markers and fingers of frame k.
        rate: of frames [1/s]; lock_step: each stands for a frame of the session, whatever the clock says.
    """

    painter: Painter
    frames: int
    scene: Callable[[int], tuple[list[Marker], tuple[Finger, ...]]]
    rate: float = RATE
    lock_step: bool = True
    _kept: dict[int, bytes] = field(default_factory=dict, init=False)

    def picture(self, k: int) -> Picture:
        """Return frame k, from 0."""
        markers, fingers = self.scene(k % self.frames)
        return self.painter.draw(markers, k % self.frames, fingers)

    def __iter__(self) -> Iterator[Picture]:
        return (self.picture(k) for k in range(self.frames))

    def shots(self) -> Iterator[Shot]:
        """Yield the film again and again; the times run on."""
        for number in count():
            k = number % self.frames
            if k not in self._kept:
                self._kept[k] = encoded(self.picture(k))
            jpeg = self._kept[k]
            yield Shot(number=number, time=number / self.rate, picture=_decoded(jpeg), jpeg=jpeg)


def demo_film() -> Film:
    """Return the demo film with its truth: the body follows the pivot's own path, the hand pushes nothing
    else."""
    mechanics = Mechanics(PRESETS["polymer"])
    poses = [mechanics.marker_at(rotation(k)) for k in range(FRAMES)]

    def scene(k: int) -> tuple[list[Marker], tuple[Finger, ...]]:
        moving = Marker(number=1, pose=tuple(poses[k]))
        markers = [Marker(number=0, pose=(0.0, 0.0, 0.0)), moving]
        return (markers[:1] if k in HIDDEN else markers), (_finger(poses[k]),) if k in FINGER else ()

    return Film(painter=Painter(Optics(), samples=2, numbered=False), frames=FRAMES, scene=scene)


def rotation(k: int) -> float:
    """Return the body's rotation in frame k [rad]: there, back, to the other side, still for the last
    second."""
    u = min(1.0, k / (FRAMES - 25))
    return TURN * math.sin(2.0 * math.pi * u) * math.sin(math.pi * u) ** 2 * 1.3


def _finger(pose: Array) -> Finger:
    corner = pose[:2] + turned(pose[2], np.array([0.03, 0.03]))
    return Finger(centre=(float(corner[0]), float(corner[1])))


class Video:
    """A film file, played again and again, or a camera of this machine by its number."""

    def __init__(self, place: Path | int) -> None:
        self._place = place
        self.lock_step = isinstance(place, Path)
        if isinstance(place, Path) and not place.is_file():
            raise BadInput(f"--film: got {place}, expected a film file or demo")
        video = self._opened()
        good, picture = video.read()
        rate = video.get(cv2.CAP_PROP_FPS)
        video.release()
        if not good or picture is None:
            if self.lock_step:
                raise BadInput(f"--film: got {place}, expected a film that OpenCV reads")
            raise BadInput(
                f"--camera: got no picture from camera {place} of this machine, expected one that is "
                "connected and that no other program uses"
            )
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
        number = 0
        while True:
            first = number
            for grey in self.once():
                yield Shot(number=number, time=number / self.rate, picture=grey, jpeg=encoded(grey))
                number += 1
            if number == first or not self.lock_step:
                return


Source = Film | Video
