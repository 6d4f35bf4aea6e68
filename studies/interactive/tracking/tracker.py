"""From pictures to the events of a session: find, follow where a corner is covered, fit, and say what is
wrong."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from studies.interactive.pivot.design import SIDE
from studies.interactive.tracking import edges, planar
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.planar import Camera
from studies.interactive.tracking.shrinkage import Shrinkage
from studies.kinds import Array

#: Residuals of the fit [px] from which it is doubted, and refused.
DOUBT_PX, REFUSE_PX = 0.12, 0.25
#: Side [px] below which all pixels are looked at where a marker is missed.
FAR_PX = 50.0
#: Longest that a marker is followed by its edges without its id being read [s].
FOLLOW = 1.0
#: Time without any marker after which a mirrored picture is tried [s].
BLIND = 1.0
#: Most powers of light that are tried on one picture.
POWERS = 3
#: Share of good stations below which an edge is called blurred, and least that a followed one keeps.
CLEAR, KEPT = 0.6, edges.LEAST_SHARE
#: Places in the white around a marker, in sides; the value from which they are clipped, and their share that
#: is named.
MARGIN = np.array(
    [[x, s * 0.56] for s in (-1, 1) for x in np.linspace(-0.5, 0.5, 9)]
    + [[s * 0.56, y] for s in (-1, 1) for y in np.linspace(-0.5, 0.5, 9)]
)
WHITEST, CLIPPED = 254, 0.5
#: Difference of the sides that is named, and how many standard deviations it must be.
ODD_SIZE, ODD_SIGMA = 0.01, 6.0


#: Pictures wider than this are found on a quarter of their size, others on half of it.
WIDE = 1000


@dataclass(frozen=True, kw_only=True, eq=False)
class _Squares:
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

    def find(self, picture: Picture, *, whole: bool = False) -> _Squares:
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
        return _Squares(
            corners=corners,
            doubles=frozenset(n for n in (0, 1) if numbers.count(n) > 1),
            others=frozenset(numbers) - {0, 1},
        )


def decoded(data: bytes) -> Picture:
    """Return the grey picture of a JPEG."""
    picture = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_GRAYSCALE)
    return np.asarray(picture, dtype=np.uint8)


def encoded(picture: Picture, quality: int = 90) -> bytes:
    """Return a grey picture as a JPEG."""
    done, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert done
    return bytes(data.tobytes())


@dataclass(eq=False)
class _Known:
    """The last place of a square: corners, their velocity [px/s], when, and when its id was last read."""

    corners: Array
    velocity: Array
    time: float
    read: float


class Tracker:
    """Follows markers 0 and 1 through the pictures of one camera.

    Args:
        side: printed side of the black squares [m].
        camera: if it is known.
    """

    def __init__(self, side: float = SIDE, camera: Camera | None = None) -> None:
        self.side, self.camera = side, camera
        self._detector = Detector()
        self._known: dict[int, _Known] = {}
        self._fit: planar.Fit | None = None
        self._shrinkage = Shrinkage()
        self._blind_since: float | None = None
        self._mirrored = False
        self._tries = 0

    def see(self, picture: Picture, time: float) -> dict[str, Any]:
        """Return the event "seen" or "unseen" of a picture taken at `time` [s]; see `session`."""
        squares = self._detector.find(picture)
        if len(squares.corners) < 2 and not squares.doubles:
            self._tries += 1
            if not self._known or self._far() or self._tries % 5 == 0:  # look at every pixel, now and then
                squares = self._detector.find(picture, whole=True)
        else:
            self._tries = 0
        if squares.doubles:
            return _unseen(f"duplicate-{min(squares.doubles)}")
        quads, followed = self._quads(squares, time)
        if set(quads) != {0, 1}:
            return self._missing(picture, squares, quads, time)
        self._blind_since = None
        return self._fitted(picture, quads, followed, time)

    def _far(self) -> bool:
        """Whether a marker was too small, when last seen, for a part of the pixels."""
        sides = [np.hypot(*(known.corners[1] - known.corners[0])) for known in self._known.values()]
        return bool(min(sides) < FAR_PX)

    def _quads(self, squares: _Squares, time: float) -> tuple[dict[int, Array], set[int]]:
        """Corners of both squares, found or predicted, and which were predicted."""
        quads, followed = dict(squares.corners), set()
        for number in {0, 1} - set(quads):
            known = self._known.get(number)
            if known is not None and time - known.read <= FOLLOW:
                quads[number] = known.corners + known.velocity * (time - known.time)
                followed.add(number)
        return quads, followed

    def _fitted(
        self, picture: Picture, quads: dict[int, Array], followed: set[int], time: float
    ) -> dict[str, Any]:
        for _ in range(POWERS):  # the first pictures tell the power that their values are of light
            gamma = self._shrinkage.gamma
            refined = edges.refine(picture, np.stack((quads[0], quads[1])), gamma)
            lit = {n: planar.cells(n) for n in (0, 1) if n not in followed and refined.share[n].min() >= KEPT}
            corners = self._shrinkage.taken_out(picture, refined.corners, lit)
            if self._shrinkage.gamma == gamma:
                break
        fit = self._fit_to(corners)
        torn = fit is None or fit.rms > REFUSE_PX
        if torn and not followed:  # a corner that is covered pulls the square: take the last one instead
            predicted = {n: k for n, k in self._known.items() if time - k.read <= FOLLOW}
            for number, known in predicted.items():
                other = dict(quads)
                other[number] = known.corners + known.velocity * (time - known.time)
                again = edges.refine(picture, np.stack((other[0], other[1])), self._shrinkage.gamma)
                second = self._fit_to(self._shrinkage.taken_out(picture, again.corners, {}))
                if second is not None and second.rms <= REFUSE_PX:
                    refined, fit, followed, torn = again, second, {number}, False
                    break
        if any((refined.share[n] < KEPT).any() for n in followed):
            return _unseen(_lost(set(followed)))
        if fit is None or torn:
            if followed:
                return _unseen(_lost(followed))
            sized = fit is not None and fit.rms_sized < 0.5 * fit.rms and _odd_sizes(fit)
            return _unseen("sizes" if sized else "refused")
        self._remember(refined.corners, followed, time)
        self._fit = fit
        return self._seen(picture, fit, refined, followed)

    def _fit_to(self, corners: Array) -> planar.Fit | None:
        try:
            fit = planar.fit(corners, self.camera, self._fit)
        except np.linalg.LinAlgError:
            return None
        return fit if np.isfinite(fit.pose).all() and np.isfinite(fit.sd).all() else None

    def _remember(self, corners: Array, followed: set[int], time: float) -> None:
        for number in (0, 1):
            known, now = self._known.get(number), corners[number]
            velocity = np.zeros((4, 2))
            if known is not None and 0.0 < time - known.time < 0.3:
                velocity = (now - known.corners) / (time - known.time)
            read = time if number not in followed or known is None else known.read
            self._known[number] = _Known(corners=now, velocity=velocity, time=time, read=read)

    def _seen(
        self, picture: Picture, fit: planar.Fit, refined: edges.Refined, followed: set[int]
    ) -> dict[str, Any]:
        faults = []
        if _clipped(picture, fit) > CLIPPED:
            faults.append("over-exposed")
        if followed:
            faults.append("followed")
        if fit.rms > DOUBT_PX:
            faults.append("not-flat")
        if (refined.share < CLEAR).any() and not followed:
            faults.append("blurred")
        if _odd_sizes(fit):
            faults.append("sizes")
        scale = np.array([self.side, self.side, 1.0])
        size = np.hypot(*(refined.corners - np.roll(refined.corners, 1, axis=1)).reshape(-1, 2).T).min()
        # an offset that is wrong changes the size of both squares, and with it all distances
        sized = np.abs(fit.pose) * [1.0, 1.0, 0.0] * (2.0 * self._shrinkage.sd / size)
        return {
            "do": "seen",
            "marker": (fit.pose * scale).tolist(),
            "sd": (np.hypot(fit.sd, sized) * scale).tolist(),
            "rms": fit.rms,
            "state": "followed" if followed else "found",
            "plane": (fit.plane @ np.diag([1.0 / self.side, 1.0 / self.side, 1.0])).ravel().tolist(),
            "quads": self._shrinkage.taken_out(picture, refined.corners, {}).tolist(),
            "faults": faults,
        }

    def _missing(
        self, picture: Picture, squares: _Squares, quads: dict[int, Array], time: float
    ) -> dict[str, Any]:
        """Why there is no pose."""
        seen = set(quads)
        if seen:
            self._blind_since = None
            return _unseen(_lost({0, 1} - seen))
        if squares.others:
            return _unseen("other-ids", ", ".join(str(n) for n in sorted(squares.others)))
        if self._blind_since is None:
            self._blind_since, self._mirrored = time, False
        if time - self._blind_since >= BLIND and (self._mirrored or self._tries % 5 == 0):
            self._mirrored = bool(self._detector.find(np.ascontiguousarray(picture[:, ::-1])).corners)
        return _unseen("mirrored" if self._mirrored else "lost-both")


def _clipped(picture: Picture, fit: planar.Fit) -> float:
    """Return the share of places in the white around marker 0 that have the largest value."""
    places = np.rint(planar.project(fit.plane, MARGIN)).astype(int)
    height, width = picture.shape
    there = places[((places >= 0) & (places < (width, height))).all(axis=1)]
    return float(np.mean(picture[there[:, 1], there[:, 0]] >= WHITEST)) if len(there) else 0.0


def _odd_sizes(fit: planar.Fit) -> bool:
    ratio, spread = fit.size_ratio
    return abs(ratio - 1.0) > max(ODD_SIZE, ODD_SIGMA * spread)


def _lost(numbers: set[int]) -> str:
    return "lost-both" if len(numbers) > 1 else f"lost-{min(numbers)}"


def _unseen(code: str, text: str = "") -> dict[str, Any]:
    return {"do": "unseen", "code": code, "text": text}
