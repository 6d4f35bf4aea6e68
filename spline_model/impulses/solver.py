"""The solver as an object: a compiled scene, its work space, and steps from state to state."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter, require_choice, require_count, require_positive
from spline_model.impulses.blocks import IMPULSES, make_blocks
from spline_model.impulses.run import Run
from spline_model.impulses.space import Options, make_space
from spline_model.impulses.state import Outcome, State
from spline_model.kernels.motion import Motion
from spline_model.mechanism import Mechanism
from spline_model.modes import static_state
from spline_model.motion.start import require_compiled, set_in_motion

Array = NDArray[np.float64]

FORMS = ("printed", "stable")
TOLERANCE = 1e-9
"""Residual of a stable step, and gap that sweeps close, in EI/L^2, EI/L, L and rad."""
ITERATIONS = 12
"""Most Newton iterations of a stable step before it is halved."""
LEAST_FRACTION = 2.0**-6
"""Least part of a step before it is refused: bounds the time that a step may take."""


class ImpulseSolver:
    """Steps of one scene; ``spline_model.sequential_impulse.impulse_solver`` makes one.

    Holds work space, so that no two threads may use it at once. What it returns shares no memory
    with it: the same state and arguments give the same bits.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        system: System,
        *,
        form: str,
        impulses: str,
        sweeps: int,
        tolerance: float,
    ) -> None:
        require_choice("form", form, FORMS)
        require_choice("impulses", impulses, IMPULSES)
        require_positive("tolerance", tolerance, "1")
        require_count("sweeps", sweeps, 1)
        require_compiled(system, "sequential impulses")
        self.mechanism, self.system, self.form = mechanism, system, form
        self.motion = set_in_motion(system)
        self.blocks = make_blocks(system, self.motion, soft=form == "stable", impulses=impulses)
        self.space = make_space(system, self.blocks)
        self.options = Options(sweeps, ITERATIONS, float(tolerance), LEAST_FRACTION)

    def start(self, rotation: float | None = None, body: str | None = None) -> State:
        """The static state at the rotation [rad] of a body, or undriven: where the paper's releases start.

        Raises ConvergenceError if statics does not reach it.
        """
        if rotation is not None and not math.isfinite(rotation):
            raise InvalidParameter("rotation", rotation, "a finite angle [rad]")
        return self.start_at(static_state(self.mechanism.at_start(), rotation, body=body))

    def start_at(self, z: Array, v: Array | None = None) -> State:
        """A state at the unknowns z (N or more,), at rest or with velocity v (Q,).

        z may be another system's of the same strips and bodies, such as of statics with other drives:
        what it has beyond this one's is left out. The constraints should hold in both.
        """
        layout = self.system.layout
        count = layout.coordinate_count
        given = np.asarray(z, dtype=float)
        speed = np.zeros(count) if v is None else np.array(v, dtype=float)
        _require_numbers("z", given, count, math.inf, "m, rad, N")
        _require_numbers("v", speed, count, count, "m/s, rad/s")
        unknowns = np.zeros(layout.size)
        same = min(len(given), layout.size)
        unknowns[:same] = given[:same]
        unknowns[self.motion.tables.drives.row] = 0.0
        return State(
            z=unknowns,
            v=speed,
            earlier_q=unknowns[:count].copy(),
            earlier_v=speed.copy(),
            known=0,
            time=0.0,
            held=False,
        )

    def step(self, state: State, h: float, count: int = 1, pose: Array | None = None) -> Outcome:
        """Take ``count`` steps of length h [s].

        pose (3,): x, y [m] and rotation [rad] of the solver's body at the end of them, on a straight
        way from where it is; the body is caught if it was free, and free again without one.
        """
        require_positive("h", h, "s")
        require_count("count", count, 1)
        motion = self.motion
        if pose is not None:
            motion = self._driven(state, np.asarray(pose, dtype=float), h * count)
        if (pose is not None) != state.held:
            state = replace(state, known=0)
        active = np.full(len(motion.tables.drives.row), int(pose is not None), dtype=np.int64)
        run = Run(self, state)
        taken = run.go(0, count, h, state.time, count, active, motion)
        return run.outcome(taken, count, state.time + taken * h, pose is not None)

    def _driven(self, state: State, pose: Array, duration: float) -> Motion:
        """The motion with its drives on the way from the state to the pose."""
        tables, drives = self.motion.tables, self.motion.tables.drives
        _require_numbers("pose", pose, drives.row.size, drives.row.size, "m, rad")
        here = state.z[drives.coordinate]
        way = drives._replace(
            origin=here,
            target=pose - here,
            first=np.zeros(pose.size, dtype=np.int64),
            pairs=np.full(pose.size, 2, dtype=np.int64),
            times=np.array([state.time, state.time + duration]),
            factors=np.array([0.0, 1.0]),
        )
        return self.motion._replace(tables=tables._replace(drives=way))


def _require_numbers(name: str, values: Array, least: int, most: float, unit: str) -> None:
    """Refuse anything but a vector of so many finite numbers."""
    if values.ndim != 1 or not least <= len(values) <= most:
        expected = f"{least}" if most == least else f"{least} or more"
        raise InvalidParameter(f"length of {name}", values.size, expected)
    if not np.isfinite(values).all():
        bad = float(values[~np.isfinite(values)][0])
        raise InvalidParameter(name, bad, f"finite numbers [{unit}]")
