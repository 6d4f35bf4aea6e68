"""The keys of case files, of a pivot, of a mechanism and of effects, and the attribute that each fills; and
the materials that they may name, each value with its source."""

import tomllib
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

from studies.cases import rules
from studies.cases.rules import FREE, Key, Rule, choice, finite_pair, keys_of, not_negative, positive, text

_FILE = Path(__file__).parent / "tables" / "materials.toml"
#: Linear elastic materials at room temperature by name: values by attribute in SI, title, source, and what
#: was found again.
MATERIALS: dict[str, dict[str, Any]] = tomllib.loads(_FILE.read_text(encoding="utf-8"))

GROUND = "ground"
#: How loads and a driven rotation meet: loads come on before it and stay, or both grow together.
LOADS_FIRST, TOGETHER = "loads first", "together"


ROTATION = rules.number("a number from -360 to 360 [deg]", -360.0, 360.0, closed="low and high", degrees=True)
DRIVEN = rules.number("a finite number [deg]", degrees=True)
INCLINATION = rules.number("a number between 0 and 90, both excluded [deg]", 0.0, 90.0, degrees=True)
INCREMENTS = rules.whole(1, 100_000)
POISSON = rules.number("a number above -1 and at most 0.5 [1]", -1.0, 0.5, closed="high")
RATIO = rules.number("a number between 0 and 1, both excluded [1]", 0.0, 1.0)
NAME, PLACE = text("a name"), text(f"{GROUND} or the name of a body")
TIP = replace(
    text(f"{PLACE.expected}, or {FREE}"),
    read=lambda place: None if place == FREE else place,
    in_file=lambda place: place or FREE,
)
CLAMP, HINGE = "clamp", "hinge"
JOINT = choice(CLAMP, HINGE)

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
TAPER = keys_of(
    "section",
    ("width_end_m", "width_end", positive("m"), "width_m",
     "0.01", "width at the end of a tapered strip; it changes linearly along the strip"),
    ("thickness_end_m", "thickness_end", positive("m"), "thickness_m",
     "0.0005", "thickness at the end of a tapered strip; it changes linearly along the strip"),
)
(FIBRE,) = keys_of(
    "section",
    ("outer_fibre_m", "outer_fibre", positive("m"), "thickness_m / 2; without a thickness there is no stress",
     "0.0005", "distance of the outermost fibre from the neutral axis of a section given by A and I"),
)
SECTION = (*SIDES, *TAPER, *MOMENTS, FIBRE)

