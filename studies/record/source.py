"""Which source a result depends on: the definitions that its study reaches by name, and a hash of their code.

A definition is a function, a class or a constant of a module. A study reaches all of its own module, what
that names, and so on. What stands beside in a module and is not named does not count, and neither does a
method whose name is nowhere said.
"""

import ast
import hashlib
import re
from collections.abc import Iterator, Set
from dataclasses import dataclass
from functools import cache
from importlib.util import resolve_name
from itertools import accumulate
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("spline_model", "fe_reference", "studies")
#: A word that may be a name.
WORD = re.compile(r"\w+")
#: Modules that move or draw numbers and cannot change them, so that results stay fresh when these are edited.
WITHOUT_INFLUENCE = ("studies.record", "studies.pictures")
#: Tables of effects by name, read by the name alone: an entry counts where its name is said, in a case of the
#: study or in the code that is reached, so that an effect more leaves alone what does not name it.
BY_NAME = ("spline_model.effects.registry:REGISTRY", "fe_reference.effects:KNOWN")


def source_hash(module: str, *, said: str | None = None, root: Path = ROOT) -> str:
    """Return the SHA-256 of the code of `module` and of all definitions of this repository that it reaches.

    The code is the syntax tree without docstrings, comments and layout; imports inside functions count too.

    Args:
        module: its full name, or module:constant for what that constant reaches.
        said: text in which an effect's name is looked for, as that of case files; None counts all effects.
        root: folder of the packages.
    """
    found = sorted(_Reach(module, said, root).found.items())
    return hashlib.sha256("".join(f"{place}\n{code}\n" for place, code in found).encode()).hexdigest()


def reached(module: str, *, said: str | None = None, root: Path = ROOT) -> list[str]:
    """Return the places `module:name` of the definitions that `source_hash` takes in, sorted.

    Raises:
        FileNotFoundError: no such module in this repository.
    """
    return sorted(_Reach(module, said, root).found)


#: The statements of a module that define nothing: they count as soon as anything of the module does.
BODY = ""
#: Fields of a syntax node that differ between versions of Python while the code is the same.
_VERSIONED = {"ctx", "kind", "type_comment", "type_params"}


@dataclass(frozen=True, kw_only=True)
class _Definition:
    """One definition: a text that is equal for equal code, and what stands in it.

    `chains` are its dotted names that begin in this repository, `said` the names of attributes and the words
    of its strings; `entries` are those of a table by its keys, or the methods of a class but for those that
    Python calls; where a class has a base of another library it is open: that may call any of them.
    """

    module: str
    code: str
    chains: frozenset[str]
    said: frozenset[str]
    entries: dict[str, "_Definition"]
    is_class: bool
    is_open: bool


@dataclass(frozen=True, kw_only=True)
class _Module:
    """The definitions of a module by name, and what the names that it imports stand for."""

    definitions: dict[str, _Definition]
    aliases: dict[str, set[str]]


