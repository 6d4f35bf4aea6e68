"""Slips where chance puts them, in both models and in the estimates: does any quick test notice each?

Of all lines that hold something to change some are drawn, and one change of each: plus and minus, times and
over, sine and cosine, least and most, "and" and "or" change places; a comparison or a sign is turned round; a
term is dropped; a number grows by a hundredth; an index is another one. Left alone is what is raised,
asserted, written in words or declared, and a number in capitals, which is a limit or a tolerance.
"""

import ast
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: What is changed, and the tests that are asked for it behind those of all commands.
CHANGED = {
    "spline_model": "spline",
    "fe_reference": "fe",
    "studies/answers/critical.py": "stability",
    "studies/answers/metrics.py": "suite",
}
#: Tests that any change of the code fails, or that are of pages and pictures.
NOT_ASKED = ("bench", "docs", "interactive", "report", "suite/test_results.py", "suite/test_slips.py")
#: Of pytest: only the names of what fails, and an end of what takes minutes, as some solvers do with a slip.
OPTIONS = (
    *("-q", "-rfE", "--tb=no", "-m", "not slow", "-p", "no:cacheprovider", "-p", "no:xdist"),
    *("-o", "faulthandler_timeout=900", "-o", "faulthandler_exit_on_timeout=true"),
)
#: Part that quick tests are to notice.
WANTED = 0.9
OPERATORS = {ast.Add: "+-", ast.Sub: "-+", ast.Mult: "*/", ast.Div: "/*"}
COMPARED = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
NAMES = {"sin": "cos", "min": "max", "minimum": "maximum", "fmin": "fmax", "argmin": "argmax"}
NAMES |= {other: one for one, other in NAMES.items()}
LEFT_ALONE = (ast.Raise, ast.Assert, ast.JoinedStr, ast.Import, ast.ImportFrom)
DECLARED = ("annotation", "returns", "decorator_list", "bases")
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+?::[^\s\[]+|\S+)", flags=re.MULTILINE)


@dataclass(frozen=True)
class Change:
    """The part of a line of a file that is changed, and what it becomes."""

    file: str
    line: int
    column: int
    old: str
    new: str

    def put_into(self, root: Path) -> None:
        """Write the changed file."""
        path = root / self.file
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        text, at = lines[self.line - 1], self.column
        lines[self.line - 1] = text[:at] + self.new + text[at + len(self.old) :]
        path.write_text("".join(lines), encoding="utf-8")


def changes(file: Path) -> Iterator[Change]:
    """Yield all changes of a file."""
    lines = file.read_text(encoding="utf-8").splitlines()
    for node, index in visited(ast.parse("\n".join(lines))):
        for line, begin, end, kind in parts(node, index):
            begin, end = (len(lines[line - 1].encode()[:at].decode()) for at in (begin, end))
            old = lines[line - 1][begin:end]
            if (new := changed(old, kind)) != old:
                yield Change(str(file.relative_to(ROOT)), line, begin, old, new)


def visited(node: ast.AST, index: bool = False) -> Iterator[tuple[ast.AST, bool]]:
    """Yield what may be changed, and whether it stands in an index."""
    if isinstance(node, LEFT_ALONE) or is_limit(node):
        return
    yield node, index
    for name, value in ast.iter_fields(node):
        inside = (isinstance(node, ast.Subscript) and name == "slice") or getattr(node, "arg", "") == "axis"
        inside |= index and not isinstance(node, ast.Call)
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST) and name not in DECLARED:
                yield from visited(child, inside)


def is_limit(node: ast.AST) -> bool:
    """Return whether names in capitals are given numbers alone."""
    if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
        return False
    left = node.targets[0] if isinstance(node, ast.Assign) else node.target
    names = [each.id for each in ast.walk(left) if isinstance(each, ast.Name)]
    plain = not any(isinstance(each, ast.Name | ast.Call | ast.List) for each in ast.walk(node.value))
    return plain and bool(names) and all(name.isupper() for name in names)


