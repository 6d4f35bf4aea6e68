"""Compiled kernels that are kept on the disk, and whether they are of the present source.

numba compiles a kernel anew when its own file changes, but not when one changes that it calls, or a constant
of another module: what is kept would then answer for a source that is gone.
"""

import re
from pathlib import Path

from studies.record.files import OutputError, write_whole
from studies.record.source import ROOT, source_hash

PACKAGES = ("spline_model", "fe_reference")
#: What a module that holds kernels says.
KERNEL = re.compile(r"^@(?:numba\.)?(?:njit|kernel|called|lane|part)\b", flags=re.MULTILINE)


def forget(root: Path = ROOT) -> int:
    """Remove all compiled kernels; return how many files that were."""
    kept = [file for package in PACKAGES for file in (root / package).rglob("*.nb[ci]")]
    for file in kept:
        file.unlink(missing_ok=True)
    return len(kept)


def forget_stale(root: Path = ROOT) -> bool:
    """Remove the compiled kernels if the code they were made of has changed since; return whether it had.

    Two marks are kept beside the kernels: places, times and sizes of all source files, which cost some
    milliseconds to compare, and where these differ a hash of the code of the modules with kernels and of all
    they import. Where there are no marks, what is kept is of unknown source and removed. Nothing happens
    where nothing may be written: numba then keeps its kernels elsewhere, by the place of the source.
    """
    mark = root / PACKAGES[0] / "__pycache__" / "kernels.txt"
    files = [file for package in PACKAGES for file in sorted((root / package).rglob("*.py"))]
    stats = "\n".join(_marked(file, root) for file in files)
    former, _, former_stats = _read(mark).partition("\n")
    if stats == former_stats:
        return False
    present = _code_hash(files, root)
    try:
        removed = forget(root) if present != former else 0
        mark.parent.mkdir(exist_ok=True)
        write_whole(mark, f"{present}\n{stats}".encode())
    except (OSError, OutputError):
        return False
    return removed > 0


def _code_hash(files: list[Path], root: Path = ROOT) -> str:
    """Return one hash of the code of every module among `files` that holds kernels, with what it imports."""
    modules = [
        ".".join(file.relative_to(root).with_suffix("").parts)
        for file in files
        if KERNEL.search(file.read_text(encoding="utf-8"))
    ]
    return " ".join(source_hash(module, root=root)[:16] for module in modules)


def _marked(file: Path, root: Path) -> str:
    found = file.stat()
    return f"{file.relative_to(root)} {found.st_mtime_ns} {found.st_size}"


def _read(mark: Path) -> str:
    try:
        return mark.read_text(encoding="utf-8")
    except OSError:
        return ""
