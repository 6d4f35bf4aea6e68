"""Films with known truth for the tests: two markers on the path of a pivot."""

import contextlib
import math
from collections.abc import Callable
from functools import cache, lru_cache

import numpy as np
import pytest

from studies.interactive.design import SIDE, turn
from studies.interactive.mechanics import Mechanics
from studies.interactive.presets import PRESETS
from studies.interactive.tracking import tracker
from studies.interactive.tracking.films import Film
from studies.interactive.tracking.planar import CORNERS, project
from studies.interactive.tracking.tracker import Tracker
from tests.interactive.painter import BLOCK, COUNTER_BITS, SKIN, Finger, Marker, Optics, Painter

#: Frames of a period of the moving marker's turn.
PERIOD = 40


#: The soft pivot.
mechanics = cache(lambda: Mechanics(PRESETS["polymer"]))


@cache
def truth(k: int) -> tuple[float, float, float]:
    """Pose of marker 1 in marker 0's frame in frame k [m, m, rad]: the soft pivot's own path, 50 degrees to
    either side."""
    angle = math.radians(50) * math.sin(2 * math.pi * k / PERIOD)
    x, y, turned = mechanics().marker_at(angle)
    return float(x), float(y), float(turned)


def both(k: int) -> list[Marker]:
    """Both markers as they should be in frame k."""
    return [Marker(number=0, pose=(0.0, 0.0, 0.0)), Marker(number=1, pose=truth(k))]


#: One for all films of the same optics.
painter = cache(Painter)


@lru_cache(maxsize=128)
def drawn(by: Painter, markers: tuple[Marker, ...], number: int, fingers: tuple[Finger, ...]) -> np.ndarray:
    """The picture that is kept."""
    return by.draw(list(markers), number, fingers)


def film(
    optics: Optics | None = None,
    frames: int = PERIOD,
    markers: Callable[[int], list[Marker]] = both,
    fingers: Callable[[int], tuple[Finger, ...]] = lambda k: (),
    samples: int = 4,
) -> Film:
    """A film of these markers and fingers."""
    own = painter(optics or Optics(), samples=samples)
    return Film(draw=lambda k: drawn(own, tuple(markers(k)), k, fingers(k)).copy(), frames=frames)


def true_corners(optics: Optics, marker: Marker) -> np.ndarray:
    """Pictures (4, 2) of a marker's corners, the lens apart."""
    x, y, angle = marker.pose
    own = np.array([turn(angle) @ corner for corner in marker.side * CORNERS])
    return project(optics.plane, own + np.array([x, y]))


def over(k: int, place: tuple[float, float], radius: float, level: float = SKIN) -> tuple[Finger, ...]:
    """A finger, or glare of another level, over a place of marker 1 [sides]."""
    x, y, angle = truth(k)
    centre = np.array([x, y]) + turn(angle) @ (SIDE * np.array(place))
    return (Finger(centre=(float(centre[0]), float(centre[1])), radius=radius, level=level),)


def error(event: dict, k: int) -> tuple[float, float]:
    """Error of a sighting against the truth of frame k: angle [deg] and shift [mm]."""
    gap = np.array(event["marker"]) - truth(k)
    return math.degrees(gap[2]), 1e3 * float(np.hypot(gap[0], gap[1]))


def rms(values: list[float]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def watch(made, camera=None, **more):
    """Events of a tracker over a film, one a frame."""
    follower = Tracker(camera=camera, **more)
    return [follower.see(picture, k / 25) for k, picture in enumerate(made)]


def names(event):
    """What an event says: its code, or its state and faults."""
    return event.get("code") or " ".join([event["state"], *event["faults"]])


def errors(events):
    """Errors of the frames with a pose: angles [deg], shifts [mm], and their number."""
    found = [error(event, k) for k, event in enumerate(events) if event["do"] == "seen"]
    return [angle for angle, _ in found], [shift for _, shift in found], len(found)


@contextlib.contextmanager
def detected_corners():
    """Corners as the detector gives them, none refused."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            tracker.squares,
            "refine",
            lambda picture, quads, gamma: (quads, np.tile([1.0, 0.0, 1.0], (2, 4, 1))),
        )
        patch.setattr(tracker, "REFUSE_PX", 10.0)
        yield


def counter(picture):
    """Return the number that the painter wrote into a picture."""
    places = BLOCK // 2 + BLOCK * np.arange(COUNTER_BITS)
    return int(sum(1 << bit for bit, x in enumerate(places) if picture[BLOCK, x] > 127))
