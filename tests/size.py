"""How large the suite is: code lines, files and public names of every package, beside the aim.

    python -m tests.size

Code lines are those without blanks, comments and docstrings; public names are functions and classes of
modules that do not begin with an underscore. Tests are shown and not counted.
"""

import ast
import io
import tokenize
from pathlib import Path

ROOT = Path(__file__).parents[1]
COUNTED = ("spline_model", "fe_reference", "studies", "report")
#: Code lines, files and public names that all packages together should not exceed.
AIM = (20_000, 220, 600)

SILENT = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER,
}  # fmt: skip
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def code_lines(source: str) -> int:
    """Return the lines of `source` that hold code."""
    docstrings: set[int] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            docstrings |= set(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in SILENT:
            lines |= set(range(token.start[0], token.end[0] + 1))
    return len(lines - docstrings)


def public_names(source: str) -> int:
    """Return how many functions and classes of a module are public."""
    kinds = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    return sum(isinstance(node, kinds) and node.name[0] != "_" for node in ast.parse(source).body)


def size_of(package: str) -> tuple[int, int, int]:
    """Return code lines, files and public names of a package."""
    sources = [path.read_text(encoding="utf-8") for path in sorted((ROOT / package).rglob("*.py"))]
    return sum(map(code_lines, sources)), len(sources), sum(map(public_names, sources))


def main() -> None:
    """Print a line a package, the sum beside the aim, and the parts of the studies."""
    sizes = {package: size_of(package) for package in (*COUNTED, "tests")}
    parts = sorted(path.name for path in (ROOT / "studies").iterdir() if (path / "__init__.py").is_file())
    sizes |= {f"  studies/{part}": size_of(f"studies/{part}") for part in parts}
    print(f"{'':28}{'code':>8}{'files':>8}{'names':>8}")
    for package, size in sizes.items():
        print(f"{package:28}" + "".join(f"{each:8}" for each in size))
        if package == COUNTED[-1]:
            whole = [sum(sizes[each][k] for each in COUNTED) for k in range(3)]
            print(f"{'all':28}" + "".join(f"{each:8}" for each in whole))
            print(f"{'aim':28}" + "".join(f"{each:8}" for each in AIM) + "\n")


if __name__ == "__main__":
    main()
