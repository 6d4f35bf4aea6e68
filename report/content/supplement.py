"""Gates, provenance, machine and versions, and what the suite does not show."""

import hashlib
import importlib.metadata
import tomllib
from typing import Any

from report.content.hard_cases import WARNED, kinds
from report.facts import Fact, Rows, Table, fact
from report.forms import count, percent, power, seconds, short_hash, significant, times, unit
from report.results import Results, at, gates, largest, where
from studies.record.source import ROOT
from studies.registry import STUDIES
from studies.stability.family import DEFAULT


def _unresolved(results: Results) -> int:
    table = where(results.table("stability/step_size", "outcomes"), model=DEFAULT)
    return int((kinds(table) == WARNED).sum())


FACTS = {
    "limits.stress": fact(
        "paper/fig05_stiffness",
        "summary",
        largest("max_stress_end_Pa", formulation="FE, 20 elements"),
        unit("GPa", 2, 1e-9),
    ),
    "limits.plate.constant": fact("model_form/plate", "paper", at("excess", kind="constant"), percent),
    "limits.plate.linear": fact("model_form/plate", "paper", at("excess", kind="linear"), percent),
    "limits.plate.ritz": fact("model_form/plate", "ritz", largest("difference"), power),
    "limits.unresolved": Fact(made=_unresolved, form=count),
    "limits.gates": Fact(made=lambda _: len(gates()), form=count),
}


#: Facts of the machine, with what they are called here.
LABELS = {
    "system": "system",
    "architecture": "architecture",
    "processor": "processor",
    "logical_cores": "logical cores",
    "threads": "threads of a solver",
}


def _gates(results: Results) -> Table:
    """Return the limits two beside each other: name, limit, and how many times the measured one it is."""
    cells = [
        [_breakable(name), power(gate["limit"]), significant(gate["limit"] / gate["measured"])]
        for name, gate in gates().items()
    ]
    half = -(-len(cells) // 2)
    right = cells[half:] + [["", "", ""]] * (2 * half - len(cells))
    rows: Rows = [[*one, *other] for one, other in zip(cells[:half], right, strict=True)]
    return ["limit of", "limit", "ratio"] * 2, rows


def _breakable(name: str) -> str:
    """Return a name that may break after its underscores."""
    return name.replace("_", "_\u200b")


def _provenance(results: Results) -> Table:
    rows: Rows = []
    for study in STUDIES:
        record = results.record(study)
        rows.append(
            [
                _place(study),
                ", ".join(map(_breakable, record["inputs"]["cases"])) or "–",
                short_hash(record["inputs"]["source_sha256"]),
                short_hash(_all_tables(record)),
                seconds(record["elapsed_s"]) if record["elapsed_s"] else "–",
                record["date"],
            ]
        )
    return ["study", "cases", "source", "tables", "computed in", "date"], rows


def _place(study: str) -> str:
    return _breakable(study.replace("/", "/\u200b"))


def _all_tables(record: Any) -> str:
    """Return one hash of a study's tables: that of their hashes in the order of their names."""
    return hashlib.sha256("".join(record["tables"].values()).encode()).hexdigest()


def _machine(results: Results) -> Table:
    """Return the machines that results were computed on, each fact with all its values."""
    records = [results.record(study) for study in STUDIES]
    rows: Rows = []
    for name, label in LABELS.items():
        rows.append([label, _values(record["machine"][name] for record in records)])
    return ["machine", "of the results"], rows


def _versions(results: Results) -> Table:
    records = [results.record(study) for study in STUDIES]
    names = sorted({name for record in records for name in record["versions"]})
    rows: Rows = [
        [name, _values(record["versions"][name] for record in records if name in record["versions"])]
        for name in names
    ]
    rows += [
        [str(row["code"]), str(row["version"])]
        for row in results.table("baselines/peers", "codes").to_dict("records")
        if row["status"] == "installed"
    ]
    rows.append(["typst (this report)", importlib.metadata.version("typst")])
    return ["package", "version"], rows


def _values(found: Any) -> str:
    return ", ".join(dict.fromkeys(str(value) for value in found))


def _ratio(pick: Any) -> Fact:
    return Fact(made=lambda _: pick(g["limit"] / g["measured"] for g in gates().values()), form=times)


def _version(results: Results) -> str:
    return str(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"])


FACTS |= {
    "gates.count": Fact(made=lambda _: len(gates()), form=count),
    "gates.loosest": _ratio(max),
    "gates.tightest": _ratio(min),
    "studies.count": Fact(made=lambda _: len(STUDIES), form=count),
    "suite.version": Fact(made=_version, form=str),
}
LISTINGS = {
    "gates": _gates,
    "provenance": _provenance,
    "machine": _machine,
    "versions": _versions,
}
