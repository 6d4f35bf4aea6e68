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
from dataclasses import replace
from multiprocessing import get_context

from studies.__main__ import command_of
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.problem import FOLDER, Problem
from studies.commands.arguments import OUT_FILE
from studies.commands.parser import command
from studies.record.files import forget, forget_stale, write_whole
from studies.registry import COMMANDS, STUDIES

MIXED, CONSISTENT = SplineSettings(control_points=4), SplineSettings(control_points=4, stretch="consistent")
ELEMENTS = FeSettings(elements=4)
#: Small calls that between them enter every kernel, settings and what is solved with them: first what others
#: stand on, one a process, then the rest, the longest first.
CALLS: tuple[tuple[tuple[Settings, tuple[str, ...]], ...], ...] = (
    (
        (MIXED, ("accuracy", "many")),
        (MIXED, ("energy from rest",)),
    ),
    (
        (ELEMENTS, ("static", "modes", "central-difference")),
        (MIXED, ("sequential impulses",)),
        (MIXED, ("leapfrog",)),
        (MIXED, ("massless", "modes")),
        (replace(ELEMENTS, element="reissner"), ("static", "modes", "central-difference")),
        (CONSISTENT, ("static", "modes")),
        (MIXED, ("energy",)),
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
            list(pool.map(_call, *zip(*calls, strict=True)))
    print(f"studies: ready after {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return 0


def _call(settings: Settings, tasks: tuple[str, ...]) -> None:
    """Solve something small by a model: statics, modes, and releases by integrators."""
    from spline_model.batch import solve_many
    from spline_model.sequential_impulse import solve_impulses
    from studies.answers.adapters import answer_modes, answer_release, answer_static
    from studies.answers.models import put
    from studies.cases.effects import Effects
    from studies.cases.problem import named_case

    problem = replace(named_case("cross_axis_pivot"), rotation=0.1, increments=1)
    for task in tasks:
        if task in ("static", "accuracy"):
            answer_static(problem, settings, accuracy=1.0 if task == "accuracy" else None)
        elif task == "many":
            solve_many(problem.pivot_parameters(), rotation=0.1, increments=1, section_depth=problem.depth)
        elif task == "modes":
            answer_modes(problem, settings)
        elif task == "sequential impulses":
            pivot = put(problem, settings, moving=True).modelled
            for form in ("published", "stable"):
                solve_impulses(pivot, duration=1e-5, step=1e-6, form=form)
        elif task == "energy from rest":
            _from_rest(problem, settings)
        elif task == "massless":
            light = replace(problem, effects=Effects(names=("bending", "stretching", "body_inertia")))
            answer_release(light, settings, duration=1e-5, integrator="energy", step=1e-8)
        else:
            answer_release(problem, settings, duration=1e-5, integrator=task, step=1e-8)


def _from_rest(problem: Problem, settings: Settings) -> None:
    """Enter the default motion without statics, which another process compiles."""
    import numpy as np

    from spline_model.compile import compile_scene
    from spline_model.motion.energy_consistent import Stepper
    from spline_model.motion.start import Start, set_in_motion
    from spline_model.solution import Later
    from studies.answers.models import put

    pivot = put(problem, settings, moving=True).modelled.in_motion()
    motion = set_in_motion(compile_scene(pivot.released()))
    start = Start(motion, Later(motion.system.rest[None].copy), np.zeros(len(motion.system.mass)))
    stepper = Stepper(start)
    stepper.take(0.0, 1e-8, 0, 4, 1, np.empty((4, stepper.width)))


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
        return sorted(path.stem for path in FOLDER.glob("*.toml"))
    return sorted({*STUDIES, *(name.partition("/")[0] for name in STUDIES)}) if argument == "names" else []
