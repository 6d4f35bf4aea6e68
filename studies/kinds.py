"""Types that all of the studies share."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Is told how many parts of how many are done.
Progress = Callable[[int, int], None]
