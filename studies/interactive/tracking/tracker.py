"""From pictures to the events of a session: find, follow where a corner is covered, fit, and say what is
wrong."""

from collections import deque
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from studies.interactive.design import SIDE
from studies.interactive.tracking import planar, squares
from studies.interactive.tracking.causes import STILL_PX, Causes, View, view
from studies.interactive.tracking.edges import Picture
from studies.interactive.tracking.planar import Camera
from studies.interactive.tracking.squares import KEPT, Shrinkage
from studies.kinds import Array

#: Residuals of the fit [px] from which it is doubted, and, less that of known causes, refused.
DOUBT_PX, REFUSE_PX = 0.08, 0.18
#: Weight of noise alone below which systematic errors are named.
UNLIKELY = 0.1
#: Least edges of a marker that are seen.
EDGES = 3
#: Share of the cells of a marker that is followed, light or dark as they should be, by which its id is read.
READ = 0.75
#: Side [px] below which all pixels are looked at where a marker is missed; of other missed ones, in one
#: picture of SOMETIMES, which is then looked at in a mirror too.
FAR_PX, SOMETIMES = 50.0, 5
#: Longest that a marker is followed by its edges without its id being read, and after which its velocity is
#: not known [s].
FOLLOW, LONG = 1.0, 0.3
#: Most powers of light that are tried on one picture.
POWERS = 3
#: Share of good stations of an edge below which it is called blurred, may be ignored where the others fit
#: without it, and is not taken for whole.
CLEAR, PART, WHOLE = 0.6, 0.75, 0.9
#: Value from which light is clipped, and its share of a marker that is named.
WHITEST, CLIPPED = 254, 0.1
#: Distance of the pixels by which a picture is told from others [px], and how many pictures are known: of a
#: film that is repeated, noise would look like a systematic error.
COARSE, PICTURES = 7, 5000
#: Least window of the detector's thresholds [px]: smaller ones find no more markers in three times as long.
LEAST_WINDOW = 13
#: Pictures wider than this are found on a quarter of their size, others on half of it.
WIDE = 1000


@dataclass(eq=False)
class _Last:
    """The last places of both squares: corners (2, 4, 2), their velocity [px/s], when they were seen and when
    the id of each was read, and the fit."""

    corners: Array
    velocity: Array
    time: float
    read: list[float]
    fit: planar.Fit


