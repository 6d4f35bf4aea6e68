"""Motion of a model after its drives are removed, or from the shape at rest."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from math import ceil
from typing import Annotated, Any

import numpy as np

from .arrays import Array, Flags
from .companions import with_companions
from .drives import DrivenRotation, Span, drive_spans
from .effects import DEFAULT_EFFECTS, Effects
from .errors import Checked, InvalidParameter, choice, count, finite, optional, positive, require_kind, within
from .mass import about_mass_centre, carried_over, couplings
from .model import Model, require_model
from .modes import natural_frequencies
from .motion import ENERGIES, Progress, Samples, Scheme, Trajectory, course, trajectory
from .places import GROUND
from .refined import limit_of
from .rigid import loose_coordinates
from .schemes import Explicit, Implicit, critical_step
from .solution import Stopwatch
from .statics import settled_state
from .structure import Structure, structure_of

INTEGRATORS = ("central-difference", "generalised-alpha")
#: Default of the implicit step: so many in the first period of small motion; strips are fifty times as fast.
STEPS_PER_PERIOD = 6000
ELASTIC = (*DEFAULT_EFFECTS, "spring", "support")
#: Most steps of one run unless more are allowed, some 25 s with 20 elements; 50 times more, 20 minutes, are
#: the most that are recommended. Most numbers kept of a run.
MOST_STEPS, FAR_MORE = 20_000_000, 50
MOST_NUMBERS = 200_000_000


@dataclass(frozen=True, kw_only=True)
class Run(Checked):
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
        step: time step [s]. Default: for "central-difference" the smaller critical step of the start and of
            rest, times `safety`; for "generalised-alpha" a 6000th of the first period of small motion about
            the shape at rest, without gravity and loads. The default is shortened so that whole steps fill
            the duration.
        integrator: "central-difference" (explicit) or "generalised-alpha" (implicit, with `spectral_radius`).
        samples: states kept beside the start, at most.
        most_steps: beyond which a run is refused before it begins.
        accuracy: wanted error of rotations [rad] and of places in strip lengths; the mesh is doubled until
            the estimate is below it, and the motion is the limit, at equal instants. Each mesh takes eight
            times as long as the one before.
        progress: called as progress(done, total) after every sample.
    """

    duration: Annotated[float, positive, "s"]
    start: Annotated[float | None, optional, finite, "rad"] = None
    body: str | None = None
    drive: DrivenRotation | None = None
    settled: bool = True
    increments: Annotated[int, count] = 20
    step: Annotated[float | None, optional, positive, "s"] = None
    integrator: Annotated[str, choice, INTEGRATORS] = INTEGRATORS[0]
    safety: Annotated[float, positive, "1"] = 0.9
    spectral_radius: Annotated[float, within, 0.0, 1.0 + 1e-12, "1"] = 0.9
    samples: Annotated[int, count] = 1000
    most_steps: Annotated[int, count] = MOST_STEPS
    accuracy: float | None = None
    progress: Progress | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.drive is not None:
            require_kind("drive", self.drive, DrivenRotation, "a DrivenRotation or None")
        if self.start is not None and not self.settled:
            raise InvalidParameter("settled", self.settled, "True for a start at a held rotation [1]")
        if self.accuracy is not None and (self.step is not None or not self.explicit):
            raise InvalidParameter(
                "accuracy", self.accuracy, f"no step beside it, and the integrator {INTEGRATORS[0]}"
            )

    @property
    def explicit(self) -> bool:
        """Whether the integrator is the explicit one."""
        return self.integrator == INTEGRATORS[0]


