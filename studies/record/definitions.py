"""What the modules of this repository define: the code of each definition as a text, and the names in it."""

import ast
import re
from collections.abc import Iterator, Set
from dataclasses import dataclass
from functools import cache
from importlib.util import resolve_name
from itertools import filterfalse

PACKAGES = ("spline_model", "fe_reference", "studies")
#: A word that may be a name.
WORD = re.compile(r"\w+")
#: The statements of a module that define nothing: they count as soon as anything of the module does.
BODY = ""
#: Fields of a syntax node that differ between versions of Python while the code is the same.
_VERSIONED = {"ctx", "kind", "type_comment", "type_params"}


@dataclass(frozen=True, kw_only=True)
class Definition:
    """One definition: a text that is equal for equal code, and what stands in it.

    `chains` are its dotted names that begin in this repository, `said` the names of attributes and the words
    of its strings; `entries` are those of a table by its keys, or the methods of a class but for those that
    Python calls; where a class has a base of another library it is open: that may call any of them.
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
    package: bool


@cache
def analysed(text: str, module: str, package: bool) -> Module:
    """Return the definitions of the module of that name whose text is given; `package` if it is one."""
    tree = ast.parse(text)
    aliases: dict[str, set[str]] = {}
    for alias, target in imports(tree, module, package=package):
        aliases.setdefault(alias, set()).add(target)
    parts: dict[str, list[ast.stmt]] = {BODY: []}
    for statement in filterfalse(_silent, tree.body):
        for name in _defined(statement) or [BODY]:
            parts.setdefault(name, []).append(statement)
    ours = parts.keys() | {
        name for name, full in aliases.items() if any(each.split(".")[0] in PACKAGES for each in full)
    }
    return Module(
        definitions={name: _definition(nodes, module, ours) for name, nodes in parts.items()},
        aliases=aliases,
        package=package,
    )


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
    read = _Reading()
    code = f"[{','.join(map(read.code, own))}]"
    return Definition(
        module=module,
        code=code,
        chains=frozenset(chain for chain in read.chains if chain.partition(".")[0] in ours),
        said=frozenset(read.attributes).union(WORD.findall("\n".join(read.texts))),
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


def imports(tree: ast.Module, module: str, *, package: bool) -> Iterator[tuple[str, str]]:
    """Yield each name that the code of `module` gives to something it imports, and the full name of that."""
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                outer = alias.name.split(".")[0]
                yield alias.asname or outer, alias.name if alias.asname else outer
        elif isinstance(node, ast.ImportFrom):
            outer = module if package else module.rpartition(".")[0]
            base = resolve_name("." * node.level + (node.module or ""), outer)
            yield from ((alias.asname or alias.name, f"{base}.{alias.name}") for alias in node.names)


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield all statements below a node."""
    for name in ("body", "orelse", "handlers", "finalbody", "cases"):
        for each in getattr(node, name, ()):
            yield each
            yield from _statements(each)


def _silent(node: object) -> bool:
    """Whether a statement is a string that stands alone: a docstring of a module, class, function or name."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


class _Reading:
    """What stands in syntax trees, collected while their `code` is asked for.

    `chains` are the dotted names, each as a whole; `attributes` the names behind dots; `texts` the strings.
    """

    def __init__(self) -> None:
        self.chains: set[str] = set()
        self.attributes: set[str] = set()
        self.texts: list[str] = []

    def code(self, node: object, *, inner: bool = False) -> str:
        """Return a text of a tree that is the same in every version of Python, without docstrings; `inner` if
        a longer dotted name goes on from it."""
        if isinstance(node, list):
            return f"[{','.join(map(self.code, node))}]"
        if not isinstance(node, ast.AST):
            return repr(node)
        if not inner and isinstance(node, ast.Attribute | ast.Name):
            self.chains.add(_chain(node))
        if isinstance(node, ast.Attribute):
            self.attributes.add(node.attr)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            self.texts.append(node.value)
        fields = []
        for name, value in ast.iter_fields(node):
            told = [*filterfalse(_silent, value)] if isinstance(value, list) else value
            if name not in _VERSIONED and told is not None and told != []:
                fields.append(f"{name}={self.code(told, inner=isinstance(node, ast.Attribute))}")
        return f"{type(node).__name__}({','.join(fields)})"
