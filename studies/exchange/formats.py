"""The formats that fields are written in, by name: each a function from fields to files by name."""

import io
import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from studies.answers.fields import Fields
from studies.errors import BadInput
from studies.exchange.tables import COLUMNS, tables
from studies.record.files import replace_folder, require_writable_folder

Contents = dict[str, bytes]
#: Size of the drawing of a path or a motion [inch].
SIZE = 4.6


def contents(fields: Fields, formats: tuple[str, ...], drawn: list[int]) -> Contents:
    """Return the files of the formats by name.

    Args:
        fields: what is written.
        formats: names of `FORMATS`.
        drawn: numbers of the states that a drawing shows.
    """
    found: Contents = {}
    for name in formats:
        found |= FORMATS[name](fields, drawn)
    return found


def _vtk(fields: Fields, drawn: list[int]) -> Contents:
    from studies.exchange.vtk import vtk  # imported by who asks for it, as all libraries here

    return vtk(fields)


def _svg(fields: Fields, drawn: list[int]) -> Contents:
    """Return `<analysis>.svg`, to scale in millimetres: the same bytes for the same fields.

    A path or a motion is one drawing of the chosen states over the shape at rest; modes are a drawing each,
    over the state that they are about.
    """
    from studies.pictures import shapes
    from studies.record import style

    with style.applied():
        if fields.mode_shape is not None:
            figure = shapes.modes([(fields, "", "-")], drawn)
        else:
            figure = style.page(SIZE, SIZE + 0.9)
            panel = figure.subplots()
            handles = shapes.states_over_rest(panel, fields, drawn)
            shapes.to_scale(panel)
            what = {"static": "static path", "release": "motion after the release"}[fields.analysis]
            panel.set_title(f"{shapes.NAMES[fields.model]}: {what}")
            figure.legend(handles=handles, loc="outside lower center", ncols=3)
        return {f"{fields.analysis}.svg": style.vector(figure)}


def _csv(fields: Fields, drawn: list[int]) -> Contents:
    return {
        f"{fields.analysis}_{name}.csv": table.to_csv(index=False, lineterminator="\n").encode()
        for name, table in tables(fields).items()
    }


def _parquet(fields: Fields, drawn: list[int]) -> Contents:
    found = {}
    for name, table in tables(fields).items():
        stream = io.BytesIO()
        table.to_parquet(stream, index=False)
        found[f"{fields.analysis}_{name}.parquet"] = stream.getvalue()
    return found


def _json(fields: Fields, drawn: list[int]) -> Contents:
    document = summary(fields) | {
        "columns": {},
        "tables": {
            name: {column: [_plain(value) for value in table[column].tolist()] for column in table.columns}
            for name, table in tables(fields).items()
        },
    }
    document["columns"] = {
        column: COLUMNS[column] for table in document["tables"].values() for column in table
    }
    return {f"{fields.analysis}.json": (json.dumps(document, allow_nan=False) + "\n").encode()}


def summary(fields: Fields) -> dict[str, Any]:
    """Return what was asked and how it ended, as JSON has it."""
    return {
        "analysis": fields.analysis,
        "model": fields.model,
        "settings": fields.settings,
        "effects": list(fields.effects),
        "status": fields.status,
        "message": fields.message,
    }


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: null for NaN."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


#: Format -> what writes it.
FORMATS: dict[str, Callable[[Fields, list[int]], Contents]] = {
    "vtk": _vtk,
    "svg": _svg,
    "csv": _csv,
    "parquet": _parquet,
    "json": _json,
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


def write(folder: Path, contents: Mapping[str, bytes], about: Mapping[str, Any]) -> None:
    """Write the files of an export and the manifest that says what they are, all of them or none.

    Args:
        folder: as `require_own` lets pass.
        contents: the files by name.
        about: what the manifest says beside their names.
    """
    manifest = json.dumps({**about, "files": sorted(contents)}, indent=1, allow_nan=False) + "\n"
    replace_folder(folder.resolve(), {**contents, MANIFEST: manifest.encode()})


def _former(folder: Path) -> list[str]:
    """Return the files of the export that the folder holds; none if it holds no manifest."""
    try:
        names = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        return [str(name) for name in names]
    except (OSError, ValueError, TypeError, KeyError):
        return []
