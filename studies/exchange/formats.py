"""Answers as tidy tables, one observation a row, units in the names of the columns; and the formats that they
are written in, by name: each a function from an answer to files by name."""

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from studies.answers.answer import Answer
from studies.answers.motion import Spectrum
from studies.answers.named import numbers_of
from studies.answers.quantities import along_of
from studies.errors import BadInput
from studies.record.files import replace_folder, require_writable_folder

#: Columns of points and bodies: where they are, and how a mode moves them.
PLACES = ("x_m", "y_m", "displacement_x_m", "displacement_y_m", "rotation_rad")
MODES = ("mode_x_per_sqrt_kg", "mode_y_per_sqrt_kg", "mode_rotation_per_m_sqrt_kg")


def tables(answer: Answer) -> dict[str, pd.DataFrame]:
    """Return `states`, `strips`, `bodies` and `reactions`; a design without bodies has no table of them."""
    found = {"states": _states(answer), "strips": _strips(answer), "reactions": _reactions(answer)}
    return found | ({"bodies": _bodies(answer)} if answer.design.bodies else {})


def _table(answer: Answer, shape: tuple[int, ...], columns: Mapping[str, Any]) -> pd.DataFrame:
    """Return columns of arrays that go over the rows of a shape, states first, behind what runs over the
    states and their numbers, which modes have as it is.

    The load factor alone does not tell states apart: it stays 1 while a loaded pivot is turned.
    """
    running = {answer.series: answer.values, "state": np.arange(len(answer.values))}
    if answer.series == "mode":
        running = {"mode": answer.values.astype(np.int64)}
    first = {name: values.reshape(-1, *(1 for _ in shape[1:])) for name, values in running.items()}
    given = (first | dict(columns)).items()
    return pd.DataFrame({name: np.broadcast_to(array, shape).ravel() for name, array in given})


def _parts(names: Iterable[str], arrays: np.ndarray) -> dict[str, np.ndarray]:
    """Return the last axis of arrays by names, as many as it has."""
    return dict(zip(names, np.moveaxis(arrays, -1, 0), strict=False))


def _states(answer: Answer) -> pd.DataFrame:
    """One row a state: what runs, and what the state has as a whole, by the names of `solve --csv`."""
    columns: dict[str, Any] = {}
    if answer.analysis != "modes" and len(answer.design.bodies) == 1:
        columns |= _parts(
            ("rotation_rad", "com_x_m", "com_y_m"), np.roll(answer.along.bodies[:, 0], 1, axis=1)
        )
    columns |= numbers_of(answer)
    return _table(answer, answer.values.shape, columns)


def _placed(place: np.ndarray, rest: np.ndarray, turn: np.ndarray) -> dict[str, np.ndarray]:
    """Return the places (..., 2) and turns of points or bodies."""
    return _parts(PLACES, np.concatenate((place, place - rest, turn[..., None]), axis=-1))


def _strips(answer: Answer) -> pd.DataFrame:
    """One row a state, strip and station."""
    along = answer.along
    columns = {
        "strip": np.array([strip.name for strip in answer.design.strips])[:, None],
        "arc_length_m": along.arc_length,
        **_placed(along.shape, along.rest_shape, along.rotation),
        **along_of(answer),
        **(_parts(MODES, answer.mode_shape) if isinstance(answer, Spectrum) else {}),
    }
    return _table(answer, along.rotation.shape, columns)


def _bodies(answer: Answer) -> pd.DataFrame:
    """One row a state and body."""
    bodies, along = answer.design.bodies, answer.along
    columns = {
        "body": np.array([body.name for body in bodies]),
        **_placed(along.bodies[..., :2], along.rest_bodies, along.bodies[..., 2]),
        **(_parts(MODES, answer.mode_bodies) if isinstance(answer, Spectrum) else {}),
        "mass_kg": np.array([body.mass for body in bodies]),
        "moment_of_inertia_kg_m2": np.array([body.moment_of_inertia for body in bodies]),
    }
    return _table(answer, along.bodies.shape[:2], columns)


def _reactions(answer: Answer) -> pd.DataFrame:
    """One row a state, strip and end."""
    strips, reactions = answer.design.strips, answer.along.reactions
    columns = {
        "strip": np.array([strip.name for strip in strips])[:, None],
        "end": np.array(["root", "tip"]),
        "on": np.array([[strip.root or "free", strip.tip or "free"] for strip in strips]),
        **_parts(("force_x_N", "force_y_N", "moment_Nm"), reactions),
    }
    return _table(answer, reactions.shape[:3], columns)


Contents = dict[str, bytes]


def _vtk(answer: Answer) -> Contents:
    from studies.exchange.vtk import vtk  # imported by who asks for it, as all libraries here

    return vtk(answer)


def _csv(answer: Answer) -> Contents:
    return {
        f"{answer.analysis}_{name}.csv": table.to_csv(index=False, lineterminator="\n").encode()
        for name, table in tables(answer).items()
    }


def _parquet(answer: Answer) -> Contents:
    made = {name: table.to_parquet(None, index=False) for name, table in tables(answer).items()}
    return {f"{answer.analysis}_{name}.parquet": bytes(content) for name, content in made.items()}


def _summary(answer: Answer) -> dict[str, Any]:
    """Return what was asked and how it ended, as the manifest has it."""
    names = ("analysis", "model", "settings", "effects", "status", "message")
    return {name: getattr(answer, name) for name in names}


#: Format -> what writes it.
FORMATS: dict[str, Callable[[Answer], Contents]] = {
    "vtk": _vtk,
    "csv": _csv,
    "parquet": _parquet,
}


#: What names the files of an export, so that a later one knows them from others.
MANIFEST = "export.json"


def require_own(folder: Path) -> None:
    """Raise BadInput unless `folder` can be written whole without losing anything but a former export."""
    place = folder.resolve()
    if place == Path.cwd().resolve() or place in Path.cwd().resolve().parents:
        raise BadInput(f"--out: got {folder}, expected a folder below the one you are in, or another")
    require_writable_folder(place.parent)
    if not place.exists():
        return
    if not place.is_dir():
        raise BadInput(f"--out: got the file {folder}, expected a folder")
    others = sorted(path.name for path in place.iterdir() if path.name not in {MANIFEST, *_former(place)})
    if others:
        raise BadInput(
            f"--out: got {folder} with {others[0]} in it, expected a new or empty folder, or one of an export"
        )


def write(folder: Path, contents: Mapping[str, bytes], answer: Answer, case: str) -> None:
    """Write the files of an export and the manifest that says what they are, all of them or none.

    Args:
        folder: as `require_own` lets pass.
        contents: the files by name.
        answer: that they hold. case: name of the file that these are of.
    """
    about = {"case": case, **_summary(answer), "files": sorted(contents)}
    manifest = json.dumps(about, indent=1, allow_nan=False) + "\n"
    replace_folder(folder.resolve(), {**contents, MANIFEST: manifest.encode()})


def _former(folder: Path) -> list[str]:
    """Return the files of the export that the folder holds; none if it holds no manifest."""
    try:
        names = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        return [str(name) for name in names]
    except (OSError, ValueError, TypeError, KeyError):
        return []
