"""A cantilever with a body at its tip."""

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
