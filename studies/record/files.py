"""Writing files whole or not at all, with one clear line when a place cannot be written to."""

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from studies.errors import BadInput

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
    """Open a temporary neighbour of `path` that takes its place at the end of the context, unless that fails.

    Raises:
        OutputError: the place cannot be written; a file that was there before is untouched.
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


def replace_folder(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Make `folder` hold exactly `contents` (file name -> bytes): written aside first, then renamed into
    place.

    Raises:
        OutputError: the place cannot be written; a folder that was there before is untouched.
    """
    with _clear_error(folder):
        folder.parent.mkdir(parents=True, exist_ok=True)
        aside = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
        try:
            fresh, former = aside / "fresh", aside / "former"
            fresh.mkdir()
            for name, content in contents.items():
                (fresh / name).write_bytes(content)
            if folder.exists():
                folder.replace(former)
            fresh.replace(folder)
        finally:
            shutil.rmtree(aside)
