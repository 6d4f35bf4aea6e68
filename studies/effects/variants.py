"""The scenes that an audit compares: the full one, and those that leave effects out or simplify them."""

from collections.abc import Iterable
from dataclasses import dataclass

from studies.cases.effects import Effects

#: Effects that a scene may do without but that could matter, with what they need beside them.
BESIDE = {"section_rotary_inertia": "strip_inertia", "gravity": "bending"}
#: Effects that cannot be left out for nothing, with their simpler form.
SIMPLER = {"stretching": "inextensible"}
#: What goes with an effect when it goes.
TOGETHER = {"strip_inertia": ("section_rotary_inertia",)}
#: What a scene without an effect is called.
CALLED = {"stretching": "inextensible strips", "strip_inertia": "massless strips"}


@dataclass(frozen=True, kw_only=True)
class Variant:
    """A scene in place of the full one.

    Attributes:
        dropped: effects of the full scene that were left out or simplified.
        added: those that were put in though the full scene could not have them.
        effects: of the scene.
    """

    dropped: tuple[str, ...]
    effects: Effects
    added: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """What was changed, in words."""
        words = [f"with {name.replace('_', ' ')}" for name in self.added]
        words += [CALLED.get(name, f"no {name.replace('_', ' ')}") for name in self.dropped]
        return ", ".join(words) or "full scene"


def full_scene(effects: Effects, omitted: Iterable[str] = ()) -> Variant:
    """Return the scene with what could matter beside its own effects, but for what is omitted."""
    names = [*effects.names, *(name for name in beside(effects) if name not in omitted)]
    return Variant(dropped=(), effects=effects.renamed(names))


def beside(effects: Effects) -> list[str]:
    """Return the effects that a scene does not have but that could matter."""
    return [name for name, base in BESIDE.items() if name not in effects.names and base in effects.names]


def without(full: Variant, dropped: Iterable[str]) -> Variant:
    """Return the full scene without these effects, or with their simpler forms."""
    chosen = tuple(dropped)
    gone = {*chosen, *(other for name in chosen for other in TOGETHER.get(name, ()))}
    names = [SIMPLER.get(name, "") if name in gone else name for name in full.effects.names]
    return Variant(dropped=chosen, effects=full.effects.renamed([name for name in names if name]))
