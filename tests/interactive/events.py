"""Sessions and their events for the tests."""

import math

import numpy as np

from studies.interactive.session import Session

FRAME = 0.04


def session(preset="polymer", drive="rotation", **more):
    """A session whose hand holds the rotation alone unless said otherwise."""
    made = Session(preset, **more)
    made.feed({"do": "drive", "by": drive, "t": 0.0})
    return made


def turned(made, *degrees, start=0.0):
    """Hold these rotations one after the other and return the last state."""
    for k, angle in enumerate(degrees):
        state = made.feed({"do": "pose", "pose": [0.0, 0.0, math.radians(angle)], "t": start + k * FRAME})
    return state


def codes(state):
    """Codes of the faults of a state."""
    return [warning["code"] for warning in state["warnings"]]


def total(state):
    """Strain and kinetic energy."""
    return state["energy"]["strain"] + state["energy"]["kinetic"]


def seen(made, displacement, angle, **more):
    """The event of markers that show a body at a displacement [m] and angle [rad]."""
    body = np.array([*(made.mechanics.placing.centre + displacement), angle])
    return {"do": "seen", "marker": made.mechanics.placing.marker(body).tolist(), **more}