def solve_release(pivot: Model, *, start: float | None, duration: float, **options: Any) -> Trajectory:
    """Release the only body at rest from the static state at a rotation.

    Parameters
    ----------
    pivot : Model
    start : float, rad
        Rotation at the release; None: no rotation is driven.
    duration : float, s
    options
        Keywords of `solve_motion`.

    Returns
    -------
    Trajectory
        T records, the start first: time (T,), rotation (T,), energies (T,) and more.

    Raises
    ------
    InvalidParameter, ConvergenceError
        As in `solve_motion`.

    References
    ----------
    Valentini and Pezzuti (2013), Fig 6.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.mechanism.cross_axis_pivot``:

    >>> motion = solve_release(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> motion.time.shape
    (6,)
    """
    require_model(pivot)
    pivot.body_index(None)
    return solve_motion(pivot, start=start, duration=duration, **options)


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
        motion, an implicit one nearly as much as itself, or eight times as much with few elements. None is
        made with an accuracy.
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
        had no solution or the accuracy was not reached; it carries the part that was computed.

    Notes
    -----
    Unless the scene names the rotary inertia of the sections, the corotational element has none but a
    numerical one (see ``fe_reference.mass``).

    References
    ----------
    Chung and Hulbert (1993), as in ``fe_reference.schemes``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.mechanism.cross_axis_pivot``:

    >>> motion = solve_motion(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> bool(motion.rotation[-1] < 0.1)
    True
    """
    require_model(mechanism)
    require_kind("check", check, bool, "True or False")
    run = Run(**asked)
    if run.accuracy is not None:
        return _limit(mechanism, run, run.accuracy).checked(raise_on_failure)
    motion = _moved(mechanism, run).checked(raise_on_failure)
    if not check or not run.settled:
        return motion
    return checked(mechanism, motion, start=run.start, body=run.body, drive=run.drive)


def _limit(model: Model, run: Run, accuracy: float) -> Trajectory:
    """Return the limit of a motion's meshes at the same instants; its rotations and places are judged."""
    units = {**dict.fromkeys((*ENERGIES, "bodies", "rates"), 1.0), "shape": structure_of(model).length}
    turns: dict[str, Callable[[Array], Array]] = {"rotation": lambda places: places[..., 2]}
    judged = ("rotation", "shape")
    motion = limit_of(model, accuracy, partial(_moved, run=run), units, turns, judged, relative=False)
    errors = {} if motion.estimate is None else motion.estimate.errors
    places = errors.get("shape", np.nan) * structure_of(model).length
    return replace(motion, rotation_error=errors.get("rotation", np.nan), displacement_error=places)


def _moved(model: Model, run: Run) -> Trajectory:
    """Return the motion of a model, however it ended."""
    model.effects.require_inertia()
    watch = Stopwatch()
    y, remark = np.zeros(structure_of(model).size), ""
    if run.settled:
        y, remark = settled_state(model, run.start, run.body, run.increments, starts=True)
    watch.stop("start")
    samples, settings = _integrate(model, y, run, watch)
    begin: dict[str, float | str] = {} if run.start is None else {"start_rad": run.start}
    remarks = [f"the way to the start: {remark}"] if remark else []
    return trajectory(samples, begin | settings, remarks, watch)


def checked(
    model: Model,
    motion: Trajectory,
    *,
    start: float | None,
    body: str | None = None,
    drive: DrivenRotation | None = None,
) -> Trajectory:
    """Return a motion with its estimated errors [rad, 1] and `resolution`, by companions of fewer elements.

    Args:
        model, body, drive: of the motion, which began in equilibrium.
        start: rotation at the start [rad]; None: no rotation is driven.
    """
    names = ("integrator", "spectral_radius")
    settings: dict[str, Any] = {name: motion.settings[name] for name in names if name in motion.settings}
    settings |= {"start": start, "body": body, "drive": drive, "check": False, "raise_on_failure": False}
    return with_companions(model, motion, partial(solve_motion, **settings))


def _integrate(model: Model, y: Array, run: Run, watch: Stopwatch) -> tuple[Samples, dict[str, float | str]]:
    """Integrate from rest at y; return the samples and the settings."""
    own = structure_of(model)

    @cache
    def scheme_of(led: tuple[int, ...]) -> Explicit | Implicit:
        about = about_mass_centre(own, led)
        return Explicit(*about) if run.explicit else Implicit(*about, run.spectral_radius)

    home = scheme_of(()).structure
    choices: dict[str, float] = {"spectral_radius": run.spectral_radius}
    longest = run.duration
    if run.explicit:
        rest = Span(begin=0.0, end=0.0, rates={}, begins=False)
        parts = {tuple(each.rates): each for each in (rest, *drive_spans(model, run.drive, run.duration))}
        limit = min(
            _critical(scheme_of(span.led), span.held(scheme_of(span.led).structure), own, state)
            for span in parts.values()
            for state in (y, np.zeros_like(y))
        )
        choices, longest = {"critical_step_s": limit, "safety": run.safety}, run.safety * limit
    elif run.step is None:
        longest = 1.0 / (STEPS_PER_PERIOD * _first_frequency(model))
    h, steps = _steps(run, longest)
    _affordable(model, run, h, steps, y.size)
    spans = drive_spans(model, run.drive, steps * h)
    watch.stop("compile")
    began = carried_over(own, y, home), np.zeros_like(y)
    samples = course(scheme_of, spans, *began, h, _sampling(steps, run.samples), run.progress)
    watch.stop("solve")
    settings: dict[str, float | str] = {"integrator": run.integrator, "duration_s": run.duration, "step_s": h}
    return samples, settings | choices


def _critical(scheme: Scheme, held: Flags, own: Structure, y: Array) -> float:
    """Return the critical step [s] at coordinates y of a model's `own` structure, with what is held."""
    at, bodies = scheme.structure, scheme.bodies
    return critical_step(at, bodies, carried_over(own, y, at), couplings(at, bodies, held))


def _sampling(steps: int, samples: int) -> list[int]:
    """Return the numbers of steps between samples: equal ones, the last perhaps shorter."""
    every = -(-steps // samples)
    whole, rest = divmod(steps, every)
    return [every] * whole + ([rest] if rest else [])


def _first_frequency(model: Model) -> float:
    """Return the first frequency about the shape at rest, of inertia, elasticity and supports alone [Hz]."""
    kept = {name: same for name, same in model.effects.named.items() if name in ELASTIC}
    bare = replace(model, effects=Effects(named=kept))
    structure = structure_of(bare)
    rigid = len(loose_coordinates(structure, [structure.first_body + at for at in bare.prescribed(None)]))
    clamped = (model.ends == GROUND).any()
    found = np.zeros(0)  # of free strips without bodies
    if clamped or model.bodies:
        found = natural_frequencies(bare, rotation=None, count=rigid + 1, mass="lumped").frequency
    if not (found > 0.0).any():
        raise InvalidParameter("step", None, "a step: the model can move freely and has no first period [s]")
    return float(found[found > 0.0][0])


def _cheaper(model: Model, run: Run, steps: int) -> str:
    """Return what to do about a run of too many steps: of all ways those that can be run."""
    ways = ["take longer steps"]
    if run.explicit:
        implicit = max(run.duration * STEPS_PER_PERIOD * _first_frequency(model), 1.0)
        ways = [f"--integrator generalised-alpha takes about {implicit:.2g}"]
        if implicit > run.most_steps:
            ways = [
                "remove strip_inertia, if strips are light, and take --integrator generalised-alpha with "
                f"a --step (its own are about {implicit:.2g})"
            ]
    if steps <= FAR_MORE * MOST_STEPS:
        ways.append("allow more by --most-steps (most_steps)")
    return "; or ".join(ways)


def _steps(run: Run, longest: float) -> tuple[float, int]:
    """Return step [s] and number of steps; what is not given is shortened to fill the duration.

    With an accuracy, to fill the time between two samples, so that all meshes have the same instants.
    """
    parts = 1 if run.accuracy is None else run.samples
    steps = parts * max(1, ceil(run.duration / parts / (run.step or longest) * (1.0 - 1e-12)))
    return run.step or run.duration / steps, steps


def _affordable(model: Model, run: Run, step: float, steps: int, size: int) -> None:
    """Refuse a run of too many steps, or of too many numbers to keep."""
    if steps > run.most_steps:
        raise InvalidParameter(
            "duration",
            run.duration,
            f"at most {run.most_steps:.3g} steps of {step:.3g} s, this is {steps:.3g} of them: "
            f"{_cheaper(model, run, steps)} [s]",
        )
    samples = min(run.samples, steps)
    if 2 * samples * size > MOST_NUMBERS:
        most = MOST_NUMBERS // (2 * size)
        raise InvalidParameter("samples", samples, f"at most {most} samples of {size} coordinates [1]")
