"""The store: tables of a study as tidy CSV with their provenance, its figures beside those of all others.

Provenance says what a stored result was made from, and whether it still stands. Digits say which numbers of
another computation reproduce those that are stored.
"""

import datetime
import importlib.metadata
import io
import json
import os
import platform
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from pandas.api.types import is_bool_dtype, is_integer_dtype, is_numeric_dtype

from studies.cases.design import fingerprint, named_design
from studies.cases.document import parsed
from studies.record.files import require_writable_folder, write_all, write_whole
from studies.record.source import HOME, ROOT, source_hash
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
RESULTS = HOME / "results"


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
        former = [path.name for path in self.data(study).glob("*.csv")]
        # the provenance comes last: what is interrupted before does not have its hashes, and is stale
        write_all(self.data(study), {**contents, PROVENANCE: _as_json(record)}, former)
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
        write_all(self.figures, contents, record["figures"] or ())
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


#: Significant digits that are written: two more than are claimed, so that rounding does not count.
WRITTEN = 8


@dataclass(frozen=True, kw_only=True)
class Digits:
    """Tolerance of a column: what round-off of another processor may change.

    A number is reproduced if it differs by at most the sum of a part of itself, a part of the largest
    magnitude in its column, and a floor in the unit of the column.

    Attributes:
        relative: part of the number [1].
        scale: part of the largest magnitude in the column [1].
        floor: in the unit of the column.
        rows: which rows are compared, as of `DataFrame.query`; all without it.
    """

    relative: float = 1e-6
    scale: float = 1e-9
    floor: float = 1e-12
    rows: str = ""

    def allow(self, stored: pd.Series, found: pd.Series) -> bool:
        """Return whether every number of `found` is reproduced; an absent number must be absent in both."""
        one, other = stored.to_numpy(float), found.to_numpy(float)
        largest = np.abs(one[np.isfinite(one)]).max(initial=0.0)
        return np.allclose(
            other, one, rtol=self.relative, atol=self.scale * largest + self.floor, equal_nan=True
        )


#: Columns of numbers that a study does not give a tolerance.
NUMBERS = Digits()
#: Columns that are not compared: the work of a search depends on round-off where it hardly converges, and
#: texts repeat numbers of their row. A study may add tolerances by "table.column" or "column".
BY_NAME: dict[str, Digits | None] = dict.fromkeys(
    ("iterations", "newton_iterations", "sentence", "reason", "message", "says")
)


def differing(
    table: str, stored: pd.DataFrame, found: pd.DataFrame, digits: Mapping[str, Digits | None]
) -> list[str]:
    """Return the columns of a table that are not reproduced, or what else is different.

    Words, truth values and whole numbers must be equal, other numbers within `NUMBERS`, unless `digits` or
    `BY_NAME` has an entry for the column.
    """
    known = {**BY_NAME, **digits}
    one, other = read_csv(as_csv(stored)), read_csv(as_csv(found))
    if list(one) != list(other):
        return sorted(map(str, set(one) ^ set(other))) or ["order of columns"]
    if len(one) != len(other):
        return [f"{len(other)} rows, stored {len(one)}"]
    names = map(str, one)
    tolerances = {name: known.get(f"{table}.{name}", known.get(name, NUMBERS)) for name in names}
    return [name for name, own in tolerances.items() if own and not _reproduced(one, other, name, own)]


def _reproduced(stored: pd.DataFrame, found: pd.DataFrame, name: str, digits: Digits) -> bool:
    if digits.rows:
        compared = stored.query(digits.rows).index
        stored, found = stored.loc[compared], found.loc[compared]
    both = (stored[name], found[name])
    numbers = all(is_numeric_dtype(each) and not is_bool_dtype(each) for each in both)
    if not numbers or (digits is NUMBERS and all(map(is_integer_dtype, both))):
        return both[0].equals(both[1])
    return digits.allow(*both)


def as_csv(table: pd.DataFrame) -> bytes:
    """Return `table` as CSV: 8 significant digits, rows sorted by the columns as written, from the left."""
    written = read_csv(_text(table)).sort_values(list(table.columns), kind="stable")
    return _text(table.iloc[written.index])


def _text(table: pd.DataFrame) -> bytes:
    return table.to_csv(index=False, float_format=f"%.{WRITTEN}g", lineterminator="\n").encode()


def read_csv(content: bytes) -> pd.DataFrame:
    """Return a table that `as_csv` wrote: an empty cell is an absent value, all other words are words."""
    return pd.read_csv(io.BytesIO(content), keep_default_na=False, na_values=[""])
