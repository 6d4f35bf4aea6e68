"""What a session shows: numbers and sentences of one instant, ready for JSON, in SI units."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from studies.interactive.pivot.design import free_stiffness, free_turn
from studies.interactive.session.readout import readout, scales, sentence

if TYPE_CHECKING:
    from studies.interactive.session.session import Session

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
    "no-catch": "The moving body could not be held here: try again.",
    "stopped": "The solver stopped: the last good state is kept and time is paused.",
    "under-resolved": "The step is too long for this swing, which it damps: take a slower time scale.",
    "no-rest": "Both markers must be seen to take their pose as rest.",
    "empty": "There is nothing.",
    "not-flat": "The markers do not lie in one plane, or the lens bends the picture.",
    "refused": "The markers fit no plane: this pose was left out.",
    "sizes": "The two markers have different sizes: print both at 100 % and measure the ruler.",
    "blurred": "The edges are blurred or dark: hold still, more light.",
    "followed": "A corner is covered: the marker is followed by its edges.",
    "no-picture": "A picture could not be read.",
}


class Warnings:
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


def shown(session: "Session") -> dict[str, Any]:
    """Return the state of a session: equal sessions give equal states, digit by digit."""
    mechanics, now = session.mechanics, session.mechanics.snapshot
    reading, values = now.reading, session.mechanics.values
    sd, force_sd = _spreads(session)
    strip, place = np.unravel_index(int(np.argmax(reading.stress)), reading.stress.shape)
    state: dict[str, Any] = {
        "t": session.time,
        "mode": "released" if mechanics.moving else "held",
        "paused": session.paused,
        "preset": session.bench.preset,
        "values": values,
        "drive": session.drive,
        "solver": session.solver,
        "step": mechanics.step,
        "steps": session.clock.steps,
        "simulated": session.clock.simulated,
        "lag": session.clock.lag,
        "pose": plain(now.pose),
        "displacement": [*plain(now.pose[:2] - session.placing.centre), float(now.pose[2])],
        "wanted": plain(session.wanted),
        "velocity": plain(now.velocity),
        "shape": plain(reading.shape),
        "force": plain(now.force),
        "stiffness": now.stiffness,
        "stress": {
            "max": float(reading.stress[strip, place]),
            "of_yield": float(reading.stress[strip, place]) / values["yield_strength"],
            "strip": int(strip),
            "place": int(place),
        },
        "strain": plain(reading.strain),
        "energy": {
            "strain": now.strain,
            "kinetic": now.kinetic,
            "dissipated": now.dissipated,
            "lost": now.lost,
            "start": session.start_energy if mechanics.moving else None,
        },
        "centre": None if now.centre is None else list(now.centre),
        "iterations": now.iterations,
        "sight": session.sight,
        "sd": sd,
        "force_sd": force_sd,
        "scale": scales(values),
        "placing": {
            "ground": plain(session.placing.ground),
            "marker": plain(session.placing.marker(now.pose)),
            "clamps": plain(mechanics.pivot.clamp_points),
            "centre": plain(mechanics.pivot.centre),
        },
        "warnings": [{"code": code, "text": text} for code, text in session.warnings.said.items()],
    }
    state["texts"] = readout(state)
    state["status"] = sentence(state, state["texts"])
    return state


def plain(array: NDArray[np.float64]) -> Any:
    """Return an array as nested lists of floats."""
    return np.asarray(array, dtype=float).tolist()


def _spreads(session: "Session") -> tuple[list[float] | None, list[float | None] | None]:
    """Standard deviations of the pose that is shown and of what holds it, to first order.

    A hand that holds the rotation alone has that of the rotation alone: the body goes where no force is
    needed, forces are nought by construction, and the moment follows with the stiffness of a free centre.
    """
    tangent, sd = session.mechanics.snapshot.tangent, session.spread
    if sd is None or tangent is None:
        return None, None
    if session.drive == "rotation":
        return plain(np.abs(free_turn(tangent)) * sd[2]), [None, None, abs(free_stiffness(tangent)) * sd[2]]
    return plain(sd), plain(np.sqrt((tangent**2) @ (sd**2)))
