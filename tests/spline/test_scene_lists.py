"""Lists of loads, supports and drives on one mechanism, and what has to act on it from outside."""

import math

import numpy as np

from spline_model import BodyDesign, StripDesign, compliant_mechanism, solve_mechanism
from tests import gates

#: A strip of unit length and rigidity, hardly stretched.
STRIP = {"start": (0.0, 0.0), "end": (1.0, 0.0), "area": 1e3, "second_moment_of_area": 1.0}
STRIP |= {"youngs_modulus": 1.0, "density": 1e-3}


def beam(tip=None, points=8, segments=1, joints=None, **parameters):
    """A strip from the ground to a body, or to nothing, with these effects beside its elasticity."""
    names = ("bending", "inextensible", "strip_inertia", "body_inertia", *parameters)
    bodies = [BodyDesign(name=tip, centre=(1.0, 0.0), mass=1.0, moment_of_inertia=1.0)] if tip else []
    strip = StripDesign(name="beam", tip=tip, **STRIP | (joints or {}))
    grid = {"control_points": points, "segments": segments}
    return compliant_mechanism(strips=[strip], bodies=bodies, effects=names, parameters=parameters, **grid)


def test_loads_superpose():
    """Requirement: loads on a tip and on a body add up, each with parameters of its own."""
    pull = [{"force": (0.3, 0.2)}, {"force": (-0.1, 1.8)}]
    turn = [{"moment": 0.2}, {"moment": 0.3}]

    def error(count=2):
        at_tip = [{"strip": "beam", **each, **more} for each, more in zip(pull, turn, strict=True)]
        several = beam("end", applied_force=pull[:count], applied_moment=turn)
        one = beam("end", applied_force={"force": (0.2, 2.0)}, applied_moment={"moment": 0.5})
        places = [solve_mechanism(each).bodies["end"] for each in (one, several)]
        places.append(solve_mechanism(beam(tip_force=at_tip)).tips["beam"])
        return max(np.abs(each - places[0]).max() for each in places)

    gates.hold("spline_lists", error)


def test_a_tip_moment_rolls_up_three_turns():
    """Requirement: the turn of a free end is counted beyond a full one."""

    def error(segments=8):
        moment = {"strip": "beam", "force": (0.0, 0.0), "moment": 6.0 * math.pi}
        path = solve_mechanism(beam(segments=segments, tip_force=moment), increments=30, check=False)
        return np.abs(path.tips["beam"][:, 2] - 6.0 * math.pi * path.load_factor).max()

    gates.hold("spline_turns", error)


def test_reactions_balance_the_loads():
    """Requirement: what drives and supports bear and the clamp bears is in balance with the loads."""
    given = {
        "driven_displacement": {"displacement": (None, 0.2)},
        "driven_rotation": {"angle": 0.4},
        "applied_force": [{"force": (1.0, 0.5)}, {"force": (0.3, -3.0)}],
    }

    def error(weigh=1.0):
        path = solve_mechanism(beam("end", **given))
        assert path.prescribed == (("end", "y"), ("end", "rotation"))
        held, root, place = path.reactions[-1], path.clamp_reactions[-1, 0, 0], path.bodies["end"][-1]
        force = root[:2] + np.array([1.3, held[0] - 2.5])
        moment = root[2] + weigh * held[1] + place[0] * (held[0] - 2.5) - place[1] * 1.3
        return max(abs(force).max(), abs(moment))

    gates.hold("spline_reactions", error)
