"""What a session is at one instant, and what it shows: numbers in SI units, ready for JSON, and sentences."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from spline_model.sequential_impulse import SWEEPS
from studies.interactive.pivot.bench import Bench
from studies.interactive.pivot.design import Curve, Placing, Reading, scales
from studies.interactive.pivot.input import Clock, Hand, Readings
from studies.interactive.pivot.mechanics import Mechanics
from studies.interactive.pivot.motion import SOLVERS
from studies.kinds import Array

#: Least spread that is written, over its value.
FINEST = 1e-4
#: What lies below this part of a design's own scale is round-off, and written as nought.
ROUND_OFF = 1e-6
#: Energies of a state, by the names that its snapshot has for them.
ENERGIES = ("strain", "kinetic", "potential", "dissipated", "lost")
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
    spread = float(f"{max(spread, FINEST * abs(value)):.2g}")
    scale, prefix = _prefix(max(abs(value), spread), unit)
    places = max(0, 1 - math.floor(math.log10(spread / scale))) if spread > 0.0 else 2
    return f"{fixed(value / scale, places)} ± {spread / scale:.{places}f} {prefix}{unit}"


def _prefix(size: float, unit: str) -> tuple[float, str]:
    if size == 0.0:
        return 1.0, ""
    return next((pair for pair in PREFIXES if size >= pair[0]), PREFIXES[-1])


def fixed(value: float, places: int) -> str:
    """Return a value with so many places, nought without a sign."""
    return f"{round(value, places) + 0.0:.{places}f}"


def _readout(state: Mapping[str, Any], reading: Array) -> dict[str, str]:
    """Return the texts of a state's numbers by what they are; `reading` (4,): force, moment and stiffness."""
    least = {name: ROUND_OFF * scale for name, scale in state["scale"].items()}
    force, spread = reading.tolist(), state["force_sd"] or (None, None, None, None)
    stiffness = None if state["stiffness"] is None else force[3]
    (dx, dy, turn), sd = state["displacement"], state["sd"]
    shift = "" if sd is None else f" ± {1e3 * max(sd[0], sd[1]):.2f}"
    of_yield = state["stress"]["of_yield"]
    percent = 100.0 * of_yield if of_yield > ROUND_OFF else 0.0
    energy = {name: quantity(state["energy"][name], "J", least["energy"]) for name in ENERGIES}
    return energy | {
        "rotation": fixed(math.degrees(turn), 2)
        + ("" if sd is None else f" ± {math.degrees(sd[2]):.2f}")
        + " °",
        "shift": f"{fixed(1e3 * dx, 2)}, {fixed(1e3 * dy, 2)}{shift} mm",
        "centre_shift": f"{fixed(1e3 * state['centre_shift'], 3)} mm",
        "moment": quantity(force[2], "N m", least["moment"], spread[2]),
        "force_x": quantity(force[0], "N", least["force"], spread[0]),
        "force_y": quantity(force[1], "N", least["force"], spread[1]),
        "stiffness": quantity(stiffness, "N m/rad", least["moment"], spread[3]),
        "grip": quantity(state["grip"], "N/m"),
        "simulated": f"{quantity(state['simulated'], 's')}, {state['steps']} steps",
        "stress": quantity(state["stress"]["max"], "Pa", least["stress"]),
        "of_yield": f"{float(f'{percent:.3g}'):g} %",
    }


def _sentence(state: Mapping[str, Any], texts: Mapping[str, str]) -> str:
    """Return what the picture shows, for the status line and screen readers."""
    angle = fixed(math.degrees(state["pose"][2]), 1)
    stress = fixed(100.0 * state["stress"]["of_yield"], 0)
    pause = ", paused" if state["paused"] else ""
    if state["mode"] == "released":
        time = quantity(state["simulated"], "s")
        return f"Released{pause}: {angle}° after {time}, stress {stress} % of yield."
    return f"Held at {angle}°{pause}: moment {texts['moment']}, stress {stress} % of yield."


