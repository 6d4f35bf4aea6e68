"""Hold two to five designs, or models, against one another: a table of what counts, and curves on one page.

    python -m studies compare cross_axis_pivot spring_steel_pivot --rotation-deg 15
    python -m studies compare spring_steel_pivot --model spline,fe --plot models.svg
    python -m studies compare four_bar_of_flexures parallel_strip_guide --json -
    python -m studies compare titanium_pivot spring_steel_pivot --plot-modes modes.svg

Every case is solved by every model, as `solve` does, to the end of its own path unless --rotation-deg is
given; frequencies are those of `modes` at rest, whose first six --plot-modes draws over one another. A, B
... are the designs in their order, and the columns at the right are over A. Variation is the largest less the
smallest stiffness of the path over that at its begin; safety, and from which rotation on a strip yields, are
of cases with a yield strength. A dash: the design has no such number. Exit code 0: all converged; 2: bad
input; 3: one did not, and is told up to where it came.
"""

import argparse
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from studies.answers.adapters import answer_modes, answer_static
from studies.answers.fields import fields_of
from studies.answers.response import Response
from studies.answers.settings import Settings
from studies.answers.strength import strength
from studies.cases.design import Design, read_design
from studies.commands import arguments as take
from studies.commands.answer import PLOT, called, deliver, draw, require_target, weakest
from studies.commands.columns import NOTHING, PREFIXES, plain, quantity, table
from studies.commands.parser import Argument, command
from studies.errors import BadInput
from studies.kinds import Array
from studies.pictures.shown import LETTERS, Shown
from studies.record.progress import Bar

#: Digits of a number; a variation below which a stiffness is constant but for round-off [1].
DIGITS, ROUND_OFF = 5, 1e-8
#: Modes that are drawn.
MODES = 6
PLOT_MODES = Argument(
    "--plot-modes",
    **PLOT.keywords
    | {"help": "draw the first six natural modes at rest over one another (default: no picture)"},
)


@dataclass(frozen=True, kw_only=True)
class Compared:
    """One design by one model.

    Attributes:
        name: in the key of table and picture; case, design: it is of; answer: its path.
        shown: what follows from it; None of a path without a state.
        modes: the natural modes at rest; None where statics does not hold the rest.
        beside: values of the lines that are not of what is shown, by their keys.
    """

    name: str
    case: str
    design: Design
    answer: Response
    shown: Shown | None
    modes: Shown | None
    beside: dict[str, float]


class Row(NamedTuple):
    """A line of the table: what it is called there and in JSON, its unit, and what it is of what is shown."""

    name: str
    key: str
    unit: str = ""
    of: Callable[[Shown], float] = lambda each: math.nan
    highest: int = 0


def _end(values: Array | None, state: int = -1) -> float:
    return math.nan if values is None else float(values[state])


def _largest(values: Array | None) -> float:
    return math.nan if values is None else float(values.max())


def _variation(shown: Shown) -> float:
    stiffness = shown.fields.stiffness
    if stiffness is None:
        return math.nan
    variation = float(np.ptp(stiffness) / abs(stiffness[0]))
    return variation if variation > ROUND_OFF else 0.0


ROWS = (
    Row("rotation, end", "rotation_rad", "deg", lambda each: _end(each.rotation)),
    Row("torque, end", "torque_Nm", "N m", lambda each: _end(each.fields.torque)),
    Row(
        "stiffness, begin",
        "stiffness_begin_Nm_per_rad",
        "N m/rad",
        lambda each: _end(each.fields.stiffness, 0),
    ),
    Row("stiffness, end", "stiffness_end_Nm_per_rad", "N m/rad", lambda each: _end(each.fields.stiffness)),
    Row("stiffness, variation", "stiffness_variation", "", _variation),
    Row("centre shift, largest", "largest_centre_shift_m", "m", lambda each: _largest(each.shift), -3),
    Row("stress, largest", "max_stress_Pa", "Pa", lambda each: _largest(each.fields.max_stress), 6),
    Row("strain energy, end", "strain_energy_J", "J", lambda each: _end(each.fields.strain_energy)),
)
#: Lines that are not of what a picture shows.
SAFETY, YIELDS, FREQUENCY = BESIDE = (
    Row("safety to yield", "safety"),
    Row("yields from", "yield_rotation_rad", "deg"),
    Row("first frequency", "first_frequency_Hz", "Hz"),
)


