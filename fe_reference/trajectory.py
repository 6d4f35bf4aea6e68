"""Motions as they are reported, and how far their elements resolve them.

The latter is told by a companion of fewer elements: half as many, a third or a fifth where they are odd.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .arrays import Array
from .errors import ConvergenceError, InvalidParameter
from .mass import about_mass_centre, carried_over
from .model import Model
from .motion import ENERGIES, Samples
from .schemes import critical_step
from .solution import Answer, ErrorEstimate, Status, Stopwatch
from .structure import structure_of

#: Estimated error of the rotation over the swing that is not remarked on.
UNRESOLVED = 0.05
#: Error of a motion that hardly is one [rad]: its start alone has it.
STILL = 1e-6
#: Part of the companion's critical step that it takes.
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
        resolution: empty, or what elements and steps leave unresolved; rotation_error: estimated error of the
            rotation by a companion with fewer elements, or by the meshes of an accuracy [rad], nan without.
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


def with_companion(
    model: Model, motion: Trajectory, body: str | None, run: Callable[..., Trajectory]
) -> Trajectory:
    """Return a trajectory with its `rotation_error`, and a remark in `resolution` where that is much.

    The error goes with the square of the element, so that of the motion is the difference to the companion
    over the square of the ratio less one; the steps, which stability keeps short, have a share in both. A
    motion that stopped, a single instant and a mesh that cannot be halved are returned as they are.

    Args:
        model, motion: the motion and its model. body: name of the one whose rotation is compared.
        run: solves a model from the same start by `duration`, `step` and `samples`.
    """
    coarse, every = coarser(model)
    if every == 1 or motion.status is not Status.CONVERGED or len(motion.time) < 3:
        return motion
    samples = len(motion.time) - 2  # the last may be shorter
    spacing = float(motion.time[1])
    step = spacing / math.ceil(spacing / _longest(model, coarse, motion.settings))
    try:
        other = run(coarse, duration=samples * spacing, step=step, samples=samples)
        failed = other.message
    except (ConvergenceError, InvalidParameter) as refusal:
        failed = str(refusal)
    if failed or len(other.time) != samples + 1:
        return replace(motion, resolution=f"not checked with 1/{every} of the elements: {failed}")
    fine = _rotation(motion, model, body)[: samples + 1]
    error = np.abs(fine - _rotation(other, coarse, body)) / (every**2 - 1)
    remarks = [motion.resolution, _remark(model, motion, body, error)]
    remark = "; ".join(each for each in remarks if each)
    return replace(motion, rotation_error=float(error.max()), resolution=remark)


def _longest(model: Model, coarse: Model, settings: Any) -> float:
    """Return the longest step of the companion [s]: that of the motion, or an explicit one that is stable."""
    if "critical_step_s" not in settings:
        return float(settings["step_s"]) * (1.0 + 1e-9)
    at_rest = []
    for each in (model, coarse):
        structure, bodies = about_mass_centre(structure_of(each))
        at_rest.append(critical_step(structure, bodies, np.zeros(structure.size)))
    return SAFETY * float(settings["critical_step_s"]) * at_rest[1] / at_rest[0]


def _rotation(motion: Trajectory, model: Model, body: str | None) -> Array:
    """Return the rotation of the body (T,) [rad]."""
    return motion.bodies[model.body_names[model.body_index(body)]][:, 2]


def _remark(model: Model, motion: Trajectory, body: str | None, error: Array) -> str:
    """Return what is to be said of the estimated errors (T,) [rad], or nothing.

    They are held against the swing: half the range of the rotation, or of the nodes over the longest strip
    where the body hardly turns.
    """
    length = max(strip.length for strip in model.strips)
    travel = float(np.ptp(motion.shape, axis=0).max()) / length
    swing = 0.5 * max(float(np.ptp(_rotation(motion, model, body))), travel)
    much = np.flatnonzero(error > max(UNRESOLVED * swing, STILL))
    if not much.size:
        return ""
    return (
        f"the rotation is uncertain by {np.degrees(error.max()):.3g} deg, by more than {UNRESOLVED:.0%} of "
        f"the swing from {motion.time[much[0]]:.3g} s on: the motion is not resolved; take more elements"
    )
