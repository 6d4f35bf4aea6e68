"""Hold two to five designs, or models, against one another: a table of what counts, and curves on one page.

    python -m studies compare cross_axis_pivot spring_steel_pivot --rotation-deg 15
    python -m studies compare spring_steel_pivot --model spline,fe --plot models.svg
    python -m studies compare four_bar_of_flexures parallel_strip_guide --json -

Every case is solved by every model, as `solve` does, to the end of its own path unless --rotation-deg is
given; frequencies are those of `modes` at rest. A, B ... are the designs in their order, and the columns at
the right are over A. Variation is the largest less the smallest stiffness of the path over that at its begin;
safety, and from which rotation on a strip yields, are of cases with a yield strength. A dash: the design has
no such number. Exit code 0: all converged; 2: bad input; 3: one did not, and is told up to where it came.
"""

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.motion import Spectrum
from studies.answers.named import quantities_of
from studies.answers.quantities import NOTHING, QUANTITIES, STANDING, Scale
from studies.answers.response import Response
from studies.answers.settings import Settings
from studies.answers.strength import strength
from studies.cases.design import read_design
from studies.cases.effects import INERTIA
from studies.commands import arguments as take
from studies.commands.answer import called, deliver, draw, headed, not_estimated
from studies.commands.columns import by_row, plain, table
from studies.commands.parser import Argument, command
from studies.errors import BadInput
from studies.pictures.shown import LETTERS
from studies.record.progress import Bar, watched

#: Digits of a number; a variation below which a stiffness is constant but for round-off [1].
DIGITS, ROUND_OFF = 5, 1e-8
#: What `solve` prints of a path beside the lines of the table.
NOT_SHOWN = ("places", "stiffness of the body")
#: Lines of the table by their key in JSON.
ROWS = {
    "rotation_rad": Scale(heading="rotation, end", unit="deg", factor=180.0 / math.pi),
    **{q.key: replace(q, heading=f"{q.heading}, {q.standing}") for q in QUANTITIES if q.standing},
    "stiffness_begin_Nm_per_rad": Scale(heading="stiffness, begin", unit="N m/rad", highest=0),
    "stiffness_end_Nm_per_rad": Scale(heading="stiffness, end", unit="N m/rad", highest=0),
    "stiffness_variation": Scale(heading="stiffness, variation", factor=1.0),
    "largest_centre_shift_m": Scale(heading="centre shift, largest", unit="m", highest=-3),
    "safety": Scale(heading="safety to yield", factor=1.0),
    "yield_rotation_rad": Scale(heading="yields from", unit="deg", factor=180.0 / math.pi),
    "first_frequency_Hz": Scale(heading="first frequency", unit="Hz", highest=0),
}


class _Compared(NamedTuple):
    """One design by one model: its case, its path, and its modes at rest, None of what has no inertia."""

    case: str
    path: Response
    modes: Spectrum | None

    @property
    def name(self) -> str:
        """What it is called."""
        return called(self.case, self.path)

    @property
    def not_estimated(self) -> list[str]:
        """What has no estimated error."""
        unknown = [name for name in not_estimated(self.path) if name not in NOT_SHOWN]
        return unknown if self.modes is None else unknown + not_estimated(self.modes)

    def values(self) -> dict[str, float]:
        """Return its numbers by the keys of `ROWS`, NaN of those that it has not."""
        found = _values(self.path) if len(self.path.load_factor) else {}
        if self.modes is not None and len(self.modes.frequency):
            found["first_frequency_Hz"] = self.modes.frequency[0]
        known = {key: float(value) for key, value in found.items() if value is not None}
        return dict.fromkeys(ROWS, math.nan) | known


