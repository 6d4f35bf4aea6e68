"""The store: tables of a study as tidy CSV with their provenance, its figures beside those of all others.

Provenance says what a stored result was made from, and whether it still stands.
"""

import datetime
import importlib.metadata
import json
import os
import platform
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.figure import Figure

from studies.cases.design import fingerprint, named_design
from studies.cases.document import parsed
from studies.record.digits import as_csv, read_csv
from studies.record.files import replace_folder, require_writable_folder, write_whole
from studies.record.source import ROOT, source_hash
from studies.record.style import rendered

#: Packages whose version can change a number or a figure.
DEPENDENCIES = ("numpy", "scipy", "numba", "scikit-fem", "pandas", "matplotlib")


#: Hashes of what a study is made from.
Inputs = dict[str, Any]


class _State(NamedTuple):
    """Whether a stored study is "fresh", "stale" or "missing", and why."""

    kind: str
    reason: str = ""


def inputs(module: str, cases: Iterable[str]) -> Inputs:
    """Return the hashes of the source and the cases of a study."""
    return {
        "source_sha256": source_hash(module.partition(":")[0]),
        "cases": {name: _fingerprint(name) for name in cases},
    }


def _fingerprint(name: str) -> str:
    """Return the hash of a design by its name, of the values of another file by its path below studies/."""
    if "/" not in name:
        return fingerprint(named_design(name))
    return sha256(json.dumps(parsed(ROOT / "studies" / f"{name}.toml"), sort_keys=True).encode()).hexdigest()


def _surroundings() -> dict[str, Any]:
    """Return the versions, facts of the machine (without its name, user or paths) and the date."""
    versions = {"python": platform.python_version()}
    versions |= {name: importlib.metadata.version(name) for name in DEPENDENCIES}
    machine = {
        "system": platform.system(),
        "architecture": platform.machine(),
        "processor": _processor(),
        "logical_cores": os.cpu_count(),
        "threads": os.environ.get("OMP_NUM_THREADS", "not set"),
    }
    return {"versions": versions, "machine": machine, "date": datetime.date.today().isoformat()}


def _processor() -> str:
    """Return the processor's model name where the system tells it, else its family."""
    facts = Path("/proc/cpuinfo")
    lines = facts.read_text(encoding="utf-8", errors="replace").splitlines() if facts.is_file() else []
    for line in lines:
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.processor() or "unknown"


PROVENANCE = "provenance.json"

#: Where the committed results are.
RESULTS = ROOT / "results"


class Store:
    """Results below one folder: `data/<study>/*.csv` with `provenance.json`, and `figures/`."""

    def __init__(self, root: Path = RESULTS) -> None:
        self.root = root
        self.figures = root / "figures"

    def data(self, study: str) -> Path:
        """Return the folder of the study's tables."""
        return self.root / "data" / study

    def require_writable(self) -> None:
        """Raise OutputError unless results can be written here: asked before anything is computed."""
        require_writable_folder(self.root)

    def save_tables(
        self, study: str, tables: Mapping[str, pd.DataFrame], now: Inputs, elapsed: float
    ) -> bool:
        """Store the tables of `study` in place of former ones, with the provenance of what they came from.

        Return whether its figures are to be drawn: nothing is written if a fresh result with the same tables
        is stored.
        """
        contents = {f"{name}.csv": as_csv(table) for name, table in tables.items()}
        if self.state(study, now).kind == "fresh" and self.record(study)["tables"] == _hashes(contents):
            return False
        record = {
            "study": study,
            "command": f"python -m studies run {study}",
            "inputs": now,
            "tables": _hashes(contents),
            "figures": None,
            "elapsed_s": round(elapsed, 2),
            **_surroundings(),
        }
        replace_folder(self.data(study), {**contents, PROVENANCE: _as_json(record)})
        return True

    def load_tables(self, study: str) -> dict[str, pd.DataFrame]:
        """Return the stored tables of `study`; FileNotFoundError when there are none."""
        names = self.record(study)["tables"]
        return {Path(name).stem: read_csv((self.data(study) / name).read_bytes()) for name in names}

    def save_figures(self, study: str, figures: Mapping[str, Figure]) -> None:
        """Store the figures of `study` as SVG and PNG and note them in its provenance."""
        pairs = [(name, kind) for name in figures for kind in ("svg", "png")]
        contents = {f"{name}.{kind}": rendered(figures[name], kind) for name, kind in pairs}
        record = self.record(study)
        require_writable_folder(self.figures)
        for name in set(record["figures"] or ()) - set(contents):
            (self.figures / name).unlink(missing_ok=True)
        for name, content in contents.items():
            write_whole(self.figures / name, content)
        record["figures"] = _hashes(contents)
        self._note(study, record)

    def renew(self, study: str, now: Inputs) -> None:
        """Note that the stored tables are those of the present source and cases."""
        self._note(study, self.record(study) | {"inputs": now})

    def _note(self, study: str, record: Mapping[str, Any]) -> None:
        write_whole(self.data(study) / PROVENANCE, _as_json(record))

    def record(self, study: str) -> dict[str, Any]:
        """Return the provenance of `study`; FileNotFoundError when it was never run."""
        record: dict[str, Any] = json.loads((self.data(study) / PROVENANCE).read_text(encoding="utf-8"))
        return record

    def state(self, study: str, now: Inputs) -> _State:
        """Return whether the stored result of `study` is fresh, stale or missing, and why."""
        try:
            record = self.record(study)
        except FileNotFoundError:
            return _State("missing", "never run")
        for folder, kind in ((self.data(study), "tables"), (self.figures, "figures")):
            for name, digest in (record[kind] or {}).items():
                path = folder / name
                if not path.is_file():
                    return _State("missing", f"{name} does not exist")
                if sha256(path.read_bytes()).hexdigest() != digest:
                    return _State("stale", f"{name} was changed after it was made")
        if record["figures"] is None:
            return _State("missing", "no figure was drawn")
        for part, said in (("cases", "a case"), ("source_sha256", "the source")):
            if record["inputs"][part] != now[part]:
                return _State("stale", f"{said} was changed")
        return _State("fresh")


def _as_json(record: Mapping[str, Any]) -> bytes:
    """Return `record` as indented JSON that ends with a newline."""
    return (json.dumps(record, indent=2) + "\n").encode()


def _hashes(contents: Mapping[str, bytes]) -> dict[str, str]:
    return {name: sha256(content).hexdigest() for name, content in sorted(contents.items())}
