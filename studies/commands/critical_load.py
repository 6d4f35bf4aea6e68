"""Find the critical load of a pivot or mechanism: the force in one direction at which it loses stability.

    python -m studies critical-load cross_axis_pivot --force-direction-deg -90
    python -m studies critical-load parallel_strip_guide --force-direction-deg -90 --held

A dead force acts at the centre of the body of the case. Its direction is an angle from x to y in
the axes of the ground. The force is raised from zero until stability is lost at a bifurcation or a limit
point, up to twice the Euler loads of the strips that bear the body. Strips side by side are added up; of
strips in a row the weakest counts. The rotation of the body is free, so that it may tip over, or --held.
Weight and pre-strain of the case act in full. Its other loads and drives are removed. Stability under weight
and pre-strain alone is checked first.

A critical load is printed only if two discretisations have it within 1 %; their difference is the estimated
error, as that of the rotation. Without --control-points the spline takes more control points until the force
settles; elements are doubled until three meshes agree, and their limit is taken. If three discretisations
find no critical load, the force at which the rotation passes 5 degrees and the force at first yield are
printed. Exit code 0: a critical load, or none up to the largest force; 2: bad input; 3: not resolved, the
discretisations disagree.
"""

import argparse
import math
from collections.abc import Iterator
from typing import Any

from studies.answers.critical import CriticalLoad, critical_load
from studies.answers.settings import Settings
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands.parser import Argument, command, degrees
from studies.record.progress import Bar

#: Rotation that is none [deg].
NO_TURN = 1e-3


@command(
    *take.MODEL,
    Argument(
        "--force-direction-deg X",
        "of the force, in deg from x to y, default -90: down",
        degrees,
        dest="direction",
        default=-90.0,
    ),
    take.HELD.but("hold the rotation of the body (default: it is free)"),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Raise the force and report; return the exit code."""
    design = take.chosen_design(arguments)
    how = {"direction": math.radians(arguments.direction), "held": arguments.held}

    def ask(settings: Settings, bar: Bar) -> CriticalLoad:
        return critical_load(design, settings, **how)

    return tell.asked(
        arguments, ask, _document, _readable, stopped=lambda each: f"{each.model}: {each.message}"
    )


def _document(found: CriticalLoad) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        **tell.headed(found),
        "force_direction_rad": found.direction,
        "held": found.held,
        "verdict": found.verdict,
        "critical_load_N": found.force,
        "kind": found.kind,
        "relative_error": found.uncertainty,
        "weight_share": found.preload,
        "borne_N": found.reached,
        "rotation_rad": found.turned,
        "rotation_error_rad": found.turned_error,
        "rotation_5_deg_N": found.soft,
        "yield_N": found.yields,
        "soft_relative_error": found.softer,
    }


def _readable(found: CriticalLoad) -> Iterator[str]:
    """Yield the model and its verdict, with the rotation there and the estimated error."""
    yield tell.described(found)
    way = f"force at {math.degrees(found.direction):g} deg, rotation {'held' if found.held else 'free'}"
    angle, turned = math.degrees(found.turned), ""
    if abs(angle) > NO_TURN:
        turned = f", turned {angle:.4g} deg within {math.degrees(found.turned_error):.1g} deg"
    error = f", estimated error {found.uncertainty:.1e}" if math.isfinite(found.uncertainty) else ""
    yield f"{way}: {found.verdict if found.converged else 'not resolved'}{turned}{error}"
    if found.converged and found.force is None:
        yield _softening(found)


def _softening(found: CriticalLoad) -> str:
    """Return where a design without a critical load turns too far and yields."""
    soft = "the rotation stays below 5 deg"
    if found.held:
        soft = "the rotation is held"
    elif found.soft is not None:
        soft = f"the rotation passes 5 deg at {found.soft:.6g} N"
    yields = "no strip yields, or the yield strength is not given"
    if found.yields is not None:
        yields = f"first yield at {found.yields:.6g} N"
    error = f", estimated error {found.softer:.1e}" if math.isfinite(found.softer) else ""
    return f"{soft}; {yields}{error}"