def _values(answer: Response) -> dict[str, Any]:
    """Return the numbers of a path by their keys."""
    limits, stiffness, shift = strength(answer), answer.stiffness, answer.shift
    found: dict[str, Any] = {
        **{q.key: STANDING[q.standing](values) for q, values in quantities_of(answer) if q.key in ROWS},
        "safety": limits.safety,
        "yield_rotation_rad": limits.yields and limits.yields.rotation,
        "rotation_rad": None if answer.body is None else answer.rotation[-1],
        "largest_centre_shift_m": None if shift is None else shift.max(),
    }
    if answer.driven:
        found["stiffness_begin_Nm_per_rad"], *_, found["stiffness_end_Nm_per_rad"] = stiffness
        variation = np.ptp(stiffness) / abs(stiffness[0])
        found["stiffness_variation"] = variation if variation > ROUND_OFF else 0.0
    return found


@command(
    Argument("cases CASE", "the designs: files, or names of the suite's", take.CASE.read, nargs="+"),
    *take.MODELS_OF,
    take.ROTATION.but("end of the paths, in deg (default: the cases')"),
    take.INCREMENTS,
    take.ACCURACY.but("wanted relative error of the paths, as of `solve` (default: that of `solve`)"),
    take.JSON,
    take.PLOT,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve all, report and draw; return the exit code. BadInput: answers that cannot be compared."""
    asked = [(case, settings) for case in arguments.cases for settings in take.chosen_settings(arguments)]
    if not 2 <= len(asked) <= len(LETTERS):
        got = f"{len(asked)} (designs: {len(arguments.cases)}, models: {len(arguments.model)})"
        raise BadInput(f"compare: got {got}, expected 2 to {len(LETTERS)} designs, or a design by two models")
    with Bar("compare") as bar:
        found = [_solved(case, settings, arguments) for case, settings in watched(asked, bar)]
    if arguments.plot is not None and all(len(each.path.load_factor) for each in found):
        draw(arguments, [(each.case, each.path) for each in found])
    failed = (f"{LETTERS[k]}: {e.path.message}" for k, e in enumerate(found) if not e.path.converged)
    document = {"designs": [_document(each) for each in found]}
    return deliver(arguments, document, _readable(found), failure="; ".join(failed))


def _document(found: _Compared) -> dict[str, Any]:
    """Return a design as the JSON of the command has it."""
    return {
        "name": found.name,
        "case": Path(found.case).name,
        **headed(found.path),
        "not_estimated": found.not_estimated,
        "estimate": found.path.estimate,
        **found.values(),
    }


def _solved(case: str, settings: Settings, arguments: argparse.Namespace) -> _Compared:
    design = take.driven(read_design(case, changes=arguments.effects), arguments)
    path, modes = answer_static(design, settings, accuracy=arguments.accuracy), None
    if set(INERTIA) & set(design.effects.names):
        modes = answer_modes(design, settings, count=1)
    return _Compared(case, path, modes)


def _readable(found: Sequence[_Compared]) -> Iterator[str]:
    """Yield the lines of the table: the key, then a row a quantity, and what the others are over A."""
    letters = LETTERS[: len(found)]
    for letter, each in zip(letters, found, strict=True):
        told = (each.path.status.replace("_", " "), *_remarks(each))
        yield f"{letter}: {each.name}, {'; '.join(told)}"
    every = [(letter, each.values()) for letter, each in zip(letters, found, strict=True)]
    shown = {k: scale for k, scale in ROWS.items() if any(math.isfinite(own[k]) for _, own in every)}
    (_, first), *others = every
    ratios = (plain(f"{name}/A", (_ratio(own[key], first[key]) for key in shown)) for name, own in others)
    yield from table([*by_row(shown, every, DIGITS), *ratios])


def _remarks(found: _Compared) -> Iterator[str]:
    """Yield the largest estimated error of a path, what has none, what was passed and what is unresolved."""
    answer, unknown = found.path, found.not_estimated
    error = answer.largest_error
    yield f"estimated error {error:.1e}" if math.isfinite(error) else "errors not estimated"
    if math.isfinite(error) and unknown:
        yield f"not estimated: {', '.join(unknown)}"
    yield from filter(None, [answer.message if answer.converged else "", answer.resolution])


def _ratio(value: float, first: float) -> str:
    return f"{value / first:.4g}" if math.isfinite(value) and math.isfinite(first) and first else NOTHING
