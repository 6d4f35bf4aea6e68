"""The inextensible column beyond its Euler load in closed form: the elastica by elliptic integrals."""

import math

import numpy as np
from scipy.special import ellipe, ellipk

from studies.kinds import Array

#: Euler load of a cantilever [EI/L^2].
EULER = math.pi**2 / 4.0

#: Tip angle [deg] -> load over the Euler load [1] as printed, found by tables of integrals, good to 2e-3:
#: S. P. Timoshenko, J. M. Gere, Theory of Elastic Stability, 2nd ed. (1961), section 2.7.
PUBLISHED = {
    20: 1.015, 40: 1.063, 60: 1.152, 80: 1.293, 100: 1.518, 120: 1.884, 140: 2.541, 160: 4.029, 176: 9.116
}  # fmt: skip


def load_ratio(angle: float) -> float:
    """Return P over the Euler load at a tip angle [rad]: (2 K / pi)^2 with modulus sin(angle / 2)."""
    return float((2.0 * ellipk(math.sin(angle / 2.0) ** 2) / math.pi) ** 2)


def tip(angles: Array) -> Array:
    """Return the tip's place along and across the column (..., 2) [L] at tip angles [rad].

    2 E / K - 1 and 2 sin(angle / 2) / K: Timoshenko and Gere, section 2.7.
    """
    modulus = np.sin(angles / 2.0)
    first = ellipk(modulus**2)
    return np.stack((2.0 * ellipe(modulus**2) / first - 1.0, 2.0 * modulus / first), axis=-1)


def extensible_euler(slenderness: float) -> float:
    """Return the critical load [EI/L^2] of a column that is shortened first: (1 - P / EA) P is Euler's.

    slenderness: L sqrt(EA / EI) [1].
    """
    return slenderness**2 / 2.0 * (1.0 - math.sqrt(1.0 - 4.0 * EULER / slenderness**2))
