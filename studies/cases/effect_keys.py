"""The effects that a scene may name, what each one is, and the keys of its table [effects.NAME]."""

from studies.cases.keys import ROTATION
from studies.cases.rules import (
    FreePair,
    History,
    Key,
    NumberOr,
    Rule,
    Text,
    finite,
    finite_pair,
    keys_of,
    not_negative,
)

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
    "applied_force": "a force on a body at its centre of mass, in fixed directions",
    "applied_moment": "a moment on a body",
    "tip_force": "a force on the free end of a strip, in fixed directions",
    "driven_displacement": "leads the centre of mass of a body from where it is at rest, in x, y or both",
    "clamped_width": "clamps over the whole width, which stiffen wide strips (of known sides)",
    "anticlastic": "sections that flatten as wide strips bend, which stiffens them (of known sides)",
    "root_compliance": "clamped ends that turn, as in a body of the strips' material (of known sides)",
    "pre_strain": "curvature and strain that the strips would have if they were free",
}

# Rows: name in the file, parameter, rule, default ("": it is needed), example, meaning.
# fmt: off
_Row = tuple[str, str, Rule, str, str, str]
_BODY: _Row = (
    "body", "body", Text(expected="the name of a body"), "the only one",
    '"body"', "on which body, of a mechanism",
)
_HISTORY: _Row = (
    "history", "history", History(), "the whole load at all times",
    "[[0, 0], [0.01, 1]]", "in motion: factor of the load over time, constant behind the last instant",
)
_FORCE: _Row = ("force_N", "force", finite_pair("N"), "", "[0, -1]", "the force [x, y]")
_FREE_TIP = Text(expected="the name of a strip with a free end")
_LED = FreePair(expected='two finite numbers [x, y], one of them or "free" [m]')
_ROOT = NumberOr(
    expected='"monolithic" or a number of at least 0 [1]', word="monolithic", number=not_negative("1")
)
#: Effect -> its keys.
_KEYS: dict[str, tuple[_Row, ...]] = {
    "gravity": (
        ("acceleration_m_per_s2", "acceleration", finite_pair("m/s^2"), "of magnitude and direction",
         "[0, -9.81]", "acceleration of free fall [x, y]"),
        ("magnitude_m_per_s2", "magnitude", not_negative("m/s^2"), "9.81",
         "9.81", "size of the acceleration of free fall"),
        ("direction_deg", "direction", ROTATION, "-90, against the y axis",
         "-90", "where it points, counter-clockwise from the x axis"),
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
    "applied_force": (_FORCE, _BODY, _HISTORY),
    "applied_moment": (
        ("moment_Nm", "moment", finite("N m"), "", "0.01", "the moment, counter-clockwise"),
        _BODY,
        _HISTORY,
    ),
    "tip_force": (("strip", "strip", _FREE_TIP, "", '"strip"', "on which strip"), _FORCE, _HISTORY),
    "driven_displacement": (
        ("displacement_m", "displacement", _LED, "", "[1e-3, 0]", "from its place at rest [x, y]"),
        _BODY,
        _HISTORY,
    ),
    "root_compliance": (
        ("root", "root", _ROOT, '"monolithic"', '"monolithic"',
         "length of strip that turns as much as a root does, over the thickness; monolithic: 0.416"),
    ),
    "pre_strain": (
        ("curvature_per_m", "curvature", finite("1/m"), "0",
         "0.1", "natural curvature, counter-clockwise from root to tip"),
        ("strain", "strain", finite("1"), "0", "1e-5", "natural axial strain"),
    ),
}
# fmt: on
KEYS: dict[str, tuple[Key, ...]] = {
    effect: keys_of(f"effects.{effect}", *_KEYS.get(effect, ())) for effect in EFFECTS
}
