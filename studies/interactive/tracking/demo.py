"""The demo film: the soft pivot bent by a hand, a finger over a corner, a marker that is hidden for a
moment."""

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.held import HeldPivot
from studies.interactive.pivot.design import Placing, build, turned
from studies.interactive.pivot.presets import PRESETS
from studies.interactive.tracking.painter import Film, Finger, Marker, Optics, Painter

#: Length of the film, its turns and the frames in which a finger covers a corner and a hand a marker.
FRAMES = 300
TURN = math.radians(52)
FINGER = range(150, 168)
HIDDEN = range(235, 247)


def demo_film() -> Film:
    """Return the demo film with its truth: the body follows the pivot's own path, the hand pushes nothing
    else."""
    pivot = build(PRESETS["polymer"].values())
    placing, solver = Placing.of(pivot), HeldPivot(pivot)
    poses = [placing.marker(solver.turn(rotation(k)).pose) for k in range(FRAMES)]

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


def _finger(pose: NDArray[np.float64]) -> Finger:
    corner = pose[:2] + turned(pose[2], np.array([0.03, 0.03]))
    return Finger(centre=(float(corner[0]), float(corner[1])))
