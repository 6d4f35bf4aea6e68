"""The keys of a mechanism's case file, beside those that a pivot's has as well, and what each one fills."""

from dataclasses import replace

from studies.cases.keys import IN_MOTION, INCREMENTS_KEY, MATERIAL, NAMED, ORDER_KEY, ROTATION, SECTION
from studies.cases.rules import FREE, Key, Text, finite, finite_pair, not_negative

GROUND = "ground"

_NAME = Text(expected="a name")
_PLACE = Text(expected=f"{GROUND} or the name of a body")
STRIP = (
    Key(
        section="strips",
        name="name",
        attribute="name",
        rule=_NAME,
        meaning="what the strip is called",
        example='"strip"',
    ),
    Key(
        section="strips",
        name="start_m",
        attribute="start",
        rule=finite_pair("m"),
        meaning="where it begins at rest",
        example="[0, 0]",
    ),
    Key(
        section="strips",
        name="end_m",
        attribute="end",
        rule=finite_pair("m"),
        meaning="where it ends at rest",
        example="[0.1, 0]",
    ),
    Key(
        section="strips",
        name="root",
        attribute="root",
        rule=_PLACE,
        optional=True,
        meaning="what its beginning is clamped to",
        default=f'"{GROUND}"',
        example=f'"{GROUND}"',
    ),
    Key(
        section="strips",
        name="tip",
        attribute="tip",
        rule=Text(expected=f"{_PLACE.expected}, or {FREE}"),
        meaning="what its end is clamped to",
        example='"body"',
    ),
    Key(
        section="strips",
        name="rise_m",
        attribute="rise",
        rule=finite("m"),
        optional=True,
        meaning="sagitta of the circular arc that it is at rest, to the left of start to end",
        default="0, straight",
        example="0.002",
    ),
)
BODY = (
    Key(
        section="bodies",
        name="name",
        attribute="name",
        rule=_NAME,
        meaning="what the body is called",
        example='"body"',
    ),
    Key(
        section="bodies",
        name="centre_m",
        attribute="centre",
        rule=finite_pair("m"),
        meaning="its centre of mass at rest",
        example="[0.11, 0]",
    ),
    Key(
        section="bodies",
        name="mass_kg",
        attribute="mass",
        rule=not_negative("kg"),
        meaning="its mass",
        example="0.05",
    ),
    Key(
        section="bodies",
        name="moment_of_inertia_kg_m2",
        attribute="moment_of_inertia",
        rule=not_negative("kg m^2"),
        meaning="its moment of inertia about its centre of mass",
        example="5e-6",
    ),
)
DRIVE = (
    Key(
        section="drive",
        name="body",
        attribute="body",
        rule=Text(expected="the name of a body"),
        optional=True,
        meaning="the body that is driven, let go, and whose swing is reported",
        default="the only one there is",
        example='"body"',
    ),
    Key(
        section="drive",
        name="rotation_deg",
        attribute="rotation",
        rule=ROTATION,
        optional=True,
        meaning="that the body is driven to, counter-clockwise",
        default="none: the bodies follow the loads",
        example="20",
    ),
    INCREMENTS_KEY,
    ORDER_KEY,
    *IN_MOTION,
)
#: What a strip may have of its own: as [section] and [material], whose name is then the key `material`.
OWN = tuple(
    replace(key, section="strips", name="material" if key is NAMED else key.name)
    for key in (*SECTION, *MATERIAL)
)
SECTIONS = ("strips", "bodies", "section", "material", "drive", "scene", "effects")
