"""Compile the kernels of both models, once; later runs load them from the disk.

    python -m studies compile

`make setup` does this. The kernels are kept beside their sources. Nothing depends on it: what is not compiled
is compiled when it is first called, and commands and tests drop what was compiled from a source that has
changed since. Exit code 0.
"""

import argparse
import os
import sys
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from io import StringIO
from multiprocessing import get_context

from studies.__main__ import command_of
from studies.__main__ import main as called
from studies.answers.settings import SplineSettings
from studies.cases.design import SHIPPED
from studies.cases.problem import named_case
from studies.commands.arguments import OUT_FILE
from studies.commands.parser import command
from studies.record.files import forget, forget_stale, write_whole
from studies.registry import COMMANDS, STUDIES

CASE = "cross_axis_pivot"
#: What small calls of `solve` and `release` have in common, and their discretisations.
PATH = f"solve {CASE} --increments 1 --rotation-deg 5"
MODES = f"modes {CASE}"
MOTION = f"release {CASE} --no-check --rotation-deg 5 --duration 1e-5"
SPLINE, ELEMENTS = "--control-points 4", "--elements 4 --model"
#: Commands that between them enter every kernel: first what others stand on, then those of each process, the
#: longest first. What no command enters stands by the name of the function that does.
CALLS: tuple[tuple[tuple[str, ...], ...], ...] = (
    (
        (f"{PATH} --accuracy 1", f"{PATH} {SPLINE} --stretch consistent"),
        tuple(
            f"{words} {ELEMENTS} {model}" for model in ("fe", "fe-shear") for words in (PATH, MODES, MOTION)
        ),
    ),
    (
        (f"{MOTION} {SPLINE} --step 1e-8",),
        (f"{MOTION} {SPLINE} --step 1e-8 --integrator leapfrog",),
        ("impulses",),
        (f"{MOTION} {SPLINE} --step 1e-8 --effects=bending,stretching,body_inertia",),
        ("many",),
        (f"{MODES} {SPLINE}", f"{MODES} {SPLINE} --stretch consistent"),
    ),
)


@command()
def main(arguments: argparse.Namespace) -> int:
    """Enter every kernel, on two cores or more; return the exit code."""
    print("studies: compiling the kernels, once (about a minute) ...", file=sys.stderr, flush=True)
    begin = time.perf_counter()
    forget()
    forget_stale()  # nothing is left, but the source is marked
    workers = min(max(map(len, CALLS)), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        for calls in CALLS:
            list(pool.map(_enter, calls))
    print(f"studies: ready after {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return 0


def _enter(calls: tuple[str, ...]) -> None:
    """Run commands, whose answers nobody reads, and functions."""
    for call in calls:
        with redirect_stdout(StringIO()):
            code = FUNCTIONS[call]() if call in FUNCTIONS else called(call.split())
        if code:
            raise RuntimeError(f"{call}: got exit code {code}, expected 0")


def _many() -> None:
    """Solve several designs in one call."""
    import spline_model

    case = named_case(CASE)
    pivot = case.modelled(spline_model)
    spline_model.solve_many(pivot, {}, rotation=0.1, increments=1, section_depth=case.depth)


def _impulses() -> None:
    """Move the pivot by sequential impulses."""
    from spline_model.sequential_impulse import solve_impulses
    from studies.answers.models import put

    pivot = put(named_case(CASE), SplineSettings(control_points=4), moving=True).modelled
    for form in ("published", "stable"):
        solve_impulses(pivot, duration=1e-5, step=1e-6, form=form)


FUNCTIONS = {"many": _many, "impulses": _impulses}


#: Around the choices of each place: `$1` is the program and `$3` the word before the cursor.
SCRIPT = """\
if [ -n "$ZSH_VERSION" ]; then autoload -U +X bashcompinit && bashcompinit; fi
_crosspivot() {{
    local words
    if [ "$COMP_CWORD" = 1 ]; then words="{commands}"; else
        case "${{COMP_WORDS[1]}} $3" in
{places}
        esac
    fi
    COMPREPLY=($(compgen -W "$words" -- "$2") $(compgen -f -- "$2"))
}}
complete -o filenames -F _crosspivot crosspivot
"""


@command(OUT_FILE.but("write it there (default: the output stream)"))
def completion(arguments: argparse.Namespace) -> int:
    """Print a script that completes commands, options and names of `crosspivot` in bash and zsh.

        python -m studies completion --out crosspivot.sh

    Load the script in the start-up file of the shell: `source crosspivot.sh`. Then the tab key completes
    commands, options, their choices, cases, studies and files. Print the script again after an update of the
    package. Exit code 0: done; 2: bad input.
    """
    places = "\n".join(line for name in COMMANDS for line in _places(name))
    script = SCRIPT.format(commands=" ".join(COMMANDS), places=places)
    if arguments.out is None:
        print(script, end="")
    else:
        write_whole(arguments.out, script.encode())
    return 0


def _places(name: str) -> Iterator[str]:
    """Yield a line for each option with choices of a command, then the line of its other words."""
    words: list[str] = []
    for action in command_of(name)[1]._actions:
        words += action.option_strings or _names(action.dest)
        for option in action.option_strings if action.choices else ():
            yield _line(f'"{name} {option}"', action.choices or ())
    yield _line(f'"{name} "*', words)


def _line(pattern: str, words: Iterable[str]) -> str:
    return f'            {pattern}) words="{" ".join(words)}" ;;'


def _names(argument: str) -> list[str]:
    """Return the names of the suite that an argument accepts: cases or studies."""
    if argument in ("case", "cases"):
        return SHIPPED
    return sorted({*STUDIES, *(name.partition("/")[0] for name in STUDIES)}) if argument == "names" else []
