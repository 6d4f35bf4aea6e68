"""The tables of the page of case files, from the declarations that read the files."""

from collections.abc import Iterable, Iterator

from studies.cases.effect_keys import EFFECTS
from studies.cases.effect_keys import KEYS as EFFECT_KEYS
from studies.cases.effects import DEFAULT
from studies.cases.keys import BODY, DRIVE, KEYS, MATERIAL, OWN, SECTION, STRIP
from studies.cases.materials import MATERIALS
from studies.cases.rules import Key

#: Tables of a pivot's file, and of a mechanism's, in the order of a file, with their keys.
PIVOT: dict[str, tuple[Key, ...]] = {
    f"[{section}]": tuple(key for key in KEYS if key.section == section)
    for section in dict.fromkeys(key.section for key in KEYS)
}
MECHANISM: dict[str, tuple[Key, ...]] = {
    "[[strips]]": STRIP,
    "[[bodies]]": BODY,
    "[section]": SECTION,
    "[material]": MATERIAL,
    "[drive]": DRIVE,
}


def pivot() -> Iterator[str]:
    """Yield the tables of a pivot's keys."""
    yield from _tables(PIVOT)


def mechanism() -> Iterator[str]:
    """Yield the tables of a mechanism's keys."""
    yield from _tables(MECHANISM)
    own = ", ".join(f"`{key.name}`" for key in OWN)
    yield ""
    yield f"A strip may also have, in place of what `[section]` and `[material]` say of all: {own}."


def effects() -> Iterator[str]:
    """Yield the table of effects, and that of the keys of their parameters."""
    yield "| effect | what it is | in a scene |"
    yield "|---|---|---|"
    for name, meaning in EFFECTS.items():
        yield f"| `{name}` | {meaning} | {'unless taken out' if name in DEFAULT else 'where it is named'} |"
    yield from _tables({f"[effects.{name}]": keys for name, keys in EFFECT_KEYS.items() if keys})


def materials() -> Iterator[str]:
    """Yield the table of materials."""
    yield "| name | E [GPa] | Poisson's ratio [1] | density [kg/m^3] | yield strength [MPa] | what, source |"
    yield "|---|---:|---:|---:|---:|---|"
    for name, given in MATERIALS.items():
        strength = "none" if given.yield_strength is None else f"{given.yield_strength / 1e6:g}"
        numbers = f"{given.youngs_modulus / 1e9:g} | {given.poisson_ratio:g} | {given.density:g} | {strength}"
        said = f"{given.title}. {given.source}. Found again: {given.checked}"
        yield f"| `{name}` | {numbers} | {said} |"


def _tables(tables: dict[str, tuple[Key, ...]]) -> Iterator[str]:
    """Yield a heading and a table of keys for each table of a file."""
    for place, (title, keys) in enumerate(tables.items()):
        if place:
            yield ""
        yield f"`{title}`"
        yield ""
        yield from _rows(keys)


def _rows(keys: Iterable[Key]) -> Iterator[str]:
    yield "| key | unit | rule | where it is left out | meaning |"
    yield "|---|---|---|---|---|"
    for key in keys:
        default = key.default if key.optional else "refused"
        yield f"| `{key.name}` | {key.unit or '-'} | {key.admitted} | {default} | {key.meaning} |"
