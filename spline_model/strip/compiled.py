"""How kernels are compiled: without reference counts, so without any allocation.

Numba counts references of every array and of every slice, atomically; in kernels of a few
hundred nanoseconds that takes half of the time. Without its runtime (``_nrt``) there is
nothing to count, and a kernel that allocates does not compile. ``fastmath`` may contract and
reassociate but keeps nan and infinity, by which a failed solve is seen.
"""

from __future__ import annotations

from functools import partial

from numba import njit
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher

FAST = {"contract", "reassoc", "nsz"}

kernel = partial(
    njit, cache=True, nogil=True, fastmath=FAST, error_model="numpy", _nrt=False, no_cfunc_wrapper=True
)
"""Decorator ``@kernel()`` of a function that works on given arrays only and is called from Python."""


class Parts(Compiler):
    """Numba's compiler, but for its last pass: a part is optimised where it ends up, and not before."""

    def define_pipelines(self):
        """The usual passes, into a library that leaves its code as it is."""
        library = self.state.targetctx.codegen().create_library(self.state.func_id.func_qualname)
        library.enable_object_caching()
        library._optimize_final_module = lambda: None
        self.state.library = library
        return super().define_pipelines()


class Inside(CPUDispatcher):
    """A function that has no entry from Python: a call would end the process."""

    def __call__(self, *arguments, **named):
        """Refuse the call."""
        raise TypeError(f"{self.py_func.__qualname__}: got a call from Python, expected one from a kernel")


def called(*, no_cpython_wrapper=True, **options):
    """Decorator of a function that kernels call, and Python does not; ``py_func`` is the plain one."""

    def decorated(function):
        made = kernel(pipeline_class=Parts, no_cpython_wrapper=no_cpython_wrapper, **options)(function)
        if no_cpython_wrapper and isinstance(made, CPUDispatcher):
            made.__class__ = Inside
        return made

    return decorated


part = partial(called, forceinline=True)
"""The same for a function that becomes a part of its callers: tables are not passed on. The compiler proper
inlines it, on machine code to be; Numba's own inlining would type and simplify it anew in each caller."""


once = partial(kernel, inline="always")
"""The same for a long function with one caller, which Numba inlines: each level of calls is optimised anew,
with all that is below it."""


@part()
def copy(source, target):
    """Copy a vector; a slice assignment would ask for a buffer."""
    for i in range(source.size):
        target[i] = source[i]
