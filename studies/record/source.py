"""Which source a result depends on: the modules that a module imports, and a hash of their code."""

import ast
import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("spline_model", "fe_reference", "studies")

#: Modules that move or draw numbers and cannot change them, so that results stay fresh when these are edited.
WITHOUT_INFLUENCE = ("studies.record", "studies.pictures")

#: Fields of a syntax node that differ between versions of Python while the code is the same.
_VERSIONED = {"ctx", "kind", "type_comment", "type_params"}


def source_hash(module: str, *, root: Path = ROOT) -> str:
    """Return the SHA-256 of the code of `module` and of all that it imports from this repository.

    The code is the syntax tree without docstrings, comments and layout; imports inside functions count too.
    """
    digest = hashlib.sha256()
    for name in closure(module, root=root):
        digest.update(f"{name}\n{_read(name, root).code}\n".encode())
    return digest.hexdigest()


def closure(module: str, *, root: Path = ROOT) -> list[str]:
    """Return `module` and every module of this repository it imports, directly or not, sorted by name.

    Raises:
        FileNotFoundError: no such module in this repository.
    """
    if _file(module, root) is None:
        raise FileNotFoundError(f"module {module}: no such module in this repository")
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name in found or name.startswith(WITHOUT_INFLUENCE) or _file(name, root) is None:
            continue
        found.add(name)
        waiting.extend(_read(name, root).imports)
        waiting.extend(_parents(name))
    return sorted(found)


@dataclass(frozen=True, kw_only=True)
class Module:
    """One module: a text that is equal for equal code, and the names that the code imports."""

    code: str
    imports: tuple[str, ...]


def _read(name: str, root: Path) -> Module:
    path = _file(name, root)
    if path is None:
        raise FileNotFoundError(f"module {name}: no such module in this repository")
    return _analysed(path.read_text(encoding="utf-8"), name, path.name == "__init__.py")


@cache
def _analysed(text: str, name: str, package: bool) -> Module:
    tree = ast.parse(text)
    names = tuple(imports(tree, name, package=package))
    return Module(code=_canonical(_Silent().visit(tree)), imports=names)


def imports(tree: ast.AST, module: str, *, package: bool) -> Iterator[str]:
    """Yield the full names that the code of `module` may import: of modules, and of names within them."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = module.split(".")
                keep = len(parts) - node.level + (1 if package else 0)
                base = ".".join([*parts[:keep], *([node.module] if node.module else [])])
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def _parents(name: str) -> Iterable[str]:
    parts = name.split(".")
    return (".".join(parts[:count]) for count in range(1, len(parts)))


def _file(name: str, root: Path) -> Path | None:
    if name.split(".")[0] not in PACKAGES:
        return None
    path = root.joinpath(*name.split("."))
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


class _Silent(ast.NodeTransformer):
    """Takes out strings that stand alone: docstrings of modules, classes, functions and names."""

    def visit_Expr(self, node: ast.Expr) -> ast.Expr | None:
        """Return the statement, or nothing for a string that stands alone."""
        alone = isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        return None if alone else node


def _canonical(node: object) -> str:
    """Return a text of the syntax tree that is the same in every version of Python."""
    if isinstance(node, ast.AST):
        fields = (
            f"{name}={_canonical(value)}"
            for name, value in ast.iter_fields(node)
            if name not in _VERSIONED and value is not None and value != []
        )
        return f"{type(node).__name__}({','.join(fields)})"
    if isinstance(node, list):
        return f"[{','.join(map(_canonical, node))}]"
    return repr(node)
