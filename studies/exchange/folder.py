"""The folder of an export: new, empty, or that of a former export, which is replaced whole or not at all."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from studies.errors import BadInput
from studies.record.files import replace_folder, require_writable_folder

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