@command(
    Argument(
        "cases",
        metavar="CASE",
        nargs="+",
        type=take.CASE.keywords["type"],
        help="the designs: files, or names of those that come with the suite",
    ),
    *(each for each in take.SEVERAL_MODELS if each is not take.CASE),
    take.ROTATION.but(help="end of the paths, in deg (default: the cases')"),
    take.INCREMENTS,
    take.ACCURACY.but(help="wanted relative error of the paths, as of `solve` (default: that of `solve`)"),
    take.JSON,
    PLOT,
    PLOT_MODES,
)
def main(arguments: argparse.Namespace) -> int:
    """Solve all, report and draw; return the exit code."""
    asked = [(case, settings) for case in arguments.cases for settings in take.all_settings(arguments)]
    if not 2 <= len(asked) <= len(LETTERS):
        got = f"{len(asked)} (designs: {len(arguments.cases)}, models: {len(arguments.model)})"
        raise BadInput(f"compare: got {got}, expected 2 to {len(LETTERS)} designs, or a design by two models")
    require_target(arguments)
    with Bar("compare") as bar:
        found = []
        for done, (case, settings) in enumerate(asked, start=1):
            found.append(_solved(case, settings, arguments))
            bar(done, len(asked))
    for target, parts in (
        (arguments.plot, [each.shown for each in found]),
        (arguments.plot_modes, [each.modes for each in found]),
    ):
        if target is not None and None not in parts:
            draw(arguments, [each for each in parts if each is not None], target)
    failed = (
        f"{LETTERS[k]}: {each.answer.message}" for k, each in enumerate(found) if not each.answer.converged
    )
    return deliver(arguments, _document(found), _readable(found), failure="; ".join(failed) or None)


def _document(found: Sequence[Compared]) -> dict[str, Any]:
    """Return the answer as the JSON object of the command."""
    return {
        "designs": [
            {
                "name": each.name,
                "case": Path(each.case).name,
                "model": each.answer.model,
                "settings": each.answer.settings,
                "status": each.answer.status,
                "message": each.answer.message,
                **{row.key: _value(row, each) for row in (*ROWS, *BESIDE)},
            }
            for each in found
        ]
    }


def _solved(case: str, settings: Settings, arguments: argparse.Namespace) -> Compared:
    design = take.driven(read_design(case, changes=arguments.effects), arguments)
    accuracy = arguments.accuracy
    answer = answer_static(design, settings, accuracy=accuracy)
    spectrum = answer_modes(design, settings, count=1 if arguments.plot_modes is None else MODES)
    name, shown, modes, beside = called(case, answer), None, None, {}
    if len(answer.load_factor):
        shown = Shown(name=name, fields=fields_of(answer, design), yield_strength=weakest(design))
        found = strength(design, answer)
        beside[SAFETY.key] = math.nan if found.safety is None else found.safety
        beside[YIELDS.key] = math.nan if found.yields is None else found.yields[1]
    if len(spectrum.frequency):
        beside[FREQUENCY.key] = float(spectrum.frequency[0])
        modes = Shown(name=called(case, spectrum), fields=fields_of(spectrum, design))
    return Compared(
        name=name, case=case, design=design, answer=answer, shown=shown, modes=modes, beside=beside
    )


def _value(row: Row, each: Compared) -> float:
    if row in BESIDE:
        return each.beside.get(row.key, math.nan)
    return math.nan if each.shown is None else row.of(each.shown)


def _readable(found: Sequence[Compared]) -> Iterator[str]:
    """Yield the lines of the table: the key, then a row a quantity, and what the others are over A."""
    letters = LETTERS[: len(found)]
    for letter, each in zip(letters, found, strict=True):
        yield f"{letter}: {each.name}, {each.answer.status.replace('_', ' ')}"
    rows = [(row, [_value(row, each) for each in found]) for row in (*ROWS, *BESIDE)]
    rows = [(row, values) for row, values in rows if np.isfinite(values).any()]
    cells = [_cells(row, values) for row, values in rows]
    columns = [
        plain("", (f"{row.name:<22}" for row, _ in rows)),
        plain("unit", (unit for unit, _ in cells)),
        *(plain(letter, (texts[k] for _, texts in cells)) for k, letter in enumerate(letters)),
        *(
            plain(f"{letter}/A", (_ratio(values[k], values[0]) for _, values in rows))
            for k, letter in enumerate(letters)
            if k
        ),
    ]
    yield from (line for line in table(columns) if line.strip())


def _cells(row: Row, values: list[float]) -> tuple[str, list[str]]:
    """Return the unit of a row, with its prefix, and its numbers."""
    if row.unit == "deg":
        return row.unit, [_short(math.degrees(value)) for value in values]
    if not row.unit:
        return "", [_short(value) for value in values]
    (column,) = quantity(row.unit, highest=row.highest, values=values)
    power = {prefix: power for power, prefix in PREFIXES.items()}[column.unit.removesuffix(row.unit)]
    return column.unit, [_short(value / 10.0**power) for value in values]


def _short(value: float) -> str:
    return f"{value:.{DIGITS}g}" if math.isfinite(value) else NOTHING


def _ratio(value: float, first: float) -> str:
    return f"{value / first:.4g}" if math.isfinite(value) and math.isfinite(first) and first else NOTHING
