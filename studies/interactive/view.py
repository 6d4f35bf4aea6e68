"""What a session is at one instant, and what it shows: numbers in SI units, ready for JSON, and sentences."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from studies.answers.quantities import PREFIXES, fixed, power_of
from studies.cases.document import parsed
from studies.interactive.presets import OWN
from studies.kinds import Array

#: Least spread that is written, over its value.
FINEST = 1e-4
#: What lies below this part of a design's own scale is round-off, and written as nought.
ROUND_OFF = 1e-6


def quantity(value: float | None, unit: str, least: float = 0.0, spread: float | None = None) -> str:
    """Return a value with its unit's prefix, three digits, or those that its spread leaves.

    Args:
        value: in the unit, None where there is none; below `least` it is nought.
        spread: standard deviation in the same unit.
    """
    if value is None:
        return "–"
    value = 0.0 if abs(value) < least else value
    if spread is None:
        value = float(f"{value:.3g}")
        power = power_of(abs(value), lowest=-9)
        return f"{value / 10.0**power + 0.0:.4g} {PREFIXES[power]}{unit}"
    spread = float(f"{max(spread, FINEST * abs(value)):.2g}")
    power = power_of(max(abs(value), spread), lowest=-9)
    scale = 10.0**power
    places = max(0, 1 - math.floor(math.log10(spread / scale))) if spread > 0.0 else 2
    return f"{fixed(value / scale, places)} ± {spread / scale:.{places}f} {PREFIXES[power]}{unit}"


def _readout(state: Mapping[str, Any]) -> dict[str, str]:
    """Return the texts of a state's numbers by what they are."""
    least = {name: ROUND_OFF * scale for name, scale in state["scale"].items()}
    force, spread = state["force"], state["force_sd"] or (None, None, None, None)
    (dx, dy, turn), sd = state["displacement"], state["sd"]
    shifted = state["centre_shift"]
    shift = "" if sd is None else f" ± {1e3 * max(sd[0], sd[1]):.2f}"
    energy = {name: quantity(value, "J", least["energy"]) for name, value in state["energy"].items()}
    return energy | {
        "rotation": fixed(math.degrees(turn), 2)
        + ("" if sd is None else f" ± {math.degrees(sd[2]):.2f}")
        + " °",
        "shift": f"{fixed(1e3 * dx, 2)}, {fixed(1e3 * dy, 2)}{shift} mm",
        "centre_shift": "–" if shifted is None else f"{fixed(1e3 * shifted, 3)} mm",
        "moment": quantity(force[2], "N m", least["moment"], spread[2]),
        "force_x": quantity(force[0], "N", least["force"], spread[0]),
        "force_y": quantity(force[1], "N", least["force"], spread[1]),
        "stiffness": quantity(state["stiffness"], "N m/rad", least["moment"], spread[3]),
        "grip": quantity(state["grip"], "N/m"),
        "critical": quantity(state["critical"], "N"),
        "simulated": f"{quantity(state['simulated'], 's')}, {state['steps']} steps",
        "stress": quantity(state["stress"]["max"], "Pa", least["stress"]),
        "of_yield": _of_yield(state["stress"]),
    }


def _of_yield(stress: Mapping[str, Any], digits: str = ".3g") -> str:
    """Return the largest stress over the yield strength, or by itself where that is not known."""
    if stress["of_yield"] is None:
        return quantity(stress["max"], "Pa")
    share = 100.0 * stress["of_yield"] if stress["of_yield"] > ROUND_OFF else 0.0
    return f"{float(format(share, digits)):g} % of yield"


def _sentence(state: Mapping[str, Any]) -> str:
    """Return what the picture shows, for the status line and screen readers."""
    texts, angle = state["texts"], fixed(math.degrees(state["pose"][2]), 1)
    stress = f"stress {_of_yield(state['stress'], '.0f')}"
    pause = ", paused" if state["paused"] else ""
    if state["mode"] == "released":
        return f"Released{pause}: {angle}° after {quantity(state['simulated'], 's')}, {stress}."
    return f"Held at {angle}°{pause}: moment {texts['moment']}, {stress}."


#: Fault -> the sentence that explains it and says what to do.
SENTENCES = parsed(Path(__file__).parent / "sentences.toml")


