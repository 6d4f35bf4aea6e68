"""Scenes and closed forms that several tests use."""

import math

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from spline_model.basis import LegendreModes, SlideModes, bezier
from spline_model.effects import (
    AppliedForce,
    AppliedMoment,
    Bending,
    BodyInertia,
    Clamp,
    MixedStretching,
    StripInertia,
)
from spline_model.scene import Body, Scene, Strip

LENGTH = 0.7
RIGIDITY = 3.0


def cantilever(*, control_points, force=0.0, moment=0.0, compliance=0.0):
    """A strip along x, clamped at the origin, with a body at its tip that carries the load.

    force in EI/L^2 along +y, moment in EI/L; compliance 1/EA in L^2/EI.
    """
    basis = bezier(control_points)
    axial = LegendreModes(count=control_points - 2)
    points = np.column_stack((basis.greville * LENGTH, np.zeros(control_points)))
    rule = {"strip": "strip", "gauss_points": control_points + 2}
    unit = RIGIDITY / LENGTH**2
    slide = SlideModes(basis=basis, axial=axial)
    return Scene(
        strips=(Strip(name="strip", basis=basis, control_points=points),),
        bodies=(Body(name="tip", centre=np.array([LENGTH, 0.0])),),
        effects=(
            Bending(flexural_rigidity=RIGIDITY, **rule),
            MixedStretching(axial_compliance=compliance / unit, modes=axial, **rule),
            MixedStretching(axial_compliance=0.1 / unit, modes=slide, **rule),
            Clamp(strip="strip", end="start"),
            Clamp(strip="strip", end="end", to="tip"),
            AppliedForce(body="tip", force=(0.0, force * unit)),
            AppliedMoment(body="tip", moment=moment * RIGIDITY / LENGTH),
        ),
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


def swinging(*, control_points, tip_mass=None, tip_inertia=None, clamped=True, compliance=0.0):
    """A strip along x in motion, clamped or free at the origin, mu = 1 kg/m.

    With a tip mass [mu L] and inertia [mu L^3] a body is clamped to its end. compliance 1/EA
    in L^2/EI; the slide stiffness is 100 EI/L^2.
    """
    scene = cantilever(control_points=control_points, compliance=compliance)
    basis, axial = scene.strips[0].basis, LegendreModes(count=control_points - 2)
    unit, with_body = RIGIDITY / LENGTH**2, tip_mass is not None
    rule = {"strip": "strip", "gauss_points": control_points + 2}
    effects = [
        Bending(flexural_rigidity=RIGIDITY, **rule),
        MixedStretching(axial_compliance=compliance / unit, modes=axial, **rule),
        MixedStretching(axial_compliance=0.01 / unit, modes=SlideModes(basis=basis, axial=axial), **rule),
        StripInertia(strip="strip", linear_density=1.0),
    ]
    if clamped:
        effects.append(Clamp(strip="strip", end="start"))
    if with_body:
        effects.append(Clamp(strip="strip", end="end", to="tip"))
        effects.append(
            BodyInertia(body="tip", mass=tip_mass * LENGTH, moment_of_inertia=tip_inertia * LENGTH**3)
        )
    return Scene(strips=scene.strips, bodies=scene.bodies if with_body else (), effects=tuple(effects))
