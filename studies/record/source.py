"""Which source a result depends on: the definitions that its study reaches by name, and a hash of their code.

A definition is a function, a class or a constant of a module. A study reaches all of its own module, what
that names, and so on. What stands beside in a module and is not named does not count, and neither does a
method whose name is nowhere said.

Compiled kernels that are kept on the disk are held to it as well. numba compiles a kernel anew when its own
file changes, but not when one changes that it calls, or a constant of another module: what is kept would then
answer for a source that is gone.
"""

import hashlib
import re
from collections.abc import Iterable
from pathlib import Path

from studies.record.files import OutputError, write_whole
from studies.record.syntax import BODY, Definition, Module, analysed, is_ours, words

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
    digest = hashlib.sha256()
    for place, code in sorted(_Reach(module, said, root).found.items()):
        digest.update(f"{place}\n{code}\n".encode())
    return digest.hexdigest()


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
        self.said = words(said or "")
        self.by_name = BY_NAME if said is not None else ()
        self.tables: dict[str, dict[str, Definition]] = {}
        self.waiting: list[Definition] = []
        module, _, constant = module.partition(":")
        if self._module(module) is None:
            raise FileNotFoundError(f"module {module}: no such module in this repository")
        if constant:
            self._define(module, constant)
        else:
            self._whole(module)
        while self.waiting or self._entries():
            self._follow(self.waiting.pop())

    def _module(self, name: str) -> Module | None:
        """Return a module of this repository that can influence numbers; None for any other name."""
        if name not in self.modules:
            path = None if name.startswith(WITHOUT_INFLUENCE) else _file(name, self.root)
            text = "" if path is None else path.read_text(encoding="utf-8")
            self.modules[name] = None if path is None else analysed(text, name, path.name == "__init__.py")
        return self.modules[name]

    def _follow(self, definition: Definition) -> None:
        self.said |= definition.said
        for chain in definition.chains:
            self._name(definition.module, chain)

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
        for outer in (*_parents(module), module):
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


def _parents(name: str) -> Iterable[str]:
    parts = name.split(".")
    return (".".join(parts[:count]) for count in range(1, len(parts)))


def _file(name: str, root: Path) -> Path | None:
    if not is_ours(name):
        return None
    path = root.joinpath(*name.split("."))
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


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
