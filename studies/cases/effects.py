"""The effects of a scene as case files and the command line name them, with the units of their parameters.

A table `[effects.NAME]` gives the parameters of an effect that the scene names, in the case file or by
`--effects=+NAME`; parameters of an effect that is not named are an error, so that no load is
forgotten.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any

from studies.cases import document
from studies.cases.document import CaseError
from studies.cases.keys import EFFECT_KEYS, LISTS, REPEATED
from studies.cases.rules import shown
from studies.errors import BadInput

DEFAULT = ("bending", "stretching", "strip_inertia", "body_inertia")

#: Effects that a static path never asks for, and of them those without one of which nothing moves.
INERTIA = ("strip_inertia", "section_rotary_inertia", "body_inertia")
MOTION_ONLY = (
    *INERTIA,
    "strip_damping",
    "strip_drag",
    "body_damping",
)

#: Effects of the third dimension: they know the sides of a section.
OF_SIDES = ("clamped_width", "anticlastic", "root_compliance")

#: How a scene is named.
WORDS = "+NAME and -NAME, or names alone"

#: Parameters that an effect has where nothing is said.
STANDARD: dict[str, dict[str, Any]] = {
    "gravity": {"acceleration": (0.0, -9.81)},
    "tip_force": {"force": (0.0, 0.0)},
}
#: Loads and drives, which grow along a path, and their parameters that do.
GROWING = {
    "applied_force": ("force",),
    "applied_moment": ("moment",),
    "tip_force": ("force", "moment"),
    "driven_displacement": ("displacement",),
    "driven_rotation": ("angle",),
}

Table = Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Effects:
    """The effects of a case, in order, and the parameters of the effects that have any.

    Attributes:
        names: of the effects.
        tables: effect -> parameter -> value in SI units, also of effects that the case does not name; for an
            effect that acts several times, a tuple of such mappings.
    """

    names: tuple[str, ...] = DEFAULT
    tables: Mapping[str, Table | tuple[Table, ...]] = field(default_factory=dict, hash=False)

    def every(self, name: str) -> tuple[Table, ...]:
        """Return the parameters of each instance of an effect; an empty table if it has none."""
        given = self.tables.get(name, {})
        return given if isinstance(given, tuple) else (given,)

    def acting(self, name: str) -> tuple[Table, ...]:
        """Return the parameters of each instance of an effect that the case names; () for other effects."""
        return self.every(name) if name in self.names else ()

    def parameters(self) -> dict[str, Any]:
        """Return the parameters of the named effects in SI units, with the defaults."""
        every = {
            name: [STANDARD.get(name, {}) | dict(own) for own in self.every(name)] for name in self.names
        }
        return {name: _alone(own) for name, own in every.items() if any(own)}

    def grown(self, factor: float, more: Mapping[str, tuple[str, ...]] | None = None) -> "Effects":
        """Return the effects with all loads and drives, and `more` parameters by effect, times a factor
        [1]."""
        growing = GROWING | dict(more or {})

        def grow(name: str, own: Table) -> Table:
            keys = growing.get(name, ())
            return {key: _times(value, factor) if key in keys else value for key, value in own.items()}

        return self.each(grow)

    def each(self, change: Callable[[str, Table], Table]) -> "Effects":
        """Return the effects with other parameters of every instance, by a function of its name and
        parameters."""
        every = {name: [change(name, own) for own in self.every(name)] for name in self.tables}
        return replace(self, tables={name: _alone(own) for name, own in every.items()})

    def renamed(self, names: Sequence[str]) -> "Effects":
        """Return the effects with other names and the same tables."""
        return replace(self, names=tuple(names))

    def plus(self, *names: str, **tables: Table | tuple[Table, ...]) -> "Effects":
        """Return the effects with additional ones, and the tables of those that have parameters."""
        every = dict.fromkeys((*self.names, *names, *tables))
        return replace(self, names=tuple(every), tables={**self.tables, **tables})

    def changed(self, text: str) -> "Effects":
        """Return the effects after "+gravity,-strip_inertia", or for the whole list "bending,stretching".

        Raises:
            BadInput: an unknown effect, one that is added twice or removed without being there, signs on
                some names only, or an effect without a parameter that it needs.
        """
        words = [word.strip() for word in text.split(",") if word.strip()]
        if not words:
            raise BadInput(f"--effects: got {text!r}, expected {WORDS}, with commas")
        scene = self.renamed(_names_after("--effects", words, self.names))
        _require_parameters("--effects", scene)
        return scene


def _alone(every: Sequence[Table]) -> Any:
    """Return the parameters of the instances of an effect: a table for each of several, or the only one."""
    return tuple(every) if len(every) > 1 else every[0]


def _names_after(where: str, words: Sequence[str], present: Sequence[str]) -> tuple[str, ...]:
    """Return the effects that `words` stand for: names alone are all, +NAME and -NAME change `present`.

    Raises:
        BadInput: an unknown effect, one that is there already or not there, or signs on some names only.
    """
    signed = [word for word in words if word.startswith(("+", "-"))]
    if signed and len(signed) < len(words):
        raise BadInput(f"{where}: got {shown(','.join(words))}, expected {WORDS}")
    names = list(present) if signed else []
    for word in words:
        name = word[1:] if signed else word
        require_known(where, name)
        if word.startswith("-"):
            if name not in names:
                raise BadInput(f"{where}: got {word}, expected one of {', '.join(names)}, which are there")
            names.remove(name)
        elif name in names:
            raise BadInput(f"{where}: got {word}, expected an effect beside {', '.join(names)}")
        else:
            names.append(name)
    return tuple(names)


def read_effects(path: str, content: Mapping[str, Any], changes: str | None = None) -> Effects:
    """Return the effects of [scene] and [effects.NAME] of a case file, after the `changes` of the command
    line.

    Raises:
        CaseError: an error in the file, or parameters of an effect that is not named; one line.
    """
    scene = document.table(path, content, "scene")
    document.refuse_unknown(path, "scene", scene, ["effects"])
    words = scene.get("effects", list(DEFAULT))
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise CaseError(f"{path}: scene.effects: got {shown(words)}, expected a list of names")
    tables: dict[str, tuple[Table, ...]] = {}
    listed = list(_read_lists(path, content))
    for name, own in (*_read_tables(path, content), *listed):
        tables[name] = (*tables.get(name, ()), own)
    names = (*_names_after(f"{path}: scene.effects", words, DEFAULT), *(name for name, _ in listed))
    effects = Effects(
        names=tuple(dict.fromkeys(names)),
        tables={name: _alone(every) for name, every in tables.items()},
    )
    _require_parameters(path, effects)
    changed = effects if changes is None else effects.changed(changes)
    for name in effects.tables:
        if name not in (*effects.names, *changed.names):
            mend = f'"{name}" in scene.effects' if scene else f'[scene] with effects = ["+{name}"]'
            raise CaseError(
                f"{path}: effects.{name}: got it, but the scene does not name {name}, expected {mend} as well"
            )
    return changed


def _read_tables(path: str, content: Mapping[str, Any]) -> Iterator[tuple[str, Table]]:
    """Yield name and parameters of every table [effects.NAME], and of those of an array [[effects.NAME]]."""
    effects = document.table(path, content, "effects")
    for name, given in effects.items():
        require_known(f"{path}: effects", name)
        every: list[tuple[str, Any]] = [(f"effects.{name}", given)]
        if name in REPEATED and isinstance(given, list) and given:
            every = document.tables(path, effects, name, within="effects.")
        elif not isinstance(given, dict):
            raise CaseError(f"{path}: effects.{name}: got {shown(given)}, expected a table [effects.{name}]")
        yield from ((name, _parameters(path, name, own, label)) for label, own in every)


def _read_lists(path: str, content: Mapping[str, Any]) -> Iterator[tuple[str, Table]]:
    """Yield name and parameters of the effects that [[loads]] and the other lists stand for."""
    for section, effects in LISTS.items():
        for label, given in document.tables(path, content, section):
            meant = [name for name, key in effects.items() if not key or key in given]
            if "tip_force" in meant:  # which is force and moment at once
                meant = ["tip_force"]
            if not meant:
                raise CaseError(f"{path}: {label}: got none of {', '.join(effects.values())}, expected one")
            known = {key.name for name in meant for key in EFFECT_KEYS[name]}
            document.refuse_unknown(path, label, given, sorted(known))
            for name in meant:
                own = {key.name: given[key.name] for key in EFFECT_KEYS[name] if key.name in given}
                yield name, _parameters(path, name, own, label)


def _times(value: Any, factor: float) -> Any:
    """Return a number, or each of a pair that is one, times a factor."""
    if isinstance(value, tuple):
        return tuple(_times(part, factor) for part in value)
    return None if value is None else factor * value


def require_known(where: str, name: str) -> None:
    """Raise CaseError, with the list of effects, unless `name` is an effect of the suite or of the
    splines."""
    if name in EFFECT_KEYS or name in _registered():
        return
    raise CaseError(f"{where}: got {name}, expected {document.nearest(name, EFFECT_KEYS)}")


def _require_parameters(where: str, effects: Effects) -> None:
    """Raise CaseError if a named effect lacks a parameter that it needs."""
    for name in effects.names:
        for key in EFFECT_KEYS.get(name, ()):
            if not key.optional and any(key.attribute not in own for own in effects.every(name)):
                raise document.missing(where, key, key.section)


def _registered() -> Mapping[str, Any]:
    """Return the effects that the spline model knows; asked for names that this file does not."""
    registry: Mapping[str, Any] = import_module("spline_model.effects.registry").REGISTRY
    return registry


def _parameters(path: str, name: str, given: Table, label: str) -> dict[str, Any]:
    """Return the parameters of a table in SI; those of an effect without keys here as they stand."""
    if name not in EFFECT_KEYS:
        return {key: tuple(value) if isinstance(value, list) else value for key, value in given.items()}
    return document.values(path, EFFECT_KEYS[name], given, label)
