"""Finding the markers' squares in a picture, by OpenCV's detector on a picture of half the size."""

import os
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studies.kinds import Array

# a picture of more pixels than this is refused before it is decoded; read when cv2 is first imported
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(1 << 22))

import cv2

Picture = NDArray[np.uint8]

#: Pictures wider than this are found on a quarter of their size, others on half of it.
WIDE = 1000


@dataclass(frozen=True, kw_only=True, eq=False)
class Squares:
    """Corners (4, 2) [px] by id, in the markers' order; ids that were seen twice; other ids."""

    corners: Mapping[int, Array]
    doubles: frozenset[int]
    others: frozenset[int]


class Detector:
    """Squares of the family 36h11 with ids 0 and 1."""

    def __init__(self) -> None:
        cv2.setNumThreads(1)
        family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        self._detector = cv2.aruco.ArucoDetector(family)

    def find(self, picture: Picture, *, whole: bool = False) -> Squares:
        """Return the squares in a grey picture; `whole` looks at all its pixels, for small markers."""
        scale = 1 if whole else (4 if picture.shape[1] > WIDE else 2)
        small = picture
        if scale > 1:
            size = picture.shape[1] // scale, picture.shape[0] // scale
            small = np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
        found, ids, _ = self._detector.detectMarkers(small)
        numbers = [] if ids is None else [int(i) for i in np.ravel(ids)]
        corners = {}
        for number, quad in zip(numbers, found, strict=True):
            if number in (0, 1):
                # the centre of the first small pixel lies between those of the first large ones
                corners[number] = np.asarray(quad[0], dtype=float) * scale + (scale - 1) / 2
        return Squares(
            corners=corners,
            doubles=frozenset(n for n in (0, 1) if numbers.count(n) > 1),
            others=frozenset(numbers) - {0, 1},
        )


def decoded(data: bytes) -> Picture | None:
    """Return the grey picture in the bytes of a JPEG or PNG, or None if there is none."""
    try:
        picture = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
    except cv2.error:
        return None
    if picture is None or picture.shape[0] < 32 or picture.shape[1] < 32:
        return None
    return np.asarray(picture, dtype=np.uint8)


def encoded(picture: Picture, quality: int = 90) -> bytes:
    """Return a grey picture as a JPEG."""
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert done
    return bytes(data.tobytes())
