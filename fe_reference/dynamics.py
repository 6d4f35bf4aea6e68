"""Motion of a model after its drives are removed, or from the shape at rest, and how far it is resolved.

Errors of elements and of steps go with their squares. A companion with half of the elements, and steps in
proportion, errs four times as much: the difference is three times the error, or less where errors do not fall
like that. Elements make a motion too fast and implicit steps too slow: one more companion with the motion's
own steps tells one from the other, lest they cancel. A mesh of few elements, or one whose companions fail,
has companions of twice as many.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import ceil
from time import perf_counter
from typing import Annotated, Any

import numpy as np

from . import read
from .arrays import Array
from .effects import DrivenRotation
from .mass import carried_over
from .model import Model, require_model
from .modes import first_frequency
from .motion import Progress, Trajectory, drive_spans, trajectory
from .places import FREE
from .read import ConvergenceError, InvalidParameter
from .schemes import RADIUS, Explicit, Implicit
from .solution import Status
from .statics import settled_state
from .structure import structure_of

INTEGRATORS = ("central-difference", "generalised-alpha")
#: Part of the critical step that an explicit motion takes.
SAFETY = 0.9
#: Default of the implicit step: so many in the first period of small motion; strips are fifty times as fast.
STEPS_PER_PERIOD = 6000
#: Most steps of one run unless more are allowed, some 25 s with 20 elements. Most numbers kept of a run.
MOST_STEPS, MOST_NUMBERS = 20_000_000, 200_000_000
#: Estimated error over the swing that is not remarked on.
UNRESOLVED = 0.05
#: Error of a motion that hardly is one [rad, or of strip lengths]: its start alone has it.
STILL = 1e-6
#: Fewest elements of a strip in a companion.
FEWEST = 4


@dataclass(frozen=True, kw_only=True)
class Run(read.Checked):
    """What is asked of a motion.

    Attributes:
        duration: [s].
        start: rotation at which a body is held until the start [rad]; None: none is held, and under loads
            without a history the mechanism stands still.
        body: name of the held body; None: the only one.
        drive: a rotation that is held or driven in a part of the motion, if any.
        settled: whether the start is in equilibrium; if not it is the shape at rest, where gravity, natural
            strains and loads act at once.
        increments: of the static path to the start.
        step: time step [s]. Default: for "central-difference" 0.9 times the smaller critical step of the
            start and of rest; for "generalised-alpha" a 6000th of the first period of small motion about
            the shape at rest, without gravity and loads. The default is shortened so that whole steps fill
            the duration.
        integrator: "central-difference" (explicit) or "generalised-alpha" (implicit).
        samples: states kept beside the start, at most.
        aligned: whether any step is shortened so that whole steps fill the time between two samples.
        most_steps: beyond which a run is refused before it begins.
        progress: called as progress(done, total) after every sample.
    """

    duration: Annotated[float, read.positive, "s"]
    start: Annotated[float | None, read.optional, read.finite, "rad"] = None
    body: str | None = None
    drive: DrivenRotation | None = None
    settled: bool = True
    increments: Annotated[int, read.count] = 20
    step: Annotated[float | None, read.optional, read.positive, "s"] = None
    integrator: Annotated[str, read.choice, INTEGRATORS] = INTEGRATORS[0]
    samples: Annotated[int, read.count] = 1000
    aligned: bool = False
    most_steps: Annotated[int, read.count] = MOST_STEPS
    progress: Progress | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.drive is not None:
            read.require_kind("drive", self.drive, DrivenRotation, "a DrivenRotation or None")
        if self.start is not None and not self.settled:
            raise InvalidParameter("settled", self.settled, "True for a start at a held rotation [1]")

    @property
    def explicit(self) -> bool:
        """Whether the integrator is the explicit one."""
        return self.integrator == INTEGRATORS[0]

    def steps(self, longest: float) -> tuple[float, int]:
        """Return step [s] and number of steps; `longest` stands for a step that is not given."""
        parts = self.samples if self.aligned else 1
        steps = parts * max(1, ceil(self.duration / parts / (self.step or longest) * (1.0 - 1e-12)))
        return self.duration / steps if self.aligned or self.step is None else self.step, steps

    def chunks(self, steps: int) -> list[int]:
        """Return the numbers of steps between samples: equal ones, the last perhaps shorter."""
        every = -(-steps // self.samples)
        whole, rest = divmod(steps, every)
        return [every] * whole + ([rest] if rest else [])

    def require_affordable(self, model: Model, step: float, steps: int, size: int) -> None:
        """Check the cost of a motion.

        Args:
            model: the model that moves.
            step: time step [s].
            steps: number of steps.
            size: number of coordinates.

        Raises:
            InvalidParameter: too many steps, or too many numbers to keep of so many coordinates.
        """
        if steps > self.most_steps:
            way = "take longer steps"
            if self.explicit:
                implicit = max(self.duration * STEPS_PER_PERIOD * first_frequency(model), 1.0)
                way = f"--integrator generalised-alpha takes about {implicit:.2g}"
                if implicit > self.most_steps:
                    way = (
                        "remove strip_inertia, if strips are light, and take --integrator generalised-alpha "
                        f"with a --step (its own are about {implicit:.2g})"
                    )
            told = f"steps of {step:.3g} s, this is {steps:.3g} of them: {way}; or allow more by most_steps"
            raise InvalidParameter("duration", self.duration, f"at most {self.most_steps:.3g} {told}")
        samples = min(self.samples, steps)
        if 2 * samples * size > MOST_NUMBERS:
            most = MOST_NUMBERS // (2 * size)
            raise InvalidParameter("samples", samples, f"at most {most} samples of {size} coordinates [1]")


def solve_motion(
    mechanism: Model, *, check: bool = True, raise_on_failure: bool = True, **asked: Any
) -> Trajectory:
    """Compute the motion of all bodies of a mechanism that is released at rest.

    The start is in static equilibrium: with the rotation of a body driven to `start`, gravity, natural
    strains in full, and every load and the driven displacement at its value times its history at t = 0
    (without a history: in full). Then the rotation is released, and so is a driven displacement without a
    history; one with a history continues. Loads go on as value times history(t), constant before its first
    and after its last time.

    Parameters
    ----------
    mechanism : Model
        Both elements work with both integrators. Masses are lumped.
    check : bool, default True
        Compute companion motions of other elements and steps. They estimate `rotation_error` and
        `displacement_error`, and set `resolution` where these are large. They cost about a third of the
        motion, an implicit one nearly as much as itself, or eight times as much with fewer than 8 elements.
    raise_on_failure : bool, default True
        Raise an error for a motion that ends early, or return it with its status.
    asked
        Duration [s], and the other attributes of ``fe_reference.dynamics.Run``.

    Returns
    -------
    Trajectory
        T records, the start first: time (T,), rotation (T,), energies (T,) and more.

    Raises
    ------
    InvalidParameter
        A value outside its domain, a run too long to finish or to keep, nothing with inertia, parts without
        inertia in the explicit integrator, a start that is held but not settled.
    ConvergenceError
        Statics does not reach the start. Or, unless `raise_on_failure` is False, the motion blew up, a step
        had no solution; it carries the part that was computed.

    Notes
    -----
    Unless the scene names the rotary inertia of the sections, the corotational element has none but a
    numerical one (see ``fe_reference.mass``).

    References
    ----------
    Chung and Hulbert (1993), as in ``fe_reference.schemes``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> motion = solve_motion(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> bool(motion.rotation[-1] < 0.1)
    True
    """
    require_model(mechanism)
    mechanism.require_inertia()
    run, check = Run(**asked), read.flag("check", check)
    y, remark = np.zeros(structure_of(mechanism).size), ""
    if run.settled:
        y, remark = settled_state(mechanism, run.start, run.body, run.increments, starts=True)
    remarks = [f"the way to the start: {remark}"] if remark else []
    motion = _integrate(mechanism, y, run, remarks).checked(raise_on_failure)
    if not check or not run.settled:
        return motion
    return checked(mechanism, motion, start=run.start, body=run.body, drive=run.drive)


def _integrate(model: Model, y: Array, run: Run, remarks: list[str]) -> Trajectory:
    """Return the motion from rest at y."""
    settings: dict[str, float | str] = {"integrator": run.integrator, "duration_s": run.duration}
    parts, kind = drive_spans(model, run.drive, run.duration), Explicit if run.explicit else Implicit
    scheme: Explicit | Implicit = kind(model, parts[0].led)
    longest, chosen = run.duration, {"spectral_radius": RADIUS}
    if isinstance(scheme, Explicit):
        start, _ = carried_over(scheme.own, y, np.zeros_like(y), scheme.structure)
        ways = {tuple(each.rates): each.held(scheme.structure) for each in parts}.values()
        limit = min(scheme.critical_step(at, held) for held in ways for at in (start, np.zeros_like(y)))
        longest, chosen = SAFETY * limit, {"critical_step_s": limit, "safety": SAFETY}
    elif run.step is None:
        longest = 1.0 / (STEPS_PER_PERIOD * first_frequency(model))
    h, steps = run.steps(longest)
    run.require_affordable(model, h, steps, y.size)
    began = perf_counter()
    scheme.follow(drive_spans(model, run.drive, steps * h), y, h, run.chunks(steps), run.progress)
    begin: dict[str, float | str] = {} if run.start is None else {"start_rad": run.start}
    return trajectory(scheme, begin | settings | {"step_s": h} | chosen, perf_counter() - began, remarks)


def checked(model: Model, motion: Trajectory, **held: Any) -> Trajectory:
    """Return a motion with its estimated errors [rad, m] and `resolution`, by companions of other elements.

    A motion that stopped and one of a few instants are returned as they are.

    Args:
        model: of the motion, which began in equilibrium.
        held: `start` [rad], `body` and `drive` of it, as of `Run`.
    """
    if motion.status is not Status.CONVERGED or len(motion.time) < 3:
        return motion
    asked, remark = held | {"integrator": motion.settings["integrator"]}, ""
    for elements in (model.elements // 2, 2 * model.elements):
        if elements >= FEWEST:
            try:
                return _compared(model, motion, replace(model, elements=elements), asked)
            except (ConvergenceError, InvalidParameter) as refusal:
                remark = f"error not estimated: a companion of other elements: {refusal}"
    return replace(motion, resolution="; ".join(each for each in (motion.resolution, remark) if each))


def _compared(model: Model, motion: Trajectory, mesh: Model, asked: dict[str, Any]) -> Trajectory:
    """Return the motion with its errors, by the differences to companions of a mesh, or raise a refusal."""
    ratio, spacing = model.elements / mesh.elements, float(motion.time[1])
    own = float(motion.settings["step_s"])
    stride = max(1, ceil(ratio * own / spacing * (1.0 - 1e-9)))
    samples = (len(motion.time) - 2) // stride  # the last may be shorter
    asked = asked | {"duration": samples * stride * spacing, "samples": samples, "aligned": True}
    # explicit companions take the steps that are stable for them
    steps = (None,) if "critical_step_s" in motion.settings else (own, ratio * own)
    runs = [solve_motion(mesh, check=False, step=step, **asked) for step in steps]
    found = [moves(model, motion, stride), *(moves(mesh, run) for run in runs)]
    part = 1.0 / (1.0 - ratio**2) if ratio < 1.0 else 1.0
    turns, places = (
        part
        * np.sum([np.abs(one - two) for one, two in pairwise(each[: samples + 1] for each in kind)], axis=0)
        for kind in zip(*found, strict=True)
    )
    places = np.linalg.norm(places, axis=2)
    remarks = [motion.resolution, _remark(model, motion, turns, places, stride)]
    return replace(
        motion,
        rotation_error=float(turns.max(initial=0.0)),
        displacement_error=float(places.max(initial=0.0)),
        resolution="; ".join(each for each in remarks if each),
    )


def moves(model: Model, motion: Trajectory, stride: int = 1) -> tuple[Array, Array]:
    """Return rotations of all bodies (T, B) [rad], and places of them and of free ends (T, P, 2) [m]."""
    poses = np.array([*motion.bodies.values()]).reshape(-1, len(motion.time), 3)[:, ::stride].swapaxes(0, 1)
    free = np.flatnonzero(model.ends[:, 1] == FREE)
    return poses[..., 2], np.concatenate((poses[..., :2], motion.shape[::stride, free, -1]), axis=1)


def _remark(model: Model, motion: Trajectory, turns: Array, places: Array, stride: int) -> str:
    """Return what is to be said of the estimated errors (T, B) [rad] and (T, P) [m], or nothing.

    They are held against the swing: half the range of the rotation, or of the nodes over the longest strip,
    whichever is more.
    """
    length = float(model.lengths.max())
    travel = float(np.ptp(motion.shape, axis=0).max()) / length
    turned = np.ptp(moves(model, motion)[0], axis=0)
    swing = 0.5 * max(float(turned.max(initial=0.0)), travel)
    apart = np.hstack((turns, places / length)).max(axis=1, initial=0.0)
    much = np.flatnonzero(apart > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"rotations are uncertain by up to {np.degrees(turns.max(initial=0.0)):.3g} deg and displacements by "
        f"up to {places.max(initial=0.0):.3g} m, by more than {UNRESOLVED:.0%} of the swing from "
        f"{motion.time[stride * much[0]]:.3g} s on: the motion is not resolved; take more elements"
    )
