"""How the functions of this package that run over all elements are compiled."""

from functools import partial

from numba import njit

#: Without numba's runtime there are no references of arrays and slices to count, which takes half of the time
#: of a small kernel; what allocates does not compile.
kernel = partial(njit, cache=True, nogil=True, error_model="numpy", _nrt=False)
