"""Which source a result depends on: the definitions that its study reaches by name, and a hash of their code.

A definition is a function, a class or a constant of a module. A study reaches all of its own module, what
that names, and so on. What stands beside in a module and is not named does not count, and neither does a
method whose name is nowhere said.
"""

import hashlib
from itertools import accumulate
from pathlib import Path

from studies.record.definitions import BODY, PACKAGES, WORD, Definition, Module, analysed

ROOT = Path(__file__).parents[2]
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


class _Reach:
    """A walk from a module along names: `found` has the code of every definition it came to, by its place."""

    def __init__(self, module: str, said: str | None, root: Path) -> None:
        self.modules: dict[str, Module | None] = {}
        self.root = root
        self.found: dict[str, str] = {}
        self.said = set(WORD.findall(said or ""))
        self.by_name = BY_NAME if said is not None else ()
        self.tables: dict[str, dict[str, Definition]] = {}
        self.waiting: list[Definition] = []
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

    def _module(self, name: str) -> Module | None:
        """Return a module of this repository that can influence numbers; None for any other name."""
        if name not in self.modules:
            self.modules[name] = self._read(name)
        return self.modules[name]

    def _read(self, name: str) -> Module | None:
        around = self._module(outer) if (outer := name.rpartition(".")[0]) else None
        if name.startswith(WITHOUT_INFLUENCE) or not (name in PACKAGES or (around and around.package)):
            return None
        path = self.root.joinpath(*name.split("."))
        file = next(filter(Path.is_file, (path.with_suffix(".py"), path / "__init__.py")), None)
        return analysed(file.read_text(encoding="utf-8"), name, file.name == "__init__.py") if file else None

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
        if f"{module}:" not in self.found:
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

    def _take(self, place: str, definition: Definition) -> None:
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
