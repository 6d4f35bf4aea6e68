"""The paper's sequential impulse solver (section 4.1, Eqs 21 to 30), and a form that is stable at any step.

Both do an unconstrained update of strips and bodies one by one and then apply impulses until
the constraints hold, at a fixed step h.

"published"  Elastic forces explicit, impulses at the level of velocities: symplectic Euler,
           first order, stable while omega h < 2 for the highest frequency of the constrained
           system. Nothing pulls positions back, so that the constraints drift.
"stable"   Elastic forces implicit, the axial ones as constraints with compliance, constraints
           fulfilled by the positions, iterations begun from the forces of the step before,
           backward differences of second order. What a step does not resolve is damped. No step
           gains energy while the ground holds the mechanism: where the differences would, the
           velocity is reduced.

Impulses are found at once (Eq 30), or, as published, by sweeps over single constraints (Eqs 24 to 26).
Misprints of the paper are corrected: Eqs 22 and 23 begin from the state before, Eq 26 has the
transposed Jacobian, Eq 30 its minus sign.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.accurate_motion import STEPS_PER_PERIOD
from spline_model.compile import compile_scene
from spline_model.dynamics import Asked, moved
from spline_model.errors import (
    InvalidParameter,
    present,
    require_choice,
    require_count,
    require_finite,
    require_positive,
)
from spline_model.impulses import (
    COUNTS,
    ENERGY,
    Moving,
    Problem,
    Space,
    advance,
    loads_of,
    store,
    strain_energy,
)
from spline_model.mechanism import Mechanism, require_mechanism
from spline_model.modes import linear_modes
from spline_model.motion.arrays import zeros
from spline_model.motion.leapfrog import highest_frequency
from spline_model.motion.moves import Moves
from spline_model.motion.records import (
    DISSIPATED,
    ENERGIES,
    KINETIC,
    STRAIN,
    WEIGHT,
    WORK,
    Trajectory,
)
from spline_model.motion.start import Start, set_in_motion
from spline_model.newton import Laps
from spline_model.scene import Scene
from spline_model.statics import settle

Array = NDArray[np.float64]

STEP = 0.01
"""The paper's step: a quarter of the time between two pictures at 25 Hz [s]."""
TOLERANCE = 1e-9
"""Residual of a stable step, and gap that sweeps close, in EI/L^2, EI/L, L and rad."""
STABILITY_LIMIT = 2.0
"""omega h up to which symplectic Euler does not amplify an oscillation."""
SMALLEST_STEP = 2.0**-6
"""Least part of a stable step before it is refused: bounds the time that a step may take."""
REASONS = {
    "published": "the step is above the stability limit",
    "stable": "no part of the step can be solved, or a strip folds; take a shorter one",
}
"""Why a motion of a form stops."""


