"""What a session has on its bench: one design at work, changed, undone and done again, the hand that holds
it, its time, and what is to be said."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from studies.interactive import presets
from studies.interactive.design import Placing, scales
from studies.interactive.input import Clock, Hand, Readings
from studies.interactive.mechanics import Mechanics
from studies.interactive.motion import SOLVERS, SWEEPS
from studies.kinds import Array

#: Designs that can be undone.
UNDO = 100
#: What the hand holds: the rotation, and the centre by a spring; the centre alone, by a spring; the rotation
#: alone; the whole pose.
DRIVES = ("grip", "pull", "rotation", "pose")
SPRUNG = ("grip", "pull")
#: Stiffness of a finger's grip [N/m]; share of EI / L^2 that the spread of a seen place may show as a force;
#: that spread where a pointer shows the place [m].
FINGER, SHARE, POINTER = 1e3, 0.04, 2e-4

_Design = tuple[str, dict[str, float]]


class Bench:
    """A session between two events; a design that cannot be built leaves the former one.

    Attributes:
        preset: name of the preset that the values began from; mechanics: the design at work; placing: where
            its markers sit.
        warnings: sentences of what is wrong by their codes.
    """

    preset: str
    mechanics: Mechanics
    placing: Placing
    _at_rest: Array | None = None

    def begin(self, preset: str, values: Mapping[str, object], lock_step: bool) -> None:
        """Everything as at the start, with these settings; BadInput for values that do not fit."""
        self._build(preset, values, anew=True)
        self._past, self._future = list[_Design](), list[_Design]()
        self._at_rest, self.placing = None, Placing.of(self.mechanics.pivot)
        self.clock, self.hand, self.readings = Clock(lock_step=lock_step), Hand(), Readings()
        self.warnings: dict[str, str] = {}
        self.drive, self.solver = DRIVES[0], next(iter(SOLVERS))
        self.sweeps, self.paused, self.time = SWEEPS, False, 0.0
        self.sight: dict[str, Any] = {"state": "none"}
        self.spread: Array | None = None
        self.marker: Array | None = None
        self.wanted = np.zeros(3)

    @property
    def design(self) -> _Design:
        """Preset and values of the present design."""
        return self.preset, dict(self.mechanics.values)

    def change(self, preset: str, values: Mapping[str, object], *, part: bool = False) -> None:
        """Another design; the present one can be had back by `swap`, but for a `part` of a longer change."""
        known = self.design
        self._build(preset, values)
        if not part:
            self._past = [*self._past[1 - UNDO :], known]
        self._future = []

    def swap(self, *, back: bool) -> bool:
        """Back to the design before, or forth to the one that was undone; False if there is none."""
        source, target = (self._past, self._future) if back else (self._future, self._past)
        if not source:
            return False
        known = self.design
        self._build(*source.pop())
        target.append(known)
        return True

    def set_rest(self, marker: Array) -> None:
        """Markers at `marker` (3,) are those of a pivot at rest, whatever the design."""
        self._at_rest = np.array(marker, dtype=float)
        self.placing = Placing.of(self.mechanics.pivot, self._at_rest)

    @property
    def grip(self) -> float:
        """Stiffness of the spring from the centre to where the hand is seen [N/m]: a finger's, in series with
        one that turns what the camera cannot tell into no more force than the strips' bending hides."""
        spread = POINTER if self.spread is None else float(np.linalg.norm(self.spread[:2], axis=1).max())
        return 1.0 / (1.0 / FINGER + spread / (SHARE * scales(self.mechanics.values)["force"]))

    @property
    def ways(self) -> Array:
        """Pose of the body over that of the hand (3, 3), as it is held, to first order."""
        tangent, rigid = self.mechanics.snapshot.tangent, np.eye(3)
        if self.drive == "pose" or tangent is None:
            return rigid
        spring = self.grip * np.diag([1.0, 1.0, 0.0])
        if self.drive == "pull":
            return np.asarray(np.linalg.solve(tangent + spring, spring))
        spring = spring[:2, :2] if self.drive == "grip" else np.zeros((2, 2))
        rigid[:2] = np.linalg.solve(tangent[:2, :2] + spring, np.hstack((spring, -tangent[:2, 2:])))
        return rigid

    def _build(self, preset: str, values: Mapping[str, object], *, anew: bool = False) -> None:
        if preset != presets.OWN:  # a recorded one brings its values
            presets.preset(preset)
        good = presets.checked(values)
        if not anew and good | {"time_scale": self.mechanics.values["time_scale"]} == self.mechanics.values:
            self.mechanics.pace(good["time_scale"])
        else:
            self.mechanics = Mechanics(good)
            self.placing = Placing.of(self.mechanics.pivot, self._at_rest)
        self.preset = preset