@cache
def _analysed(text: str, module: str, package: bool) -> _Module:
    """Return the definitions of the module of that name whose text is given; `package` if it is one."""
    tree = _Silent().visit(ast.parse(text))
    aliases: dict[str, set[str]] = {}
    for alias, target in imports(tree, module, package=package):
        aliases.setdefault(alias, set()).add(target)
    parts: dict[str, list[ast.stmt]] = {BODY: []}
    for statement in tree.body:
        for name in _defined(statement) or [BODY]:
            parts.setdefault(name, []).append(statement)
    ours = parts.keys() | {
        name for name, full in aliases.items() if any(each.split(".")[0] in PACKAGES for each in full)
    }
    return _Module(
        definitions={name: _definition(nodes, module, ours) for name, nodes in parts.items()}, aliases=aliases
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


def _definition(nodes: list[ast.stmt], module: str, ours: Set[str]) -> _Definition:
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
    chains = (_chain(node) for node in walked if id(node) not in inner)
    attributes = (node.attr for node in walked if isinstance(node, ast.Attribute))
    texts = [node.value for node in walked if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return _Definition(
        module=module,
        code=_canonical(own),
        chains=frozenset(chain for chain in chains if chain.partition(".")[0] in ours),
        said=frozenset(attributes).union(WORD.findall("\n".join(texts))),
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


def imports(tree: ast.AST, module: str, *, package: bool) -> Iterator[tuple[str, str]]:
    """Yield each name that the code of `module` gives to something it imports, and the full name of that."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                outer = alias.name.split(".")[0]
                yield alias.asname or outer, alias.name if alias.asname else outer
        elif isinstance(node, ast.ImportFrom):
            outer = module if package else module.rpartition(".")[0]
            base = resolve_name("." * node.level + (node.module or ""), outer)
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


class _Reach:
    """A walk from a module along names: `found` has the code of every definition it came to, by its place."""

    def __init__(self, module: str, said: str | None, root: Path) -> None:
        self.modules: dict[str, _Module | None] = {}
        self.root = root
        self.found: dict[str, str] = {}
        self.said = set(WORD.findall(said or ""))
        self.by_name = BY_NAME if said is not None else ()
        self.tables: dict[str, dict[str, _Definition]] = {}
        self.waiting: list[_Definition] = []
        self.named: set[tuple[str, str]] = set()
        module, _, constant = module.partition(":")
        if self._module(module) is None:
            raise FileNotFoundError(f"module {module}: no such module in this repository")
        if constant:
            self._define(module, constant)
        else:
            self._whole(module)
        while self.waiting or self._entries():
            definition = self.waiting.pop()
            self.said |= definition.said
            for name in {(definition.module, chain) for chain in definition.chains} - self.named:
                self.named.add(name)
                self._name(*name)

    def _module(self, name: str) -> _Module | None:
        """Return a module of this repository that can influence numbers; None for any other name."""
        if name not in self.modules:
            path, self.modules[name] = self.root.joinpath(*name.split(".")), None
            file = next(filter(Path.is_file, (path.with_suffix(".py"), path / "__init__.py")), None)
            if file and name.split(".")[0] in PACKAGES and not name.startswith(WITHOUT_INFLUENCE):
                text = file.read_text(encoding="utf-8")
                self.modules[name] = _analysed(text, name, file.name == "__init__.py")
        return self.modules[name]

    def _entries(self) -> bool:
        """Take entries of tables and methods whose name was said by now; return whether there were any."""
        for place, entries in self.tables.items():
            for key in entries.keys() & self.said:
                self._take(f"{place}[{key}]", entries.pop(key))
        return bool(self.waiting)

    def _whole(self, name: str) -> None:
        module = self._module(name)
        for each in module.definitions if module else ():
            self._define(name, each)

    def _define(self, module: str, name: str) -> None:
        """Take one definition, with what its module and the packages around it do on import."""
        place = f"{module}:{name}"
        known = self._module(module)
        if place in self.found or known is None:
            return
        for outer in accumulate(module.split("."), "{}.{}".format):
            if around := self._module(outer):
                self._take(f"{outer}:", around.definitions[BODY])
        definition = known.definitions[name]
        if place in self.by_name or definition.is_class:
            self.tables[place] = dict(definition.entries)
        if definition.is_open:
            self.said |= definition.entries.keys()
        if place in self.by_name:
            self.found[place] = ""
        else:
            self._take(place, definition)

    def _take(self, place: str, definition: _Definition) -> None:
        if place not in self.found:
            self.found[place] = definition.code
            self.waiting.append(definition)

    def _name(self, module: str, chain: str) -> None:
        """Take what a dotted name of `module` means, if that is of this repository."""
        head, _, rest = chain.partition(".")
        known = self._module(module)
        if known is None:
            return
        if head in known.definitions:
            self._define(module, head)
        for target in known.aliases.get(head, ()):
            self._target(f"{target}.{rest}" if rest else target)

    def _target(self, dotted: str) -> None:
        """Take what a full name means: a definition of a module, or the whole module where none is named."""
        parts = dotted.split(".")
        for count in range(len(parts), 0, -1):
            module, rest = ".".join(parts[:count]), parts[count:]
            if known := self._module(module):
                if rest and (rest[0] in known.definitions or rest[0] in known.aliases):
                    self._name(module, ".".join(rest))
                else:
                    self._whole(module)
                return
