"""The keys of case files, of a pivot and of a mechanism, and the attribute that each fills."""

import math
from dataclasses import replace

from studies.cases.materials import MATERIALS
from studies.cases.rules import (
    FREE,
    Choice,
    History,
    Interval,
    Number,
    Text,
    Whole,
    finite,
    finite_pair,
    keys_of,
    not_negative,
    positive,
)

GROUND = "ground"
#: How loads and a driven rotation meet: loads come on before it and stay, or both grow together.
LOADS_FIRST, TOGETHER = "loads first", "together"


def degrees(expected: str, low: float, high: float, *, closed: bool = True) -> Number:
    """Return the rule for an angle that a file gives in degrees."""
    ends = {"closed_low": closed, "closed_high": closed}
    return Number(
        expected=f"{expected} [deg]", low=low, high=high, to_si=math.radians, from_si=math.degrees, **ends
    )


ROTATION = degrees("a number from -360 to 360", -360.0, 360.0)
INCLINATION = degrees("a number between 0 and 90, both excluded", 0.0, 90.0, closed=False)
INCREMENTS = Whole(expected="a whole number from 1 to 100000", low=1, high=100_000)
POISSON = Number(expected="a number above -1 and at most 0.5 [1]", low=-1.0, high=0.5, closed_high=True)
RATIO = Number(expected="a number between 0 and 1, both excluded [1]", low=0.0, high=1.0)
NAME, PLACE = Text(expected="a name"), Text(expected=f"{GROUND} or the name of a body")
TIP = Text(expected=f"{PLACE.expected}, or {FREE}")

# Rows: name in the file, attribute, rule, default ("": it is needed), example, meaning.
# fmt: off
#: Sides of a rectangular section, or what follows from them: a case gives one pair.
SIDES = keys_of(
    "section",
    ("width_m", "width", positive("m"), "with thickness_m, or the other pair: area_m2 and second_moment_m4",
     "0.02", "width b of the rectangular section, out of the plane of motion"),
    ("thickness_m", "thickness", positive("m"), "with width_m, or the other pair",
     "0.001", "thickness h of the rectangular section, in the plane of bending"),
)
MOMENTS = keys_of(
    "section",
    ("area_m2", "area", positive("m^2"), "b h of width_m and thickness_m",
     "2e-5", "area A of the section"),
    ("second_moment_m4", "second_moment_of_area", positive("m^4"), "b h^3 / 12 of width_m and thickness_m",
     "1.6667e-12", "second moment I of the section's area, for bending in the plane"),
)
SECTION = (*SIDES, *MOMENTS)

MATERIAL = NAMED, *_VALUES = keys_of(
    "material",
    ("name", "material", Choice(names=tuple(MATERIALS)), "none: every key is given",
     '"spring_steel"', "a material of the suite, whose values hold where no key gives another"),
    ("youngs_modulus_Pa", "youngs_modulus", positive("Pa"), "the named material's",
     "206e9", "Young's modulus E"),
    ("poisson_ratio", "poisson_ratio", POISSON, "the named material's",
     "0.29", "Poisson's ratio, for what knows shear or the section's curl"),
    ("density_kg_m3", "density", positive("kg/m^3"), "the named material's",
     "7850", "density of the strips"),
    ("yield_strength_Pa", "yield_strength", positive("Pa"), "the named material's, or none",
     "1020e6", "stress that the strips must stay below"),
)
ELASTIC = tuple(_VALUES[:-1])

#: Of any path; and of a motion that goes on with the rotation that it starts from: without, it lets go.
_PATH = keys_of(
    "drive",
    ("increments", "increments", INCREMENTS, "", "20", "equal increments of the path"),
    ("order", "order", Choice(names=(LOADS_FIRST, TOGETHER)), f'"{LOADS_FIRST}"',
     f'"{TOGETHER}"', "loads come on before the rotation and stay, or both grow together"),
    ("history", "history", History(), "a motion lets go",
     "[[0, 1], [0.01, 0.5]]", "of a motion that drives the rotation on: its factor over time"),
    ("held_s", "held", Interval(), "a motion lets go at once",
     "[0, 0.01]", "of a motion: from when until when it holds the rotation"),
)

