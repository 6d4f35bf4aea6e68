"""Print a commented case file to begin with, which can be solved as it is.

    python -m studies case --pivot --out my_design.toml
    python -m studies case --mechanism

Every key that a case may have is in it, with its meaning, its unit and its default;
docs/cases.md contains the same with the rules. Exit code 0: done; 2: bad input.
"""

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence

from studies.cases import keys
from studies.cases.effects import DEFAULT
from studies.cases.rules import Key
from studies.commands.arguments import OUT_FILE
from studies.commands.parser import Argument, command
from studies.errors import BadInput
from studies.record.files import write_whole

#: Optional keys that are nevertheless shown in use: a section by its sides, a material by its name.
SHOWN = {keys.NAMED.name, *(key.name for key in keys.SIDES), "rotation_deg", "centre_offset_m"}
#: The effect that the template of a mechanism names beside the usual ones.
NAMES = "gravity"
#: Where the comments begin.
COLUMN = 36
#: Tables of a pivot's file, and of a mechanism's, in the order of a file, with their keys.
PIVOT = {f"[{section}]": rows for section, rows in keys.PIVOT.items()}
MECHANISM = {f"[[{s}]]" if s in ("strips", "bodies") else f"[{s}]": r for s, r in keys.MECHANISM.items()}


@command(
    Argument("--pivot", "of a cross-axis pivot (default)"),
    Argument("--mechanism", "of any mechanism of strips and bodies"),
    OUT_FILE.but("write it there (default: the output stream)"),
)
def main(arguments: argparse.Namespace) -> int:
    """Print or write the template; return the exit code. BadInput: both kinds, or a file with other
    content."""
    if arguments.pivot and arguments.mechanism:
        raise BadInput("case: got --pivot and --mechanism, expected one of them")
    text = "\n".join(_template(mechanism=arguments.mechanism))
    if arguments.out is None:
        print(text)
        return 0
    written = f"{text}\n".encode()
    if arguments.out.is_file() and arguments.out.read_bytes() != written:
        raise BadInput(f"--out: got {arguments.out}, which holds something else, expected a new file")
    write_whole(arguments.out, written)
    print(f"{arguments.out}: written; `python -m studies solve {arguments.out}`")
    return 0


def _template(*, mechanism: bool) -> Iterator[str]:
    """Yield the lines of a case file to begin with, which can be solved as it is: of a pivot, or of a
    mechanism of one strip with a body at its end."""
    yield "# A mechanism of strips and bodies." if mechanism else "# A cross-axis flexural pivot."
    yield "# Lines that begin with # may be deleted or put into use; tables in [[ ]] may be repeated."
    for title, rows in (MECHANISM if mechanism else PIVOT).items():
        yield from ("", title, *_template_lines(rows))
    yield ""
    yield f"# What acts: {', '.join(DEFAULT)} unless said otherwise, + adds to them."
    yield "[scene]"
    yield f'{"" if mechanism else "# "}effects = ["+{NAMES}"]'
    for name, rows in keys.EFFECT_KEYS.items():
        used = mechanism and name == NAMES
        if used or (rows and name not in DEFAULT):
            mark = "" if used else "# "
            yield from ("", f"# {name}: {keys.EFFECTS[name]}", f"{mark}[effects.{name}]")
            yield from _template_lines(rows, mark)


def _template_lines(rows: Iterable[Key], prefix: str = "") -> Iterator[str]:
    """Yield a line for each key, with what it is; optional keys are comments."""
    for key in rows:
        used = not key.optional or key.name in SHOWN
        begin = f"{prefix if used else '# '}{key.name} = {key.example}"
        unit = f" [{key.unit}]" if key.unit not in ("", "1") else ""
        choice = f": {key.admitted}" if key.rule.kind == "choice" else ""
        default = "" if used else f"; default: {key.default}"
        yield f"{begin:<{COLUMN}} # {key.meaning}{unit}{choice}{default}"


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a table of Markdown."""
    yield f"| {' | '.join(head)} |"
    yield f"|{'---|' * len(head)}"
    yield from (f"| {' | '.join(row)} |" for row in rows)


def _mechanism() -> Iterator[str]:
    """Yield the tables of a mechanism's keys."""
    yield from _tables(MECHANISM | {"[[points]]": keys.POINT})
    own = ", ".join(f"`{key.name}`" for key in keys.OWN)
    yield ""
    yield f"A strip may also have, in place of what `[section]` and `[material]` say of all: {own}."


def _effects() -> Iterator[str]:
    """Yield the table of effects, and that of the keys of their parameters."""
    acts = {name: "unless taken out" if name in DEFAULT else "where it is named" for name in keys.EFFECTS}
    rows = ((f"`{name}`", meaning, acts[name]) for name, meaning in keys.EFFECTS.items())
    yield from markdown(("effect", "what it is", "in a scene"), rows)
    yield ""
    listed = {name: f"`, `[[{section}]]" for section, effects in keys.LISTS.items() for name in effects}
    titles = {f"[effects.{n}]{listed.get(n, '')}": rows for n, rows in keys.EFFECT_KEYS.items() if rows}
    yield from _tables(titles)


def _materials() -> Iterator[str]:
    """Yield the table of materials."""
    head = (
        "name",
        "E [GPa]",
        "Poisson's ratio [1]",
        "density [kg/m^3]",
        "yield strength [MPa]",
        "what, source",
    )
    rows = []
    for name, given in keys.MATERIALS.items():
        strength = f"{given['yield_strength'] / 1e6:g}" if "yield_strength" in given else "none"
        elastic = f"{given['youngs_modulus'] / 1e9:g}", f"{given['poisson_ratio']:g}", f"{given['density']:g}"
        said = f"{given['title']}. {given['source']}. Found again: {given['checked']}"
        rows.append((f"`{name}`", *elastic, strength, said))
    return markdown(head, rows)


#: Tables of the page of case files, by the names of their places.
PAGE: dict[str, Callable[[], Iterator[str]]] = {
    "keys of a pivot": lambda: _tables(PIVOT),
    "keys of a mechanism": _mechanism,
    "effects": _effects,
    "materials": _materials,
}


def _tables(tables: dict[str, tuple[Key, ...]]) -> Iterator[str]:
    """Yield a heading and a table of keys for each table of a file."""
    for place, (title, rows) in enumerate(tables.items()):
        yield from ("",) * min(place, 1)
        yield from (f"`{title}`", "")
        defaults = {key.name: key.default if key.optional else "refused" for key in rows}
        yield from markdown(
            ("key", "unit", "rule", "default", "meaning"),
            ((f"`{k.name}`", k.unit or "-", k.admitted, defaults[k.name], k.meaning) for k in rows),
        )
