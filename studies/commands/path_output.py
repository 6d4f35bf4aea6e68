"""What is told of a static path: its columns for JSON and CSV, and a table to read."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from studies.answers.response import Response
from studies.answers.strength import Strength, strength
from studies.answers.validity import validity
from studies.cases.design import flexural_scale
from studies.commands import columns
from studies.commands.answer import described, ending, estimated, headed, places
from studies.commands.columns import Column, one, quantity
from studies.kinds import Array

if TYPE_CHECKING:
    import pandas as pd

#: Effects whose share a table shows beside the rotation.
LOADS = {"applied_force", "applied_moment", "tip_force", "driven_displacement"}
#: Entries of the stiffness of a body, in x, y and turn, by name with unit.
ENTRIES = {
    "xx_N_per_m": (0, 0),
    "xy_N_per_m": (0, 1),
    "yy_N_per_m": (1, 1),
    "xt_N": (0, 2),
    "yt_N": (1, 2),
    "tt_Nm_per_rad": (2, 2),
}
#: States that the table of the stiffness of the body shows.
SHOWN = 4
#: Its digits, and its part that is round-off.
DIGITS, ROUND_OFF = 4, 1e-9
#: Displacement below which there is none, in lengths of a strip.
SHIFT_FLOOR = 1e-12


def _arrays(answer: Response) -> dict[str, Array]:
    """Return what is one number in every state, by names with units."""
    found, pivot = {"load_factor": answer.load_factor}, answer.crossing is not None
    if pivot:
        found |= {"rotation_rad": answer.rotation}
        found |= dict(zip(("com_x_m", "com_y_m"), answer.centre.T, strict=True))
        found |= dict(zip(("centre_shift_x_m", "centre_shift_y_m"), answer.centre_shift.T, strict=True))
    found |= {"torque_Nm": answer.torque, "stiffness_Nm_per_rad": answer.stiffness}
    found["strain_energy_J"] = answer.strain_energy
    if not pivot:
        found |= {"gravity_energy_J": answer.gravity_energy, "work_J": answer.work}
    found["max_stress_Pa"] = answer.max_stress
    if answer.body is not None:
        matrix = answer.body_stiffness
        found |= {f"body_stiffness_{name}": matrix[:, i, j] for name, (i, j) in ENTRIES.items()}
        found |= dict(zip(("off_axis_ratio_x", "off_axis_ratio_y"), _off_axis(answer), strict=True))
    return found


def _off_axis(answer: Response) -> Array:
    """Return the stiffness in x and y over that of the rotation, whose lever is a strip's length (2, S) [1].

    In x and y all else is held; the rotation is free to shift.
    """
    matrix = answer.body_stiffness
    known = ~np.isnan(matrix).any(axis=(1, 2))
    turning = np.full(len(matrix), np.nan)
    turning[known] = 1.0 / np.linalg.inv(matrix[known])[:, 2, 2]
    return np.asarray(_length(answer) ** 2 * np.diagonal(matrix, axis1=1, axis2=2)[:, :2].T / turning)


def _length(answer: Response) -> float:
    """Return the length of the longest strip [m]."""
    return max(strip.length for strip in answer.design.strips)


def as_document(answer: Response) -> dict[str, Any]:
    """Return the answer as the JSON object of the command: of a pivot the one body, of a mechanism all."""
    return {
        **headed(answer),
        "critical_points": critical(answer),
        **({} if answer.crossing is not None else {"bodies": places(answer.bodies)}),
        **_arrays(answer),
        "strength": _strength(strength(answer)),
        "validity": asdict(validity(answer)),
        **({} if answer.estimate is None else {"estimate": answer.estimate}),
        "counters": answer.counters,
        "wall_s": answer.wall_s,
    }


def critical(answer: Response) -> list[dict[str, Any]]:
    """Return the critical points of a path as JSON has them, with the force that acts on a body there [N]."""
    acting = answer.design.effects.parameters().get("applied_force")
    force = math.hypot(*acting["force"]) if acting and "applied_force" in answer.effects else None
    return [
        {
            "kind": point.kind,
            "load_factor": point.load_factor,
            "rotation_rad": point.rotation,
            **({} if force is None else {"force_N": force * point.load_factor}),
        }
        for point in answer.critical_points
    ]


def _remarks(answer: Response) -> Iterator[str]:
    """Yield what is to be said of a path beside its numbers: what it passed, how uncertain it is.

    Why a path stopped early is told on the error stream, see `deliver`.
    """
    if answer.converged and answer.message:
        yield answer.message
    yield from dict.fromkeys(f"{point['kind']}: {passed(point)}" for point in critical(answer))
    if answer.resolution:
        yield answer.resolution


def passed(point: Mapping[str, Any]) -> str:
    """Return where a critical point is: its load factor, the force that acts there, and the rotation."""
    force = f" (force {point['force_N']:.4g} N)" if "force_N" in point else ""
    turn = point["rotation_rad"]
    return f"load factor {point['load_factor']:.6g}{force}" + (
        f", {math.degrees(turn):.6g} deg" if math.isfinite(turn) else ""
    )


def as_frame(answer: Response) -> "pd.DataFrame":
    """Return a row a state: the model, its arrays, and of a mechanism the places of all bodies."""
    found: dict[str, Any] = {"model": answer.model} | _arrays(answer)
    for name, place in places(answer.bodies if answer.crossing is None else {}).items():
        found |= {f"{name}_{key}": column for key, column in place.items()}
    import pandas as pd  # only who asks for a table waits for it

    return pd.DataFrame(found)


def readable(answer: Response) -> Iterator[str]:
    """Yield the lines of the tables, and what is to be said of the answer."""
    yield described(answer)
    yield from columns.table([*_states(answer), *_columns(answer)])
    if answer.body is not None:
        body = answer.body if answer.crossing is None else "the body"
        yield f"stiffness of {body} about its centre at fixed loads, and over that of the rotation"
        yield from columns.table(list(_body_columns(answer)))
    yield from _told(strength(answer), floor=_stress_floor(answer))
    worth = validity(answer)  # of yield the strength has told
    yield from (f"beyond the model: {each}" for each in worth.outside)
    yield from estimated(answer)
    yield from _remarks(answer)
    yield ending(answer)


def _states(answer: Response) -> Iterator[Column]:
    """Yield the columns that say which state it is."""
    pivot = answer.crossing is not None
    if not pivot or LOADS & set(answer.effects):
        yield columns.plain("load", (f"{factor:.3f}" for factor in answer.load_factor))
    if answer.crossing is not None:
        yield columns.angle(answer.rotation)


def _columns(answer: Response) -> Iterator[Column]:
    """Yield the columns of places, torque, stiffness, energy and stress."""
    pivot, scale = answer.crossing is not None, flexural_scale(answer.design)
    if answer.crossing is not None:
        yield from quantity("m", highest=-3, x=answer.centre[:, 0], y=answer.centre[:, 1])
        floor = SHIFT_FLOOR * _length(answer)
        yield from quantity("m", highest=-3, floor=floor, digits=6, shift=np.hypot(*answer.centre_shift.T))
    if pivot or np.isfinite(answer.torque).any():
        yield from quantity("N m", floor=columns.FORCE_FLOOR * scale, torque=answer.torque)
        yield from quantity("N m/rad", floor=columns.FORCE_FLOOR * scale, stiffness=answer.stiffness)
    yield from quantity("J", floor=columns.ENERGY_FLOOR * scale, energy=answer.strain_energy)
    yield from quantity("Pa", floor=_stress_floor(answer), highest=6, digits=6, stress=answer.max_stress)
    if not pivot:
        for name, place in answer.bodies.items():
            yield from quantity("m", highest=-3, group=name, x=place[:, 0], y=place[:, 1])
            yield columns.angle(place[:, 2], group=name)


def _body_columns(answer: Response) -> Iterator[Column]:
    """Yield the columns of the stiffness of the body, at a few of the states."""
    last = len(answer.load_factor) - 1
    rows = sorted({round(last * part / SHOWN) for part in range(SHOWN + 1)})
    for column in _states(answer):
        yield Column(name=column.name, unit=column.unit, cells=tuple(column.cells[row] for row in rows))
    if answer.crossing is None and np.isfinite(answer.torque).any():
        yield columns.angle(answer.bodies[str(answer.body)][rows, 2])
    matrix = answer.body_stiffness[rows]
    xx, yy, xy = matrix[:, 0, 0], matrix[:, 1, 1], matrix[:, 0, 1]
    floor = ROUND_OFF * float(np.nanmax(np.abs(xx) + np.abs(yy), initial=0.0))
    yield from columns.wide("N/m", DIGITS, floor=floor, **{"x": xx, "y": yy, "x y": xy})
    coupled = {"x turn": matrix[:, 0, 2], "y turn": matrix[:, 1, 2]}
    yield from columns.wide("N", DIGITS, floor=floor * _length(answer), **coupled)
    yield from columns.wide("N m/rad", DIGITS, turn=matrix[:, 2, 2])
    for name, ratio in zip(("x over", "y over"), _off_axis(answer), strict=True):
        yield columns.plain(name, (one(each, DIGITS) for each in ratio[rows]))


def _stress_floor(answer: Response) -> float:
    """Return the stress below which it is round-off [Pa]."""
    return columns.STRAIN_FLOOR * max(float(strip.youngs_modulus) for strip in answer.design.strips)


def _told(found: Strength, *, floor: float) -> Iterator[str]:
    """Yield where the stress is largest and what of it the material bears; below the floor there is none."""
    if found.stress < floor:
        yield "no stress: nothing is turned, and no load acts"
        return
    at = _state(found.load_factor, found.rotation)
    yield f"largest stress {one(found.stress / 1e6, 5)} MPa, of {found.strip} {found.place}, {at}"
    if found.safety is None:
        return
    limit = f" of {one(found.yield_strength / 1e6, 4)} MPa" if found.yield_strength is not None else ""
    if found.yields is None:
        yield f"safety {one(found.safety, 4)} against the yield strength{limit}, which is not reached"
    else:
        where = _state(*found.yields).removeprefix("at ")
        yield f"safety {one(found.safety, 4)} against the yield strength{limit}: it yields from {where} on"


def _state(load_factor: float, rotation: float) -> str:
    """Return which state it is, in degrees, or by its load."""
    if math.isfinite(rotation) and abs(rotation) > columns.ANGLE_FLOOR:
        return f"at {math.degrees(rotation):.4g} deg"
    return f"at load factor {load_factor:.4g}"


def _strength(found: Strength) -> dict[str, Any]:
    """Return the largest stress and what of it the material bears, as JSON has it."""
    yields = None
    if found.yields is not None:
        yields = {"load_factor": found.yields[0], "rotation_rad": found.yields[1]}
    return {
        "max_stress_Pa": found.stress,
        "strip": found.strip,
        "station": found.station,
        "load_factor": found.load_factor,
        "rotation_rad": found.rotation,
        "yield_strength_Pa": found.yield_strength,
        "safety": found.safety,
        "yields_from": yields,
    }
