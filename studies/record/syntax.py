"""The definitions of a module, read from its text: their code, the names in it and what it imports."""

import ast
import re
from collections.abc import Iterator, Set
from dataclasses import dataclass
from functools import cache

PACKAGES = ("spline_model", "fe_reference", "studies")

#: The statements of a module that define nothing: they count as soon as anything of the module does.
BODY = ""

#: Fields of a syntax node that differ between versions of Python while the code is the same.
_VERSIONED = {"ctx", "kind", "type_comment", "type_params"}


@dataclass(frozen=True, kw_only=True)
class Definition:
    """One definition: a text that is equal for equal code, and what stands in it.

    `chains` are its dotted names, `said` the names of attributes and the words of its strings; `entries` are
    those of a table by its keys, or the methods of a class but for those that Python calls; where a class has
    a base of another library it is open: that may call any of them.
    """

    module: str
    code: str
    chains: frozenset[str]
    said: frozenset[str]
    entries: dict[str, "Definition"]
    is_class: bool
    is_open: bool


@dataclass(frozen=True, kw_only=True)
class Module:
    """The definitions of a module by name, and what the names that it imports stand for."""

    definitions: dict[str, Definition]
    aliases: dict[str, set[str]]


@cache
def analysed(text: str, module: str, package: bool) -> Module:
    """Return the definitions of the module of that name whose text is given; `package` if it is one."""
    tree = _Silent().visit(ast.parse(text))
    aliases: dict[str, set[str]] = {}
    for alias, target in imports(tree, module, package=package):
        aliases.setdefault(alias, set()).add(target)
    parts: dict[str, list[ast.stmt]] = {BODY: []}
    for statement in tree.body:
        for name in _defined(statement) or [BODY]:
            parts.setdefault(name, []).append(statement)
    ours = parts.keys() | {name for name, full in aliases.items() if any(map(is_ours, full))}
    return Module(
        definitions={name: _definition(nodes, module, ours) for name, nodes in parts.items()}, aliases=aliases
    )


def is_ours(dotted: str) -> bool:
    """Return whether a full name is of this repository."""
    return dotted.partition(".")[0] in PACKAGES


def _defined(statement: ast.stmt) -> list[str]:
    """Return the names that a statement at the top of a module defines; none for one that only acts."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return [] if statement.name.startswith("__") else [statement.name]
    targets: list[ast.expr] = []
    if isinstance(statement, ast.Assign):
        targets = statement.targets
    elif isinstance(statement, ast.AnnAssign):
        targets = [statement.target]
    plain = [node for target in targets for node in getattr(target, "elts", [target])]
    return [node.id for node in plain if isinstance(node, ast.Name)] if targets else []


def _definition(nodes: list[ast.stmt], module: str, ours: Set[str]) -> Definition:
    entries: dict[str, list[ast.stmt]] = {}
    own = [node for node in nodes if not _imports(node)]
    bases = own[0].bases if own and isinstance(own[0], ast.ClassDef) else []
    if is_class := len(own) == 1 and isinstance(own[0], ast.ClassDef):
        entries, own = _methods(own[0])
    elif nodes and isinstance(table := getattr(nodes[-1], "value", None), ast.Dict):
        entries = {
            key.value: [ast.Expr(value=value)]
            for key, value in zip(table.keys, table.values, strict=True)
            if isinstance(key, ast.Constant) and isinstance(key.value, str)
        }
    walked = [node for statement in own for node in ast.walk(statement)]
    inner = {id(node.value) for node in walked if isinstance(node, ast.Attribute)}
    texts = [node.value for node in walked if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return Definition(
        module=module,
        code=_canonical(own),
        chains=frozenset(chain for node in walked if id(node) not in inner and (chain := _chain(node))),
        said=frozenset(node.attr for node in walked if isinstance(node, ast.Attribute)).union(
            *map(words, texts)
        ),
        entries={key: _definition(value, module, ours) for key, value in entries.items()},
        is_class=is_class,
        is_open=not all(_chain(base).partition(".")[0] in ours for base in bases),
    )


def _methods(given: ast.ClassDef) -> tuple[dict[str, list[ast.stmt]], list[ast.stmt]]:
    """Return the methods of a class by name, and the class without them; those like __init__ stay."""
    apart: dict[str, list[ast.stmt]] = {}
    for node in given.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("__"):
            apart.setdefault(node.name, []).append(node)
    rest = [node for node in given.body if not (isinstance(node, ast.FunctionDef) and node.name in apart)]
    fields = {name: value for name, value in ast.iter_fields(given) if name != "body"}
    return apart, [ast.ClassDef(**fields, body=rest)]


def words(text: str) -> set[str]:
    """Return the words of a text that may be names."""
    return set(re.findall(r"\w+", text))


def _imports(node: ast.stmt) -> bool:
    """Return whether a statement only imports: it counts through the names that are used."""
    if isinstance(node, ast.If) and not node.orelse:
        return all(map(_imports, node.body))
    return isinstance(node, ast.Import | ast.ImportFrom)


def _chain(node: ast.AST) -> str:
    """Return the dotted name that a node is, or nothing."""
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    return ".".join([node.id, *reversed(names)]) if isinstance(node, ast.Name) else ""


def imports(tree: ast.AST, module: str, *, package: bool) -> Iterator[tuple[str, str]]:
    """Yield each name that the code of `module` gives to something it imports, and the full name of that."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                outer = alias.name.split(".")[0]
                yield alias.asname or outer, alias.name if alias.asname else outer
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = module.split(".")
                keep = len(parts) - node.level + (1 if package else 0)
                base = ".".join([*parts[:keep], *([node.module] if node.module else [])])
            yield from ((alias.asname or alias.name, f"{base}.{alias.name}") for alias in node.names)


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
