"""Places where loads, drives, supports and springs of a model act, and what they prescribe there."""

from collections.abc import Sequence

from .effects import Effects
from .errors import History, InvalidParameter, choice
from .loading import WAYS, BodyLoad, Prescribed, Spring, TipForce

#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2


def index_of(bodies: Sequence[str], name: str | None) -> int:
    """Return the place of a body among the names of all; None means the only one.

    Raises:
        InvalidParameter: an unknown name, or None where there is not one body.
    """
    known = ", ".join(bodies) or "no bodies"
    if len(bodies) != 1 if name is None else name not in bodies:
        raise InvalidParameter("body", name, f"one of {known} [name]")
    return 0 if name is None else bodies.index(name)


def check_places(effects: Effects, bodies: Sequence[str], strips: Sequence[str], free: Sequence[str]) -> None:
    """Refuse loads, springs and drives on what is not there; free: names of strips whose tips are."""
    for load in effects.every(BodyLoad):
        index_of(bodies, load.body)
    for tip in effects.every(TipForce):
        if choice("strip", tip.strip, tuple(strips)) not in free:
            raise InvalidParameter("tip_force", tip.strip, "a strip whose tip is free [name]")
    for spring in effects.every(Spring):
        index_of(bodies, spring.body)
        index_of(bodies, spring.other or spring.body)
    led = effects.every(Prescribed)
    if led and not bodies:
        name = next(name for name, same in effects.named.items() if led[0] in same)
        raise InvalidParameter(name, "no bodies", "a body to lead [name]")
    # those that name no body are of the one that is driven, which only a solve knows
    prescribed(Effects(named={"": tuple(each for each in led if each.body is not None)}), bodies, None)


def prescribed(
    effects: Effects, bodies: Sequence[str], body: int | None
) -> dict[int, tuple[float, History | None]]:
    """Return the prescribed coordinates of drives and supports: end [m, rad] and history of each.

    Coordinate k of body b has the key 3 b + k. body: where the effects name none; None: the only one.

    Raises:
        InvalidParameter: a coordinate that is prescribed twice, or an unknown body.
    """
    found: dict[int, tuple[float, History | None]] = {}
    for effect in effects.every(Prescribed):
        index = body if effect.body is None and body is not None else index_of(bodies, effect.body)
        for at, end in enumerate(effect.ends, start=3 * index):
            if at in found and end is not None:
                raise twice(bodies, at)
            if end is not None:
                found[at] = (end, effect.history)
    return found


def twice(bodies: Sequence[str], at: int) -> InvalidParameter:
    """Return the refusal of a coordinate, numbered as in `prescribed`, that is prescribed twice."""
    told = f"{WAYS[at % 3]} of {bodies[at // 3]}"
    return InvalidParameter("prescribed", told, "one drive or support for each coordinate [name]")
