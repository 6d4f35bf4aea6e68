"""Commented case files to begin with, from the declarations that read them, to be solved as they are."""

from collections.abc import Iterable, Iterator

from studies.cases.effect_keys import EFFECTS
from studies.cases.effect_keys import KEYS as EFFECT_KEYS
from studies.cases.effects import DEFAULT
from studies.cases.keys import NAMED, SIDES
from studies.cases.page import MECHANISM, PIVOT
from studies.cases.rules import Choice, Key

#: Keys that may be left out and yet are shown in use: a section by its sides, a material by its name.
SHOWN = {NAMED.name, *(key.name for key in SIDES), "rotation_deg", "centre_offset_m"}
#: The effect that the template of a mechanism names beside the usual ones.
NAMES = "gravity"
#: Where the comments begin.
COLUMN = 36


def pivot() -> Iterator[str]:
    """Yield the lines of a pivot's case file."""
    yield "# A cross-axis flexural pivot. Lines that begin with # may be taken out or put into use."
    yield from _tables(PIVOT)
    yield from _scene([])


def mechanism() -> Iterator[str]:
    """Yield the lines of the case file of a mechanism: one strip with a body at its end."""
    yield "# A mechanism of strips and bodies: as many [[strips]] and [[bodies]] as it has."
    yield "# Lines that begin with # may be taken out or put into use."
    yield from _tables(MECHANISM)
    yield from _scene([NAMES])


def _tables(tables: dict[str, tuple[Key, ...]]) -> Iterator[str]:
    for title, keys in tables.items():
        yield ""
        yield title
        yield from _lines(keys)


def _lines(keys: Iterable[Key], prefix: str = "") -> Iterator[str]:
    """Yield a line for each key, with what it is; those that may be left out are comments."""
    for key in keys:
        used = not key.optional or key.name in SHOWN
        begin = f"{prefix if used else '# '}{key.name} = {key.example}"
        unit = f" [{key.unit}]" if key.unit not in ("", "1") else ""
        choice = f": {key.admitted}" if isinstance(key.rule, Choice) else ""
        default = "" if used else f"; left out: {key.default}"
        yield f"{begin:<{COLUMN}} # {key.meaning}{unit}{choice}{default}"


def _scene(named: list[str]) -> Iterator[str]:
    """Yield the scene, and the tables of all effects, those that are not named as comments."""
    yield ""
    yield f"# What acts: {', '.join(DEFAULT)} unless said otherwise, + adds to them."
    yield "[scene]"
    words = ", ".join(f'"+{name}"' for name in named or [NAMES])
    yield f"{'' if named else '# '}effects = [{words}]"
    for name, keys in EFFECT_KEYS.items():
        if name in DEFAULT or (not keys and name not in named):
            continue
        mark = "" if name in named else "# "
        yield ""
        yield f"# {name}: {EFFECTS[name]}"
        yield f"{mark}[effects.{name}]"
        yield from _lines(keys, mark)
