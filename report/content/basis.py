"""What the report rests on: the given pivot, references, limits of tests, provenance, machine, versions."""

import hashlib
import importlib.metadata
import tomllib
from collections.abc import Callable, Iterable
from functools import cache
from itertools import chain
from typing import Any

from report.content.hard_cases import DEFAULT, WARNED, kinds
from report.facts import FACTS, Fact, Results, Stored, Table, holds, listing
from report.forms import Form, count, degrees, digits, percent, power, seconds, significant, times, unit
from studies.cases.problem import Problem, named_case
from studies.record.source import ROOT
from studies.registry import STUDIES

STATICS = Stored("convergence/control_points", "reference")
RELEASE = Stored("paper/fig06_release", "reference")
FINE = Stored("cost/codes", "swing_limits", theory="material")
TORQUE = Stored("cost/codes", "path_limits", theory="shear", quantity="torque")
SWING = Stored("cost/codes", "swing_limits", theory="shear")
SPATIAL = Stored("cost/codes", "path_limits", theory="spatial")
AT_REST = Stored("paper/fig05_stiffness", "curves", formulation="FE refined", rotation_rad=0.0)


@cache
def _pivot() -> Problem:
    """Return the case of Table 1."""
    return named_case("cross_axis_pivot")


def _rigidity() -> float:
    """Return EI of a strip [N m^2]."""
    return _pivot().youngs_modulus * _pivot().second_moment_of_area


def _stiffness() -> float:
    """Return 2 EI / L [N m/rad]: the pivot of two strips that cross at mid-length, at small angles."""
    return 2.0 * _rigidity() / _pivot().length


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
    ("mass of the body", "m₂", "body_mass", unit("kg", 2)),
    ("moment of inertia of the body", "J₂", "body_moment_of_inertia", unit("kg m²", 2)),
    ("prescribed rotation", "θ₂⁰", "rotation", degrees),
    ("increments of the path", "–", "increments", count),
)


@listing("given")
def _given(results: Results) -> Table:
    problem = _pivot()
    axial = unit("MN", 3, 1e-6)(problem.youngs_modulus * problem.area)
    yield ["quantity", "symbol", "value"]
    yield from ([what, symbol, form(getattr(problem, name))] for what, symbol, name, form in _GIVEN)
    yield ["derived: flexural rigidity", "EI", unit("N m²", 4)(_rigidity())]
    yield ["derived: axial rigidity", "EA", axial]
    yield ["derived: slenderness", "L/t", significant(problem.length / problem.depth, 3)]
    yield ["derived: stiffness at small angles", "2EI/L", unit("N m/rad", 4)(_stiffness())]


def _closed_form(results: Results) -> float:
    stiffness = AT_REST.value(results, "stiffness_Nm_per_rad")
    return abs(float(stiffness) / _stiffness() - 1.0)


FACTS |= {
    f"reference.{name}": STATICS.at("uncertainty", power, quantity=name)
    for name in ("trajectory", "torque", "stiffness")
}
FACTS |= {
    "pivot.slenderness": Fact(made=lambda _: _pivot().length / _pivot().depth, form=digits(2)),
    "pivot.stiffness": Fact(made=lambda _: _stiffness(), form=unit("N m/rad", 4)),
    "pivot.depth": Fact(made=lambda _: _pivot().depth, form=unit("mm", 2, 1e3)),
    "pivot.width": Fact(made=lambda _: _pivot().area / _pivot().depth, form=unit("mm", 2, 1e3)),
    "pivot.quarter-turn": Fact(made=lambda _: _pivot().rotation, form=degrees),
    "reference.frequency": RELEASE.at("uncertainty", power, quantity="frequency"),
    "reference.rotation": RELEASE.at("uncertainty", unit("rad"), quantity="rotation_rad"),
    "reference.fine.rotation": FINE.at("rotation_rad", unit("rad")),
    "theory.shear.torque": TORQUE.at("distance_to_material", power),
    "theory.shear.swing": SWING.at("distance_to_material_rad", unit("rad")),
    "theory.spatial.torque": SPATIAL.at("distance_to_material", power, quantity="torque"),
    "theory.spatial.trajectory": SPATIAL.at("distance_to_material", power, quantity="trajectory"),
    "small-angle.error": Fact(made=_closed_form, form=power),
}


