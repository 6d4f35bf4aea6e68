"""The arrays of this package, and how its functions that run over all elements are compiled."""

import logging
from collections.abc import Callable
from functools import cache, partial
from typing import Any, TypeVar, cast

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]
F = TypeVar("F", bound=Callable[..., Any])

#: Without numba's runtime there are no references of arrays and slices to count, which takes half of the time
#: of a small kernel; what allocates does not compile.
_compiled = partial(njit, nogil=True, error_model="numpy", _nrt=False)


def kernel(**options: Any) -> Callable[[F], F]:
    """Return the decorator of a function over all elements; it is kept compiled where there is a place."""

    def decorated(function: F) -> F:
        made: Any
        try:
            made = _compiled(cache=True, **options)(function)
        except RuntimeError:  # numba has no folder in which it can store the kernel
            _say_unkept()
            made = _compiled(**options)(function)
        return cast(F, made)

    return decorated


@cache
def _say_unkept() -> None:
    logging.getLogger("fe_reference").warning(
        "fe_reference: got no writable place for compiled kernels, expected one beside the source, in the "
        "user's cache or as NUMBA_CACHE_DIR: they are compiled again each time"
    )


#: The same, compiled into its callers: what they do not use of it costs nothing there.
inlined = partial(kernel, forceinline=True)
