"""Gates, provenance, machine and versions, and what the suite does not show."""

import hashlib
import importlib.metadata
import tomllib
from collections.abc import Callable, Iterable
from itertools import chain
from typing import Any

from report.content.hard_cases import DEFAULT, WARNED, kinds
from report.facts import Fact, Rows, Stored, Table, facts, listing
from report.forms import count, percent, power, seconds, short_hash, significant, times, unit
from report.results import Results, gates
from studies.record.source import ROOT
from studies.registry import STUDIES, question_of

#: Gates beside each other in a row of their table; cases of a study that are named one by one.
BESIDE, NAMED = 3, 3
#: Facts of the machine, with what they are called here.
LABELS = {
    "system": "system",
    "architecture": "architecture",
    "processor": "processor",
    "logical_cores": "logical cores",
    "threads": "threads of a solver",
}
PLATE = Stored("model_form/plate", "paper")


def _breakable(name: str) -> str:
    """Return a name that may break after its underscores and strokes."""
    return name.replace("_", "_\u200b").replace("/", "/\u200b")


@listing("gates")
def _gates(results: Results) -> Table:
    """Return the limits some beside each other: name, limit, and how many times the measured one it is."""
    cells: Rows = [
        [_breakable(name), power(gate["limit"]), significant(gate["limit"] / gate["measured"])]
        for name, gate in gates().items()
    ]
    height = -(-len(cells) // BESIDE)
    cells += [["", "", ""]] * (BESIDE * height - len(cells))
    rows: Rows = [list(chain.from_iterable(cells[k::height])) for k in range(height)]
    return ["limit of", "limit", "ratio"] * BESIDE, rows


@listing("further")
def _further(results: Results) -> Table:
    """Return the figures that no section shows, with what their studies ask."""
    sections = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "report/sections").glob("*.typ"))
    rows: Rows = [
        [_breakable(file.removesuffix(".svg")), question_of(study)]
        for study in STUDIES
        for file in results.record(study)["figures"]
        if file.endswith(".svg") and f'#plot("{file.removesuffix(".svg")}"' not in sections
    ]
    return ["figure", "what it is about"], rows or [["none", "–"]]


@listing("provenance")
def _provenance(results: Results) -> Table:
    rows: Rows = []
    for study in STUDIES:
        record = results.record(study)
        cases = record["inputs"]["cases"]
        tables = hashlib.sha256("".join(record["tables"].values()).encode()).hexdigest()
        rows.append(
            [
                _breakable(study),
                f"{len(cases)} cases" if len(cases) > NAMED else ", ".join(map(_breakable, cases)) or "–",
                short_hash(record["inputs"]["source_sha256"]),
                short_hash(tables),
                seconds(record["elapsed_s"]) if record["elapsed_s"] else "–",
                record["date"],
            ]
        )
    return ["study", "cases", "source", "tables", "computed in", "date"], rows


@listing("machine")
def _machine(results: Results) -> Table:
    """Return the machines that results were computed on, each fact with all its values."""
    machines = [results.record(study)["machine"] for study in STUDIES]
    rows: Rows = [[label, _values(each[name] for each in machines)] for name, label in LABELS.items()]
    return ["machine", "of the results"], rows


@listing("versions")
def _versions(results: Results) -> Table:
    found = [results.record(study)["versions"] for study in STUDIES]
    names = sorted({name for versions in found for name in versions})
    codes = Stored("baselines/peers", "codes", status="installed").rows(results)
    return ["package", "version"], [
        *([name, _values(versions[name] for versions in found if name in versions)] for name in names),
        *([str(row["code"]), str(row["version"])] for row in codes.to_dict("records")),
        ["typst (this report)", importlib.metadata.version("typst")],
    ]


def _values(found: Iterable[Any]) -> str:
    return ", ".join(dict.fromkeys(str(value) for value in found))


def _ratio(pick: Callable[[Iterable[float]], float]) -> Fact:
    return Fact(made=lambda _: pick(g["limit"] / g["measured"] for g in gates().values()), form=times)


def _version(results: Results) -> str:
    return str(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"])


facts(
    {
        "limits.stress": Stored("paper/fig05_stiffness", "summary").largest(
            "max_stress_end_Pa", unit("GPa", 2, 1e-9), formulation="FE, 20 elements"
        ),
        "limits.plate.constant": PLATE.at("excess", percent, kind="constant"),
        "limits.plate.linear": PLATE.at("excess", percent, kind="linear"),
        "limits.plate.ritz": Stored("model_form/plate", "ritz").largest("difference", power),
        "limits.unresolved": Stored("stability/step_size", "outcomes", model=DEFAULT).fact(
            lambda rows: (kinds(rows) == WARNED).sum(), count
        ),
        "gates.count": Fact(made=lambda _: len(gates()), form=count),
        "gates.loosest": _ratio(max),
        "gates.tightest": _ratio(min),
        "studies.count": Fact(made=lambda _: len(STUDIES), form=count),
        "suite.version": Fact(made=_version, form=str),
    }
)