#: Of a pivot.
KEYS = (
    *keys_of(
        "strip",
        ("length_m", "length", positive("m"), "", "0.08", "length L of each of the two strips"),
        ("inclination_deg", "inclination", INCLINATION, "",
         "45", "angle of a strip to the ground plate at rest"),
        ("crossing_ratio", "crossing_ratio", RATIO, "",
         "0.5", "distance of the crossing point from the ground end of a strip, over L"),
    ),
    *(replace(key, section="strip") for key in SECTION),
    *keys_of(
        "strip",
        ("section_depth_m", "section_depth", positive("m"), "sqrt(12 I / A), that of the rectangle",
         "0.001", "depth of a section that is no rectangle in the plane of bending, for stresses"),
        ("orientation_deg", "orientation", ROTATION, "0",
         "0", "turns the whole pivot about A1, the ground clamp of strip 1, counter-clockwise; "
         "loads and gravity keep their directions"),
    ),
    *MATERIAL,
    *keys_of(
        "body",
        ("mass_kg", "body_mass", positive("kg"), "", "0.2", "mass of the moving body"),
        ("moment_of_inertia_kg_m2", "body_moment_of_inertia", positive("kg m^2"), "",
         "2e-4", "its moment of inertia about its centre of mass"),
        ("centre_offset_m", "centre_offset", finite_pair("m"), "[0, 0]",
         "[0, 0]", "its centre of mass from the midpoint of the two clamps on it, in the pivot's own axes"),
    ),
    *keys_of(
        "drive",
        ("rotation_deg", "rotation", ROTATION, "",
         "15", "end of the path, counter-clockwise; 0 holds the body while loads come on"),
    ),
    *_PATH,
)

#: Of a mechanism.
STRIP = keys_of(
    "strips",
    ("name", "name", NAME, "", '"strip"', "what the strip is called"),
    ("start_m", "start", finite_pair("m"), "", "[0, 0]", "where it begins at rest"),
    ("end_m", "end", finite_pair("m"), "", "[0.1, 0]", "where it ends at rest"),
    ("root", "root", PLACE, f'"{GROUND}"', f'"{GROUND}"', "what its beginning is clamped to"),
    ("tip", "tip", TIP, "", '"body"', "what its end is clamped to"),
    ("rise_m", "rise", finite("m"), "0, straight",
     "0.002", "sagitta of the circular arc that it is at rest, to the left of start to end"),
)
BODY = keys_of(
    "bodies",
    ("name", "name", NAME, "", '"body"', "what the body is called"),
    ("centre_m", "centre", finite_pair("m"), "", "[0.11, 0]", "its centre of mass at rest"),
    ("mass_kg", "mass", not_negative("kg"), "", "0.05", "its mass"),
    ("moment_of_inertia_kg_m2", "moment_of_inertia", not_negative("kg m^2"), "",
     "5e-6", "its moment of inertia about its centre of mass"),
)
DRIVE = (
    *keys_of(
        "drive",
        ("body", "body", Text(expected="the name of a body"), "the only one there is",
         '"body"', "the body that is driven, let go, and whose swing is reported"),
        ("rotation_deg", "rotation", ROTATION, "none: the bodies follow the loads",
         "20", "that the body is driven to, counter-clockwise"),
    ),
    *_PATH,
)
# fmt: on
#: What a strip may have of its own: as [section] and [material], whose name is then the key `material`.
OWN = tuple(
    replace(key, section="strips", name="material" if key is NAMED else key.name)
    for key in (*SECTION, *MATERIAL)
)
SECTIONS = ("strips", "bodies", "section", "material", "drive", "scene", "effects")
