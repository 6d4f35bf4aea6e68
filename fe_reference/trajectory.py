"""Motions as they are reported, and how far their elements resolve them.

The latter is told by companions of fewer elements: half as many, a third or a fifth where they are odd.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .arrays import Array
from .errors import ConvergenceError, InvalidParameter
from .mass import about_mass_centre, carried_over
from .model import FREE, Model
from .motion import ENERGIES, Samples
from .schemes import critical_step
from .solution import Answer, ErrorEstimate, Status, Stopwatch
from .structure import structure_of

#: Estimated error over the swing that is not remarked on.
UNRESOLVED = 0.05
#: Error of a motion that hardly is one [rad, or of strip lengths]: its start alone has it.
STILL = 1e-6
#: Part of a companion's critical step that it takes at most.
SAFETY = 0.8
#: Most elements that one of the companion's stands for.
COARSEST = 5


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory(Answer):
    """A motion at T sampled instants, the start first; G strips, P nodes a strip.

    Attributes:
        status, message: how the run ended; why and when it stopped ("" if it did not).
        time (T,): [s].
        bodies, rates: by name, place of the centre and turn (T, 3) [m, rad], and their rates.
        kinetic_energy, strain_energy (T,): [J].
        gravity_energy (T,): of the weight, zero in the shape at rest [J].
        work, dissipated (T,): by loads and dampers since the start [J].
        shape (T, G, P, 2): positions of the nodes [m].
        states (T, size): reduced coordinates, for `section_forces`.
        effects: names of the effects of the scene.
        counters: steps, force_evaluations; implicit also iterations, factorisations, halvings.
        history: residual norms of implicit steps.
        settings: integrator, step_s, critical_step_s (explicit), start_rad and what else defines the run.
        seconds: by part (`Stopwatch`), "start" the static state that is let go.
        resolution: empty, or what elements and steps leave unresolved.
        rotation_error, displacement_error: estimated errors of the rotations of all bodies [rad] and of the
            places of all bodies and free ends [m], by companions with fewer elements and longer steps, or by
            the meshes of an accuracy; nan without.
        estimate: of the error, where an accuracy was asked for: then all but `states` are limits of meshes,
            at the nodes of the coarsest.

    Clamps and attachments are eliminated exactly, not enforced: there are no residuals of constraints.
    """

    status: Status
    message: str
    time: Array
    bodies: Mapping[str, Array]
    rates: Mapping[str, Array]
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    shape: Array
    states: Array
    effects: tuple[str, ...]
    counters: Mapping[str, int]
    settings: Mapping[str, float | str]
    history: tuple[tuple[float, ...], ...]
    seconds: Mapping[str, float]
    resolution: str = ""
    rotation_error: float = math.nan
    displacement_error: float = math.nan
    estimate: ErrorEstimate | None = None

    @property
    def reached(self) -> float:
        """Part of the duration that the motion went on [1]."""
        return float(self.time[-1] / float(self.settings["duration_s"]))

    @property
    def energy_error(self) -> float:
        """Largest deviation of kinetic + strain + gravity energy - work + dissipated from its start [1].

        It is measured against the largest of: strain and kinetic energy of the start, change of gravity
        energy, work, dissipated energy.
        """
        stored, gravity = self.kinetic_energy + self.strain_energy, self.gravity_energy
        balance = stored + gravity - self.work + self.dissipated
        parts = (stored[:1], gravity - gravity[0], self.work, self.dissipated)
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0

    def columns(self) -> dict[str, Array]:
        """Return what is one number at every instant, by names with units: the columns of a frame."""
        return {
            "time_s": self.time,
            **self.body_columns(self.bodies, ("x_m", "y_m", "rotation_rad")),
            **self.body_columns(self.rates, ("x_rate_m_per_s", "y_rate_m_per_s", "rotation_rate_rad_per_s")),
            **{f"{name}_J": getattr(self, name) for name in ENERGIES},
        }


def trajectory(
    motion: Samples, settings: Mapping[str, float | str], remarks: list[str], watch: Stopwatch
) -> Trajectory:
    """Turn samples in the reduced coordinates into the motion of all bodies; remarks: on its start."""
    structure, y, v = motion.home.structure, motion.y, motion.v
    model, pairs = structure.model, list(zip(y, v, strict=True))
    moved = np.array([structure.displacement(each)[:, :2] for each in y])
    # the motion is reduced about other points of the bodies than the model's own structure
    own = structure_of(model)
    states = np.array([carried_over(structure, each, own) for each in y])
    rates = np.array([carried_over(structure, at, own, rate)[own.first_body :] for at, rate in pairs])
    places = own.body_places(states)
    energies: dict[str, Any] = dict(zip(ENERGIES, np.array(motion.energy).T.copy(), strict=True))
    status = Status.CONVERGED if not motion.message else Status.NOT_CONVERGED
    return Trajectory(
        status=Status.UNSTABLE if motion.unstable else status,
        message=motion.message,
        time=np.array(motion.time),
        bodies={name: places[:, k] for k, name in enumerate(model.body_names)},
        rates={name: rates[:, 3 * k : 3 * k + 3] for k, name in enumerate(model.body_names)},
        **energies,
        shape=model.rest + moved.reshape(-1, *model.rest.shape),
        states=states,
        effects=model.effects.names,
        counters=dict(motion.counters),
        history=tuple(motion.history),
        settings=settings,
        seconds=watch.stop("recover"),
        resolution="; ".join([*motion.home.remarks(motion, float(settings["step_s"])), *remarks]),
    )


def coarser(model: Model) -> tuple[Model, int]:
    """Return the model on every second, third or fifth node, and which; 1 where none of these is possible."""
    elements = len(model.strips[0].nodes) - 1
    every = next((k for k in range(2, COARSEST + 1) if elements % k == 0 and elements > k), 1)
    strips = tuple(replace(strip, nodes=strip.nodes[::every]) for strip in model.strips)
    return replace(model, strips=strips), every


def with_companion(model: Model, motion: Trajectory, run: Callable[..., Trajectory]) -> Trajectory:
    """Return a trajectory with its estimated errors, and a remark in `resolution` where they are much.

    Companions have half the elements and twice the steps, and again half and twice: errors of elements and
    steps go with their squares, so that the error is a third of the difference to the first, if the
    differences fall as that. Where they fall less, as where a fast motion is out of phase in all of them,
    the error is the difference divided by the ratio less one, at most all of it. A motion that stopped, one
    of few instants and a mesh that cannot be halved are returned as they are.

    Args:
        model, motion: the motion and its model.
        run: solves a model from the same start by `duration`, `step` and `samples`.
    """
    levels, spacing = _coarser_levels(model, motion.settings), float(motion.time[-1])
    if len(motion.time) > 1:
        spacing = float(motion.time[1])
    stride = math.ceil(levels[-1][2] / spacing * (1.0 - 1e-9)) if levels else 1
    samples = (len(motion.time) - 2) // stride  # the last may be shorter
    if not levels or motion.status is not Status.CONVERGED or samples < 2:
        return motion
    spacing, differences = stride * spacing, []
    fine = moves(model, motion, stride)
    for coarse, every, longest in levels:
        step = spacing / math.ceil(spacing / longest * (1.0 - 1e-9))
        try:
            other = run(coarse, duration=samples * spacing, step=step, samples=samples)
            failed = other.message or ("" if len(other.time) == samples + 1 else "too few instants")
        except (ConvergenceError, InvalidParameter) as refusal:
            failed = str(refusal)
        if failed and not differences:
            remark = f"error not estimated with 1/{every} of the elements: {failed}"
            return replace(motion, resolution="; ".join(each for each in (motion.resolution, remark) if each))
        if failed:
            break
        theirs = moves(coarse, other, 1)
        differences.append([mine[: samples + 1] - its for mine, its in zip(fine, theirs, strict=True)])
        fine = theirs
    return _estimated(model, motion, differences, levels[0][1], stride)


def _estimated(
    model: Model, motion: Trajectory, differences: list[list[Array]], every: int, stride: int
) -> Trajectory:
    """Return the motion with the errors that its companions' differences tell.

    Args:
        differences: of rotations (T, B) [rad] and places (T, P, 2) [m], to one or two of them in turn.
        every: elements of the motion in one of the first companion. stride: of the instants T.
    """
    length = max(strip.length for strip in model.strips)
    sizes = [
        max(float(np.abs(each).max(initial=0.0)) for each in (turns, places / length))
        for turns, places in differences
    ]
    ratio = sizes[1] / max(sizes[0], np.finfo(float).tiny) if len(sizes) > 1 else 2.0
    part = 1.0 / (min(max(ratio, 2.0), every**2) - 1.0)
    turns, places = part * np.abs(differences[0][0]), part * np.linalg.norm(differences[0][1], axis=2)
    remarks = [motion.resolution, _remark(model, motion, turns, places, stride)]
    return replace(
        motion,
        rotation_error=float(turns.max(initial=0.0)),
        displacement_error=float(places.max(initial=0.0)),
        resolution="; ".join(each for each in remarks if each),
    )


def moves(model: Model, motion: Trajectory, stride: int) -> tuple[Array, Array]:
    """Return rotations of all bodies (T, B) [rad], and places of them and of free ends (T, P, 2) [m]."""
    poses = np.array([*motion.bodies.values()]).reshape(-1, len(motion.time), 3)[:, ::stride].swapaxes(0, 1)
    free = [k for k, strip in enumerate(model.strips) if strip.tip == FREE]
    return poses[..., 2], np.concatenate((poses[..., :2], motion.shape[::stride, free, -1]), axis=1)


def _coarser_levels(model: Model, settings: Any) -> list[tuple[Model, int, float]]:
    """Return coarser models, how many of the elements are one in them, and their longest steps [s].

    The step is that of the motion as many times, or an explicit one that is stable where it is shorter.
    """
    levels: list[tuple[Model, int, float]] = []
    step, many, coarse = float(settings["step_s"]), 1, model
    limits = [_stable(model)] if "critical_step_s" in settings else []
    while len(levels) < 2:
        coarse, every = coarser(coarse)
        if every == 1:
            break
        many *= every
        longest = many * step
        if limits:
            stable = SAFETY * float(settings["critical_step_s"]) * _stable(coarse) / limits[0]
            longest = min(longest, stable)
        levels.append((coarse, many, longest))
    return levels


def _stable(model: Model) -> float:
    """Return the critical explicit step at rest [s]."""
    structure, bodies = about_mass_centre(structure_of(model))
    return critical_step(structure, bodies, np.zeros(structure.size))


def _remark(model: Model, motion: Trajectory, turns: Array, places: Array, stride: int) -> str:
    """Return what is to be said of the estimated errors (T, B) [rad] and (T, P) [m], or nothing.

    They are held against the swing: half the range of the rotation, or of the nodes over the longest strip,
    whichever is more.
    """
    length = max(strip.length for strip in model.strips)
    travel = float(np.ptp(motion.shape, axis=0).max()) / length
    turned = np.ptp(moves(model, motion, 1)[0], axis=0)
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
