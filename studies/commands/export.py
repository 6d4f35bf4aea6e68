"""Solve a design and write its deformed shapes, section forces and reactions for other programs.

    python -m studies export cross_axis_pivot --out exported
    python -m studies export four_bar_of_flexures --model fe --analysis modes --out modes
    python -m studies export my_pivot.toml --analysis release --duration 0.01 --out swing

vtk: NAME.pvd, which ParaView opens as one series, with NAME_0000.vtu ... for the states; csv, parquet: tables
NAME_states, NAME_strips, NAME_bodies, NAME_reactions. NAME is the analysis: static, release or modes.
docs/data.md describes the files; the names of columns and arrays contain the units. The folder must be new or
empty, or hold a former export, which is replaced as a whole: nothing is ever half-written. Exit code 0: done;
2: bad input; 3: not converged, and then the converged part of a path or a motion is written.
"""

import argparse
import dataclasses
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.answer import Answer
from studies.answers.settings import Settings
from studies.commands import answer as tell
from studies.commands import arguments as take
from studies.commands.parser import Argument, command, names_of, whole_number
from studies.errors import BadInput
from studies.exchange.formats import FORMATS, require_own, write
from studies.record.progress import Bar

#: Options that belong to one analysis, with their defaults; given for another they are refused.
OPTIONS: dict[str, dict[str, Any]] = {
    "static": {"increments": None},
    "release": {"duration": 0.05, "step": None, "integrator": None, "records": 200},
    "modes": {"count": 6, "held": False},
}
RECORDS = Argument("--records R", "release: largest number of states, default 200", whole_number(1))


@command(
    *take.MODEL,
    take.OUT.but("new, empty, or of a former export", required=True),
    Argument(
        "--formats LIST",
        f"of {', '.join(FORMATS)}, separated by commas, default vtk",
        names_of(FORMATS),
        default=("vtk",),
    ),
    Argument("--analysis", "what is solved, default static", choices=list(OPTIONS), default="static"),
    take.ROTATION.but(
        "end of the path, start of the motion, or state of the modes, in deg "
        "(default: the case's; of modes 0)"
    ),
    *(
        each.but(group="of one analysis")
        for each in (
            take.INCREMENTS.but("static: of the path (default: the case's)"),
            take.DURATION.but("release: in s, default 0.05"),
            take.STEP.but("release: in s (default: the integrator's)"),
            take.INTEGRATOR.but("release: as of `release` (default: the model's)"),
            RECORDS,
            take.COUNT.but("modes: number of modes, default 6", default=None),
            take.HELD.but("modes: hold the rotation of the body", default=None),
        )
    ),
)
def main(arguments: argparse.Namespace) -> int:
    """Solve and write; return the exit code. BadInput: options of another analysis."""
    design = take.driven(take.chosen_design(arguments), arguments)
    if arguments.analysis == "modes" and arguments.rotation is None:
        design = dataclasses.replace(design, rotation=0.0)  # modes are at rest unless they say more
    own = _own_options(arguments)
    require_own(arguments.out)

    def ask(settings: Settings, bar: Bar) -> Answer:
        if arguments.analysis == "static":
            return answer_static(design, settings, progress=bar)
        if arguments.analysis == "release":
            return answer_release(design, settings, swings=False, **own)
        return answer_modes(design, settings, rotation=design.rotation, **own)

    def written(answers: list[Answer]) -> Iterator[str]:
        (answer,) = answers
        if answer.solution is None:
            return
        files = {name: each for form in arguments.formats for name, each in FORMATS[form](answer).items()}
        write(arguments.out, files, answer, Path(arguments.case).name)
        yield from (tell.described(answer), *tell.estimated(answer))
        yield from filter(None, [answer.resolution])
        yield f"{arguments.out}: {len(answer.values)} states of {answer.analysis} in {len(files)} files"

    return tell.asked(arguments, ask, lambda answer: {}, written)


def _own_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of the analysis; those of another are an error."""
    for analysis, options in OPTIONS.items():
        for name in options:
            if analysis != arguments.analysis and getattr(arguments, name) is not None:
                raise BadInput(
                    f"{take.option(name)}: got it with --analysis {arguments.analysis}, expected {analysis}"
                )
    own = OPTIONS[arguments.analysis]
    given = {name: getattr(arguments, name) for name in own}
    return {name: own[name] if value is None else value for name, value in given.items()}
