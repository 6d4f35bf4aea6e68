"""How kernels are compiled: without reference counts, so without any allocation.

Numba counts references of every array and of every slice, atomically; in kernels of a few
hundred nanoseconds that takes half of the time. Without its runtime (``_nrt``) there is
nothing to count, and a kernel that allocates does not compile. ``fastmath`` may contract and
reassociate but keeps nan and infinity, by which a failed solve is seen.
"""

from __future__ import annotations

import logging
import math
from functools import cache, lru_cache, partial
from typing import Any

import numpy as np
from numba import njit, types
from numba.core.caching import FunctionCache
from numba.core.codegen import JITCodeLibrary, ll, llvmir
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numpy.typing import NDArray

Array = NDArray[np.float64]

FAST = {"contract", "reassoc", "nsz"}
ENVIRONMENT = "_ZN08NumbaEnv"
"""What the names of the places begin with where Numba keeps the Python objects of a function."""


class _Short(Compiler):
    """Numba's compiler, optimising once and for short loops: of eight Gauss points, not of eighty.

    Numba optimises twice, around the pruning of reference counts that are not there, and lets a vectorised
    loop do four vectors at a time, of which a short one fills none.
    """

    def define_pipelines(self):
        """The usual passes, into a library that finishes its code so."""
        library = self.state.targetctx.codegen().create_library(self.state.func_id.func_qualname)
        library.enable_object_caching()
        library._optimize_final_module = partial(self.finish, library)
        self.state.library = library
        return super().define_pipelines()

    def finish(self, library):
        """Optimise the code of a library in place."""
        options = ll.create_pipeline_tuning_options(speed_level=3)
        options.loop_vectorization, options.loop_interleaving = True, False
        builder = ll.create_pass_builder(library.codegen._tm, options)
        builder.getModulePassManager().run(library._final_module, builder)


class _Parts(_Short):
    """The same, but for the last steps: a part is optimised where it ends up, and only there machine code."""

    def finish(self, library):
        """Keep the code for those that link it; what is made machine code of has no function in it."""
        if not self.state.flags.no_cpython_wrapper:  # Python enters it as well
            return
        library._finalized = True
        library._get_module_for_linking()
        library._finalized = False
        rest = library.codegen._create_empty_module(library.name)
        for name in (v.name for v in library._final_module.global_variables):
            if name.startswith(ENVIRONMENT):  # which Numba writes to
                place = llvmir.GlobalVariable(rest, llvmir.IntType(8).as_pointer(), name)
                place.linkage, place.initializer = "common", llvmir.Constant(place.value_type, None)
        library._final_module = ll.parse_assembly(str(rest))


class _Lanes(_Parts):
    """The same for arguments that share no element of an array, which lets their loops fill vectors."""

    def define_pipelines(self):
        """The usual passes, with the arguments told apart."""
        self.state.flags.noalias = True
        return super().define_pipelines()


class _Linked(JITCodeLibrary):
    """A library whose machine code was stored; ``code`` for those that link it is read when one does."""

    code = b""

    def _get_module_for_linking(self):
        if self.code:
            self._shared_module, self.code = ll.parse_bitcode(self.code), b""
        return super()._get_module_for_linking()


class _Stored(FunctionCache):
    """Where compiled kernels are stored, which commands load by the dozen.

    Numba would first import all that compilation knows, and read the code of each for those that may link it:
    0.4 s, more than a third of a command.
    """

    def load_overload(self, sig, target_context):
        """Load a kernel for arguments of these kinds; a compilation that follows imports what it needs."""
        with self._guard_against_spurious_io_errors():
            data = self._cache_file.load(self._index_key(sig, target_context.codegen()))
            return None if data is None else self._read(target_context, *data)

    def _read(self, target_context, library, description, *others):
        """The kernel from what is stored of it."""
        name, kind, (machine, code) = library
        names = {description.llvm_func_name, description.llvm_cpython_wrapper_name}
        target_context.codegen()._engine._defined_symbols |= {n for n in names if n.encode() in machine}
        library = name, kind, (machine, ll.parse_assembly("").as_bitcode())
        made = self._impl.rebuild(target_context, (library, description, *others))
        made.library.__class__, made.library.code = _Linked, code
        return made


class _Kernel(CPUDispatcher):
    """A function that is compiled once for all numbers it is called with, those that are written out too."""

    def get_call_template(self, args, kws):
        """What a call is compiled to."""
        return super().get_call_template([types.unliteral(each) for each in args], kws)


class _Inside(_Kernel):
    """A function that has no entry from Python: a call would end the process."""

    def __call__(self, *arguments, **named):
        """Refuse the call."""
        raise TypeError(f"{self.py_func.__qualname__}: got a call from Python, expected one from a kernel")


_compiled = partial(njit, nogil=True, fastmath=FAST, error_model="numpy", _nrt=False, no_cfunc_wrapper=True)


@cache
def _say_unkept():
    logging.getLogger("spline_model").warning(
        "spline_model: got no writable place for compiled kernels, expected one beside the source, in the "
        "user's cache or as NUMBA_CACHE_DIR: they are compiled again each time"
    )


def kernel(*, pipeline_class=_Short, entered=False, **options):
    """Return the decorator of a function that works on given arrays only and is called from Python.

    entered: a part is called from Python too; with two callers it stays a function of its own.
    """
    inside = issubclass(pipeline_class, _Parts) and not entered
    compiled = partial(_compiled, pipeline_class=pipeline_class, no_cpython_wrapper=inside, **options)

    def decorated(function):
        try:
            made = compiled(cache=True)(function)
        except RuntimeError:  # numba has no folder in which it can store the kernel
            _say_unkept()
            made = compiled()(function)
        if isinstance(made, CPUDispatcher):
            made.__class__ = _Inside if inside else _Kernel
            stored = getattr(made, "_cache", None)
            if isinstance(stored, FunctionCache):
                stored.__class__ = _Stored
        return made

    return decorated


called = partial(kernel, pipeline_class=_Parts)
"""The same for a function that kernels call, and Python does not; ``py_func`` is the plain one."""


part = partial(called, forceinline=True)
"""The same for a function that becomes a part of its callers: tables are not passed on. The compiler proper
inlines it, on machine code to be; Numba's own inlining would type and simplify it again in each caller."""


lane = partial(part, pipeline_class=_Lanes)
"""The same for loops over Gauss points, or pairs of control points: no two arguments share an element."""


once = partial(kernel, inline="always")
"""The same for a long function with one caller, which Numba inlines: each level of calls is optimised again,
with all that is below it."""


@part()
def copy(source, target):
    """Copy a vector; a slice assignment would ask for a buffer."""
    for i in range(source.size):
        target[i] = source[i]


def aligned(*shapes: tuple[int, ...], dtype: np.dtype[Any] | type = float) -> list[NDArray[Any]]:
    """Return arrays of zeros (one per shape, in any unit) that begin at a cache line, for fast vectors."""
    places, count = _places(shapes)
    room = np.zeros(count + 8, dtype=dtype)
    room = room[-room.ctypes.data % 64 // room.itemsize :]
    return [room[begin:end].reshape(shape) for begin, end, shape in places]


@lru_cache(maxsize=64)
def _places(shapes: tuple[tuple[int, ...], ...]) -> tuple[list[tuple[int, int, tuple[int, ...]]], int]:
    """Where arrays begin and end that stand in lines of eight, one behind the other; and where all end."""
    places, count = [], 0
    for shape in shapes:
        places.append((count, count + math.prod(shape), shape))
        count += -(-math.prod(shape) // 8) * 8
    return places, count