MATERIAL = NAMED, *_VALUES = keys_of(
    "material",
    ("name", "material", choice(*MATERIALS), "none: every key is given",
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

#: Of any path; and of a motion that prescribes the rotation further: without it, the rotation is released.
_PATH = keys_of(
    "drive",
    ("increments", "increments", INCREMENTS, "", "20", "equal increments of the path"),
    ("order", "order", choice(LOADS_FIRST, TOGETHER), f'"{LOADS_FIRST}"',
     f'"{TOGETHER}"', "loads come on before the rotation and stay, or both grow together"),
    ("history", "history", rules.HISTORY, "released",
     "[[0, 1], [0.01, 0.5]]", "of a motion that drives the rotation on: its factor over time"),
    ("held_s", "held", rules.INTERVAL, "released at once",
     "[0, 0.01]", "of a motion: from when until when it holds the rotation"),
)

_PIVOT = (
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
        ("rotation_deg", "rotation", DRIVEN, "",
         "15", "end of the path, counter-clockwise; 0 holds the body while loads come on"),
    ),
    *_PATH,
)
#: Tables of a pivot's file.
PIVOT = {section: tuple(rows) for section, rows in groupby(_PIVOT, lambda key: key.section)}

#: Of a mechanism.
STRIP = keys_of(
    "strips",
    ("name", "name", NAME, "", '"strip"', "what the strip is called"),
    ("start_m", "start", finite_pair("m"), "", "[0, 0]", "where it begins at rest"),
    ("end_m", "end", finite_pair("m"), "", "[0.1, 0]", "where it ends at rest"),
    ("root", "root", PLACE, f'"{GROUND}"', f'"{GROUND}"', "what its beginning is clamped to"),
    ("tip", "tip", TIP, "", '"body"', "what its end is clamped to"),
    ("root_joint", "root_joint", JOINT, f'"{CLAMP}"', f'"{HINGE}"', "whether its root turns freely"),
    ("tip_joint", "tip_joint", JOINT, f'"{CLAMP}"', f'"{HINGE}"', "whether its tip turns freely"),
    ("rise_m", "rise", rules.finite("m"), "0, straight",
     "0.002", "sagitta of the circular arc that it is at rest, to the left of start to end; half of the "
     "distance of its ends for a half circle, more for a longer arc"),
)
BODY = keys_of(
    "bodies",
    ("name", "name", NAME, "", '"body"', "what the body is called"),
    ("centre_m", "centre", finite_pair("m"), "", "[0.11, 0]", "its centre of mass at rest"),
    ("mass_kg", "mass", not_negative("kg"), "", "0.05", "its mass"),
    ("moment_of_inertia_kg_m2", "moment_of_inertia", not_negative("kg m^2"), "",
     "5e-6", "its moment of inertia about its centre of mass"),
)
POINT = keys_of(
    "points",
    ("name", "name", NAME, "", '"point"', "what the point is called"),
    ("body", "body", text("the name of a body"), "the only one there is", '"body"', "of which body"),
    ("at_m", "at", finite_pair("m"), "", "[0.12, 0]", "where it is at rest"),
)
DRIVE = (
    *keys_of(
        "drive",
        ("body", "body", text("the name of a body"), "the only one there is",
         '"body"', "the body that is driven, released, and whose motion is reported"),
        ("rotation_deg", "rotation", DRIVEN, "none: the bodies follow the loads",
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
#: Tables of a mechanism's file.
MECHANISM = {rows[0].section: rows for rows in (STRIP, BODY, SECTION, MATERIAL, DRIVE)}
#: Arrays of tables, and the effects that a table [[loads]], ... stands for: each where the table has the key
#: beside it, or in any case.
LISTS: dict[str, dict[str, str]] = {
    "loads": {"tip_force": "strip", "applied_force": "force_N", "applied_moment": "moment_Nm"},
    "supports": {"support": ""},
    "springs": {"spring": ""},
    "drives": {"driven_displacement": "displacement_m", "driven_rotation": "rotation_deg"},
}
#: Effects that may act several times.
REPEATED = tuple(effect for effects in LISTS.values() for effect in effects)
#: Tables of any file beside those of its kind.
ANY = ("scene", "effects", *LISTS, "points")

#: Effect -> what it is.
EFFECTS: dict[str, str] = {
    "bending": "the strips resist curvature",
    "stretching": "the strips resist stretch",
    "inextensible": "the strips keep their length, in place of stretching (spline)",
    "strip_inertia": "mass of the strips, in motions and modes",
    "section_rotary_inertia": "rotary inertia of the strips' sections, in motions and modes",
    "body_inertia": "mass and moment of inertia of the bodies, in motions and modes",
    "gravity": "weight of bodies and strips",
    "strip_damping": "damping of the strips' strain rates",
    "strip_drag": "damping of the strips' velocity, over their mass",
    "body_damping": "damping of the bodies' velocity and angular velocity",
    "applied_force": "a force on a body, in fixed directions or turning with the body",
    "applied_moment": "a moment on a body",
    "tip_force": "a force and a moment on the free end of a strip",
    "driven_displacement": "leads the centre of mass of a body from where it is at rest, in x, y or both",
    "driven_rotation": "drives the rotation of a body beside the one that `[drive]` names",
    "support": "holds a body where it is at rest, in x, y or rotation, in a motion too",
    "spring": "a spring, and a damper, between a body and the ground or another body",
    "clamped_width": "clamps over the whole width, which stiffen wide strips (of known sides); alone up to "
    "4.5 % too soft",
    "anticlastic": "sections that flatten as wide strips bend, which stiffens them (of known sides); with "
    "clamped_width within 0.1 % of a shell",
    "root_compliance": "clamped ends that turn, as in a body of the strips' material (of known sides)",
    "shear": "sections that turn against the strips (fe-shear)",
    "pre_strain": "curvature and strain that the strips would have if they were free",
}

# Rows: name in the file, parameter, rule, default ("": it is needed), example, meaning.
# fmt: off
_Row = tuple[str, str, Rule, str, str, str]
_BODY: _Row = (
    "body", "body", text("the name of a body"), "the only one",
    '"body"', "on which body, of a mechanism",
)
_HISTORY: _Row = (
    "history", "history", rules.HISTORY, "the whole load at all times",
    "[[0, 0], [0.01, 1]]", "in motion: factor of the load over time, constant behind the last instant",
)
_FORCE: _Row = ("force_N", "force", finite_pair("N"), "", "[0, -1]", "the force [x, y]")
_FOLLOWER: _Row = (
    "follower", "follower", rules.TRUTH, "false", "true", "whether it turns with what it acts on",
)
_MOMENT: _Row = ("moment_Nm", "moment", rules.finite("N m"), "", "0.01", "the moment, counter-clockwise")
_FREE_TIP = text("the name of a strip with a free end")
_LED, _ROOT = rules.free_pair("m"), rules.number_or("monolithic", not_negative("1"))
#: Effect -> its keys.
_PARAMETERS: dict[str, tuple[_Row, ...]] = {
    "gravity": (
        ("acceleration_m_per_s2", "acceleration", finite_pair("m/s^2"), "[0, -9.81]",
         "[0, -9.81]", "acceleration of free fall [x, y]"),
    ),
    "strip_damping": (
        ("relaxation_time_s", "relaxation_time", not_negative("s"), "",
         "1e-4", "stress by strain rate, over E"),
    ),
    "strip_drag": (
        ("rate_per_s", "rate", not_negative("1/s"), "", "10", "force by velocity, over the strip's mass"),
    ),
    "body_damping": (
        ("translation_Ns_per_m", "translation", not_negative("N s/m"), "0", "0.1", "force by velocity"),
        ("rotation_Nms", "rotation", not_negative("N m s"), "0", "1e-5", "moment by angular velocity"),
    ),
    "applied_force": (
        _FORCE,
        ("at_m", "at", finite_pair("m"), "its centre of mass",
         "[0, 0]", "the point of the body that it acts on, where this is at rest"),
        _FOLLOWER,
        _BODY,
        _HISTORY,
    ),
    "applied_moment": (_MOMENT, _BODY, _HISTORY),
    "tip_force": (
        ("strip", "strip", _FREE_TIP, "", '"strip"', "on which strip"),
        (*_FORCE[:3], "[0, 0]", *_FORCE[4:]),
        (*_MOMENT[:3], "0", *_MOMENT[4:]),
        _FOLLOWER,
        _HISTORY,
    ),
    "driven_displacement": (
        ("displacement_m", "displacement", _LED, "", "[1e-3, 0]", "from its place at rest [x, y]"),
        _BODY,
        _HISTORY,
    ),
    "driven_rotation": (
        ("rotation_deg", "angle", DRIVEN, "", "5", "that the body is driven to, counter-clockwise"),
        _BODY,
        _HISTORY,
    ),
    "support": (
        ("fixed", "fixed", rules.some_of("x", "y", "rotation"), "", '["x", "y"]', "what of the body is held"),
        _BODY,
    ),
    "spring": (
        _BODY,
        ("other", "other", text("the name of a body"), "the ground", '"other"', "what it leads to"),
        ("stiffness_N_per_m", "stiffness", finite_pair("N/m"), "[0, 0]",
         "[1000, 0]", "force by displacement of the centre of mass [x, y]"),
        ("rotational_stiffness_Nm_per_rad", "rotational_stiffness", not_negative("N m/rad"), "0",
         "0.05", "moment by rotation"),
        ("damping_N_s_per_m", "damping", finite_pair("N s/m"), "[0, 0]",
         "[0.1, 0]", "force by velocity of the centre of mass [x, y]"),
        ("rotational_damping_Nm_s_per_rad", "rotational_damping", not_negative("N m s/rad"), "0",
         "1e-5", "moment by angular velocity"),
    ),
    "root_compliance": (
        ("root", "root", _ROOT, '"monolithic"', '"monolithic"',
         "length of strip that turns as much as a root does, over the thickness; monolithic: 0.416"),
    ),
    "pre_strain": (
        ("curvature_per_m", "curvature", rules.finite("1/m"), "0",
         "0.1", "natural curvature, counter-clockwise from root to tip"),
        ("strain", "strain", rules.finite("1"), "0", "1e-5", "natural axial strain"),
    ),
}
# fmt: on
EFFECT_KEYS: dict[str, tuple[Key, ...]] = {
    effect: keys_of(f"effects.{effect}", *_PARAMETERS.get(effect, ())) for effect in EFFECTS
}
