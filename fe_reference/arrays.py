"""The arrays of this package, and how its functions that run over all elements are compiled."""

from functools import partial

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

#: Without numba's runtime there are no references of arrays and slices to count, which takes half of the time
#: of a small kernel; what allocates does not compile.
kernel = partial(njit, cache=True, nogil=True, error_model="numpy", _nrt=False)
#: The same, compiled into its callers: what they do not use of it costs nothing there.
inlined = partial(kernel, forceinline=True)
