"""Report the natural frequencies of small motion, at rest or about a driven rotation, with one of the models.

    python -m studies modes cross_axis_pivot --control-points 8
    python -m studies modes cross_axis_pivot --model fe --rotation-deg 45 --held --json -
    python -m studies modes parallel_strip_guide --effects=-strip_inertia

Modes are free vibrations about a static state: of a pivot with the body turned to --rotation-deg, 0 unless
said otherwise; of a mechanism with none turned unless --rotation-deg is given. In that state loads, weight,
pre-strain and driven displacements act in full. A release from it frees these coordinates: the rotation,
unless it is --held, and driven displacements without a history; the torque and forces that drove them act on
as they are. A negative frequency is an unstable mode (growth rate over 2 pi), zero is a rigid motion.
slide_frequency_Hz holds those frequencies that are of the spline's parametrisation alone. Exit code 0: done;
2: bad input; 3: statics does not reach the rotation.
"""

import argparse
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studies.answers.adapters import answer_modes
from studies.answers.motion import Spectrum
from studies.answers.settings import Settings
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands.columns import plain, significant, table
from studies.commands.parser import command
from studies.kinds import Array
from studies.record.progress import Bar

#: Of displacement and rotation at unit modal mass; and what is round-off of the largest of all modes.
SHAPE_UNITS, NOISE = ("kg^-0.5", "kg^-0.5", "kg^-0.5/m"), 1e-7


@command(
    *take.MODEL,
    take.ROTATION.but("of the static state, in deg (default: 0 of a pivot; a mechanism is not turned)"),
    take.HELD,
    take.COUNT,
    take.ACCURACY.but(
        "wanted relative error of the frequencies: raises the control points (default 1e-4, or none "
        "with --control-points) or doubles the elements (default: none is asked for)"
    ),
    take.JSON,
    take.PLOT,
    take.EXPORT,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve and report; return the exit code."""
    design = take.chosen_design(arguments)
    how = {"count": arguments.count, "held": arguments.held, "accuracy": arguments.accuracy}

    def ask(settings: Settings, bar: Bar) -> Spectrum:
        return answer_modes(design, settings, rotation=arguments.rotation, **how)

    return tell.asked(arguments, ask, _document, _readable, stopped=_stopped)


def _stopped(answer: Spectrum) -> str:
    return f"at {math.degrees(answer.turned):g} deg: {answer.message}"


def _document(answer: Spectrum) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        **tell.headed(answer),
        "rotation_rad": answer.turned,
        **tell.keyed(answer, "held", "frequency_Hz", "body_shapes", "slide_frequency_Hz"),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "wall_s": answer.wall_s,
    }


def _readable(answer: Spectrum) -> Iterator[str]:
    """Yield the lines of a short table."""
    yield tell.described(answer)
    yield "displacement of the body at unit modal mass"
    shapes = zip(("x", "y", "rotation"), SHAPE_UNITS, answer.body_shapes.T, strict=True)
    yield from table(
        [
            plain("mode", map(str, range(1, len(answer.frequency) + 1))),
            plain("frequency", (significant(f) if f else "rigid" for f in answer.frequency), "Hz"),
            *(plain(name, map(significant, _above_noise(shape)), unit) for name, unit, shape in shapes),
        ]
    )
    if rigid := int((answer.frequency == 0.0).sum()):
        yield f"{rigid} of frequency 0: rigid motions that nothing holds"
    if (fall := answer.falls_in) is not None:
        yield f"a negative frequency is an unstable mode: a disturbance grows e-fold in {fall:.3g} s"
    yield from tell.estimated(answer)
    if answer.resolution:
        yield answer.resolution
    if answer.converged and len(answer.frequency) < answer.count:
        yield f"{len(answer.frequency)} of {answer.count} modes: the discretisation has no more"
    yield tell.ending(answer)


def _above_noise(shape: Array) -> Array:
    """Return one component of all modes, zero where it is round-off."""
    return np.where(np.abs(shape) < NOISE * np.abs(shape).max(initial=0.0), 0.0, shape)
