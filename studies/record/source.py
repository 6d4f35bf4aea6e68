"""The source of a result: the modules of this repository that a study imports, and a hash of their code."""

import ast
import hashlib
from collections.abc import Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
#: Folder of `results/`: the clone, or the caller's folder if the suite is installed from a wheel.
HOME = ROOT if (ROOT / "pyproject.toml").is_file() else Path()
PACKAGES = ("spline_model", "fe_reference", "studies", "report")
#: Modules that only move or draw numbers: results stay fresh when these change.
WITHOUT_INFLUENCE = ("studies.record", "studies.pictures", "studies.commands")
#: Fields of a syntax tree that differ between versions of Python.
_VERSIONED = {"ctx", "kind", "type_comment", "type_params"}


def source_hash(module: str, *, root: Path = ROOT) -> str:
    """Return the SHA-256 of the code of `module` and of all modules below `root` that it imports.

    The code is the syntax tree without docstrings, comments and layout.
    """
    codes = (f"{name} {_read(name, root)[0]}\n" for name in reached(module, root=root))
    return hashlib.sha256("".join(codes).encode()).hexdigest()


def reached(module: str, *, root: Path = ROOT) -> list[str]:
    """Return the modules that `module` imports directly or through others, with the packages around them.

    Imports inside functions count. A package counts with all its imports only if it is itself imported.

    Raises:
        FileNotFoundError: no such module in this repository.
    """
    if not _file(module, root):
        raise FileNotFoundError(f"module {module}: no such module in this repository")
    found: set[str] = set()
    waiting = {module}
    while waiting:
        name = waiting.pop()
        found.add(name)
        waiting |= {each for each in imported(name, root) if not each.startswith(WITHOUT_INFLUENCE)} - found
    return sorted(found.union(*map(_outer, found)))


@cache
def imported(module: str, root: Path = ROOT) -> set[str]:
    """Return the modules of this repository that a module imports, those for type checking included."""
    return {name for full in _read(module, root)[1] if (name := _longest(full, root))} - {module}


def imports(tree: ast.Module, module: str, *, package: bool) -> Iterator[str]:
    """Yield the full name of everything that the code of `module` imports."""
    outer = module if package else module.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = resolve_name("." * node.level + (node.module or ""), outer)
            yield from (f"{base}.{alias.name}" for alias in node.names)


@cache
def _read(module: str, root: Path) -> tuple[str, list[str]]:
    """Return the hash of a module's code and the names that it imports."""
    file: Any = _file(module, root)
    tree = ast.parse(file.read_bytes())
    names = sorted(set(imports(tree, module, package=file.name == "__init__.py")))
    return hashlib.sha256(repr(_code(tree)).encode()).hexdigest(), names


def _code(node: Any) -> Any:
    """Return a syntax tree as tuples that are the same in every version of Python, without docstrings."""
    if isinstance(node, list):
        return [_code(each) for each in node if not _docstring(each)]
    if not isinstance(node, ast.AST):
        return node
    fields = ((name, _code(value)) for name, value in ast.iter_fields(node) if name not in _VERSIONED)
    return type(node).__name__, [(name, value) for name, value in fields if value not in (None, [])]


def _docstring(node: object) -> bool:
    value = node.value if isinstance(node, ast.Expr) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def _longest(full: str, root: Path) -> str:
    """Return the module that a full name is, or is a name of; nothing for another library."""
    while full and not _file(full, root):
        full = full.rpartition(".")[0]
    return full


def _outer(module: str) -> set[str]:
    """Return the packages around a module."""
    parts = module.split(".")
    return {".".join(parts[:count]) for count in range(1, len(parts))}


@cache
def _file(module: str, root: Path) -> Path | None:
    """Return the file of a module of this repository."""
    if module.split(".")[0] not in PACKAGES:
        return None
    path = root.joinpath(*module.split("."))
    return next(filter(Path.is_file, (path.with_suffix(".py"), path / "__init__.py")), None)
