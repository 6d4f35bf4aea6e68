"""The pivot of Table 1 and the references that all errors are held against."""

from typing import Any

from report.facts import Fact, Stored, Table, facts, holds, listing
from report.forms import Form, count, degrees, digits, power, significant, unit
from report.results import Results
from studies.cases.problem import Problem, named_case

STATICS = Stored("convergence/control_points", "reference")
RELEASE = Stored("paper/fig06_release", "reference")
FINE = Stored("work_precision/dynamics", "reference")
SHEAR = {"what": "difference of the theories"}
TORQUE = Stored("baselines/peers", "theories", **SHEAR)
SWING = Stored("baselines/peers", "swing_theories", **SHEAR)
SPATIAL = Stored("work_precision/statics", "reference", theory="spatial")
AT_REST = Stored("paper/fig05_stiffness", "curves", formulation="FE refined", rotation_rad=0.0)


def pivot() -> Problem:
    """Return the case of Table 1."""
    return named_case("cross_axis_pivot")


def _flexural_rigidity() -> float:
    """Return EI of a strip [N m^2]."""
    return pivot().youngs_modulus * pivot().second_moment_of_area


def _small_angle_stiffness() -> float:
    """Return 2 EI / L [N m/rad]: the pivot of two strips that cross at mid-length."""
    return 2.0 * _flexural_rigidity() / pivot().length


#: Rows of Table 1: what, symbol, attribute, form.
_GIVEN: tuple[tuple[str, str, str, Form], ...] = (
    ("length of a strip", "L", "length", unit("mm", 5, 1e3)),
    ("inclination of the strips", "α", "inclination", degrees),
    ("crossing point over the length", "λ", "crossing_ratio", significant),
    ("section area", "A", "area", unit("mm²", 3, 1e6)),
    ("second moment of area", "I", "second_moment_of_area", unit("mm⁴", 4, 1e12)),
    ("Young's modulus", "E", "youngs_modulus", unit("GPa", 3, 1e-9)),
    ("Poisson's ratio", "ν", "poisson_ratio", significant),
    ("density", "ρ", "density", unit("kg/m³", 4)),
    ("mass of the body", "m", "body_mass", unit("kg", 2)),
    ("moment of inertia of the body", "J", "body_moment_of_inertia", unit("kg m²", 2)),
    ("prescribed rotation", "θ₂⁰", "rotation", degrees),
    ("increments of the path", "–", "increments", count),
)


@listing("given")
def _given(results: Results) -> Table:
    problem = pivot()
    axial = unit("MN", 3, 1e-6)(problem.youngs_modulus * problem.area)
    return ["quantity", "symbol", "value"], [
        *([what, symbol, form(getattr(problem, name))] for what, symbol, name, form in _GIVEN),
        ["derived: flexural rigidity", "EI", unit("N m²", 4)(_flexural_rigidity())],
        ["derived: axial rigidity", "EA", axial],
        ["derived: slenderness", "L/t", significant(problem.length / problem.depth, 3)],
        ["derived: stiffness at small angles", "2EI/L", unit("N m/rad", 4)(_small_angle_stiffness())],
    ]


def _closed_form(results: Results) -> float:
    stiffness = AT_REST.value(results, "stiffness_Nm_per_rad")
    return abs(float(stiffness) / _small_angle_stiffness() - 1.0)


facts(
    {
        f"reference.{name}": STATICS.at("uncertainty", power, quantity=name)
        for name in ("trajectory", "torque", "stiffness")
    }
)
facts(
    {
        "pivot.slenderness": Fact(made=lambda _: pivot().length / pivot().depth, form=digits(2)),
        "pivot.stiffness": Fact(made=lambda _: _small_angle_stiffness(), form=unit("N m/rad", 4)),
        "pivot.depth": Fact(made=lambda _: pivot().depth, form=unit("mm", 2, 1e3)),
        "pivot.width": Fact(made=lambda _: pivot().area / pivot().depth, form=unit("mm", 2, 1e3)),
        "pivot.quarter-turn": Fact(made=lambda _: pivot().rotation, form=degrees),
        "reference.frequency": RELEASE.at("uncertainty", power, quantity="frequency"),
        "reference.rotation": RELEASE.at("uncertainty", unit("rad"), quantity="rotation_rad"),
        "reference.fine.rotation": FINE.at("uncertainty", unit("rad"), quantity="rotation_rad"),
        "theory.shear.torque": TORQUE.at("torque", power),
        "theory.shear.swing": SWING.at("rotation_rad", unit("rad")),
        "theory.spatial.torque": SPATIAL.at("distance_to_material", power, quantity="torque"),
        "theory.spatial.trajectory": SPATIAL.at("distance_to_material", power, quantity="trajectory"),
        "small-angle.error": Fact(made=_closed_form, form=power),
    }
)


@holds("theory.matters")
def _(r: Results) -> Any:
    """shear changes torque and swing by more than six control points or twenty elements are off"""
    compared = (
        (Stored("paper/fig05_stiffness", "summary"), "error_torque_largest", TORQUE.value(r, "torque")),
        (Stored("paper/fig06_release", "summary"), "error_rotation_rad", SWING.value(r, "rotation_rad")),
    )
    return all(
        abs(summary.value(r, name, formulation=each)) < shear
        for summary, name, shear in compared
        for each in ("n = 6", "FE, 20 elements")
    )
