"""The benchmark package: inputs and reference solutions of the benchmark pivot, for any other code.

`results/reference/` has the inputs as TOML and one table for each theory. The tables come from the stored
results of the studies; nothing is solved here. A row is one value of a reference solution:

    quantity     one of `QUANTITIES`
    at           rotation [rad], mode number or time [s] of the value
    value        in the unit that ends the name of the quantity
    uncertainty  of the value, in the same unit
    scale        the deviation of another code is (its value - value) / scale
"""

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from studies.cases.problem import Problem, named_case
from studies.record.source import ROOT
from studies.record.store import as_csv

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
    """Return the files of the package by their names."""
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
    for table, values in tables.items():
        lines += ["", f"[{table}]", *(f"{key} = {json.dumps(value)}" for key, value in values.items())]
    return "\n".join([*lines, ""])
