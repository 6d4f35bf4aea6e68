"""Release a driven pivot or mechanism and report its motion with one of the models.

    python -m studies release cross_axis_pivot --control-points 8
    python -m studies release cross_axis_pivot --model fe --duration 0.02 --json -
    python -m studies release cantilever_with_body --effects=-gravity

The motion starts at rest in static equilibrium. The body is rotated to the rotation of the case or to
--rotation-deg. Weight, pre-strain and driven displacements act in full. Each load acts with its value times
its history at t = 0, or in full without a history. Then the rotation is released, and each driven
displacement without a history. A driven displacement with a history remains prescribed. The rotation remains
prescribed in the interval `held_s = [begin, end]` of [drive]. A `history` in [drive] changes the prescribed
rotation: its change times rotation_deg is added to the current rotation. Loads follow value times history(t),
which is constant before its first and after its last time. A mechanism without a rotation starts in its
equilibrium: under constant loads it does not move, and `message` reports this.

Without --duration the motion lasts four periods of the first natural mode at rest, after the end of all
histories. If this mode is unstable, the motion lasts until it has grown by a factor of 23. Without --step the
implicit splines take 256 steps per period, or more if another of the first modes requires it. A design
without such a mode moves for 0.05 s.
The coordinates of a pivot have their origin at A1, the ground clamp of strip 1. Rotation is positive
counter-clockwise. The arrays of the JSON run over the times, the release first. `effects` lists the effects
that were assembled. frequency_Hz is the frequency of the free vibration if one mode carries the rotation: no
other mode has more than a fifth of its amplitude. Otherwise, and in less than one period, it is null, and
frequency_reason states the reason. `modes` lists the frequencies that the rotation contains, with their
amplitudes, in decreasing order down to a tenth of the largest. Harmonics of a larger one are not listed.
rotation_error_rad and displacement_error_m estimate the largest errors of the rotations of all bodies, and of
the positions of all bodies and free ends. They come from additional motions with other steps and control
points or elements; --no-check omits them. wall_s is the time of the whole call without these motions.
Exit code 0: done; `resolution` may state that step or discretisation do not resolve the motion. 2: bad
input. 3: the start was not reached, or the motion stopped early.
"""

import argparse
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.motion import Motion
from studies.answers.quantities import ENERGY_FLOOR, MOTION, QUANTITIES
from studies.answers.settings import Settings
from studies.cases.design import Design, flexural_scale
from studies.cases.effects import DEFAULT
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands.columns import angle, plain, quantity, table
from studies.commands.parser import Argument, command
from studies.record.progress import Bar

#: Parts of an estimate that are angles [rad].
ANGLES = ("accuracy", "rotation", "time", "space")

#: Energy in EI/L below which the motion is round-off and the energy balance is not evaluated [1].
STILL = 1e-15

#: Periods that are computed beyond the prescribed motion of the design, and steps in each; an unstable mode
#: gets pi e-foldings of them.
SWINGS, STEPS, GROWTH = 4, 256, 0.5
#: Modes that a step resolves, if they are at most so many times as fast as the first: steps in each period.
MODES, FASTEST, LEAST_STEPS = 3, 40.0, 40
#: Rigid motions that may come before them.
RIGID = 3
#: Duration of what has no first frequency [s].
USUAL = 0.05

#: Lines of the table, beside the release itself.
LINES = 20


@command(
    *take.MODEL,
    take.ROTATION.but("at the release, in deg (default: the case's)"),
    take.DURATION,
    take.STEP,
    take.INTEGRATOR,
    take.ACCURACY.but(
        "wanted error of the rotation, in rad: chooses steps and raises the control points "
        "(splines; default: none is asked for)"
    ),
    Argument("--no-check", "omit the companion motions that estimate the resolution"),
    take.JSON,
    take.PLOT,
    take.EXPORT,
)
def main(arguments: argparse.Namespace) -> int:
    """Release and report; return the exit code."""
    design, start = take.chosen_design(arguments), arguments.rotation

    def ask(settings: Settings, bar: Bar) -> Motion:
        duration, step = _pace(arguments, design, settings)
        how = {"step": step, "integrator": arguments.integrator, "accuracy": arguments.accuracy}
        check = not arguments.no_check
        return answer_release(design, settings, start=start, duration=duration, check=check, **how)

    return tell.asked(arguments, ask, _document, _readable)


def _pace(arguments: argparse.Namespace, design: Design, settings: Settings) -> tuple[float, float | None]:
    """Return duration and step [s] as given, or as the design's first frequency asks for.

    A step only of the implicit splines: what is explicit, or has an accuracy, has steps of its own, and so
    have the elements.
    """
    implicit = arguments.integrator in (None, "energy") and arguments.accuracy is None
    free = settings.model == "spline" and implicit and arguments.step is None
    duration, step = arguments.duration, arguments.step
    if duration is None or free:
        usual, fine = _usual(design, settings)
        duration = usual if duration is None else duration
        step = min(fine, duration) if free and fine is not None else step
    return duration, step


