"""What the report rests on: the given pivot, limits of tests, provenance, machine, versions."""

import importlib.metadata
import tomllib
from collections.abc import Mapping
from fnmatch import fnmatchcase
from functools import cache
from typing import Any

from report.facts import FACTS, Fact, Results, Stored, Table, listing
from report.forms import Form, count, degrees, percent, significant, unit
from studies.cases.problem import Problem, named_case
from studies.record.source import ROOT
from studies.registry import STUDIES

TORQUE = Stored("cost/codes", "path_limits", theory="shear", quantity="torque")
SWING = Stored("cost/codes", "swing_limits", theory="shear")


@cache
def _pivot() -> Problem:
    """Return the case of Table 1."""
    return named_case("cross_axis_pivot")


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
    yield ["quantity", "symbol", "value"]
    yield from ([what, symbol, form(getattr(_pivot(), name))] for what, symbol, name, form in _GIVEN)


@listing("machine")
def _machine(results: Results) -> Table:
    """Return machines and packages that results were computed with, each with all its values."""
    found: dict[str, dict[str, None]] = {}
    for study in STUDIES:
        record = results.record(study)
        for name, value in (record["machine"] | record["versions"]).items():
            found.setdefault(name.replace("_", " "), {})[str(value)] = None
    yield ["machine or package", "of the results"]
    yield from ([name, ", ".join(values)] for name, values in found.items())
    yield from Stored("cost/codes", "codes").rows(results)[["code", "version"]].to_numpy().tolist()
    yield ["typst (this report)", importlib.metadata.version("typst")]


def _read(name: str) -> dict[str, Any]:
    """Return what a TOML file of the suite holds."""
    return tomllib.loads((ROOT / name).read_text(encoding="utf-8"))


@listing("matrix")
def _matrix(results: Results) -> Table:
    """Return the verification and validation matrix: one row per claim of ``tests/claims.toml``."""
    gates = _read("tests/gates.toml")
    yield ["claim", "evidence", "result", "uncertainty", "unit or scale", "number", "test"]
    for claim in _read("tests/claims.toml")["claim"]:
        number = sum(any(fnmatchcase(name, each) for each in claim["gates"]) for name in gates)
        if "result" in claim:
            pair, scale = [_magnitude(claim[part], results) for part in ("result", "uncertainty")], "relative"
        else:
            first = gates[claim["gates"][0]]
            pair, scale = [first["measured"], first["limit"]], first["unit"].partition(",")[0]
            scale = "relative" if scale == "1" or " over " in scale else scale.removesuffix(" of the beam")
        form = percent if scale == "relative" else significant
        values = [form(value) for value in pair]
        yield [claim["text"], claim["kind"], *values, scale, count(number), claim["test"]]


def _magnitude(source: Mapping[str, Any], results: Results) -> float:
    """Return the largest magnitude of a column of a stored table, from its entry in ``claims.toml``."""
    rows = Stored(source["study"], source["table"], **source["where"]).rows(results)
    return float(rows[source["column"]].abs().max())


FACTS |= {
    "suite.version": Fact(made=lambda _: _read("pyproject.toml")["project"]["version"], form=str),
    "gates.count": Fact(made=lambda _: len(_read("tests/gates.toml")), form=count),
    "pivot.slenderness": Fact(made=lambda _: _pivot().length / _pivot().depth, form=significant),
    "pivot.rotation": Fact(made=lambda _: _pivot().rotation, form=degrees),
    "theory.shear.torque": TORQUE.at("distance_to_material", percent),
    "theory.shear.swing": SWING.at("distance_to_material_rad", unit("rad")),
    "limits.stress": Stored("paper/fig05_stiffness", "summary").largest(
        "max_stress_end_Pa", unit("GPa", 2, 1e-9), formulation="FE, 20 elements"
    ),
    "ends.width": Stored("charts/pivot", "limits").at("value", percent, ratio="width_ratio", share=0.01),
    "ends.thick": Stored("charts/pivot", "limits").at("value", percent, ratio="thickness_ratio", share=0.01),
}