class Stepper(Moves):
    """A motion from a start by impulses, which see to the energy themselves.

    A record is unknowns (N,), velocities (Q,), strain energy and energy dissipated [J]. form, sweeps,
    tolerance: as of ``solve_impulses``.
    """

    most_gain = math.inf
    counts = ("steps", "halved_steps", "solves", "sweeps", "limited_steps")

    def __init__(
        self, start: Start, *, form: str = "stable", sweeps: int | None = None, tolerance: float = TOLERANCE
    ) -> None:
        self.motion, self._form, motion = start.motion, form, start.motion
        self.name = f"sequential impulses, {form}"
        self.smallest = SMALLEST_STEP if form == "stable" else 1.0
        self.settings = {} if sweeps is None else {"sweeps": sweeps}
        problem = Problem.of(motion, sweeps=sweeps, tolerance=tolerance)
        self._given = problem, zeros(Space, problem.sizes)
        self.counters = np.zeros(6, dtype=np.int64)
        z, v = start.z.copy(), start.v.copy()
        q, status = z[: v.size].copy(), np.zeros(3)
        earlier = np.array((q, v))
        self.state = Moving(z, v, earlier=earlier, begun=q, status=status, counters=self.counters)
        status[ENERGY] = 0.5 * v @ problem.mass @ v + strain_energy(z, *self._given)
        self.width = len(z) + len(v) + 2

    def switch(self, time: float, span: float) -> None:
        """The run starts again: no step before it counts."""
        self.state.status[COUNTS] = 0.0

    def take(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """Take the steps ``begin`` ... ``end`` - 1; the number of the first that cannot be, or end."""
        self._whole = step
        return super().take(time, step, begin, end, every, records)

    def steps(self, time: float, step: float, begin: int, end: int, every: int, records: Array) -> int:
        """The same of whole steps, or of a part of one."""
        how = self._form == "stable", step == self._whole
        return int(advance(self.state, step, begin, end, every, *how, *self._given, records))

    def record(self) -> Array:
        """The present state's record (W,)."""
        record = np.empty(self.width)
        store(self.state, *self._given, record)
        return record

    def unknowns(self, records: Array) -> tuple[Array, Array]:
        """Unknowns (R, N) and velocities (R, Q) of records."""
        size = self.motion.system.layout.size
        return records[:, :size], records[:, size:-2]

    def shown(self, records: Array) -> tuple[Array, Array]:
        """Poses (R, 3 B) of the bodies [m, rad] and rows (R, 5) of energies [J] of records."""
        (z, v), system = self.unknowns(records), self.motion.system
        q, rows = z[:, : v.shape[1]], np.zeros((len(z), ENERGIES))
        rows[:, KINETIC] = 0.5 * ((v @ system.mass) * v).sum(axis=1)
        rows[:, WEIGHT] = -q @ system.weight if system.weight.size else 0.0
        rows[:, WORK] = (q - self.state.begun) @ loads_of(self.motion)
        rows[:, STRAIN], rows[:, DISSIPATED] = records[:, -2], records[:, -1]
        return z[:, system.layout.poses], rows

    def reason(self) -> str:
        """Why the last step was given up, and what helps."""
        return REASONS[self._form]


def _unresolved(scene: Scene, start: Start, step: float) -> str:
    """How far a step [s] under-resolves the swing at rest, or an empty string."""
    system = start.motion.system
    squares = linear_modes(system, system.rest)[0]
    period = 2 * math.pi / math.sqrt(squares[0]) if squares[0] > 0 else math.inf
    if step * STEPS_PER_PERIOD <= period:
        return ""
    return (
        f"the step of {step:g} s is {step / period:.3g} of the swing's period at rest: "
        f"take {period / STEPS_PER_PERIOD:.2g} s or less for its phase and amplitude"
    )


def stability_limit(pivot: Mechanism) -> float:
    """Return the limit 2 / omega [s] of the step of the published form; omega: highest frequency at rest."""
    system = compile_scene(pivot.in_motion().released())
    return STABILITY_LIMIT / highest_frequency(set_in_motion(system), system.rest)


def solve_impulses(
    pivot: Mechanism,
    *,
    start: float | None = None,
    body: str | None = None,
    duration: float = 0.05,
    step: float = STEP,
    form: str = "stable",
    sweeps: int | None = None,
    records: int | None = None,
) -> Trajectory:
    """Return the motion by sequential impulses from the static state at a rotation, at rest.

    Loads are constant, and supports stand still.

    Parameters
    ----------
    pivot : Mechanism
    start : float, rad, default None
        Rotation at the start.
    body, duration, records
        As in ``spline_model.dynamics.solve_motion``; the duration in s.
    step : float, s, default 0.01
        Shortened so that a whole number of steps fits between the records.
    form : str
        "published" or "stable" (default); see ``spline_model.sequential_impulse``.
    sweeps : int, default None
        Largest number of sweeps over single constraints for one linear system of the published form; None
        solves it directly. Sweeps converge slowly where strips cannot stretch.

    Returns
    -------
    Trajectory
        T records; arrays as in ``spline_model.dynamics.solve_motion``.

    Raises
    ------
    InvalidParameter
        A value outside its range, or an effect that impulses do not support.
    ConvergenceError
        Statics does not reach `start`.

    Notes
    -----
    The numerical damping of the stable form does not count as dissipated.

    References
    ----------
    Valentini and Pezzuti (2013), section 4.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> solve_impulses(pivot, start=0.1, duration=0.02, step=0.01).time.tolist()
    [0.0, 0.01, 0.02]
    """
    require_mechanism(pivot)
    form = present(form)
    require_choice("form", form, tuple(REASONS))
    for name, value in (("duration", duration), ("step", step)):
        require_positive(name, value, "s")
    if start is not None:
        require_finite("start", start, "rad")
    if sweeps is not None:
        require_count("sweeps", sweeps, 1)
        if form == "stable":
            raise InvalidParameter("sweeps", sweeps, "none of the stable form, which is solved at once")
    mechanism, laps = pivot.in_motion(), Laps()
    body = mechanism.design.body_named(body)
    scheme = partial(Stepper, form=form, sweeps=sweeps)
    path = settle(mechanism.at_start(), start, body=body, starts=True)
    asked = Asked(body, None, duration, step, records, scheme, _unresolved)
    return moved(mechanism, path, asked, laps)
