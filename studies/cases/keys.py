"""The keys of a pivot's case file and the attribute of `Problem` that each one fills."""

import math

from studies.cases.rules import Choice, History, Interval, Key, Number, Whole, finite_pair, positive

ROTATION = Number(
    expected="a number from -360 to 360 [deg]",
    low=-360.0,
    high=360.0,
    closed_low=True,
    closed_high=True,
    to_si=math.radians,
    from_si=math.degrees,
)
INCREMENTS = Whole(expected="a whole number from 1 to 100000", low=1, high=100_000)

#: How loads and a driven rotation meet: loads come on before it and stay, or both grow together.
LOADS_FIRST, TOGETHER = "loads first", "together"
ORDER = Choice(names=(LOADS_FIRST, TOGETHER))

POISSON = Number(expected="a number above -1 and at most 0.5 [1]", low=-1.0, high=0.5, closed_high=True)

#: When a motion goes on with the rotation that it starts from, and how that changes; without, it lets go.
IN_MOTION = (
    Key(section="drive", name="history", attribute="history", rule=History(), optional=True),
    Key(section="drive", name="held_s", attribute="held", rule=Interval(), optional=True),
)

KEYS: tuple[Key, ...] = (
    Key(section="strip", name="length_m", attribute="length", rule=positive("m")),
    Key(
        section="strip",
        name="inclination_deg",
        attribute="inclination",
        rule=Number(
            expected="a number between 0 and 90, both excluded [deg]",
            low=0.0,
            high=90.0,
            to_si=math.radians,
            from_si=math.degrees,
        ),
    ),
    Key(
        section="strip",
        name="crossing_ratio",
        attribute="crossing_ratio",
        rule=Number(expected="a number between 0 and 1, both excluded [1]", low=0.0, high=1.0),
    ),
    Key(section="strip", name="area_m2", attribute="area", rule=positive("m^2")),
    Key(section="strip", name="second_moment_m4", attribute="second_moment_of_area", rule=positive("m^4")),
    Key(
        section="strip", name="section_depth_m", attribute="section_depth", rule=positive("m"), optional=True
    ),
    Key(section="material", name="youngs_modulus_Pa", attribute="youngs_modulus", rule=positive("Pa")),
    Key(
        section="material",
        name="poisson_ratio",
        attribute="poisson_ratio",
        rule=POISSON,
    ),
    Key(section="material", name="density_kg_m3", attribute="density", rule=positive("kg/m^3")),
    Key(section="body", name="mass_kg", attribute="body_mass", rule=positive("kg")),
    Key(
        section="body",
        name="moment_of_inertia_kg_m2",
        attribute="body_moment_of_inertia",
        rule=positive("kg m^2"),
    ),
    Key(
        section="body",
        name="centre_offset_m",
        attribute="centre_offset",
        rule=finite_pair("m"),
    ),
    Key(section="drive", name="rotation_deg", attribute="rotation", rule=ROTATION),
    Key(section="drive", name="increments", attribute="increments", rule=INCREMENTS),
    Key(section="drive", name="order", attribute="order", rule=ORDER, optional=True),
    *IN_MOTION,
)
