"""Judge the results of another code by a reference solution of the benchmark pivot.

    python -m studies judge results/reference/beam.csv
    python -m studies judge results/reference/solid_neo_hookean.csv --reference solid_neo_hookean

The file is CSV with the columns quantity, at and value, as the tables in results/reference; docs/benchmark.md
explains them. Values are compared at the places of the reference: rotations in rad, mode numbers, times in s.
Values at other places are ignored. A quantity passes if no deviation exceeds the tolerance plus the
uncertainty of the reference. Exit code 0: all given quantities pass; 1: one deviates; 2: invalid input.
"""

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from studies.cases.document import nearest
from studies.cases.problem import Problem, named_case
from studies.commands.columns import plain, table
from studies.commands.parser import Argument, command
from studies.engine import percent
from studies.errors import BadInput
from studies.record.source import ROOT
from studies.record.store import as_csv, read_csv

FOLDER, INPUTS = ROOT / "results" / "reference", "benchmark_pivot.toml"
#: Reference -> its theory.
THEORIES = {
    "beam": "plane beams without shear, extensible, bending per reference length: limit of refinement",
    "beam_with_shear": "geometrically exact plane beams with shear, extensible: 160 elements per strip",
    "solid": "solids between rigid end faces, St. Venant-Kirchhoff material: limit of refinement",
    "solid_neo_hookean": "solids between rigid end faces, neo-Hookean material: limit of refinement",
}
#: Quantity -> what `at` is, what `scale` is, and the tolerance. Theories differ by more than 0.1 % in torque:
#: shear by 0.24 %, the material law and lateral clamping by 0.8 %. Shear changes the vibration by 2 %.
QUANTITIES: dict[str, tuple[str, str, float]] = {
    "torque_Nm": ("rotation of the body [rad]", "the torque of the state", 1e-3),
    "centre_x_m": ("rotation of the body [rad]", "the largest displacement of the centre of mass", 1e-3),
    "centre_y_m": ("rotation of the body [rad]", "the largest displacement of the centre of mass", 1e-3),
    "frequency_Hz": ("number of the natural mode at rest", "the frequency", 1e-3),
    "vibration_rotation_rad": (
        "time after the release at 90 degrees [s]",
        "the rotation at the release",
        5e-3,
    ),
}
#: Digits of the written values, relative.
WRITTEN = 1e-8

#: Gives a stored table by its study and name.
Stored = Callable[[str, str], pd.DataFrame]


def package(stored: Stored) -> dict[str, bytes]:
    """Return the files of the benchmark package by their names: inputs as TOML and a table for each theory.

    The tables come from the stored results of the studies; nothing is solved here. A row is one value of a
    reference solution: `quantity`, one of `QUANTITIES`; `at`, the rotation [rad], mode number or time [s];
    `value` and its `uncertainty`, in the unit that ends the name of the quantity; `scale`: the deviation of
    another code is (its value - value) / scale.
    """
    tables = {"beam": _beam(stored), "beam_with_shear": _with_shear(stored)}
    limits = stored("model_form/solid_pivot", "limits")
    for name, law in (("solid", "st-venant-kirchhoff"), ("solid_neo_hookean", "neo-hookean")):
        rows = limits[limits["law"] == law]
        tables[name] = _states(rows, rows["uncertainty"] * rows["torque_Nm"], rows["uncertainty_m"])
    return {INPUTS: _inputs(named_case()).encode()} | {
        f"{name}.csv": as_csv(table) for name, table in tables.items()
    }


