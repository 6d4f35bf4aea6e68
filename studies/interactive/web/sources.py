"""Where pictures come from when the page's own camera does not send them: a film file, a camera of this
machine, the demo film."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from studies.errors import BadInput
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.painter import Film
from studies.interactive.tracking.planar import Camera

#: Pictures a second of films that do not say.
RATE = 25.0


def decoded(data: bytes) -> Picture:
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
    picture: NDArray[np.uint8]
    jpeg: bytes


class Source(Protocol):
    """A series of pictures; `lock_step` says whether each stands for a frame whatever the clock says."""

    rate: float
    lock_step: bool

    def shots(self) -> Iterator[Shot]:
        """Yield pictures for ever, or until the camera fails."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """What one server serves.

    Attributes:
        port: 0 for any; share: the address of this machine by which its network reaches the page too.
        camera: "browser", "none", "film" or "server", which the page is told.
        source: of every page's pictures, None where the page's camera or nothing sends them; keep: takes the
            lines of a recording, of the first page that is open.
    """

    port: int = 0
    share: str | None = None
    camera: str = "browser"
    source: Source | None = None
    calibration: Camera | None = None
    preset: str = "polymer"
    keep: Callable[[str], None] | None = None


class FilmSource:
    """A film that is drawn when it is first shown, and kept as JPEG."""

    lock_step = True

    def __init__(self, film: Film) -> None:
        self._film, self.rate = film, film.rate
        self._kept: dict[int, bytes] = {}

    def shots(self) -> Iterator[Shot]:
        """Yield the film again and again; the times run on."""
        number = 0
        while True:
            k = number % self._film.frames
            if k not in self._kept:
                self._kept[k] = encoded(self._film.picture(k))
            jpeg = self._kept[k]
            yield Shot(number=number, time=number / self.rate, picture=decoded(jpeg), jpeg=jpeg)
            number += 1


class VideoSource:
    """A film file, played again and again, or a camera of this machine by its number."""

    def __init__(self, place: Path | int) -> None:
        self._place = place
        self.lock_step = isinstance(place, Path)
        if isinstance(place, Path) and not place.is_file():
            raise BadInput(f"--film: got {place}, expected a film file or demo")
        video = cv2.VideoCapture(str(place) if isinstance(place, Path) else place)
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

    def once(self) -> Iterator[Picture]:
        """Yield the grey pictures of a film to its end, or of a camera until it fails."""
        video = cv2.VideoCapture(str(self._place) if isinstance(self._place, Path) else self._place)
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
        """Yield the pictures; a film begins anew at its end, a camera ends when it fails."""
        number = 0
        while True:
            first = number
            for grey in self.once():
                yield Shot(number=number, time=number / self.rate, picture=grey, jpeg=encoded(grey))
                number += 1
            if number == first or not self.lock_step:
                return
