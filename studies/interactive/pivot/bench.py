"""One design at a time: changed, undone and done again; what cannot be built leaves the former one."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from studies.interactive.pivot import presets
from studies.interactive.pivot.design import Placing
from studies.interactive.pivot.mechanics import Mechanics

#: Designs that can be undone.
UNDO = 100

Design = tuple[str, dict[str, float]]


class Bench:
    """One design at a time; what cannot be built leaves the former one.

    Args:
        preset: name of the preset that the values began from.
        values: all parameters in SI units; BadInput for one that does not fit.
    """

    mechanics: Mechanics
    placing: Placing

    def __init__(self, preset: str, values: Mapping[str, object]) -> None:
        self.preset = preset
        self._past: list[Design] = []
        self._future: list[Design] = []
        self._rest: NDArray[np.float64] | None = None
        self._build(preset, values)

    @property
    def design(self) -> Design:
        """Preset and values of the present design."""
        return self.preset, dict(self.mechanics.values)

    def change(self, preset: str, values: Mapping[str, object], *, part: bool = False) -> None:
        """Another design; the present one can be had back by `undo`, but for a `part` of a longer change."""
        known = self.design
        self._build(preset, values)
        if not part:
            self._past = [*self._past[1 - UNDO :], known]
        self._future = []

    def undo(self) -> bool:
        """Back to the design before; False if there is none."""
        return self._swap(self._past, self._future)

    def redo(self) -> bool:
        """Forth to the design that was undone; False if there is none."""
        return self._swap(self._future, self._past)

    def set_rest(self, marker: NDArray[np.float64]) -> None:
        """Markers at `marker` (3,) are those of a pivot at rest, whatever the design."""
        self._rest = np.array(marker, dtype=float)
        self.placing = self.placing.with_rest(self._rest)

    def _swap(self, source: list[Design], target: list[Design]) -> bool:
        if not source:
            return False
        known = self.design
        self._build(*source.pop())
        target.append(known)
        return True

    def _build(self, preset: str, values: Mapping[str, object]) -> None:
        if preset != presets.OWN:  # a recorded one brings its values
            presets.preset(preset)
        good = presets.checked(values)
        if self._paced(good):
            self.mechanics.pace(good["time_scale"])
        else:
            self.mechanics = Mechanics(good)
            self.placing = Placing.of(self.mechanics.pivot)
            if self._rest is not None:
                self.placing = self.placing.with_rest(self._rest)
        self.preset = preset

    def _paced(self, values: Mapping[str, float]) -> bool:
        """Whether nothing of a design but the pace of its time is another one."""
        known = getattr(self, "mechanics", None)
        return known is not None and {**values, "time_scale": known.values["time_scale"]} == known.values
