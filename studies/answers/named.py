"""The numbers of the named parts of a design: what holds its prescribed coordinates, where its free ends and
points go, what its springs store, and how far the instantaneous centre of its body moves.

Each is a quantity like those of every path, so that tables, files, pictures and sweeps have it too.
"""

from collections.abc import Callable, Iterator
from functools import partial
from operator import methodcaller
from typing import Any

import numpy as np

from studies.answers.answer import centre_shift
from studies.answers.quantities import MOTION, PATH, QUANTITIES, Quantity
from studies.answers.response import PLACES, REACTIONS
from studies.cases.design import Design
from studies.cases.mechanism import Point
from studies.kinds import Array

#: Coordinate of a body -> end of the key of what is exerted on the body for it, heading, and what that is.
EXERTED = {
    "x": ("force_x_N", "x", "force along x"),
    "y": ("force_y_N", "y", "force along y"),
    "rotation": ("moment_Nm", "moment", "moment"),
}
#: What takes the displacement of a place (S, 2 or 3), with its rotation, from an answer.
Moved = Callable[[Any], Array]


def named(design: Design) -> tuple[Quantity, ...]:
    """Return the quantities of the named parts of a design; a plain pivot has none."""
    return (*_reactions(design), *_parts(design))


def quantities_of(answer: Any) -> Iterator[tuple[Quantity, Array]]:
    """Yield the quantities of an answer with their values (S,), in the SI unit of each quantity."""
    for quantity in (*QUANTITIES, *named(answer.design)):
        if answer.analysis in quantity.analyses:
            yield quantity, np.asarray(quantity.of(answer))


def numbers_of(answer: Any) -> dict[str, Array]:
    """Return the quantities (S,) of an answer in SI units by key, without those of a drive if nothing is
    driven."""
    return {each.key: values for each, values in quantities_of(answer) if answer.driven or not each.drive}


def prescribed(design: Design) -> tuple[tuple[str, str], ...]:
    """Return body and coordinate ("x", "y" or "rotation") of all prescribed coordinates of drives and
    supports.

    The rotation that the path drives is excluded: its torque is a quantity of every path.
    """
    found: list[tuple[str | None, str]] = []
    effects = design.effects
    for own in effects.acting("support"):
        found += [(own.get("body"), part) for part in own["fixed"]]
    for own in effects.acting("driven_displacement"):
        led = zip("xy", own["displacement"], strict=True)
        found += [(own.get("body"), axis) for axis, moved in led if moved is not None]
    found += [(own.get("body"), "rotation") for own in effects.acting("driven_rotation")]
    return tuple((str(body or design.body), part) for body, part in found)


def _reactions(design: Design) -> Iterator[Quantity]:
    """Yield the forces and moments that prescribed coordinates need."""
    for body, part in prescribed(design):
        key, heading, name = EXERTED[part]
        yield Quantity(
            key=f"{body}_{key}",
            heading=heading,
            group=f"exerted on {body}",
            meaning=f"{name} that is exerted on {body} from outside",
            of=methodcaller("exerted", body, part),
            estimated=REACTIONS,
        )


def _parts(design: Design) -> Iterator[Quantity]:
    """Yield where the free ends of strips and the named points of bodies go, the energy of springs between
    bodies, and how far the instantaneous centre at rest of a mechanism's driven body moves with the body."""
    for place, strip in enumerate(design.strips):
        if strip.tip is None:
            moved = partial(_end_moved, place)
            yield from _moved(f"{strip.name}_tip_displacement", f"tip of {strip.name}", moved, turns=True)
    for point in design.points:
        moved = partial(_point_moved, point)
        yield from _moved(f"{point.name}_displacement", point.name, moved, estimated=PLACES)
    if design.effects.acting("spring"):
        meaning = "energy of the springs between bodies"
        yield Quantity(key="spring_energy_J", heading="springs", meaning=meaning, chart=False)
    if design.rotation and design.crossing_point is None:
        yield from _moved("centre_drift", "centre drift", _drifted, analyses=(PATH,))


def _moved(
    key: str, group: str, of: Moved, *, turns: bool = False, analyses: Any = (PATH, MOTION), **more: Any
) -> Iterator[Quantity]:
    """Yield the displacement of a place, and its rotation if it is one that turns."""
    names = {f"{key}_{axis}_m": (axis, f"displacement of {group} along {axis}") for axis in "xy"}
    if turns:
        names[f"{key.removesuffix('displacement')}rotation_rad"] = "rotation", f"rotation of {group}"
    for part, (name, (heading, meaning)) in enumerate(names.items()):
        yield Quantity(
            key=name,
            heading=heading,
            group=group,
            meaning=meaning,
            of=partial(_part, of, part),
            analyses=analyses,
            **more,
        )


def _part(moved: Moved, part: int, answer: Any) -> Array:
    """Return a column of a displacement."""
    return np.asarray(moved(answer)[:, part])


def _end_moved(strip: int, answer: Any) -> Array:
    """Return displacement [m] and rotation [rad] (S, 3) of the end of a strip."""
    along = answer.along
    moved = along.shape[:, strip, -1] - along.rest_shape[strip, -1]
    return np.column_stack((moved, along.rotation[:, strip, -1]))


def _point_moved(point: Point, answer: Any) -> Array:
    """Return the displacement (S, 2) of a point of a body [m]."""
    rest = next(body.centre for body in answer.design.bodies if body.name == point.body)
    place = answer.bodies[point.body]
    return centre_shift(point.at, place[:, 2], place[:, :2], np.array([rest]))


def _drifted(answer: Any) -> Array:
    """Return the displacement (S, 2) [m] of the body's point about which it turns in the first state, by a
    moment alone; NaN where forces do not hold the body."""
    matrix = answer.body_stiffness[0]
    if not np.isfinite(matrix).all() or np.linalg.matrix_rank(matrix[:2, :2]) < 2:
        return np.full((len(answer.rotation), 2), np.nan)
    x, y = -np.linalg.solve(matrix[:2, :2], matrix[:2, 2])  # of the centre, by a rotation
    pole = answer.centre[0] + np.array([-y, x])
    return centre_shift(pole, answer.rotation - answer.rotation[0], answer.centre)
