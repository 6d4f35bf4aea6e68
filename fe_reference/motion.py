"""A motion from span to span, whatever the scheme: its samples, where their energy comes from, its report.

Histories are linear between their instants, so that a motion falls into spans on which every led coordinate
goes at a constant rate. Held like that they need no multiplier: the body is reduced about the point that is
led (`mass.about_mass_centre`), the led rows have no equation of motion, and what resists them is what the
drive exerts. At the beginning of a span velocities change at once, by impulses of the drives alone.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from .actions import couple, resist
from .arrays import Array, Flags
from .effects import DrivenRotation, Prescribed, factor_of
from .law import FORCES, MATERIAL
from .loads import load_power, put_factors
from .mass import about_mass_centre, carried_over, mass_matrix
from .model import Model
from .places import turned
from .solution import Answer, Status
from .structure import Structure, structure_of

Progress = Callable[[int, int], None]
#: Relative gain of energy above which a motion is called unstable: a sound one keeps within a thousandth.
BLOW_UP = 0.1
#: Dimensionless forces (over EI/L^2, EI/L) that are none, where round-off is less.
BALANCED = 1e-9
#: Part of EI/L that is at stake in any motion.
FLOOR = 1e-12
#: Energies of a state and what loads and dampers did until then [J], with their signs in what is conserved.
ENERGIES = {"kinetic_energy": 1, "strain_energy": 1, "gravity_energy": 1, "work": -1, "dissipated": 1}
SIGNS = np.array([*ENERGIES.values()])
#: Instants nearer than this part of the motion are the same.
SAME = 1e-12


@dataclass(frozen=True, kw_only=True)
class Span:
    """A part of a motion, `begin` to `end` [s], on which all drives go at constant rates.

    Attributes:
        rates: of coordinate k of body b, under 3 b + k [m/s, rad/s].
        begins: whether a drive takes hold at its beginning.
    """

    begin: float
    end: float
    rates: Mapping[int, float]
    begins: bool

    @property
    def led(self) -> tuple[int, ...]:
        """The bodies whose centres are led."""
        return tuple(sorted({at // 3 for at in self.rates if at % 3 < 2}))

    def held(self, structure: Structure) -> Flags:
        """Return which coordinates of a structure are led (size,)."""
        return structure.flags([structure.first_body + at for at in self.rates])

    def caught(self, structure: Structure, y: Array, v: Array) -> Array:
        """Return velocities (size,) with the rates of the drives, all others as impulses of these leave them.

        The mass of a body may be off the point that is led: an impulse there turns it.

        Args:
            structure: reduced model in whose coordinates the motion is.
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s] before the impulse.
        """
        after, mass = v.copy(), mass_matrix(structure, y, "lumped")
        for at, rate in self.rates.items():
            after[structure.first_body + at] = rate
        held = self.held(structure) | (mass.data[mass.pattern.diagonal] == 0.0)
        # free coordinates take what keeps their momentum
        after -= mass.factors(held).solve(mass.times(after - v))
        return after

    def pieces(self, step: float, chunks: Sequence[int]) -> Iterator[tuple[float, float, int, bool]]:
        """Yield the pieces of a motion whose samples are `chunks` of steps [s] apart.

        Of each piece: begin and step [s], number of steps, and whether a sample is at its end.
        Chunks within which a span begins or ends are cut there, in whole steps of their own.
        """
        close, done = SAME * step * sum(chunks), 0
        for many in chunks:
            low, high = step * done, step * (done + many)
            done += many
            begin, end = max(low, self.begin), min(high, self.end)
            if end - begin >= high - low - close:
                yield low, step, many, True
            elif end - begin > close:
                steps = max(1, math.ceil((end - begin) / step * (1.0 - SAME)))
                yield begin, (end - begin) / steps, steps, end >= high - close


def drive_spans(model: Model, drive: DrivenRotation | None, duration: float) -> list[Span]:
    """Return the spans of a motion of `duration` [s], in order; without a drive, one free span.

    Raises:
        InvalidParameter: two drives of one coordinate.
    """
    every = [*model.every(Prescribed), *([drive] if drive else [])]
    drives = {at: led for at, led in model.prescribed(None, every).items() if led[1].leads}
    times = {duration}
    for _, effect in drives.values():
        times |= {*effect.held, *(time for time, _ in effect.leads)}
    instants = [0.0]
    for time in sorted(times):
        if instants[-1] + SAME * duration < time <= duration:
            instants.append(time)
    spans: list[Span] = []
    for begin, end in pairwise([*instants[:-1], duration]):
        rates = {
            at: (factor_of(led.leads, end) - factor_of(led.leads, begin)) / (end - begin) * target
            for at, (target, led) in drives.items()
            if led.held[0] < 0.5 * (begin + end) < led.held[1]
        }
        before = spans[-1].rates if spans else {}
        spans.append(Span(begin=begin, end=end, rates=rates, begins=bool(rates.keys() - before.keys())))
    return spans


@dataclass(frozen=True, eq=False)
class Instant:
    """A motion at an instant, and what resists it there.

    Attributes:
        time [s]. y, v, a (size,): coordinates, velocities, accelerations.
        force (size,): what resists [N, N m]. strain, gravity: energies [J].
        load_power, loss_power: of the loads, and lost in dampers [W].
    """

    time: float
    y: Array
    v: Array
    force: Array
    strain: float
    gravity: float
    load_power: float
    loss_power: float
    a: Array = field(default_factory=lambda: np.zeros(0))


class Scheme:
    """A way to integrate the motion of a model, and the samples of the motion.

    Attributes:
        own: the structure of the model. structure, bodies: about the centres of mass of its bodies; about the
            centres of those that are `led`.
        blow_up: relative gain of energy that stops a motion. mass (size,): lumped. held (size,): what is led;
        inverse (size,): of the mass, zero where there is none and where it is led. off: bodies whose mass is
        off the point that is led.
        time [s], y (size,), v (size,), energy (5,): of the samples, instants, coordinates and velocities of
            the own structure, `ENERGIES`.
        counters: counted steps and iterations by name. history: residual norms of implicit steps.
        unstable: whether the motion was stopped because its energy blew up.
        message: why and when the motion stopped early ("" if it did not).
        books: work of loads and drives, and what dampers took, until now [J]. content: sums of a.M a and
            v.M v over implicit steps.
        still: whether it starts at rest in equilibrium. stake: largest energy at stake so far [J].
        floor: energy that is at stake in any motion [J]: what loads put into a rest is held against it.
    """

    blow_up = BLOW_UP

    def __init__(self, model: Model, led: Sequence[int] = ()) -> None:
        self.own = structure_of(model)
        self.structure, self.bodies = about_mass_centre(self.own, led)
        self.mass, self.coupled = self.bodies.diagonal(self.structure), np.zeros((0, 7))
        self.held = np.zeros(self.structure.size, dtype=bool)
        self.off = np.flatnonzero((self.bodies.centre != self.structure.points).any(axis=1)).tolist()
        self.time, self.y, self.v, self.energy = list[float](), list[Array](), list[Array](), list[Array]()
        self.counters, self.history = Counter[str](), list[tuple[float, ...]]()
        self.unstable, self.message, self.still = False, "", False
        self.books, self.content = np.zeros((2, 2))
        self.stake, self.floor = 0.0, FLOOR * self.structure.moment_unit

    def start(self, time: float, y: Array, v: Array, held: Flags) -> Instant:
        """Return an instant with its consistent acceleration.

        Args:
            time: instant [s].
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
            held: which coordinates are led at their velocities (size,).
        """
        self.held, inert = held, (self.mass > 0.0) & ~held
        self.coupled = self.couplings(held)
        self.inverse = np.where(inert, 1.0 / np.where(inert, self.mass, 1.0), 0.0)
        now = self.resist(y, v, time)
        return replace(now, a=-self.inverse * now.force)

    def couplings(self, held: Flags) -> Array:
        """Return of each body that is led one way, its mass off that point, what couples its other motions.

        The rows (K, 7): row of the body, free direction, mass, moment of inertia, first moment (2,) [kg m],
        whether the turn is led as well. What is `held` (size,) is led.
        """
        s, bodies, rows = self.structure, self.bodies, []
        for k in self.off:
            x, y, turn = held[s.body_slice(k)]
            first = bodies.mass[k] * (bodies.centre[k] - s.points[k])
            if x != y and first.any():
                rows.append([s.nodes + k, x, bodies.mass[k], bodies.moment_of_inertia[k], *first, turn])
        return np.array(rows, dtype=np.float64).reshape(-1, 7)

    def resist(self, y: Array, v: Array, time: float) -> Instant:
        """Return the state of the motion with its resisting forces at an instant.

        Args:
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
            time: instant [s], which gives the factors of the loads.
        """
        s, state = self.structure, (self.structure.displacement(y), self.structure.velocity(v))
        put_factors(s.loads.histories, time, s.loads.pulls[2])
        asked = MATERIAL if s.relaxation else FORCES
        strain, spring, gravity, _, loss = resist(s.tables, 1.0, 1.0, asked, state, s.written, s.curvature)
        couple(self.coupled, *state, s.written[0])
        power = load_power(s.loads.pulls, state[1])
        return Instant(time, y, v, s.gathered(s.written[0]), sum(strain) + spring, gravity, power, loss)

    def go(self, now: Instant, step: float, steps: int) -> Instant | None:
        """Return the instant after steps of equal length [s], or None where the motion stopped; books their
        work."""
        raise NotImplementedError

    def swing(self, y: Array, v: Array, ways: Flags) -> float:
        """Return the kinetic energy of masses that turn off led points moving in `ways` (size,) [J]."""
        s, total = self.structure, 0.0
        for k in self.off:
            at = s.body_slice(k)
            moved, spin = np.where(ways, v, 0.0)[at], v[at][2]
            x, y_arm = turned(y[at][2], *(self.bodies.centre[k] - s.points[k]))
            total += float(self.bodies.mass[k] * spin * (x * moved[1] - y_arm * moved[0]))
        return total

    def kinetic(self, y: Array, v: Array) -> float:
        """Return the kinetic energy [J].

        Args:
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
        """
        return 0.5 * float(self.mass @ v**2) + self.swing(y, v, np.ones(len(v), dtype=bool))

    def beside(self, at: Instant) -> float:
        """Return what of it the equations of motion do not have, for it is of led coordinates [J]."""
        return self.swing(at.y, at.v, self.held)

    def unloaded(self, at: Instant) -> Flags:
        """Return where the forces are none but round-off (size,)."""
        tangent = self.structure.evaluate(at.y).tangent
        least = BALANCED * self.structure.scale + self.structure.round_off(tangent)
        return np.asarray(np.abs(at.force) <= least)

    def remarks(self, step: float) -> list[str]:
        """Return what the step [s] leaves unresolved: nothing where it is stable."""
        return []

    def take(self, at: Instant, begun: float) -> bool:
        """Keep an instant if its energy is sound; otherwise note when it was lost.

        The gain is measured against the largest energy at stake before this sample. At constant rates drives
        do the work of what is beside the scheme's energy as well.

        Args:
            at: the instant.
            begun: energy beside the scheme's as the span began [J].

        Returns:
            Whether it was kept.
        """
        work, kinetic = float(self.books[0]) + self.beside(at) - begun, self.kinetic(at.y, at.v)
        energy = np.array([kinetic, at.strain, at.gravity, work, float(self.books[1])])
        former = self.energy[-1] if self.energy else energy
        self.stake = max(self.stake, float(former[:2].sum()), *np.abs(former[2:]).tolist())
        start, now = (float(each @ SIGNS) for each in ((self.energy or [energy])[0], energy))
        at_stake = max(self.stake, abs(work), abs(at.gravity), self.floor)
        if not np.isfinite(now) or now - start > self.blow_up * at_stake:
            self.unstable = True
            self.message = (
                f"the energy grew from {start:.6g} J to {now:.6g} J"
                f" between {self.time[-1]:.6g} s and {at.time:.6g} s"
            )
            return False
        y, v = carried_over(self.structure, at.y, at.v, self.own)
        self.time.append(at.time)
        self.y.append(y)
        self.v.append(v)
        self.energy.append(energy)
        return True

    def gained(self) -> Array:
        """Return the gain in the balance of energies over the energy at stake (T,) [1]."""
        balance, at_stake = np.array(self.energy) @ SIGNS, max(self.stake, self.floor)
        gain: Array = (balance - balance[0]) / (at_stake or np.inf)
        return gain

    def follow(
        self, spans: Sequence[Span], y: Array, step: float, chunks: Sequence[int], progress: Progress | None
    ) -> None:
        """Take the samples of a motion from rest through its spans.

        Args:
            y: coordinates of the own structure (size,) [m, rad] at the start.
            step: [s]. chunks: steps between samples.
            progress: called as progress(done, total) after every sample.
        """
        y, v = carried_over(self.own, y, np.zeros_like(y), self.structure)
        for span in spans:
            caught = span.caught(self.structure, y, v)
            gained = self.kinetic(y, caught) - self.kinetic(y, v)
            # energy that a catch ends is lost; what a drive adds, by a jump of rates too, is work
            self.books += (0.0, -gained) if span.begins and gained < 0.0 else (gained, 0.0)
            now = self.start(span.begin, y, caught, span.held(self.structure))
            begun = self.beside(now)
            if not self.time:
                self.still = not caught.any() and bool(self.unloaded(now)[~self.held].all())
                self.take(now, begun)
            for time, own, many, kept in span.pieces(step, chunks):
                after = self.go(replace(now, time=time), own, many)
                if after is None or (kept and not self.take(after, begun)):
                    return
                now = after
                if kept and progress is not None:
                    progress(len(self.time) - 1, len(chunks))
            self.books[0] += self.beside(now) - begun
            y, v = now.y, now.v


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory(Answer):
    """A motion at T sampled instants, the start first; G strips, P nodes a strip.

    Attributes:
        status, message: how the run ended; why and when it stopped ("" if it did not).
        time (T,): [s].
        bodies, rates: by name, place of the centre and turn (T, 3) [m, rad], and their rates.
        kinetic_energy, strain_energy (T,): the second with that of springs between bodies [J].
        gravity_energy (T,): of the weight, zero in the shape at rest [J].
        work, dissipated (T,): by loads and dampers since the start [J].
        shape (T, G, P, 2): positions of the nodes [m].
        states (T, size): reduced coordinates, for `strip_fields`.
        counters: steps, force_evaluations; implicit also iterations, factorisations, halvings.
        history: residual norms of implicit steps.
        settings: integrator, step_s, critical_step_s (explicit), start_rad and what else defines the run.
        seconds: "solve", of the steps alone [s].
        starts_still: whether it starts at rest in equilibrium, to round-off.
        resolution: empty, or what elements and steps leave unresolved.
        rotation_error, displacement_error: estimated errors of the rotations of all bodies [rad] and of the
            places of all bodies and free ends [m], by companions with fewer elements and longer steps; nan
            without.

    Clamps and attachments are eliminated exactly, not enforced: there are no residuals of constraints.

    References
    ----------
    Valentini and Pezzuti (2013), Fig 6.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> motion = solve_motion(pivot, start=0.1, duration=1e-4, samples=5, check=False)
    >>> motion.bodies["body"].shape, motion.settings["integrator"]
    ((6, 3), 'central-difference')
    """

    time: Array
    rates: Mapping[str, Array]
    kinetic_energy: Array
    strain_energy: Array
    dissipated: Array
    settings: Mapping[str, float | str]
    starts_still: bool = False
    resolution: str = ""
    rotation_error: float = math.nan
    displacement_error: float = math.nan

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
        """Return the columns of a frame: arrays (T,) of one number at every instant, by names with units."""
        return {
            "time_s": self.time,
            **self.body_columns(self.bodies, ("x_m", "y_m", "rotation_rad")),
            **self.body_columns(self.rates, ("x_rate_m_per_s", "y_rate_m_per_s", "rotation_rate_rad_per_s")),
            **{f"{name}_J": getattr(self, name) for name in ENERGIES},
        }


def trajectory(
    motion: Scheme, settings: Mapping[str, float | str], seconds: float, remarks: list[str]
) -> Trajectory:
    """Return the motion of all bodies from samples in the reduced coordinates [m, rad].

    Args:
        settings: of the integrator, by names with units. seconds: that the steps took. remarks: on the start.
    """
    own, states, model = motion.own, np.array(motion.y), motion.own.model
    places, rates = own.body_places(states), own.bodies(np.array(motion.v))
    moved = np.array([own.displacement(y)[: own.nodes, :2] for y in states])
    energies: dict[str, Any] = dict(zip(ENERGIES, np.array(motion.energy).T.copy(), strict=True))
    status = Status.CONVERGED if not motion.message else Status.NOT_CONVERGED
    return Trajectory(
        status=Status.UNSTABLE if motion.unstable else status,
        message=motion.message,
        time=np.array(motion.time),
        bodies={name: places[:, k] for k, name in enumerate(model.body_names)},
        rates={name: rates[:, k] for k, name in enumerate(model.body_names)},
        **energies,
        shape=model.rest + moved.reshape(-1, *model.rest.shape),
        states=states,
        counters=dict(motion.counters),
        history=tuple(motion.history),
        settings=settings,
        seconds={"solve": seconds},
        starts_still=motion.still,
        resolution="; ".join([*motion.remarks(float(settings["step_s"])), *remarks]),
    )
