"""Report the influence of each effect of a scene, and find the cheapest scene within a tolerance.

    python -m studies audit cross_axis_pivot
    python -m studies audit my_pivot.toml --tolerance 1e-2 --json audit.json

The spline model solves the static path of the case and the motion from its end for every scene. The
full scene is that of the case with weight and the rotary inertia of the sections; where one of these makes
the design unstable at rest, it is removed and a last line reports this. One line per effect contains the
changes of the answer when the effect is removed or replaced by its simpler form: inextensible strips for
stretching and massless strips for their inertia. Changes are of the path over the
travel, of the torque over the largest, of the swing's and the first mode's frequency, and of the part of the
energy that is lost. Times are of static path and motion together, the full scene's over the line's: above 1
the line is faster. DOF are those with inertia; the explicit step is the longest stable one of the leapfrog.
Then come the effects that planar beams neglect: lateral clamping, anticlastic stiffening, monolithic
supports, all three, and shear, which the elements have (--model fe-shear). Printed are the changes of path,
of stiffness at the begin of the rotation, of torque and largest stress at its end, and of the first mode.
The cheapest scene within the tolerance is that with the fewest effects, which is not always the fastest.
Exit code 0: done; 2: bad input; 3: the full scene has no answer.
"""

import argparse
from collections.abc import Iterator
from typing import Any

from studies.answers.settings import SplineSettings
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import cell
from studies.commands.parser import Argument, command, positive, whole_number
from studies.effects.audit import Audit, audit
from studies.effects.scenes import Scene
from studies.errors import Unanswered
from studies.record.progress import Bar


@command(
    take.CASE,
    take.EFFECTS,
    take.CONTROL_POINTS.but("control points a strip, default 6", read=whole_number(4), default=6),
    Argument("--tolerance T", "allowed relative change, default 1e-3", positive, default=1e-3),
    take.JSON,
)
def main(arguments: argparse.Namespace) -> int:
    """Audit and report; return the exit code."""
    design = take.chosen_design(arguments)
    settings = SplineSettings(control_points=arguments.control_points)
    try:
        with Bar("audit") as bar:
            found = audit(design, settings, arguments.tolerance, bar)
    except Unanswered as error:
        return not_converged(f"the full scene: {error}")
    return deliver(arguments, _document(found), _readable(found), failure=None)


def _document(found: Audit) -> dict[str, Any]:
    """Return the audit as the JSON object of the command."""
    return {
        "tolerance": found.tolerance,
        "model": found.run.settings.model,
        "settings": found.run.settings.keywords(),
        "duration_s": found.run.duration,
        "step_s": found.run.step,
        "full": found.full.row(found.full),
        "rows": [row.row(found.full) for row in found.rows],
        "tried": [row.row(found.full) for row in found.tried],
        "beyond": found.beyond,
        "cheapest": found.cheapest.row(found.full),
        "full_wall_s": found.full.wall_s,
    }


def _readable(found: Audit) -> Iterator[str]:
    """Yield the lines of a table, and the cheapest scene."""
    run = found.run
    yield f"full scene: {', '.join(found.full.effects.names)}"
    yield f"static path and {1e3 * run.duration:.3g} ms of motion in steps of {run.step:.2g} s; changes to it"
    head = f"{'path':>9}{'torque':>9}{'swing':>10}{'1st mode':>10}{'loss':>10}"
    yield f"{'scene':<28}{head}{'time':>8}{'unknowns':>9}{'DOF':>5}{'highest Hz':>12}{'step s':>9}"
    for row in (found.full, *found.rows):
        yield _line(found, row)
    best = found.cheapest
    yield ""
    head = f"{'path':>9}{'stiffness':>11}{'torque':>10}{'stress':>10}{'1st mode':>10}"
    yield f"{'neglected by planar beams':<28}{head}"
    for price in found.beyond:
        cells = f"{cell(price['trajectory'], 9)}{cell(price['stiffness'], 11, sign='+')}"
        cells += "".join(cell(price[name], 10, sign="+") for name in ("torque", "stress", "first_mode"))
        answer = f"{price['status'].replace('_', ' ')}: {price['reason']}" if price["reason"] else cells
        yield f"{'with ' + price['effect'].replace('_', ' '):<28}{answer}"
    yield ""
    if not best.dropped:
        yield f"no cheaper scene is within {found.tolerance:g}"
        return
    yield f"cheapest within {found.tolerance:g}: {', '.join(best.effects.names)}"
    yield f"that is: {best.label}"
    yield _line(found, best)
    ratio = best.row(found.full)["time_ratio"]
    yield f"largest change {best.largest:.2g}, {ratio:.2f} times as fast as the full scene"


def _line(found: Audit, row: Scene) -> str:
    label = f"{row.label if len(row.dropped) < 2 else 'all of these':<28}"
    if not row.size:
        return f"{label} {row.status.replace('_', ' ')}: {row.reason}"
    shown = row.row(found.full)
    cells = f"{cell(shown['trajectory'], 9)}{cell(shown['torque'], 9)}"
    cells += "".join(cell(shown[name], 10, sign="+") for name in ("swing_frequency", "first_mode", "loss"))
    extent = f"{shown['unknowns']:9d}{shown['degrees_of_freedom']:5d}"
    speed = f"{shown['highest_frequency_Hz']:12.4g}{shown['explicit_step_s']:9.1e}"
    return f"{label}{cells}{cell(shown['time_ratio'], 8, '.2g')}{extent}{speed}  {row.reason}".rstrip()
