"""Every module of a package as Sphinx can read it: annotations resolved, functions not hidden in objects."""

import ast
import importlib
import inspect
import pkgutil
import typing
from types import ModuleType

from skfem.assembly import Form


def import_whole(package: str) -> None:
    """Import all modules of `package`, then what they import under `if TYPE_CHECKING:`."""
    top = importlib.import_module(package)
    names = [each.name for each in pkgutil.walk_packages(top.__path__, f"{package}.")]
    modules = [importlib.import_module(name) for name in names]
    for module in modules:
        for node in ast.parse(inspect.getsource(module)).body:
            if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
                exec(compile(ast.Module(node.body, []), module.__name__, "exec"), vars(module))
    for module in modules:
        _resolve_fields(module)
        _unwrap_forms(module)


def _resolve_fields(module: ModuleType) -> None:
    """Replace the annotations of named tuples, which are kept as bare names, by the types themselves."""
    for value in vars(module).values():
        if isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields"):
            value.__annotations__ = value.__new__.__annotations__ = typing.get_type_hints(value)


def _unwrap_forms(module: ModuleType) -> None:
    """Put the functions that scikit-fem made forms of back in their places: a form has no docstring."""
    for name, value in list(vars(module).items()):
        if isinstance(value, Form):
            setattr(module, name, value.form)
