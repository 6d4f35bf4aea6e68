"""A camera's constants: optional, for lens distortion and as a check that the markers lie in one plane."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from studies.errors import BadInput
from studies.kinds import Array


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A pinhole with a radial lens: focal lengths and principal point [px], k1 and k2 of Brown's model."""

    fx: float
    fy: float
    cx: float
    cy: float
    k1: float = 0.0
    k2: float = 0.0

    @property
    def matrix(self) -> Array:
        """The camera matrix (3, 3)."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def undistorted(self, picture: Array) -> Array:
        """Return where points (..., 2) [px] would be seen without the lens."""
        scale, centre = np.array([self.fx, self.fy]), np.array([self.cx, self.cy])
        seen = (picture - centre) / scale
        straight = seen.copy()
        for _ in range(20):
            square = np.sum(straight**2, axis=-1, keepdims=True)
            straight = seen / (1.0 + square * (self.k1 + square * self.k2))
        return np.asarray(straight * scale + centre)

    @classmethod
    def read(cls, path: Path) -> "Camera":
        """Return the camera of a file that `write` made; BadInput in one line if it is none."""
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            return cls(**{name: float(value) for name, value in values.items()})
        except (OSError, ValueError, TypeError, AttributeError) as error:
            raise BadInput(f"{path}: got no camera, expected JSON with fx, fy, cx, cy ({error})") from None

    def write(self, path: Path) -> None:
        """Store the camera."""
        path.write_text(json.dumps(asdict(self), indent=2) + "\n", encoding="utf-8")
