"""Studies of the pivot: cases, the answers of both models, and the tables and figures drawn from them.

`plot` and `overlay` draw what either model returned; each is loaded when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studies.pictures.page import overlay, plot

__all__ = ["overlay", "plot"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module studies has no attribute {name!r}; public are {', '.join(__all__)}")
    return getattr(import_module("studies.pictures.page"), name)