def _beam(stored: Stored) -> pd.DataFrame:
    """Return statics, natural frequencies and free vibration of beams without shear."""

    def refined(study: str, table: str) -> pd.DataFrame:
        rows = stored(f"paper/{study}", table)
        return rows[rows["formulation"] == "FE refined"].reset_index()

    def unsure(study: str, quantity: str) -> float:
        rows = stored(f"paper/{study}", "reference").set_index("quantity")
        return float(rows["uncertainty"][quantity])

    torque = refined("fig05_stiffness", "curves")["torque_Nm"]
    states = refined("fig04_trajectory", "paths").assign(torque_Nm=torque).iloc[1:]
    modes, motion = stored("convergence/frequency", "modes"), refined("fig06_release", "motions").iloc[1:]
    modes = modes[(modes["model"] == "fe") & (modes["count"] == modes.query("model == 'fe'")["count"].max())]
    limit, rotation = modes["limit_Hz"], motion["rotation_rad"]
    return pd.concat(
        [
            _states(
                states,
                unsure("fig05_stiffness", "torque") * torque.max(),
                unsure("fig04_trajectory", "trajectory") * _travel(states),
            ),
            _rows("frequency_Hz", modes["mode"], limit, modes["uncertainty"] * limit, limit),
            _rows(
                "vibration_rotation_rad",
                motion["time_s"],
                rotation,
                unsure("fig06_release", "rotation_rad"),
                named_case().rotation,
            ),
        ]
    )


def _with_shear(stored: Stored) -> pd.DataFrame:
    """Return statics of beams with shear; the study of meshes has the errors of the mesh."""
    rows = stored("model_form/solid_pivot", "models")
    rows = rows[rows["model"] == "beam with shear"]
    meshes = stored("convergence/elements", "meshes").set_index(["element", "elements"])
    error: Any = meshes.loc[("reissner", 160)]
    torque, place = (float(error[f"error_{each}"]) for each in ("torque", "trajectory"))
    return _states(rows, torque * rows["torque_Nm"].max(), place * _travel(rows))


def _travel(rows: pd.DataFrame) -> float:
    """Return the largest displacement of the centre of mass [m]."""
    x, y = named_case().bodies[0].centre
    return float(np.hypot(rows["com_x_m"] - x, rows["com_y_m"] - y).max())


def _states(rows: pd.DataFrame, torque: Any, place: Any) -> pd.DataFrame:
    """Return torque and centre of states, with the uncertainties of torque [N m] and place [m]."""
    at, scales = rows["rotation_rad"], (rows["torque_Nm"], *[_travel(rows)] * 2)
    names, columns = tuple(QUANTITIES)[:3], ("torque_Nm", "com_x_m", "com_y_m")
    parts = zip(names, columns, (torque, place, place), scales, strict=True)
    return pd.concat([_rows(name, at, rows[column], unsure, scale) for name, column, unsure, scale in parts])


def _rows(quantity: str, at: Any, value: Any, uncertainty: Any, scale: Any) -> pd.DataFrame:
    """Return rows of one quantity; the uncertainty is at least that of the written digits."""
    unsure = np.maximum(uncertainty, WRITTEN * np.abs(value))
    given = {"quantity": quantity, "at": at, "value": value, "uncertainty": unsure, "scale": scale}
    return pd.DataFrame(given)


def _rounded(place: tuple[float, float]) -> list[float]:
    """Return a place [m] without round-off."""
    return [round(each, 15) for each in place]


def _inputs(pivot: Problem) -> str:
    """Return the inputs as TOML, whose values JSON writes in the same way."""
    given: dict[str, Any] = {
        "strip_length_m": pivot.length,
        "strip_width_m": pivot.width,
        "strip_thickness_m": pivot.thickness,
        "youngs_modulus_Pa": pivot.youngs_modulus,
        "poisson_ratio": pivot.poisson_ratio,
        "density_kg_per_m3": pivot.density,
        "ground_clamps_m": [_rounded(strip.start) for strip in pivot.strips],
        "body_clamps_m": [_rounded(strip.end) for strip in pivot.strips],
        "body_mass_kg": pivot.body_mass,
        "body_moment_of_inertia_kg_m2": pivot.body_moment_of_inertia,
        "centre_of_mass_m": _rounded(pivot.bodies[0].centre),
        "rotation_rad": pivot.rotation,
    }
    tables: dict[str, dict[str, Any]] = {"pivot": given}
    tables |= {f"references.{name}": {"theory": theory} for name, theory in THEORIES.items()}
    for name, (at, scale, tolerance) in QUANTITIES.items():
        tables[f"quantities.{name}"] = {"at": at, "scale": scale, "tolerance": tolerance}
    lines = ["# The benchmark pivot, written by `python -m studies readme`; docs/benchmark.md explains it."]
    for title, values in tables.items():
        lines += ["", f"[{title}]", *(f"{key} = {json.dumps(value)}" for key, value in values.items())]
    return "\n".join([*lines, ""])