#: What the hand holds: the rotation, and the centre by a spring; the centre alone, by a spring; the rotation
#: alone; the whole pose.
DRIVES = ("grip", "pull", "rotation", "pose")
SPRUNG = ("grip", "pull")
#: Stiffness of a finger's grip [N/m]; share of EI / L^2 that the spread of a seen place may show as a force;
#: that spread where a pointer shows the place [m].
FINGER, SHARE, POINTER = 1e3, 0.04, 2e-4
#: Fault -> the sentence that explains it and says what to do.
SENTENCES = {
    "lost": "A marker is not seen: show both markers whole, flat and lit.",
    "lost-0": "The ground marker (0) is not seen: uncover it.",
    "lost-1": "The moving marker (1) is not seen: uncover it.",
    "lost-both": "No marker is seen: show both markers whole, flat and lit.",
    "duplicate-0": "Two copies of marker 0 are in view: cover one.",
    "duplicate-1": "Two copies of marker 1 are in view: cover one.",
    "other-ids": "Other markers are seen than 0 and 1: use the printed sheet.",
    "mirrored": "The camera picture is mirrored: switch off mirroring in the camera's settings.",
    "swapped": "The markers look swapped: marker 0 belongs on the ground, marker 1 on the moving body.",
    "jump": "The pose jumped: waiting for a second picture that agrees.",
    "absurd": "The pose is out of reach and was left out.",
    "no-equilibrium": "No equilibrium was found for this pose: the last good state is kept.",
    "off-path": "The markers are not where the pivot turns by itself: check their printed size with "
    "the ruler, or take the pose of the unloaded pivot as rest.",
    "swing-ended": "This design cannot take the swing over: it is held.",
    "slowed": "Slowed down: the solver needs longer than the motion takes.",
    "no-catch": "The moving body could not be held here: try again.",
    "stopped": "The solver stopped: the last good state is kept and time is paused.",
    "under-resolved": "The step is too long for this swing, which it damps: take a slower time scale.",
    "no-rest": "Both markers must be seen to take their pose as rest.",
    "empty": "There is nothing.",
    "not-flat": "The markers do not lie in one plane, or the lens bends the picture.",
    "refused": "The markers fit no plane: this pose was left out.",
    "sizes": "The two markers have different sizes: print both at 100 % and measure the ruler.",
    "blurred": "The edges are blurred or dark: hold still, more light.",
    "over-exposed": "The paper's white is over-exposed: less light, or a shorter exposure.",
    "followed": "A corner is covered: the marker is followed by its edges.",
    "no-picture": "A picture could not be read.",
}


def curved(curve: Curve, strength: float) -> dict[str, Any]:
    """Return what a moment alone does to a design, and where it yields, as plain numbers and a sentence."""
    at, end = curve.where(strength), math.degrees(curve.rotation[-1])
    text = f"yields at ±{math.degrees(at[0]):.1f}° by {quantity(at[1], 'N m')}" if at else ""
    return {
        "rotation": _plain(curve.rotation),
        "moment": _plain(curve.moment),
        "yields": at,
        "text": text or f"does not yield up to ±{end:.0f}°",
    }


class _Warnings:
    """The faults of one event by code, each said once."""

    def __init__(self) -> None:
        self.said: dict[str, str] = {}

    def begin(self) -> None:
        """Forget those of the last event."""
        self.said = {}

    def say(self, code: str, detail: str = "") -> None:
        """Add a fault; `detail` stands behind its sentence in brackets."""
        sentence = SENTENCES.get(code, SENTENCES["lost"])
        self.said[code] = f"{sentence[:-1]} ({detail})." if detail else sentence


class Instant:
    """A session between two events: its design, its time, what holds the body, and what is to be said."""

    def _begin(self, preset: str, values: Mapping[str, object], lock_step: bool) -> None:
        """Everything as at the start, with these settings."""
        self.bench, self.clock = Bench(preset, values), Clock(lock_step=lock_step)
        self.warnings = _Warnings()
        self.drive, self.solver = DRIVES[0], next(iter(SOLVERS))
        self.sweeps, self.paused, self.time = SWEEPS, False, 0.0
        self.sight: dict[str, Any] = {"state": "none"}
        self.spread: Array | None = None
        self.wanted = np.zeros(3)
        self._marker: Array | None = None
        self._hand = Hand()
        self.readings = Readings()

    @property
    def grip(self) -> float:
        """Stiffness of the spring from the centre to where the hand is seen [N/m]: a finger's, in series with
        one that turns what the camera cannot tell into no more force than the strips' bending hides."""
        spread = POINTER if self.spread is None else float(np.linalg.norm(self.spread[:2], axis=1).max())
        return 1.0 / (1.0 / FINGER + spread / (SHARE * scales(self.mechanics.values)["force"]))

    @property
    def ways(self) -> Array:
        """Pose of the body over that of the hand (3, 3), as it is held, to first order."""
        tangent, rigid = self.mechanics.snapshot.tangent, np.eye(3)
        if self.drive == "pose" or tangent is None:
            return rigid
        spring = self.grip * np.diag([1.0, 1.0, 0.0])
        if self.drive == "pull":
            return np.asarray(np.linalg.solve(tangent + spring, spring))
        spring = spring[:2, :2] if self.drive == "grip" else np.zeros((2, 2))
        rigid[:2] = np.linalg.solve(tangent[:2, :2] + spring, np.hstack((spring, -tangent[:2, 2:])))
        return rigid

    @property
    def mechanics(self) -> Mechanics:
        """The present design at work."""
        return self.bench.mechanics

    @property
    def placing(self) -> Placing:
        """Where its markers sit."""
        return self.bench.placing


