"""The store: tables of a study as tidy CSV with their provenance, its figures beside those of all others."""

import io
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.record import provenance
from studies.record.files import replace_folder, require_writable_folder, write_whole
from studies.record.provenance import State
from studies.record.source import ROOT
from studies.record.style import rendered

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
        self,
        study: str,
        tables: Mapping[str, pd.DataFrame],
        *,
        module: str,
        cases: Iterable[str],
        command: str,
        elapsed: float,
    ) -> None:
        """Store the tables of `study` in place of former ones, with the provenance of what they came from."""
        contents = {f"{name}.csv": as_csv(table) for name, table in tables.items()}
        record = {
            "study": study,
            "command": command,
            "inputs": provenance.inputs(module, cases),
            "tables": _hashes(contents),
            "figures": {},
            "elapsed_s": round(elapsed, 2),
            **provenance.surroundings(),
        }
        replace_folder(self.data(study), {**contents, PROVENANCE: as_json(record)})

    def load_tables(self, study: str) -> dict[str, pd.DataFrame]:
        """Return the stored tables of `study`; FileNotFoundError when there are none."""
        record = self.record(study)
        return {
            Path(name).stem: pd.read_csv(self.data(study) / name, keep_default_na=False, na_values=[""])
            for name in record["tables"]
        }

    def save_figures(self, study: str, figures: Mapping[str, Figure]) -> None:
        """Store the figures of `study` as SVG and PNG and note them in its provenance."""
        contents = {
            f"{name}.{kind}": content
            for name, figure in figures.items()
            for kind, content in rendered(figure).items()
        }
        record = self.record(study)
        require_writable_folder(self.figures)
        for name in set(record["figures"]) - set(contents):
            (self.figures / name).unlink(missing_ok=True)
        for name, content in contents.items():
            write_whole(self.figures / name, content)
        record["figures"] = _hashes(contents)
        write_whole(self.data(study) / PROVENANCE, as_json(record))

    def renew(self, study: str, *, module: str, cases: Iterable[str]) -> None:
        """Note that the stored tables are those of the present source and cases."""
        record = self.record(study) | {"inputs": provenance.inputs(module, cases)}
        write_whole(self.data(study) / PROVENANCE, as_json(record))

    def record(self, study: str) -> dict[str, Any]:
        """Return the provenance of `study`; FileNotFoundError when it was never run."""
        record: dict[str, Any] = json.loads((self.data(study) / PROVENANCE).read_text(encoding="utf-8"))
        return record

    def state(self, study: str, *, module: str, cases: Iterable[str]) -> State:
        """Return whether the stored result of `study` is fresh, stale or missing."""
        try:
            record = self.record(study)
        except FileNotFoundError:
            return State(kind="missing", reason="never run")
        now = provenance.inputs(module, cases)
        return provenance.judge(record, now, data=self.data(study), figures=self.figures)


@dataclass(frozen=True, kw_only=True)
class Digits:
    """How far a column of numbers comes out again: to a part of itself [1], or to a floor in its unit.

    Sums of floating point numbers depend on their order, and so on what else keeps the cores busy.
    """

    relative: float = 0.0
    floor: float = 0.0


def same(stored: pd.DataFrame, found: pd.DataFrame, digits: Mapping[str, Digits]) -> bool:
    """Return whether two tables are the same: to the letter, columns with `digits` to these."""
    if list(stored.columns) != list(found.columns) or len(stored) != len(found):
        return False
    one, other = (pd.read_csv(io.BytesIO(as_csv(table)), dtype=str) for table in (stored, found))
    exact = [name for name in one.columns if name not in digits]
    return one[exact].equals(other[exact]) and all(
        np.allclose(
            one[name].to_numpy(float), other[name].to_numpy(float), each.relative, each.floor, equal_nan=True
        )
        for name, each in digits.items()
        if name in one.columns
    )


def as_csv(table: pd.DataFrame) -> bytes:
    """Return `table` as CSV: 12 significant digits, rows sorted by the columns from left to right."""
    ordered = table.sort_values(list(table.columns), kind="stable")
    text = io.StringIO()
    ordered.to_csv(text, index=False, float_format="%.12g", lineterminator="\n")
    return text.getvalue().encode()


def as_json(record: Mapping[str, Any]) -> bytes:
    """Return `record` as indented JSON that ends with a newline."""
    return (json.dumps(record, indent=2) + "\n").encode()


def _hashes(contents: Mapping[str, bytes]) -> dict[str, str]:
    return {name: provenance.sha256(content) for name, content in sorted(contents.items())}
