"""Table 1 of the paper in SI units, written out once more so that tests do not depend on the case reader."""

import math

TABLE_ONE = {
    "length": 0.06 * math.sqrt(2.0),
    "inclination": math.pi / 4,
    "crossing_ratio": 0.5,
    "area": 5e-5,
    "second_moment_of_area": 1.041e-10,
    "youngs_modulus": 206e9,
    "poisson_ratio": 0.29,
    "density": 7800.0,
    "body_mass": 0.2,
    "body_moment_of_inertia": 0.002,
}

#: Strip length [m], its EI [N m^2] and the unit of moment and rotational stiffness EI/L [N m].
LENGTH = TABLE_ONE["length"]
EI = TABLE_ONE["youngs_modulus"] * TABLE_ONE["second_moment_of_area"]
MOMENT = EI / LENGTH

#: The same as a spline of six control points.
SIX = TABLE_ONE | {"control_points": 6}

#: Of a strip alone; its material and the body without the section, which width and thickness then give.
SECTION = {
    name: TABLE_ONE[name]
    for name in ("area", "second_moment_of_area", "youngs_modulus", "poisson_ratio", "density")
}
BARE = {name: value for name, value in TABLE_ONE.items() if name not in ("area", "second_moment_of_area")}
SIDES = {"width": 0.01, "thickness": 0.005}
#: Area and second moment of strips ten times thinner, ten times more slender.
THINNER = {"area": 5e-6, "second_moment_of_area": 1.041e-13}
