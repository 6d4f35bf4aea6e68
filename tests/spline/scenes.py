"""A cantilever with a body at its tip, and the closed form of its elastica."""

import math

from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from spline_model import BodyDesign, StripDesign, compliant_mechanism

LENGTH = 0.7
RIGIDITY = 3.0
SECTION = {"area": 1.0, "second_moment_of_area": 1e-2, "youngs_modulus": 1e2 * RIGIDITY, "density": 1.0}


def cantilever(*effects, force=0.0, moment=0.0, tip=(0.0, 0.0), **discretisation):
    """A strip along x that does not stretch, clamped at the origin, with a body at its tip.

    force in EI/L^2 along +y, moment in EI/L; tip: mass [mu L] and inertia [mu L^3] of the body, mu = 1 kg/m.
    """
    unit = RIGIDITY / LENGTH**2
    parameters = {
        "applied_force": {"force": (0.0, force * unit)},
        "applied_moment": {"moment": moment * unit * LENGTH},
    }
    mass, inertia = tip[0] * LENGTH, tip[1] * LENGTH**3
    return compliant_mechanism(
        strips=[StripDesign(name="strip", start=(0.0, 0.0), end=(LENGTH, 0.0), tip="tip", **SECTION)],
        bodies=[BodyDesign(name="tip", centre=(LENGTH, 0.0), mass=mass, moment_of_inertia=inertia)],
        effects=("bending", "inextensible", *effects),
        parameters={name: given for name, given in parameters.items() if name in effects},
        **discretisation,
    )


def elastica_tip(load):
    """Tip (x/L, y/L, rotation) of an inextensible cantilever under a tip force of ``load`` EI/L^2.

    Bisshopp and Drucker, Large deflection of cantilever beams, Q Appl Math 3 (1945) 272.
    """

    def parts(rotation):
        m = (1.0 + math.sin(rotation)) / 2.0
        return m, math.asin(1.0 / math.sqrt(2.0 * m))

    def too_long(rotation):
        m, phi = parts(rotation)
        return ellipk(m) - ellipkinc(phi, m) - math.sqrt(load)

    rotation = brentq(too_long, 1e-9, math.pi / 2 - 1e-12, xtol=1e-15, rtol=1e-15)
    m, phi = parts(rotation)
    x = math.sqrt(2.0 * math.sin(rotation) / load)
    y = 1.0 - 2.0 / math.sqrt(load) * (ellipe(m) - ellipeinc(phi, m))
    return x, y, rotation