DEVIATES = 1
#: Largest relative distance between two places that are the same.
SAME = 1e-6
COLUMNS = ["quantity", "at", "value"]
RESULTS = Argument("file", "CSV file with the columns quantity, at, value", Path, metavar="RESULTS.csv")
REFERENCE = Argument(
    "--reference NAME", "solution to compare with, default beam", choices=tuple(THEORIES), default="beam"
)


@command(RESULTS, REFERENCE)
def main(arguments: argparse.Namespace) -> int:
    """Judge a file; return the exit code."""
    reference = read_csv((FOLDER / f"{arguments.reference}.csv").read_bytes())
    given = _read(arguments.file, reference["quantity"].unique().tolist())
    known = dict(iter(reference.groupby("quantity")))
    rows = [_judged(arguments.file, str(name), own, known[name]) for name, own in given.groupby("quantity")]
    print(f"{arguments.file}: compared with {arguments.reference} ({THEORIES[arguments.reference]})")
    heads = ("quantity", "compared", "largest deviation", "at", "allowed", "verdict")
    print("\n".join(line for line in table(list(map(plain, heads, zip(*rows, strict=True)))) if line.strip()))
    return DEVIATES if "deviates" in [row[-1] for row in rows] else 0


def _judged(path: Path, name: str, own: pd.DataFrame, known: pd.DataFrame) -> tuple[str, ...]:
    """Return quantity, number of places, largest deviation, its place, what is allowed there, verdict."""
    (at, _, tolerance), places = QUANTITIES[name], known["at"].to_numpy()
    row, place = np.nonzero(np.abs(own["at"].to_numpy()[:, None] - places) <= SAME * np.abs(places))
    if not len(row):
        expected = f"{at}, for example {places[0]:.8g} or {places[-1]:.8g}"
        raise BadInput(f"{path}: {name}: got no value at a place of the reference, expected at: {expected}")
    true = known.iloc[place]
    deviation = (own["value"].to_numpy()[row] - true["value"].to_numpy()) / true["scale"].to_numpy()
    allowed = tolerance + (true["uncertainty"] / true["scale"]).to_numpy()
    worst = int(np.argmax(np.abs(deviation) - allowed))
    verdict = "pass" if abs(deviation[worst]) <= allowed[worst] else "deviates"
    compared, where = f"{len(set(place))} of {len(places)}", f"{true['at'].iloc[worst]:.6g}"
    return name, compared, percent(deviation[worst]), where, percent(allowed[worst]), verdict


def _read(path: Path, known: list[str]) -> pd.DataFrame:
    """Return the rows of a file of results; BadInput if a row is not of a known quantity or has no number."""
    try:
        rows = pd.read_csv(path, dtype=str, keep_default_na=False, index_col=False).fillna("")
    except OSError as error:
        raise BadInput(f"{path}: cannot be read ({error.strerror}), expected a CSV file") from None
    except ValueError as error:
        raise BadInput(f"{path}: got no table ({error}), expected a CSV file in UTF-8") from None
    if not set(COLUMNS) <= set(rows) or rows.empty:
        got = f"{len(rows)} rows with the columns {', '.join(map(str, rows))}"
        raise BadInput(f"{path}: got {got}, expected rows with the columns {', '.join(COLUMNS)}")
    numbers = pd.DataFrame({name: pd.to_numeric(rows[name], errors="coerce") for name in COLUMNS[1:]})
    for line, row in enumerate(rows.to_dict("records")):
        where, quantity = f"{path}: line {line + 2}", row["quantity"]
        if quantity not in known:
            raise BadInput(f"{where}: quantity: got {quantity}, expected {nearest(quantity, known)}")
        for name in COLUMNS[1:]:
            if not np.isfinite(numbers[name][line]):
                raise BadInput(f"{where}: {name}: got {row[name] or 'nothing'}, expected a finite number")
    return numbers.assign(quantity=rows["quantity"])