def parts(node: ast.AST, index: bool) -> Iterator[tuple[int, int, int, str]]:
    """Yield line, begin and end, in bytes, of what can be changed at a node, and how."""
    gaps: list[tuple[ast.expr, ast.expr]] = []
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        gaps, kind = [(node.left, node.right)], OPERATORS[type(node.op)]
        if kind in ("+-", "-+") and node.left.end_lineno == node.end_lineno:
            yield node.end_lineno, node.left.end_col_offset, node.end_col_offset, "drop"
    elif isinstance(node, ast.BoolOp):
        gaps, kind = list(zip(node.values, node.values[1:], strict=False)), "word"
    elif isinstance(node, ast.Compare) and len(node.ops) == 1:
        gaps, kind = [(node.left, node.comparators[0])], "compare"
    elif isinstance(node, ast.AugAssign) and type(node.op) in OPERATORS:
        gaps, kind = [(node.target, node.value)], OPERATORS[type(node.op)]
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield node.lineno, node.col_offset, node.col_offset + 1, "drop"
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name | ast.Attribute):
        yield node.func.end_lineno, node.func.col_offset, node.func.end_col_offset, "name"
    elif isinstance(node, ast.Constant) and type(node.value) is (int if index else float):
        yield node.lineno, node.col_offset, node.end_col_offset, "index" if index else "more"
    for left, right in gaps:
        if left.end_lineno == right.lineno:
            yield left.end_lineno, left.end_col_offset, right.col_offset, kind


def changed(old: str, kind: str) -> str:
    """Return what a text becomes, or itself."""
    word = old.strip(" ()")
    if kind == "drop":
        return "" if old.count(")") == old.count("(") else old
    if kind == "name":
        head, dot, name = old.rpartition(".")
        return head + dot + NAMES.get(name, name)
    if kind == "index":
        return str(int(old) - 1 if int(old) else 1) if old.isdigit() else old
    if kind == "more":
        return repr(1.01 * float(old)) if float(old) else old
    if kind in ("word", "compare"):
        return old.replace(word, {**COMPARED, "and": "or", "or": "and"}.get(word, word))
    return old.replace(kind[0], kind[1], 1)


def drawn(count: int, seed: int) -> list[Change]:
    """Return changes of so many lines, all lines having the same chance."""
    lines: dict[tuple[str, int], list[Change]] = defaultdict(list)
    for place in (ROOT / each for each in CHANGED):
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            for change in changes(file):
                lines[change.file, change.line].append(change)
    chance = random.Random(seed)
    return [chance.choice(lines[line]) for line in chance.sample(sorted(lines), count)]


def noticed_by(change: Change | None, known: Sequence[str] = ()) -> list[str]:
    """Return the first test that fails with a change, or all that fail without any.

    The copy brings its compiled kernels along: the tests begin by dropping those that a change concerns.
    """
    with tempfile.TemporaryDirectory() as folder:
        ignored = shutil.ignore_patterns(".*", "_build", "*.egg-info", "build")
        copy = Path(shutil.copytree(ROOT, Path(folder) / "copy", ignore=ignored))
        first = ["goldens", "agreement"]
        if change:
            change.put_into(copy)
            first[1:1] = [tests for place, tests in CHANGED.items() if change.file.startswith(place)]
        every = sorted(path.parent.name for path in (copy / "tests").glob("*/__init__.py"))
        tests = [f"tests/{name}" for name in dict.fromkeys([*first, *every]) if name not in NOT_ASKED]
        left_out = [f"--ignore=tests/{name}" for name in NOT_ASKED] + [f"--deselect={name}" for name in known]
        command = [sys.executable, "-m", "pytest", *OPTIONS, *left_out, *(["-x"] if change else []), *tests]
        env = os.environ | {"PYTHONPATH": str(copy), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        ended = subprocess.run(command, cwd=copy, env=env, capture_output=True, text=True)
    failed = FAILED.findall(ended.stdout)
    return failed or ([] if ended.returncode == 0 else [f"end of the process, {ended.returncode}"])


def score(count: int, seed: int) -> float:
    """Try changes, one on each core, print who notices each, and return the part that is noticed."""
    known = noticed_by(None)
    print(f"{len(known)} tests fail without a slip and are not used:", *known, flush=True)

    def tried(change: Change) -> bool:
        failed = noticed_by(change, known)
        what = f"{change.file}:{change.line}  {change.old.strip()!r} -> {change.new.strip()!r}"
        print(what, failed[0] if failed else "SURVIVED", sep="  ", flush=True)
        return bool(failed)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        noticed = sum(pool.map(tried, drawn(count, seed)))
    print(f"{noticed} of {count} random slips noticed, seed {seed}")
    return noticed / count
