"""Gates, provenance, machine and versions."""

import hashlib
import importlib.metadata
import tomllib
from typing import Any

from report.facts import Cell, Derived, Fact, Listing
from report.forms import count, power, seconds, short_hash, significant, times
from report.gates import gates
from report.results import Results
from studies.record.source import ROOT
from studies.registry import STUDIES

#: Facts of the machine, with what they are called here.
LABELS = {
    "system": "system",
    "architecture": "architecture",
    "processor": "processor",
    "logical_cores": "logical cores",
    "threads": "threads of a solver",
}


def _gates(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = [
        [
            _breakable(name),
            power(gate["limit"]),
            power(gate["measured"]),
            significant(gate["limit"] / gate["measured"]),
            gate["unit"],
            gate["against"],
        ]
        for name, gate in gates().items()
    ]
    return ["gate", "limit", "measured", "ratio", "unit", "measured against"], rows


def _breakable(name: str) -> str:
    """Return a name that may break after its underscores."""
    return name.replace("_", "_\u200b")


def _provenance(results: Results) -> tuple[list[str], list[list[Cell]]]:
    rows: list[list[Cell]] = []
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


def _machine(results: Results) -> tuple[list[str], list[list[Cell]]]:
    """Return the machines that results were computed on, each fact with all its values."""
    records = [results.record(study) for study in STUDIES]
    rows: list[list[Cell]] = []
    for name, label in LABELS.items():
        rows.append([label, _values(record["machine"][name] for record in records)])
    return ["machine", "of the results"], rows


def _versions(results: Results) -> tuple[list[str], list[list[Cell]]]:
    records = [results.record(study) for study in STUDIES]
    names = sorted({name for record in records for name in record["versions"]})
    rows: list[list[Cell]] = [
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


def _ratio(pick: Any) -> Derived:
    return Derived(made=lambda _: pick(g["limit"] / g["measured"] for g in gates().values()), form=times)


def _version(results: Results) -> str:
    return str(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"])


FACTS: dict[str, Fact | Derived] = {
    "gates.count": Derived(made=lambda _: len(gates()), form=count),
    "gates.loosest": _ratio(max),
    "gates.tightest": _ratio(min),
    "studies.count": Derived(made=lambda _: len(STUDIES), form=count),
    "suite.version": Derived(made=_version, form=str),
}
LISTINGS = {
    "gates": Listing(made=_gates),
    "provenance": Listing(made=_provenance),
    "machine": Listing(made=_machine),
    "versions": Listing(made=_versions),
}
