"""Small motion about a static state, and the load at which such a state loses its stability."""

import argparse
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from studies.answers import critical
from studies.answers.adapters import answer_modes
from studies.answers.critical import CriticalLoad
from studies.answers.motion import Spectrum
from studies.answers.settings import Settings
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands.columns import plain, significant, table
from studies.commands.parser import Argument, command, degrees
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
        "wanted relative error of the frequencies, as of `solve` (default 1e-4; none with a given number)"
    ),
    take.JSON,
    take.PLOT,
    take.EXPORT,
)
def modes(arguments: argparse.Namespace) -> int:
    """Report the natural frequencies of small motion, at rest or about a driven rotation, with one of the
    models.

        python -m studies modes cross_axis_pivot --control-points 8
        python -m studies modes cross_axis_pivot --model fe --rotation-deg 45 --held --json -
        python -m studies modes parallel_strip_guide --effects=-strip_inertia

    Modes are free vibrations about a static state: of a pivot with the body turned to --rotation-deg, 0
    unless said otherwise; of a mechanism with none turned unless --rotation-deg is given. In that state
    loads, weight, pre-strain and driven displacements act in full. A release from it frees these
    coordinates: the rotation, unless it is --held, and driven displacements without a history; the torque
    and forces that drove them act on as they are. A negative frequency is an unstable mode (growth rate
    over 2 pi), zero is a rigid motion. slide_frequency_Hz holds those frequencies that are of the
    spline's parametrisation alone. Exit code 0: done; 2: bad input; 3: statics does not reach the
    rotation.
    """
    design = take.chosen_design(arguments)
    how = {"count": arguments.count, "held": arguments.held, "accuracy": arguments.accuracy}

    def ask(settings: Settings, bar: Bar) -> Spectrum:
        return answer_modes(design, settings, rotation=arguments.rotation, **how)

    return tell.asked(arguments, ask, _document_of_modes, _readable_of_modes, stopped=_stopped_of_modes)


def _stopped_of_modes(answer: Spectrum) -> str:
    return f"at {math.degrees(answer.turned):g} deg: {answer.message}"


def _document_of_modes(answer: Spectrum) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        **tell.headed(answer),
        "rotation_rad": answer.turned,
        **tell.keyed(answer, "held", "frequency_Hz", "body_shapes", "slide_frequency_Hz"),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "wall_s": answer.wall_s,
    }


def _readable_of_modes(answer: Spectrum) -> Iterator[str]:
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


#: Rotation that is none [deg].
NO_TURN = 1e-3


@command(
    *take.MODEL,
    Argument("--force-direction-deg X", "in deg from x to y, default -90: down", degrees, default=-90.0),
    take.HELD.but("hold the rotation of the body (default: it is free)"),
    take.JSON,
)
def critical_load(arguments: argparse.Namespace) -> int:
    """Find the critical load of a pivot or mechanism: the force in one direction at which it loses stability.

        python -m studies critical-load cross_axis_pivot --force-direction-deg -90
        python -m studies critical-load parallel_strip_guide --force-direction-deg -90 --held

    A dead force acts at the centre of the body of the case. Its direction is an angle from x to y in the
    axes of the ground. The force is raised from zero until stability is lost at a bifurcation or a limit
    point, up to twice the Euler loads of the strips that bear the body. Strips side by side are added up;
    of strips in a row the weakest counts. The rotation of the body is free, so that it may tip over, or
    --held. Weight and pre-strain of the case act in full. Its other loads and drives are removed.
    Stability under weight and pre-strain alone is checked first.

    A critical load is printed only if two discretisations have it within 1 %; their difference is the
    estimated error, as that of the rotation. Without --control-points the spline takes more control
    points until the force settles; elements are doubled until three meshes agree, and their limit is
    taken. If three discretisations find no critical load, the force at which the rotation passes 5
    degrees and the force at first yield are printed. Exit code 0: a critical load, or none up to the
    largest force; 2: bad input; 3: not resolved, the discretisations disagree.
    """
    design = take.chosen_design(arguments)
    how = {"direction": math.radians(arguments.force_direction_deg), "held": arguments.held}

    def ask(settings: Settings, bar: Bar) -> CriticalLoad:
        return critical.critical_load(design, settings, **how)

    return tell.asked(arguments, ask, _document_of_load, _readable_of_load, stopped=_stopped_of_load)


def _stopped_of_load(found: CriticalLoad) -> str:
    return f"{found.model}: {found.message}"


def _document_of_load(found: CriticalLoad) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        **tell.headed(found),
        **tell.keyed(found, "force_direction_rad", "held", "verdict"),
        "critical_load_N": found.force,
        **tell.keyed(found, "kind", "relative_error", "weight_share", "borne_N"),
        **tell.keyed(found, "rotation_rad", "rotation_error_rad", "rotation_5_deg_N", "yield_N"),
        "soft_relative_error": found.soft_relative_error,
    }


def _readable_of_load(found: CriticalLoad) -> Iterator[str]:
    """Yield the model and its verdict, with the rotation there and the estimated error."""
    yield tell.described(found)
    way = f"force at {math.degrees(found.force_direction):g} deg, rotation {'held' if found.held else 'free'}"
    angle, turned = math.degrees(found.rotation_rad), ""
    if abs(angle) > NO_TURN:
        turned = f", turned {angle:.4g} deg within {math.degrees(found.rotation_error):.1g} deg"
    error = f", estimated error {found.relative_error:.1e}" if math.isfinite(found.relative_error) else ""
    yield f"{way}: {found.verdict if found.converged else 'not resolved'}{turned}{error}"
    if found.converged and found.force is None:
        yield _softening(found)


def _softening(found: CriticalLoad) -> str:
    """Return where a design without a critical load turns too far and yields."""
    soft = "the rotation stays below 5 deg"
    if found.held:
        soft = "the rotation is held"
    elif found.rotation_5_deg is not None:
        soft = f"the rotation passes 5 deg at {found.rotation_5_deg:.6g} N"
    yields = "no strip yields, or the yield strength is not given"
    if found.yield_N is not None:
        yields = f"first yield at {found.yield_N:.6g} N"
    error = (
        f", estimated error {found.soft_relative_error:.1e}"
        if math.isfinite(found.soft_relative_error)
        else ""
    )
    return f"{soft}; {yields}{error}"