def shown(session: Instant) -> dict[str, Any]:
    """Return the state of a session: equal sessions give equal states, digit by digit."""
    mechanics, now = session.mechanics, session.mechanics.snapshot
    values, moving = mechanics.values, mechanics.moving
    state: dict[str, Any] = {
        "t": session.time,
        "mode": "released" if moving else "held",
        "paused": session.paused,
        "preset": session.bench.preset,
        "values": values,
        "drive": session.drive,
        "solver": session.solver,
        "sweeps": session.sweeps,
        "steps": session.clock.steps,
        "simulated": session.clock.simulated,
        "iterations": now.iterations,
        "sight": session.sight,
        "scale": scales(values),
        **_body(session),
        **_strips(now.reading, values["yield_strength"]),
        "energy": {
            **{name: getattr(now, name) for name in ENERGIES},
            "start": mechanics.begun if moving else None,
        },
        "placing": _placing(session),
        "warnings": [{"code": code, "text": text} for code, text in session.warnings.said.items()],
    }
    state["texts"] = _readout(state, session.readings.mean(now))
    state["status"] = _sentence(state, state["texts"])
    return state


def _body(session: Instant) -> dict[str, Any]:
    """Where the body is, how it moves, what holds it, and how sure that is."""
    now, placing, sd = session.mechanics.snapshot, session.placing, session.readings.sd
    held_by_spring = session.drive in SPRUNG and not session.mechanics.moving
    return {
        "pose": _plain(now.pose),
        "displacement": [*_plain(now.pose[:2] - placing.centre), float(now.pose[2])],
        "wanted": _plain(session.wanted),
        "centre_shift": placing.crossing_shift(now.pose),
        "velocity": _plain(now.velocity),
        "centre": None if now.centre is None else list(now.centre),
        "force": _plain(now.force),
        "stiffness": now.stiffness,
        "grip": session.grip if held_by_spring else None,
        "sd": None if sd is None else _plain(sd),
        "force_sd": _force_sd(session),
    }


def _strips(reading: Reading, strength: float) -> dict[str, Any]:
    """Shapes of the strips, and their stress over their strength [Pa]."""
    strip, place = np.unravel_index(int(np.argmax(reading.stress)), reading.stress.shape)
    largest = float(reading.stress[strip, place])
    stress = {
        "max": largest,
        "of_yield": largest / strength,
        "strip": int(strip),
        "place": int(place),
        "along": _plain(np.round(reading.stress / strength, 4)),
    }
    return {"shape": _plain(reading.shape), "stress": stress}


def _placing(session: Instant) -> dict[str, Any]:
    """Places of markers, clamps and body at rest."""
    placing, pivot = session.placing, session.mechanics.pivot
    return {
        "ground": _plain(placing.ground),
        "marker": _plain(placing.marker(session.mechanics.snapshot.pose)),
        "clamps": _plain(pivot.clamp_points),
        "centre": _plain(pivot.centre),
    }


def _plain(array: Array) -> Any:
    """Return an array as nested lists of floats."""
    return np.asarray(array, dtype=float).tolist()


def _force_sd(session: Instant) -> list[float | None] | None:
    """Standard deviations of force, moment and stiffness; none of forces that are nought by make."""
    sd = session.readings.force_sd
    if sd is None:
        return None
    known: list[float | None] = [value if np.isfinite(value) else None for value in sd.tolist()]
    return [None, None, *known[2:]] if session.drive == "rotation" else known
