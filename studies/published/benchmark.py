"""The benchmark package: inputs and reference solutions of the benchmark pivot, for any other code.

`results/reference/` has the inputs as TOML and one table for each theory. The tables come from the stored
results of `model_form/solid_pivot`. A row is one value of a reference solution:

    quantity     one of `QUANTITIES`
    at           rotation [rad], mode number or time [s] of the value
    value        in the unit that ends the name of the quantity
    uncertainty  of the value, in the same unit
    scale        the deviation of another code is (its value - value) / scale
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.adapters import answer_modes
from studies.answers.metrics import extrapolate
from studies.answers.reference import MESHES, SWING_MESHES, reference, swing_reference
from studies.answers.settings import FeSettings
from studies.cases.design import as_toml, document_of
from studies.cases.problem import named_case
from studies.paper.formulations import DURATION, INSTANTS
from studies.published.solids import PIVOT, SOFT, STIFF, VALUES, states_of
from studies.record.source import ROOT
from studies.record.store import as_csv

FOLDER, INPUTS = ROOT / "results" / "reference", "benchmark_pivot.toml"
#: Reference -> its theory.
THEORIES = {
    "beam": "plane beams without shear, extensible, bending per reference length: limit of refinement",
    "beam_with_shear": "geometrically exact plane beams with shear, extensible: limit of refinement",
    "solid": "solids between rigid end faces, St. Venant-Kirchhoff material: limit of refinement",
    "solid_neo_hookean": "solids between rigid end faces, neo-Hookean material: limit of refinement",
}
#: References of beams: element, order of the frequencies, and meshes of the free vibration.
BEAMS: dict[str, tuple[str, float, tuple[int, ...]]] = {
    "beam": ("corotational", 4.0, SWING_MESHES),
    "beam_with_shear": ("reissner", 2.0, (40, 60, 90, 135)),
}
LAWS = {STIFF: "solid", SOFT: "solid_neo_hookean"}
#: Quantity -> what `at` is, what `scale` is, and the tolerance. Theories differ by more than 0.1 % in torque:
#: shear by 0.24 %, the material law and lateral clamping by 0.8 %. Shear changes the vibration by 2 %.
ROTATION, INSTANT = "rotation of the body [rad]", "time after the release at 90 degrees [s]"
TRAVEL = "the largest displacement of the centre of mass"
QUANTITIES: dict[str, dict[str, Any]] = {
    "torque_Nm": {"at": ROTATION, "scale": "the torque of the state", "tolerance": 1e-3},
    "centre_x_m": {"at": ROTATION, "scale": TRAVEL, "tolerance": 1e-3},
    "centre_y_m": {"at": ROTATION, "scale": TRAVEL, "tolerance": 1e-3},
    "frequency_Hz": {"at": "number of the natural mode at rest", "scale": "the frequency", "tolerance": 1e-3},
    "vibration_rotation_rad": {"at": INSTANT, "scale": "the rotation at the release", "tolerance": 5e-3},
}
#: Number of the modes and the meshes that their limit is taken from; every so many instants of the free
#: vibration; relative digits of the written values.
MODES, MODE_MESHES, STORED, WRITTEN = 5, MESHES[:3], 2, 1e-8


def beams(theory: str) -> dict[str, pd.DataFrame]:
    """Return statics, natural frequencies and free vibration of plane beams: limits of refinement."""
    pivot, (element, order, meshes) = named_case(), BEAMS[theory]
    path = reference(pivot, element)
    torque = path.uncertainty["torque"] * path.torque.max()
    states = states_of(path).iloc[1:]
    settings = (FeSettings(elements=count, element=element) for count in MODE_MESHES)
    modes = [answer_modes(pivot, each, count=MODES).frequency for each in settings]
    frequency, unsure = extrapolate(modes, order=order)
    swing = swing_reference(
        pivot, duration=DURATION, instants=INSTANTS[::STORED], meshes=meshes, element=element
    )
    time, rotation, late = swing.time[1:], swing.rotation[1:], swing.uncertainty["rotation_rad"]
    rows = [
        _states(states, torque, path.uncertainty["trajectory"] * _travel(states)),
        _rows("frequency_Hz", np.arange(1, MODES + 1), frequency, unsure, frequency),
        _rows("vibration_rotation_rad", time, rotation, late, pivot.rotation),
    ]
    return {"references": pd.concat(rows).assign(theory=theory)}


def package(stored: Callable[[str, str], pd.DataFrame]) -> dict[str, bytes]:
    """Return the files of the package by their names; `stored` gives a table by its study and name."""
    known, limits = (stored("model_form/solid_pivot", each) for each in ("references", "limits"))
    tables = {str(theory): rows.drop(columns="theory") for theory, rows in known.groupby("theory")}
    for law, rows in limits[limits["design"] == PIVOT].groupby("law"):
        torque = rows["uncertainty"] * rows["torque_Nm"]
        tables[LAWS[str(law)]] = _states(rows, torque, rows["uncertainty_m"])
    files = {f"{name}.csv": as_csv(tables[name]) for name in THEORIES}
    return {INPUTS: _inputs().encode(), **files}


def _travel(rows: pd.DataFrame) -> float:
    """Return the largest displacement of the centre of mass [m]."""
    x, y = named_case().bodies[0].centre
    return float(np.hypot(rows["com_x_m"] - x, rows["com_y_m"] - y).max())


def _states(rows: pd.DataFrame, torque: Any, place: Any) -> pd.DataFrame:
    """Return torque and centre of states, with the uncertainties of torque [N m] and place [m]."""
    at, scales = rows["rotation_rad"], (rows["torque_Nm"], *[_travel(rows)] * 2)
    parts = zip(QUANTITIES, VALUES, (torque, place, place), scales, strict=False)
    return pd.concat([_rows(name, at, rows[column], unsure, scale) for name, column, unsure, scale in parts])


def _rows(quantity: str, at: Any, value: Any, uncertainty: Any, scale: Any) -> pd.DataFrame:
    """Return rows of one quantity; the uncertainty is at least that of the written digits."""
    unsure = np.maximum(uncertainty, WRITTEN * np.abs(value))
    return pd.DataFrame(
        {"quantity": quantity, "at": at, "value": value, "uncertainty": unsure, "scale": scale}
    )


def _inputs() -> str:
    """Return the inputs as TOML: the case, the places of its clamps, and what the references contain."""
    pivot = named_case()
    places: dict[str, Any] = {
        "ground_clamps_m": [strip.start for strip in pivot.strips],
        "body_clamps_m": [strip.end for strip in pivot.strips],
        "centre_of_mass_m": pivot.bodies[0].centre,
    }
    document = document_of(pivot) | {
        "places_at_rest": {name: np.round(place, 15).tolist() for name, place in places.items()},
        "references": {name: {"theory": theory} for name, theory in THEORIES.items()},
        "quantities": QUANTITIES,
    }
    remark = "The benchmark pivot, written by `python -m studies readme`; docs/benchmark.md explains it."
    return as_toml(document, [remark])