@holds("theory.matters")
def _(r: Results) -> Any:
    """shear changes torque and swing by more than six control points or twenty elements are off"""
    compared = (
        (
            Stored("paper/fig05_stiffness", "summary"),
            "error_torque_largest",
            TORQUE.value(r, "distance_to_material"),
        ),
        (
            Stored("paper/fig06_release", "summary"),
            "error_rotation_rad",
            SWING.value(r, "distance_to_material_rad"),
        ),
    )
    return all(
        abs(summary.value(r, name, formulation=each)) < shear
        for summary, name, shear in compared
        for each in ("n = 6", "FE, 20 elements")
    )


#: Gates beside each other in a row of their table; cases of a study that are named; letters of a hash.
BESIDE, NAMED, HASH = 3, 3, 10
PLATE = Stored("model_form/plate", "paper")


@cache
def _limits_of_tests() -> dict[str, dict[str, Any]]:
    """Return every gate by name: limit, unit, measured, against."""
    return tomllib.loads((ROOT / "tests" / "gates.toml").read_text(encoding="utf-8"))


def _breakable(name: str) -> str:
    """Return a name that may break after its underscores and strokes."""
    return name.replace("_", "_\u200b").replace("/", "/\u200b")


@listing("gates")
def _gates(results: Results) -> Table:
    """Return the limits some beside each other: name, limit, and how many times the measured one it is."""
    cells = [
        [_breakable(name), power(gate["limit"]), significant(gate["limit"] / gate["measured"])]
        for name, gate in _limits_of_tests().items()
    ]
    height = -(-len(cells) // BESIDE)
    cells += [["", "", ""]] * (BESIDE * height - len(cells))
    yield ["limit of", "limit", "ratio"] * BESIDE
    yield from (list(chain.from_iterable(cells[k::height])) for k in range(height))


@listing("provenance")
def _provenance(results: Results) -> Table:
    yield ["study", "cases", "source", "tables", "computed in", "date"]
    for study in STUDIES:
        record = results.record(study)
        cases = record["inputs"]["cases"]
        tables = hashlib.sha256("".join(record["tables"].values()).encode()).hexdigest()
        named = f"{len(cases)} cases" if len(cases) > NAMED else ", ".join(map(_breakable, cases)) or "–"
        hashes = record["inputs"]["source_sha256"][:HASH], tables[:HASH]
        took = seconds(record["elapsed_s"]) if record["elapsed_s"] else "–"
        yield [_breakable(study), named, *hashes, took, record["date"]]


@listing("machine")
def _machine(results: Results) -> Table:
    """Return the machines that results were computed on, each fact with all its values."""
    machines = [results.record(study)["machine"] for study in STUDIES]
    yield ["machine", "of the results"]
    for name in machines[0]:
        yield [name.replace("_", " "), _values(each[name] for each in machines)]


@listing("versions")
def _versions(results: Results) -> Table:
    found = [results.record(study)["versions"] for study in STUDIES]
    names = sorted({name for versions in found for name in versions})
    codes = Stored("cost/codes", "codes", status="installed").rows(results)
    yield ["package", "version"]
    yield from ([name, _values(versions[name] for versions in found if name in versions)] for name in names)
    yield from codes[["code", "version"]].to_numpy().tolist()
    yield ["typst (this report)", importlib.metadata.version("typst")]


def _values(found: Iterable[Any]) -> str:
    return ", ".join(dict.fromkeys(str(value) for value in found))


def _ratio(pick: Callable[[Iterable[float]], float]) -> Fact:
    return Fact(
        made=lambda _: pick(g["limit"] / g["measured"] for g in _limits_of_tests().values()), form=times
    )


def _version(results: Results) -> str:
    return str(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"])


FACTS |= {
    "limits.stress": Stored("paper/fig05_stiffness", "summary").largest(
        "max_stress_end_Pa", unit("GPa", 2, 1e-9), formulation="FE, 20 elements"
    ),
    "limits.plate.constant": PLATE.at("excess", percent, kind="constant"),
    "limits.plate.linear": PLATE.at("excess", percent, kind="linear"),
    "limits.unresolved": Stored("stability/step_size", "outcomes", model=DEFAULT).fact(
        lambda rows: (kinds(rows) == WARNED).sum(), count
    ),
    "gates.count": Fact(made=lambda _: len(_limits_of_tests()), form=count),
    "gates.loosest": _ratio(max),
    "gates.tightest": _ratio(min),
    "studies.count": Fact(made=lambda _: len(STUDIES), form=count),
    "suite.version": Fact(made=_version, form=str),
}
