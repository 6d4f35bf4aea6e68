"""A camera's constants from views of the printed sheet, and how uncertain they are."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from studies.errors import BadInput
from studies.interactive.pivot.design import PRINTED, SIDE
from studies.interactive.tracking.planar import CORNERS, Camera
from studies.interactive.tracking.tracker import Picture, Tracker, cv2
from studies.kinds import Array

#: Corners (8, 2) of both markers of the printed sheet [m], as long as it is not cut.
SHEET = (np.array([(0.0, 0.0), PRINTED[:2]])[:, None] + SIDE * CORNERS).reshape(8, 2)
#: How much the outlines of two views differ at least once moved, turned and scaled onto one another, and the
#: part of the focal length that it may be uncertain by.
APART, SURE = 0.02, 0.01


def views(pictures: Iterable[Picture], count: int) -> Iterator[tuple[Array, tuple[int, int]]]:
    """Yield the corners (8, 2) [px] of both markers, and width and height, of those pictures that show them
    from another side than all before, `count` of them at most."""
    tracker, known = Tracker(), list[Array]()
    for k, picture in enumerate(pictures):
        event = tracker.see(picture, float(k))
        if event["do"] != "seen" or event["state"] != "found" or "blurred" in event["faults"]:
            continue
        corners = np.reshape(event["quads"], (8, 2))
        if all(_unlike(corners, other) > APART for other in known):
            known.append(corners)
            yield corners, (picture.shape[1], picture.shape[0])
        if len(known) == count:
            return


def _unlike(corners: Array, other: Array) -> float:
    """Return the part of one outline that no shift, turn and scale takes to the other."""
    z, w = (each @ [1.0, 1.0j] for each in (corners - corners.mean(axis=0), other - other.mean(axis=0)))
    return float(np.linalg.norm(z - w * np.vdot(w, z) / np.vdot(w, w)) / np.linalg.norm(z))


@dataclass(frozen=True, kw_only=True)
class _Calibration:
    """A camera, the standard deviations of its constants, and the residual (rms) of the corners [px]."""

    camera: Camera
    sd: Camera
    rms: float


def calibrated(pictures: Sequence[Array], size: tuple[int, int]) -> _Calibration:
    """Return the camera that saw the sheet's corners as (8, 2) [px] in three views or more.

    Args:
        size: width and height of the pictures [px].

    Raises:
        BadInput: fewer than three views, or such that do not tell the focal length to a part of SURE.
    """
    if len(pictures) < 3:
        raise BadInput(f"views: got {len(pictures)}, expected at least 3 of the sheet at different tilts")
    flat = [np.column_stack((SHEET, np.zeros(8))).astype(np.float32)] * len(pictures)
    seen = [np.asarray(view, dtype=np.float32)[:, None] for view in pictures]
    flags = cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_ZERO_TANGENT_DIST
    rms, matrix, lens, _, _, sd, *_ = cv2.calibrateCameraExtended(
        flat, seen, size, np.eye(3), np.zeros(5), flags=flags
    )
    (fx, _, cx), (_, fy, cy), _ = matrix.tolist()
    k1, k2 = np.ravel(lens)[:2].tolist()
    spread = Camera(**dict(zip(("fx", "fy", "cx", "cy", "k1", "k2"), np.ravel(sd)[:6].tolist(), strict=True)))
    if not spread.fx < SURE * fx:
        raise BadInput(
            f"views: got a focal length of {fx:.0f} ± {spread.fx:.0f} px, expected it to {100 * SURE:g} %: "
            "tilt the sheet more, to all sides, near to the camera"
        )
    return _Calibration(camera=Camera(fx=fx, fy=fy, cx=cx, cy=cy, k1=k1, k2=k2), sd=spread, rms=float(rms))
