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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from studies.answers.settings import SplineSettings
from studies.commands import arguments as take
from studies.commands.answer import deliver, not_converged
from studies.commands.columns import numbers, plain, table
from studies.commands.parser import Argument, command, positive, whole_number
from studies.effects.audit import CHANGED, Audit, audit
from studies.effects.scenes import CHANGES, SIZES, Outcome
from studies.errors import Unanswered
from studies.record.progress import Bar

#: Headings of columns that are not called as in JSON.
HEADINGS = {
    "trajectory": "path",
    "swing_frequency": "swing",
    "first_mode": "1st mode",
    "time_ratio": "time",
    "degrees_of_freedom": "DOF",
    "highest_frequency_Hz": "highest Hz",
    "explicit_step_s": "step s",
}


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
        "full": found.row(found.full),
        "rows": [found.row(row) for row in found.rows],
        "tried": [found.row(row) for row in found.tried],
        "beyond": found.beyond,
        "cheapest": found.row(found.cheapest),
        "full_wall_s": found.full.wall_s,
    }


def _readable(found: Audit) -> Iterator[str]:
    """Yield the lines of a table, and the cheapest scene."""
    run, best = found.run, found.cheapest
    yield f"full scene: {', '.join(found.full.variant.effects.names)}"
    yield f"static path and {1e3 * run.duration:.3g} ms of motion in steps of {run.step:.2g} s; changes to it"
    yield from _scenes(found, (found.full, *found.rows))
    yield ""
    labels = ("with " + price["effect"].replace("_", " ") for price in found.beyond)
    yield from _table("neglected by planar beams", labels, found.beyond, CHANGED)
    yield ""
    if not best.variant.dropped:
        yield f"no cheaper scene is within {found.tolerance:g}"
        return
    yield f"cheapest within {found.tolerance:g}: {', '.join(best.variant.effects.names)}"
    yield f"that is: {best.variant.label}"
    yield from _scenes(found, (best,))
    ratio = found.row(best)["time_ratio"]
    yield f"largest change {best.largest:.2g}, {ratio:.2f} times as fast as the full scene"


def _scenes(found: Audit, outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield the lines of a table of scenes, several effects without their names."""
    labels = (each.variant.label if len(each.variant.dropped) < 2 else "all of these" for each in outcomes)
    rows = [found.row(each) for each in outcomes]
    return _table("scene", labels, rows, (*CHANGES, "time_ratio", *SIZES))


def _table(
    title: str, labels: Iterable[str], rows: Sequence[Mapping[str, Any]], keys: Sequence[str]
) -> Iterator[str]:
    """Yield the lines of a table of numbers by their keys, with how and why a row ended that has none."""
    status = (row["status"].replace("_", " ").replace("converged", "") for row in rows)
    said = (": ".join(filter(None, (ended, row["reason"]))) for ended, row in zip(status, rows, strict=True))
    columns = (numbers(HEADINGS.get(key, key), (row[key] for row in rows), ".3g") for key in keys)
    return table([plain(title, labels, left=True), *columns, plain("", said, left=True)])
