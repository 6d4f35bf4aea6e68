"""From a pivot in motion to its swing in reduced coordinates, and back to the records of a run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.fast.frame import Frame, frame_of, grid_of, is_fast
from spline_model.fast.swing import Swing, swing_of
from spline_model.kernels.motion import Motion
from spline_model.mechanism import Mechanism

Array = NDArray[np.float64]

UNDAMPED = {"bending", "stretching", "strip_inertia", "section_rotary_inertia", "body_inertia"}
"""Effects that a swing may have."""


def is_swing(mechanism: Mechanism, system: System) -> bool:
    """Whether a motion has the fast form: strips with inertia from the ground to one free body."""
    return (
        is_fast(mechanism)
        and set(mechanism.effects) <= UNDAMPED
        and {"strip_inertia", "body_inertia"} <= set(mechanism.effects)
        and not system.tables.drives.row.size
    )


def swing(mechanism: Mechanism, system: System, motion: Motion) -> Swing:
    """Constants of the swing, masses from those of the system in motion."""
    layout, design = system.layout, mechanism.design
    strips = [layout.strip(s.name) for s in design.strips]
    masses = [motion.mass[at, at][::2, ::2] for at in strips]
    body = np.diag(motion.mass)[layout.body(design.bodies[0].name)]
    return swing_of(frame_of(mechanism), grid_of(design), masses, body[[0, 2]])


def reduced(mechanism: Mechanism, system: System, frame: Frame, z: Array, v: Array) -> tuple[Array, Array]:
    """Coordinates r and rates w, (R,) each, of a state z (N,), v (Q,) whose clamps hold."""
    layout, design = system.layout, mechanism.design
    at_body = layout.body(design.bodies[0].name)
    places, rates = [z[at_body]], [v[at_body]]
    for s, strip in enumerate(design.strips):
        c, d = frame.axis[s]
        to_local = np.array([[c, -d], [d, c]]) / frame.length[s]
        local = (z[layout.strip(strip.name)].reshape(-1, 2) - frame.root[s]) @ to_local
        rate = v[layout.strip(strip.name)].reshape(-1, 2) @ to_local
        chord = local[-1] - local[-2]
        reach = float(np.hypot(*chord))
        places += [local[1, :1], local[2:-2].ravel(), np.array([reach])]
        rates += [rate[1, :1], rate[2:-2].ravel(), np.array([chord @ (rate[-1] - rate[-2]) / reach])]
    return np.concatenate(places), np.concatenate(rates)


def coordinates(
    mechanism: Mechanism, system: System, frame: Frame, r: Array, w: Array
) -> tuple[Array, Array]:
    """Coordinates q and velocities v, (K, Q) each, of K states r with rates w, (K, R)."""
    layout, design = system.layout, mechanism.design
    q, v = (np.zeros((len(r), layout.coordinate_count)) for _ in range(2))
    at_body = layout.body(design.bodies[0].name)
    q[:, at_body], v[:, at_body] = r[:, :3], w[:, :3]
    turn, spin = r[:, 2:3], w[:, 2:3]
    out = np.hstack((np.cos(turn), np.sin(turn)))
    across = np.hstack((-out[:, 1:], out[:, :1]))
    n = design.discretisation.control_points
    own = 2 * n - 6
    for s, strip in enumerate(design.strips):
        at, length = 3 + s * own, frame.length[s]
        arm = out * frame.arm[s, 0] + across * frame.arm[s, 1]
        arm_rate = spin * (across * frame.arm[s, 0] - out * frame.arm[s, 1])
        to_local = np.array([frame.axis[s], [-frame.axis[s, 1], frame.axis[s, 0]]]).T
        points, rates = (np.zeros((len(r), n, 2)) for _ in range(2))
        for values, given in ((points, r), (rates, w)):
            values[:, 1, 0] = given[:, at]
            values[:, 2 : n - 2] = given[:, at + 1 : at + own - 1].reshape(len(r), n - 4, 2)
        points[:, n - 1] = (r[:, :2] + arm - frame.root[s]) @ to_local / length
        rates[:, n - 1] = (w[:, :2] + arm_rate) @ to_local / length
        reach, reach_rate = r[:, at + own - 1, None], w[:, at + own - 1, None]
        points[:, n - 2] = points[:, n - 1] - reach * out
        rates[:, n - 2] = rates[:, n - 1] - reach_rate * out - reach * spin * across
        place = layout.strip(strip.name)
        q[:, place] = (frame.root[s] + length * points @ to_local.T).reshape(len(r), 2 * n)
        v[:, place] = (length * rates @ to_local.T).reshape(len(r), 2 * n)
    return q, v