def unstable(session: Any) -> str:
    """Return from which load on the body is held by the hand alone, and how stiff it is, if that is known."""
    stiffness = session.mechanics.snapshot.stiffness or 0.0
    load = f"critical load {quantity(session.critical, 'N')}" if session.critical else ""
    stiff = f"stiffness {quantity(stiffness, 'N m/rad')}" if stiffness < 0.0 else ""
    return ", ".join(filter(None, (load, stiff)))


def curved(session: Any) -> dict[str, Any]:
    """Return what a moment alone does to the design at work, and where it yields, as plain numbers and a
    sentence; and its case file."""
    mechanics = session.mechanics
    curve, piece = mechanics.curve, mechanics.piece
    at, end = curve.where(piece.values.get("yield_strength")), math.degrees(curve.rotation[-1])
    text = f"yields at ±{math.degrees(at[0]):.1f}° by {quantity(at[1], 'N m')}" if at else ""
    if piece.values.get("yield_strength") is None:
        text = "yield strength is not known"
    return {
        "rotation": _plain(curve.rotation),
        "moment": _plain(curve.moment),
        "yields": at,
        "text": text or f"does not yield up to ±{end:.0f}°",
        "case": piece.document if piece.name == OWN else None,
    }


#: What a state tells of the session, of its clock and of the mechanics as it is.
OF_SESSION = ("paused", "drive", "sight", "wanted", "critical")
OF_CLOCK = ("steps", "simulated")
OF_NOW = ("iterations", "pose", "poses", "velocity", "centre", "force", "stiffness", "shape", "energy")
#: Of the placing.
OF_PLACING = ("ground", "clamps", "centre", "ends", "centres")


def shown(session: Any) -> dict[str, Any]:
    """Return the state of a session: equal sessions give equal states, digit by digit."""
    mechanics, now = session.mechanics, session.mechanics.snapshot
    placing, piece, moving = mechanics.placing, mechanics.piece, mechanics.moving
    given = ((session, OF_SESSION), (session.clock, OF_CLOCK), (now, OF_NOW))
    state: dict[str, Any] = {name: getattr(source, name) for source, names in given for name in names} | {
        "t": session.time,
        "mode": "released" if moving else "held",
        "preset": piece.name,
        "values": piece.values,
        "control_points": mechanics.control_points,
        "scale": mechanics.scale,
        "displacement": [*(now.pose[:2] - placing.centre), now.pose[2]],
        "centre_shift": placing.crossing_shift(now.pose),
        "grip": session.grip if session.drive in ("grip", "pull") and not moving else None,
        "sd": session.sd,
        "force_sd": _force_sd(session),
        "stress": _stress(now.stress, piece.values.get("yield_strength")),
        "placing": {name: getattr(placing, name) for name in OF_PLACING}
        | {
            "marker": placing.marker(now.pose),
            "bodies": placing.names,
            "body": placing.number,
            "depth": [strip.depth for strip in piece.design.strips],
            "length": mechanics.length,
        },
        "warnings": [{"code": code, "text": text} for code, text in session.warnings.items()],
    }
    state = _plain(state)
    state["texts"] = _readout(state)
    state["status"] = _sentence(state)
    return state


def _stress(stress: Array, strength: float | None) -> dict[str, Any]:
    """The largest stress (S, P) of the strips, where it is, and all of it, over their strength [Pa]; over the
    largest, if that is not known."""
    strip, place = np.unravel_index(int(np.argmax(stress)), stress.shape)
    largest = float(stress[strip, place])
    return {
        "max": largest,
        "of_yield": None if strength is None else largest / strength,
        "strip": int(strip),
        "place": int(place),
        "along": np.round(stress / (strength or max(largest, 1.0)), 4),
    }


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: arrays and tuples as lists."""
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [_plain(each) for each in value] if isinstance(value, list | tuple) else value


def _force_sd(session: Any) -> list[float | None] | None:
    """Standard deviations of force, moment and stiffness; none of forces that are nought by make."""
    if session.force_sd is None:
        return None
    known = [value if math.isfinite(value) else None for value in session.force_sd.tolist()]
    return [None, None, *known[2:]] if session.drive == "rotation" else known
