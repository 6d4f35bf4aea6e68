"""Print a script that completes commands, options and names of `crosspivot` in bash and zsh.

    python -m studies completion --out crosspivot.sh

Load the script in the start-up file of the shell: `source crosspivot.sh`. Then the tab key completes
commands, options, their choices, cases, studies and files. Print the script again after an update of the
package. Exit code 0: done; 2: bad input.
"""

import argparse
from collections.abc import Iterable, Iterator

from studies.__main__ import command_of
from studies.cases.problem import FOLDER
from studies.commands.arguments import OUT_FILE
from studies.commands.parser import command
from studies.record.files import write_whole
from studies.registry import COMMANDS, STUDIES

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
def main(arguments: argparse.Namespace) -> int:
    """Print or write the script; return the exit code."""
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
