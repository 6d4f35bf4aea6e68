"""What a study asks of a machine beside this suite: the extras of pyproject.toml.

A study that needs one has `missing()`, which returns what `lacking` says; `run` then keeps its stored result.
"""

import importlib.util
from collections.abc import Iterable


def absent(modules: Iterable[str]) -> list[str]:
    """Return those of the modules that cannot be imported here."""
    return [name for name in modules if importlib.util.find_spec(name) is None]


def lacking(extra: str, names: list[str]) -> str:
    """Return in a line that packages are not there and how they come; nothing where none is absent."""
    if not names:
        return ""
    return f"it needs {', '.join(names)}: python -m pip install '.[{extra}]'"
