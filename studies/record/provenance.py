"""Provenance: what a stored result was made from, and whether it still stands."""

import datetime
import hashlib
import importlib.metadata
import json
import os
import platform
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studies.cases.design import FOLDER, named_design
from studies.cases.document import parsed
from studies.record.source import ROOT, source_hash

#: Packages whose version can change a number or a figure.
DEPENDENCIES = ("numpy", "scipy", "numba", "scikit-fem", "pandas", "matplotlib")


@dataclass(frozen=True, kw_only=True)
class State:
    """Whether a stored study is "fresh", "stale" or "missing", and why."""

    kind: str
    reason: str = ""


def sha256(content: bytes) -> str:
    """Return the SHA-256 of `content` in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def inputs(module: str, cases: Iterable[str]) -> dict[str, Any]:
    """Return the hashes of what a study is made from: its source and its cases."""
    cases = tuple(cases)
    said = "\n".join(_file(name).read_text(encoding="utf-8") for name in cases)
    return {
        "source_sha256": source_hash(module, said=said),
        "cases": {name: _fingerprint(name) for name in cases},
    }


def _fingerprint(name: str) -> str:
    """Return the hash of a design by its name, of the values of another file by its path below studies/."""
    if "/" not in name:
        return named_design(name).fingerprint()
    return sha256(json.dumps(parsed(_file(name)), sort_keys=True).encode())


def _file(name: str) -> Path:
    return (ROOT / "studies" if "/" in name else FOLDER) / f"{name}.toml"


def surroundings() -> dict[str, Any]:
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


def judge(record: Mapping[str, Any], now: Mapping[str, Any], *, data: Path, figures: Path) -> State:
    """Return whether the result described by `record` still stands.

    Args:
        record: its provenance.
        now: `inputs` of the study as it is today.
        data: folder of its tables.
        figures: folder of all figures.
    """
    for folder, kind in ((data, "tables"), (figures, "figures")):
        for name, digest in record[kind].items():
            path = folder / name
            if not path.is_file():
                return State(kind="missing", reason=f"{name} does not exist")
            if sha256(path.read_bytes()) != digest:
                return State(kind="stale", reason=f"{name} was changed after it was made")
    if not record["figures"]:
        return State(kind="missing", reason="no figure was drawn")
    if record["inputs"]["cases"] != now["cases"]:
        return State(kind="stale", reason="a case was changed")
    if record["inputs"]["source_sha256"] != now["source_sha256"]:
        return State(kind="stale", reason="the source was changed")
    return State(kind="fresh")


def _processor() -> str:
    """Return the processor's model name where the system tells it, else its family."""
    facts = Path("/proc/cpuinfo")
    if facts.is_file():
        for line in facts.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown"