class Tracker:
    """Follows markers 0 and 1 through the pictures of one camera.

    Args:
        side: printed side of the black squares [m].
        camera: if it is known.
    """

    def __init__(self, side: float = SIDE, camera: Camera | None = None) -> None:
        self.side, self.camera = side, camera
        cv2.setNumThreads(1)
        family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        how = cv2.aruco.DetectorParameters()
        how.adaptiveThreshWinSizeMin = LEAST_WINDOW
        self._detector = cv2.aruco.ArucoDetector(family, how)
        self._last: _Last | None = None
        self._shrinkage, self._causes = Shrinkage(), Causes()
        self._mirrored, self._tries = False, 0
        self._pictures: deque[int] = deque(maxlen=PICTURES)

    def markers(self, picture: Picture, *, whole: bool = False) -> dict[int, list[Array]]:
        """Return the corners (4, 2) [px], in the markers' order, of the squares of the family 36h11 in a grey
        picture by their ids; `whole` looks at all its pixels, for small markers."""
        scale = 1 if whole else (4 if picture.shape[1] > WIDE else 2)
        small = picture
        if scale > 1:
            size = picture.shape[1] // scale, picture.shape[0] // scale
            small = np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
        quads, ids, _ = self._detector.detectMarkers(small)
        found: dict[int, list[Array]] = {}
        for number, quad in zip([] if ids is None else map(int, np.ravel(ids)), quads, strict=True):
            # the centre of the first small pixel lies between those of the first large ones
            corners = np.asarray(quad[0], dtype=float) * scale + (scale - 1) / 2
            found.setdefault(number, []).append(corners)
        return found

    def see(self, picture: Picture, time: float) -> dict[str, Any]:
        """Return the event "seen" or "unseen" of a picture taken at `time` [s]; see `session`."""
        found, last = self.markers(picture), self._last
        if {0, 1} <= set(found):
            self._mirrored, self._tries = False, 0
        else:
            self._tries += 1
            far = last is None or np.hypot(*(last.corners[:, 1] - last.corners[:, 0]).T).min() < FAR_PX
            if far or self._tries % SOMETIMES == 0:
                found = self.markers(picture, whole=True)
        for number in (0, 1):
            if len(found.get(number, ())) > 1:
                return _unseen(f"duplicate-{number}")
        read = {number: found[number][0] for number in (0, 1) if number in found}
        quads = self._predicted(time) | read
        if len(quads) < 2:
            return self._missing(picture, set(found), set(quads))
        return self._fitted(picture, quads, {0, 1} - set(read), time)

    def _predicted(self, time: float) -> dict[int, Array]:
        """Where the corners of the squares that were read lately move to."""
        if (last := self._last) is None:
            return {}
        corners = last.corners + last.velocity * (time - last.time)
        return {number: corners[number] for number in (0, 1) if time - last.read[number] <= FOLLOW}

    def _fitted(
        self, picture: Picture, quads: dict[int, Array], followed: set[int], time: float
    ) -> dict[str, Any]:
        for _ in range(POWERS):  # the first pictures tell the power that their values are of light
            gamma = self._shrinkage.gamma
            refined, good = squares.refine(picture, np.stack((quads[0], quads[1])), gamma)
            whole = [n for n in (0, 1) if n not in followed and good[n, :, 0].min() >= KEPT]
            corners = self._shrinkage.taken_out(picture, refined, whole)
            if self._shrinkage.gamma == gamma:
                break
        seen = self._fit_to(corners, good, picture.shape, time)
        torn = seen is None or self._left(seen) > REFUSE_PX
        if followed and torn:
            return _unseen(_lost(followed))
        last = self._predicted(time)
        if torn and len(last) == 2 and (good[..., 0] < WHOLE).any():  # a covered corner pulls the square
            again = self._fitted(picture, last, {0, 1}, time)
            if again["do"] == "seen":
                return again
        if seen is None:
            return _unseen("refused")
        fit = seen.fit
        if torn:
            alone = Causes()
            alone.add(seen)
            if self._is_new(picture):
                self._causes.add(seen, min(1.0, (REFUSE_PX / fit.rms) ** 2))
            return _unseen("sizes" if alone.name(0.0) == "sizes" else "refused")
        if self._is_new(picture):
            spread = self._causes.spread_of(seen, own=bool(followed))
            self._causes.add(seen, self._causes.variance / spread)
        hidden = ~fit.trust.any(axis=(1, 2)).reshape(2, 4)
        hidden |= np.roll(hidden, 1, axis=1)
        drawn = fit.corners if self.camera is None else self.camera.distorted(fit.corners)
        refined = np.where(hidden[..., None], drawn, refined)
        self._remember(picture, fit, refined, followed, time)
        return self._seen(picture, seen, refined, good[..., 0], followed)

    def _is_new(self, picture: Picture) -> bool:
        """Return whether a picture, its noise included, was not seen before."""
        number = hash(picture[::COARSE, ::COARSE].tobytes())
        known = number in self._pictures
        self._pictures.append(number)
        return not known

    def _fit_to(self, corners: Array, good: Array, shape: tuple[int, ...], time: float) -> View | None:
        """Return the fit to corners (2, 4, 2) [px] of a picture of a `shape`, with what causes do to it; None
        where there is none."""
        if ((good[..., 0] >= KEPT).sum(axis=1) < EDGES).any():
            return None
        try:
            start = None if self._last is None else self._last.fit
            fit = planar.fit(corners, self.camera, start, planar.trusted(good, KEPT))
            seen = view(fit, shape[::-1], self._velocity(corners, time), self.camera)
        except (np.linalg.LinAlgError, ValueError):
            return None
        if not (np.isfinite(fit.pose).all() and np.isfinite(seen.error).all()):
            return None
        worst = np.unravel_index(np.where(good[..., 0] < KEPT, 1.0, good[..., 0]).argmin(), (2, 4))
        if self._left(seen) > REFUSE_PX and good[worst][0] < PART:  # it may be that of a finger
            fewer = good.copy()
            fewer[worst] = 0.0
            without = self._fit_to(corners, fewer, shape, time)
            if without is not None and without.fit.rms <= DOUBT_PX:
                return without
        return seen

    def _left(self, seen: View) -> float:
        """Return the residual [px] of the corners, or that which known causes do not explain."""
        return min(seen.fit.rms, planar.rms(self._causes.unexplained(seen)))

    def _velocity(self, corners: Array, time: float) -> Array:
        """Return the velocity (2, 4, 2) [px/s] of corners since they were last seen, 0 where that is long
        ago."""
        last = self._last
        if last is None or not 0.0 < time - last.time < LONG:
            return np.zeros((2, 4, 2))
        return (corners - last.corners) / (time - last.time)

    def _remember(
        self, picture: Picture, fit: planar.Fit, corners: Array, followed: set[int], time: float
    ) -> None:
        read = [time, time]
        for number in followed:
            if self._last is not None and not _reads(picture, corners[number], number):
                read[number] = self._last.read[number]
        velocity = self._velocity(corners, time)
        self._last = _Last(corners=corners, velocity=velocity, time=time, read=read, fit=fit)

    def _seen(
        self, picture: Picture, seen: View, refined: Array, share: Array, followed: set[int]
    ) -> dict[str, Any]:
        fit = seen.fit
        covered = bool(followed) or bool((share < WHOLE).any())
        noise = fit.spread * np.sqrt(self._causes.spread_of(seen, own=covered) + STILL_PX**2)
        error = self._causes.error(seen)
        doubt = fit.rms > DOUBT_PX or (self._causes.none < UNLIKELY and bool((error > noise).any()))
        faults = {
            "over-exposed": _clipped(picture, refined[0]) > CLIPPED,
            "followed": bool(followed),
            self._causes.name() or "not-flat": doubt,
            "blurred": bool((share < CLEAR).any()) and not followed,
        }
        scale = np.array([self.side, self.side, 1.0])
        size = np.hypot(*(refined - np.roll(refined, 1, axis=1)).reshape(-1, 2).T).min()
        # an offset that is wrong changes the size of both squares, and with it all distances
        sized = np.abs(fit.pose) * [1.0, 1.0, 0.0] * (2.0 * self._shrinkage.sd / size)
        return {
            "do": "seen",
            "marker": (fit.pose * scale).tolist(),
            "sd": (np.sqrt(noise**2 + error**2 + sized**2) * scale).tolist(),
            "rms": fit.rms,
            "state": "followed" if followed else "found",
            "plane": (fit.plane @ np.diag([1.0 / self.side, 1.0 / self.side, 1.0])).ravel().tolist(),
            "quads": self._shrinkage.taken_out(picture, refined, ()).tolist(),
            "faults": [name for name, wrong in faults.items() if wrong],
        }

    def _missing(self, picture: Picture, found: set[int], quads: set[int]) -> dict[str, Any]:
        """Why there is no pose."""
        if quads:
            return _unseen(_lost({0, 1} - quads))
        if found:
            return _unseen("other-ids", ", ".join(map(str, sorted(found))))
        if self._tries % SOMETIMES == 0:
            self._mirrored = not {0, 1}.isdisjoint(self.markers(np.ascontiguousarray(picture[:, ::-1])))
        return _unseen("mirrored" if self._mirrored else "lost-both")


def _clipped(picture: Picture, corners: Array) -> float:
    """Return the share of the largest value in the box around corners (4, 2) [px]."""
    (left, top), (right, bottom) = corners.clip(0.0).min(axis=0), corners.max(axis=0)
    return float(np.mean(picture[int(top) : int(bottom), int(left) : int(right)] >= WHITEST))


def _reads(picture: Picture, corners: Array, number: int) -> bool:
    """Return whether the cells between corners (4, 2) [px] are those of a marker, as far as they are seen."""
    cells = planar.BITS * (planar.CORNERS * [1.0, -1.0] + 0.5) - 0.5  # a pixel each
    back = cv2.getPerspectiveTransform(corners.astype(np.float32), cells.astype(np.float32))
    grey = cv2.warpPerspective(picture, back, (planar.BITS, planar.BITS)).astype(float)
    light = grey > 0.5 * (grey.min() + grey.max())
    return float(np.mean((light == planar.cells(number))[1:-1, 1:-1])) >= READ


def _lost(numbers: set[int]) -> str:
    return "lost-both" if len(numbers) > 1 else f"lost-{min(numbers)}"


def _unseen(code: str, text: str = "") -> dict[str, Any]:
    return {"do": "unseen", "code": code, "text": text}
