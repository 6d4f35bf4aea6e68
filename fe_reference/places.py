"""Places where loads, drives, supports and springs of a model act, and what they prescribe there."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .errors import History, InvalidParameter
from .loading import WAYS, BodyLoad, Prescribed, Spring, TipForce

if TYPE_CHECKING:
    from .model import Model

#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2


def check_places(model: "Model") -> None:
    """Refuse loads, springs and drives on what is not there."""
    effects = model.effects
    for load in effects.every(BodyLoad):
        model.body_index(load.body)
    for tip in effects.every(TipForce):
        if model.ends[model.strip_index(tip.strip), 1] != FREE:
            raise InvalidParameter("tip_force", tip.strip, "a strip whose tip is free [name]")
    for name in (name for each in effects.every(Spring) for name in (each.body, each.other)):
        if name is not None:
            model.body_index(name)
    led = effects.every(Prescribed)
    if led and not model.bodies:
        name = next(name for name, same in effects.named.items() if led[0] in same)
        raise InvalidParameter(name, "no bodies", "a body to lead [name]")
    # those that name no body are of the one that is driven, which only a solve knows
    prescribed(model, None, [each for each in led if each.body is not None])


def prescribed(
    model: "Model", body: int | None, led: Sequence[Prescribed] | None = None
) -> dict[int, tuple[float, History | None]]:
    """Return what drives and supports prescribe: end [m, rad] and history of a coordinate.

    Coordinate k of body b stands under 3 b + k. body: where the effects name none; None: the only one.
    """
    found: dict[int, tuple[float, History | None]] = {}
    for effect in model.effects.every(Prescribed) if led is None else led:
        index = body if effect.body is None and body is not None else model.body_index(effect.body)
        for at, end in enumerate(effect.ends, start=3 * index):
            if at in found and end is not None:
                raise twice(model, at)
            if end is not None:
                found[at] = (end, effect.history)
    return found


def twice(model: "Model", at: int) -> InvalidParameter:
    """Return the refusal of a coordinate, numbered as in `prescribed`, that is prescribed twice."""
    told = f"{WAYS[at % 3]} of {model.body_names[at // 3]}"
    return InvalidParameter("prescribed", told, "one drive or support for each coordinate [name]")
