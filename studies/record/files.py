"""What is kept on the disk: files written whole or not at all, and kernels while their source stands.


numba compiles a kernel again when its own file changes, but not when one changes that it calls, or a constant
of another module: what is kept would then answer for a source that is gone.
"""

import json
import os
import tempfile
from collections.abc import Container, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from studies.errors import BadInput
from studies.record.source import ROOT, source_hash

#: Endings of the files that a picture is written to.
PICTURES = ("svg", "png", "pdf")


class OutputError(BadInput):
    """A file or folder that cannot be written."""


@contextmanager
def _clear_error(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise OutputError(f"{path}: cannot be written ({reason}), expected a writable place") from None


def require_writable_file(path: Path) -> None:
    """Raise OutputError unless a file could be written at `path`; nothing is left behind."""
    with _clear_error(path):
        if path.is_dir():
            raise IsADirectoryError(21, "is a folder")
        with tempfile.TemporaryFile(dir=path.parent):
            pass


def require_writable_folder(folder: Path) -> None:
    """Raise OutputError unless files could be written in `folder`, which is made if it does not exist."""
    with _clear_error(folder):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass


def write_whole(path: Path, content: bytes) -> None:
    """Write `content` to a temporary neighbour of `path` and rename it, so that no reader ever sees a part.

    Raises:
        OutputError: the place cannot be written; a file that was there before is untouched.
    """
    with whole_file(path) as stream:
        stream.write(content)


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Yield a temporary neighbour of `path`, opened to write, which replaces `path` at the end of the
    context.

    Raises:
        OutputError: the place cannot be written; a file that existed before is untouched.
    """
    with _clear_error(path):
        handle, name = tempfile.mkstemp(prefix=temporary_prefix(path), dir=path.parent)
        temporary = Path(name)
        try:
            with os.fdopen(handle, "wb") as stream:
                yield stream
            temporary.chmod(0o644)
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def temporary_prefix(path: Path) -> str:
    """Return how the names of the temporary neighbours of `path` begin."""
    return f".{path.name}."


def write_all(folder: Path, contents: Mapping[str, bytes], former: Iterable[str] = ()) -> None:
    """Write files (name -> content) to a folder, which is made, each whole, and remove former ones by name.

    Raises:
        OutputError: the place cannot be written.
    """
    require_writable_folder(folder)
    for name, content in contents.items():
        write_whole(folder / name, content)
    for name in set(former) - set(contents):
        (folder / name).unlink(missing_ok=True)


#: Packages that hold compiled kernels.
COMPILED = ("spline_model", "fe_reference")


def forget(root: Path = ROOT, keep: Container[Path] = ()) -> int:
    """Remove the compiled kernels of all files but those to `keep`; return how many that were."""
    kept = [file for package in COMPILED for file in (root / package).rglob("*.nb[ci]")]
    old = [file for file in kept if file.parents[1] / f"{file.name.partition('.')[0]}.py" not in keep]
    for file in old:
        file.unlink(missing_ok=True)
    return len(old)


def forget_stale(root: Path = ROOT) -> bool:
    """Remove the compiled kernels whose code has changed since; return whether there were any.

    A mark beside the kernels holds places, times and sizes of all source files, which cost some milliseconds
    to compare, and where these differ a hash of each file and of all it imports. Where there is no mark, what
    is kept is of unknown source and removed. Nothing happens where nothing may be written: numba then keeps
    its kernels elsewhere, by the place of the source.
    """
    mark = root / COMPILED[0] / "__pycache__" / "kernels.json"
    files = [file for package in COMPILED for file in sorted((root / package).rglob("*.py"))]
    stats = [_marked(file, root) for file in files]
    former = json.loads(mark.read_bytes()) if mark.is_file() else {"stats": [], "sources": {}}
    if stats == former["stats"]:
        return False
    names = [".".join(file.relative_to(root).with_suffix("").parts) for file in files]
    sources = {name: source_hash(name, root=root) for name in names if not name.endswith("__init__")}
    same = [name for name, source in sources.items() if former["sources"].get(name) == source]
    try:
        removed = forget(root, {root.joinpath(*name.split(".")).with_suffix(".py") for name in same})
        mark.parent.mkdir(exist_ok=True)
        write_whole(mark, json.dumps({"stats": stats, "sources": sources}).encode())
    except (OSError, OutputError):
        return False
    return removed > 0


def _marked(file: Path, root: Path) -> str:
    found = file.stat()
    return f"{file.relative_to(root)} {found.st_mtime_ns} {found.st_size}"