def _usual(design: Design, settings: Settings) -> tuple[float, float | None]:
    """Return duration and step [s] that suit the first mode at rest, after all histories of loads and drives.

    Of an unstable mode the duration is that in which it grows twentyfold. What has rigid motions alone has
    the usual duration, in the model's own steps.
    """
    found = answer_modes(_without_followers(design), settings, count=MODES + RIGID)
    frequency = np.sort(np.abs(found.frequency[found.frequency != 0.0]))[:MODES]
    led = _last_time(design)
    if not found.converged or not frequency.size:
        return led + USUAL, None
    first = float(frequency[0])
    last = float(frequency[frequency <= FASTEST * first].max())
    swings = GROWTH if found.falls_in else SWINGS
    return led + swings / first, 1.0 / max(STEPS * first, LEAST_STEPS * last)


def _without_followers(design: Design) -> Design:
    """Return the design whose loads keep their directions, which alone has modes."""
    effects = design.effects.each(
        lambda _, own: {**own, **({"follower": False} if "follower" in own else {})}
    )
    return replace(design, effects=effects)


def _last_time(design: Design) -> float:
    """Return when the last history of a load or a drive is over [s]."""
    histories, effects = [design.history or ()], design.effects
    histories += [own.get("history") or () for name in effects.names for own in effects.every(name)]
    times = [float(time) for history in histories for time, _ in np.reshape(history, (-1, 2))]
    return float(max([0.0, *times, *(design.held or ())]))


def _document(answer: Motion) -> dict[str, Any]:
    """Return the answer as the JSON object of the command: of a pivot the one body, of a mechanism all."""
    pivot, estimate = answer.crossing is not None, answer.estimate
    if estimate is not None:
        estimate = {f"{name}_rad" if name in ANGLES else name: value for name, value in estimate.items()}
    few = pivot and set(answer.effects) <= {*DEFAULT, "inextensible"}
    energies = [
        q for q in QUANTITIES if MOTION in q.analyses and q.unit == "J" and not (few and q.mechanisms)
    ]
    return {
        **tell.headed(answer),
        **tell.keyed(answer, "rotation_error_rad", "displacement_error_m"),
        "frequency_Hz": answer.swing.value,
        "frequency_reason": answer.swing.reason,
        "modes": [each._asdict() for each in answer.modes],
        "time_s": answer.time,
        **tell.moved(answer),
        **{each.key: each.of(answer) for each in energies},
        "constraint_residual": answer.constraint_residual,
        **({} if estimate is None else {"estimate": estimate}),
        **tell.keyed(answer, "counters", "wall_s"),
    }


def _readable(answer: Motion) -> Iterator[str]:
    """Yield the lines of a short table: a few of the instants, of the released body."""
    yield tell.described(answer)
    last, scale = len(answer.time) - 1, flexural_scale(answer.design)
    shown = sorted({round(last * part / LINES) for part in range(LINES + 1)} if last >= 0 else ())
    kinetic, strain = answer.kinetic_energy[shown], answer.strain_energy[shown]
    yield from table(
        [
            *quantity("s", highest=-3, digits=6, time=answer.time[shown]),
            angle(answer.rotation[shown]),
            *quantity("m", highest=-3, x=answer.centre[shown, 0], y=answer.centre[shown, 1]),
            *quantity("J", floor=ENERGY_FLOOR * scale, kinetic=kinetic, strain=strain),
            plain("clamp gap", (f"{gap:.1e}" for gap in answer.constraint_residual[shown]), "m"),
        ]
    )
    swing = answer.swing
    if len(answer.time):
        rate = f"{_frequency(swing.value)} Hz" if math.isfinite(swing.value) else f"-: {swing.reason}"
        moved = max(float(each.max()) for each in (kinetic, strain)) > STILL * scale
        yield f"frequency {rate}" + (f"; energy balanced to {answer.energy_error:.1e}" if moved else "")
    if math.isfinite(answer.rotation_error):
        apart = f"{answer.rotation_error:.1e} rad, displacements by {answer.displacement_error:.1e} m"
        yield f"rotations uncertain by {apart}, by steps and discretisation"
    elif len(answer.time) and answer.estimate is None:
        yield "errors of rotations and displacements: not estimated"
    if answer.estimate is not None:
        told = {name: f"{value:.1e} rad" for name, value in answer.estimate.items() if name in ANGLES}
        parts = f"{told['time']} by steps, {told['space']} by control points"
        yield f"estimated error of the rotation {told['rotation']}: {parts}"
    if answer.resolution:
        yield answer.resolution
    if answer.converged and answer.message:
        yield answer.message
    yield tell.ending(answer)


def _frequency(value: float) -> str:
    """Return a frequency [Hz] with four decimals, or with as many digits where these are none."""
    return f"{value:.4f}" if value >= 1.0 else f"{value:.5g}"
