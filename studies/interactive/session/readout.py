"""How numbers are written for the user: one formatter for the sentence and for the table."""

import math
from collections.abc import Mapping
from typing import Any

#: What lies below this part of a design's own scale is round-off, and written as nought.
ROUND_OFF = 1e-6
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


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
        scale, prefix = _prefix(abs(value), unit)
        return f"{value / scale + 0.0:.4g} {prefix}{unit}"
    spread = float(f"{spread:.2g}")
    scale, prefix = _prefix(max(abs(value), spread), unit)
    places = max(0, 1 - math.floor(math.log10(spread / scale))) if spread > 0.0 else 2
    return f"{fixed(value / scale, places)} ± {spread / scale:.4g} {prefix}{unit}"


def _prefix(size: float, unit: str) -> tuple[float, str]:
    if size == 0.0:
        return 1.0, ""
    return next((pair for pair in PREFIXES if size >= pair[0]), PREFIXES[-1])


def fixed(value: float, places: int) -> str:
    """Return a value with so many places, nought without a sign."""
    return f"{round(value, places) + 0.0:.{places}f}"


def scales(values: Mapping[str, float]) -> dict[str, float]:
    """Return the sizes of moment [N m], force [N], energy [J] and stress [Pa] of a design's bending."""
    length, thickness = values["length"], values["thickness"]
    bending = values["youngs_modulus"] * values["width"] * thickness**3 / 12.0 / length
    stress = values["youngs_modulus"] * thickness / length
    return {"moment": bending, "force": bending / length, "energy": bending, "stress": stress}


def readout(state: Mapping[str, Any]) -> dict[str, str]:
    """Return the texts of a state's numbers by what they are."""
    least = {name: ROUND_OFF * scale for name, scale in state["scale"].items()}
    force, spread = state["force"], state["force_sd"] or (None, None, None)
    (dx, dy, turn), sd = state["displacement"], state["sd"]
    shift = "" if sd is None else f" ± {1e3 * max(sd[0], sd[1]):.2f}"
    of_yield = state["stress"]["of_yield"]
    percent = 100.0 * of_yield if of_yield > ROUND_OFF else 0.0
    energy = {
        name: quantity(state["energy"][name], "J", least["energy"])
        for name in ("strain", "kinetic", "dissipated", "lost")
    }
    return energy | {
        "rotation": fixed(math.degrees(turn), 2)
        + ("" if sd is None else f" ± {math.degrees(sd[2]):.2f}")
        + " °",
        "shift": f"{fixed(1e3 * dx, 2)}, {fixed(1e3 * dy, 2)}{shift} mm",
        "moment": quantity(force[2], "N m", least["moment"], spread[2]),
        "force_x": quantity(force[0], "N", least["force"], spread[0]),
        "force_y": quantity(force[1], "N", least["force"], spread[1]),
        "stiffness": quantity(state["stiffness"], "N m/rad", least["moment"]),
        "simulated": f"{quantity(state['simulated'], 's')}, {state['steps']} steps",
        "stress": quantity(state["stress"]["max"], "Pa", least["stress"]),
        "of_yield": f"{float(f'{percent:.3g}'):g} %",
    }


def sentence(state: Mapping[str, Any], texts: Mapping[str, str]) -> str:
    """Return what the picture shows, for the status line and screen readers."""
    angle = fixed(math.degrees(state["pose"][2]), 1)
    stress = fixed(100.0 * state["stress"]["of_yield"], 0)
    pause = ", paused" if state["paused"] else ""
    if state["mode"] == "released":
        time = quantity(state["simulated"], "s")
        return f"Released{pause}: {angle}° after {time}, stress {stress} % of yield."
    return f"Held at {angle}°{pause}: moment {texts['moment']}, stress {stress} % of yield."
