"""The pivot of Table 1 and the references that all errors are held against."""

from report.facts import Fact, Holds, Rows, Table, fact
from report.forms import Form, count, degrees, power, significant, unit
from report.results import Results, at
from studies.answers.reference import SWING_MESHES
from studies.cases.problem import Problem, named_case

CASE = "cross_axis_pivot"


def pivot() -> Problem:
    """Return the case of Table 1."""
    return named_case(CASE)


def flexural_rigidity(problem: Problem) -> float:
    """Return EI of a strip [N m^2]."""
    return problem.youngs_modulus * problem.second_moment_of_area


def small_angle_stiffness(problem: Problem) -> float:
    """Return 2 EI / L [N m/rad]: the pivot of two strips that cross at mid-length."""
    return 2.0 * flexural_rigidity(problem) / problem.length


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


def _given(results: Results) -> Table:
    problem = pivot()
    rows: Rows = [[what, symbol, form(getattr(problem, name))] for what, symbol, name, form in _GIVEN]
    rows += [
        ["derived: flexural rigidity", "EI", unit("N m²", 4)(flexural_rigidity(problem))],
        ["derived: axial rigidity", "EA", unit("MN", 3, 1e-6)(problem.youngs_modulus * problem.area)],
        ["derived: slenderness", "L/h", significant(problem.length / problem.depth, 3)],
        ["derived: stiffness at small angles", "2EI/L", unit("N m/rad", 4)(small_angle_stiffness(problem))],
    ]
    return ["quantity", "symbol", "value"], rows


def _static(quantity: str) -> Fact:
    return fact("convergence/control_points", "reference", at("uncertainty", quantity=quantity), power)


def _swing(quantity: str, form: Form) -> Fact:
    return fact("paper/fig06_release", "reference", at("uncertainty", quantity=quantity), form)


def _theory_matters(results: Results) -> bool:
    static = results.table("paper/fig05_stiffness", "summary")
    moving = results.table("paper/fig06_release", "summary")
    return all(
        abs(at("error_torque_largest", formulation=name)(static)) < FACTS["theory.shear.torque"].made(results)
        and at("error_rotation_rad", formulation=name)(moving) < FACTS["theory.shear.swing"].made(results)
        for name in ("n = 6", "FE, 20 elements")
    )


FACTS = {
    "pivot.slenderness": Fact(
        made=lambda _: pivot().length / pivot().depth, form=lambda value: significant(value, 2)
    ),
    "pivot.stiffness": Fact(made=lambda _: small_angle_stiffness(pivot()), form=unit("N m/rad", 4)),
    "pivot.depth": Fact(made=lambda _: pivot().depth, form=unit("mm", 2, 1e3)),
    "pivot.width": Fact(made=lambda _: pivot().area / pivot().depth, form=unit("mm", 2, 1e3)),
    "reference.trajectory": _static("trajectory"),
    "reference.torque": _static("torque"),
    "reference.stiffness": _static("stiffness"),
    "reference.frequency": _swing("frequency", power),
    "reference.rotation": _swing("rotation_rad", unit("rad")),
    "reference.meshes": Fact(made=lambda _: len(SWING_MESHES), form=count),
    "reference.fine.rotation": fact(
        "work_precision/dynamics", "reference", at("uncertainty", quantity="rotation_rad"), unit("rad")
    ),
    "theory.shear.torque": fact(
        "baselines/peers", "theories", at("torque", what="difference of the theories"), power
    ),
    "theory.shear.swing": fact(
        "baselines/peers",
        "swing_theories",
        at("rotation_rad", what="difference of the theories"),
        unit("rad"),
    ),
    "theory.spatial.torque": fact(
        "work_precision/statics",
        "reference",
        at("distance_to_material", theory="spatial", quantity="torque"),
        power,
    ),
    "theory.spatial.trajectory": fact(
        "work_precision/statics",
        "reference",
        at("distance_to_material", theory="spatial", quantity="trajectory"),
        power,
    ),
    "small-angle.error": Fact(
        made=lambda results: abs(
            at("stiffness_Nm_per_rad", formulation="FE refined", rotation_rad=0.0)(
                results.table("paper/fig05_stiffness", "curves")
            )
            / small_angle_stiffness(pivot())
            - 1.0
        ),
        form=power,
    ),
    "pivot.quarter-turn": Fact(made=lambda _: pivot().rotation, form=degrees),
}
HOLDS = {
    "theory.matters": Holds(
        words="shear changes torque and swing by more than six control points or twenty elements are off",
        test=_theory_matters,
    )
}
LISTINGS = {"given": _given}
