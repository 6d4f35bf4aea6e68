"""Say which force a pivot or mechanism bears in a direction before it buckles, by one model or several.

    python -m studies capacity cross_axis_pivot --force-direction-deg -90
    python -m studies capacity parallel_strip_guide --force-direction-deg -90 --held --model spline,fe

A dead force at the centre of the body, of the case's own or of --body, is raised from nothing in the
direction, an angle from x to y in the axes of the ground, until stability is lost. The rotation of the body
is free, so that it may tip over, or --held. Weight and pre-strain of the case act in full; its other loads
and drives are left out. The spline takes more control points until the force settles, elements are doubled
twice and their limit is taken; the estimated error says how far. The material has no say in it: `solve` tells
the stress. Exit code 0: done, though nothing may be lost up to twice the Euler loads of all strips; 2: bad
input; 3: the path ended before stability was lost.
"""

import argparse
import math
from collections.abc import Iterator
from typing import Any

from studies.answers.strength import Capacity, capacity
from studies.commands import arguments as take
from studies.commands.answer import deliver, described, headed
from studies.commands.columns import one
from studies.commands.parser import Argument, command, degrees
from studies.record.progress import Bar

#: Digits of a force; rotation that is none [deg].
DIGITS, NO_TURN = 6, 1e-6


@command(
    *take.SEVERAL_MODELS,
    Argument(
        "--force-direction-deg X",
        "of the force, in deg from x to y, default -90: down",
        degrees,
        dest="direction",
        default=-90.0,
    ),
    take.HELD.but("hold the rotation of the body (default: it is free)"),
    Argument("--body NAME", "that the force acts on (default: the case's)"),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Raise the force and report; return the exit code."""
    design, every = take.chosen_design(arguments), take.chosen_settings(arguments)
    how = {"direction": math.radians(arguments.direction), "held": arguments.held, "body": arguments.body}
    found = []
    for settings in every:
        with Bar(f"capacity {settings.model}"):
            found.append(capacity(design, settings, **how))
    stopped = [f"{each.model}: {each.message}" for each in found if not each.converged]
    every_one = [_document(each) for each in found]
    document = every_one[0] if len(found) == 1 else {"answers": every_one}
    return deliver(arguments, document, _readable(found), failure="; ".join(stopped) or None)


def _document(found: Capacity) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        **headed(found),
        "force_direction_rad": found.direction,
        "held": found.held,
        "capacity_N": found.force,
        "kind": found.kind,
        "relative_error": found.uncertainty,
        "borne_N": found.reached,
        "rotation_rad": found.turned,
    }


def _readable(found: list[Capacity]) -> Iterator[str]:
    """Yield what every model says, and how far they are apart."""
    for each in found:
        yield described(each)
        way = f"force at {math.degrees(each.direction):g} deg, rotation {'held' if each.held else 'free'}"
        angle = math.degrees(each.turned) if math.isfinite(each.turned) else 0.0
        turned = f", turned {angle:.4g} deg" if abs(angle) > NO_TURN else ""
        if each.force is None:
            yield f"{way}: no loss of stability up to {one(each.reached, DIGITS)} N{turned}"
            continue
        error = f", estimated error {each.uncertainty:.1e}" if math.isfinite(each.uncertainty) else ""
        yield f"{way}: buckles at {one(each.force, DIGITS)} N{turned} ({each.kind}){error}"
    for each in found[1:]:
        if each.force is not None and found[0].force is not None:
            apart = abs(each.force / found[0].force - 1.0)
            yield f"{each.model} differs from {found[0].model} by {apart:.1e}"
