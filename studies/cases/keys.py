"""The keys of a pivot's case file, many of them a mechanism's as well, and the attribute that each fills."""

import math
from dataclasses import replace

from studies.cases.materials import MATERIALS
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

#: Sides of a rectangular section, or what follows from them: a case gives one pair.
SIDES = (
    Key(
        section="section",
        name="width_m",
        attribute="width",
        rule=positive("m"),
        optional=True,
        meaning="width b of the rectangular section, out of the plane of motion",
        default="with thickness_m, or the other pair: area_m2 and second_moment_m4",
        example="0.02",
    ),
    Key(
        section="section",
        name="thickness_m",
        attribute="thickness",
        rule=positive("m"),
        optional=True,
        meaning="thickness h of the rectangular section, in the plane of bending",
        default="with width_m, or the other pair",
        example="0.001",
    ),
)
MOMENTS = (
    Key(
        section="section",
        name="area_m2",
        attribute="area",
        rule=positive("m^2"),
        optional=True,
        meaning="area A of the section",
        default="b h of width_m and thickness_m",
        example="2e-5",
    ),
    Key(
        section="section",
        name="second_moment_m4",
        attribute="second_moment_of_area",
        rule=positive("m^4"),
        optional=True,
        meaning="second moment I of the section's area, for bending in the plane",
        default="b h^3 / 12 of width_m and thickness_m",
        example="1.6667e-12",
    ),
)
SECTION = (*SIDES, *MOMENTS)

NAMED = Key(
    section="material",
    name="name",
    attribute="material",
    rule=Choice(names=tuple(MATERIALS)),
    optional=True,
    meaning="a material of the suite, whose values hold where no key gives another",
    default="none: every key is given",
    example='"spring_steel"',
)
ELASTIC = (
    Key(
        section="material",
        name="youngs_modulus_Pa",
        attribute="youngs_modulus",
        rule=positive("Pa"),
        optional=True,
        meaning="Young's modulus E",
        default="the named material's",
        example="206e9",
    ),
    Key(
        section="material",
        name="poisson_ratio",
        attribute="poisson_ratio",
        rule=POISSON,
        optional=True,
        meaning="Poisson's ratio, for what knows shear or the section's curl",
        default="the named material's",
        example="0.29",
    ),
    Key(
        section="material",
        name="density_kg_m3",
        attribute="density",
        rule=positive("kg/m^3"),
        optional=True,
        meaning="density of the strips",
        default="the named material's",
        example="7850",
    ),
)
YIELD = Key(
    section="material",
    name="yield_strength_Pa",
    attribute="yield_strength",
    rule=positive("Pa"),
    optional=True,
    meaning="stress that the strips must stay below",
    default="the named material's, or none",
    example="1020e6",
)
MATERIAL = (NAMED, *ELASTIC, YIELD)

INCREMENTS_KEY = Key(
    section="drive",
    name="increments",
    attribute="increments",
    rule=INCREMENTS,
    meaning="equal increments of the path",
    example="20",
)
ORDER_KEY = Key(
    section="drive",
    name="order",
    attribute="order",
    rule=ORDER,
    optional=True,
    meaning="loads come on before the rotation and stay, or both grow together",
    default=f'"{LOADS_FIRST}"',
    example=f'"{TOGETHER}"',
)
#: When a motion goes on with the rotation that it starts from, and how that changes; without, it lets go.
IN_MOTION = (
    Key(
        section="drive",
        name="history",
        attribute="history",
        rule=History(),
        optional=True,
        meaning="of a motion that drives the rotation on: its factor over time",
        default="a motion lets go",
        example="[[0, 1], [0.01, 0.5]]",
    ),
    Key(
        section="drive",
        name="held_s",
        attribute="held",
        rule=Interval(),
        optional=True,
        meaning="of a motion: from when until when it holds the rotation",
        default="a motion lets go at once",
        example="[0, 0.01]",
    ),
)

KEYS: tuple[Key, ...] = (
    Key(
        section="strip",
        name="length_m",
        attribute="length",
        rule=positive("m"),
        meaning="length L of each of the two strips",
        example="0.08",
    ),
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
        meaning="angle of a strip to the ground plate at rest",
        example="45",
    ),
    Key(
        section="strip",
        name="crossing_ratio",
        attribute="crossing_ratio",
        rule=Number(expected="a number between 0 and 1, both excluded [1]", low=0.0, high=1.0),
        meaning="distance of the crossing point from the ground end of a strip, over L",
        example="0.5",
    ),
    *(replace(key, section="strip") for key in SECTION),
    Key(
        section="strip",
        name="section_depth_m",
        attribute="section_depth",
        rule=positive("m"),
        optional=True,
        meaning="depth of a section that is no rectangle in the plane of bending, for stresses",
        default="sqrt(12 I / A), that of the rectangle",
        example="0.001",
    ),
    Key(
        section="strip",
        name="orientation_deg",
        attribute="orientation",
        rule=ROTATION,
        optional=True,
        meaning="turns the whole pivot about A1, the ground clamp of strip 1, counter-clockwise; "
        "loads and gravity keep their directions",
        default="0",
        example="0",
    ),
    *MATERIAL,
    Key(
        section="body",
        name="mass_kg",
        attribute="body_mass",
        rule=positive("kg"),
        meaning="mass of the moving body",
        example="0.2",
    ),
    Key(
        section="body",
        name="moment_of_inertia_kg_m2",
        attribute="body_moment_of_inertia",
        rule=positive("kg m^2"),
        meaning="its moment of inertia about its centre of mass",
        example="2e-4",
    ),
    Key(
        section="body",
        name="centre_offset_m",
        attribute="centre_offset",
        rule=finite_pair("m"),
        optional=True,
        meaning="its centre of mass from the midpoint of the two clamps on it, in the pivot's own axes",
        default="[0, 0]",
        example="[0, 0]",
    ),
    Key(
        section="drive",
        name="rotation_deg",
        attribute="rotation",
        rule=ROTATION,
        meaning="end of the path, counter-clockwise; 0 holds the body while loads come on",
        example="15",
    ),
    INCREMENTS_KEY,
    ORDER_KEY,
    *IN_MOTION,
)
