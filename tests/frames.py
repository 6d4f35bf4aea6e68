"""Frames with published limit loads, and strips that buckle: mechanisms for tests of either model.

`models` is the package that makes the mechanism: `spline_model` or `fe_reference`.
"""

import math

import spline_model
from tests.table_one import SECTION

STATIC = ("bending", "stretching")
#: Mass and shear do not matter.
UNITS = {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "density": 1.0}

#: Spring steel, 100 mm x 10 mm x 0.5 mm, next to weightless.
LENGTH = 0.1
STEEL = {
    "area": 5e-6,
    "second_moment_of_area": 0.01 * 0.5e-3**3 / 12,
    "youngs_modulus": 206e9,
    "poisson_ratio": 0.29,
    "density": 1e-3,
}
RIGIDITY = STEEL["youngs_modulus"] * STEEL["second_moment_of_area"]
# by collocation on the equations of the extensible elastica (scipy's solve_bvp, tolerance 1e-8)
LED_TIP = 15.204414550  # deg
HEAVY_TIPS = {3.0: -71.307634279, 5.0: -124.497920896}  # deg, by weight in EI/L^2


def one_strip(
    models,
    effects,
    parameters,
    *,
    end=(LENGTH, 0.0),
    centre=None,
    mass=0.0,
    inertia=1e-6,
    section=STEEL,
    **settings,
):
    """A straight strip of spring steel, or of another section, clamped, with a body at its tip."""
    strip = models.StripDesign(name="strip", start=(0.0, 0.0), end=end, tip="tip", **section)
    body = models.BodyDesign(name="tip", centre=centre or end, mass=mass, moment_of_inertia=inertia)
    return models.compliant_mechanism(
        strips=[strip], bodies=[body], effects=(*STATIC, *effects), parameters=parameters, **settings
    )


def led(models, displacement=(-1.3e-3, 13e-3), **settings):
    """The strip as a cantilever whose tip is led, and free to turn."""
    given = {"driven_displacement": {"displacement": displacement}}
    return one_strip(models, given, given, **settings)


def heavy(models, weight, offset=1e-3, **settings):
    """The strip as an upright column under a body of a weight [EI/L^2], off its centre [m]."""
    given = {"gravity": {"acceleration": (0.0, -10.0)}}
    mass = weight * RIGIDITY / LENGTH**2 / 10.0
    more = {"end": (0.0, LENGTH), "centre": (offset, LENGTH), "mass": mass}
    return one_strip(models, given, given, **more, **settings)


def tip(answer, state=-1):
    """Rotation of the tip's body [deg]."""
    return math.degrees(answer.bodies["tip"][state, 2])


def column(models=spline_model, *, load, slenderness=1e3, side=0.0, effects=STATIC, **discretisation):
    """A cantilever column of length 1 and EI = 1 along x; ``load`` [EI/L^2] pushes its tip back to the root.

    slenderness: L sqrt(EA / EI); side: part of the load that acts across, the imperfection.
    """
    section = UNITS | {"area": slenderness**2, "second_moment_of_area": 1.0}
    strip = models.StripDesign(name="column", start=(0.0, 0.0), end=(1.0, 0.0), tip="tip", **section)
    return models.compliant_mechanism(
        strips=[strip],
        bodies=[models.BodyDesign(name="tip", centre=(1.0, 0.0))],
        effects=(*effects, "applied_force"),
        parameters={"applied_force": {"body": "tip", "force": (-load, side * load)}},
        **discretisation,
    )


def opposed(models=spline_model, *, offset=0.01, **discretisation):
    """A body on two parallel strips of Table 1's section that come from opposite sides, 0.1 m long.

    Turned clockwise, both strips are pushed together alike: half a turn maps the pivot onto
    itself, until the strips buckle and the body gives way.
    """
    half = 0.05
    ends = (((-half, -offset), (half, -offset)), ((half, offset), (-half, offset)))
    strips = [
        models.StripDesign(name=f"strip_{i}", start=start, end=end, tip="body", **SECTION)
        for i, (start, end) in enumerate(ends, start=1)
    ]
    body = models.BodyDesign(name="body", centre=(0.0, 0.0))
    return models.compliant_mechanism(strips=strips, bodies=[body], effects=STATIC, **discretisation)
