"""How kernels are compiled: without reference counts, so without any allocation.

Numba counts references of every array and of every slice, atomically; in kernels of a few
hundred nanoseconds that takes half of the time. Without its runtime (``_nrt``) there is
nothing to count, and a kernel that allocates does not compile. ``fastmath`` may contract and
reassociate but keeps nan and infinity, by which a failed solve is seen.
"""

from __future__ import annotations

from functools import partial

from numba import njit

FAST = {"contract", "reassoc", "nsz"}

kernel = partial(njit, cache=True, nogil=True, fastmath=FAST, error_model="numpy", _nrt=False)
"""Decorator ``@kernel()`` of a function that works on given arrays only."""

part = partial(kernel, forceinline=True)
"""The same for a function that becomes a part of its callers: tables are not passed on. The compiler proper
inlines it, on machine code to be; Numba's own inlining would type and simplify it anew in each caller."""


@part()
def copy(source, target):
    """Copy a vector; a slice assignment would ask for a buffer."""
    for i in range(source.size):
        target[i] = source[i]
