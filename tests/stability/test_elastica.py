"""The elastica that columns are held against solves its own equation."""

import numpy as np
from scipy.integrate import solve_ivp

from studies.stability.questions import EULER, PUBLISHED, load_ratio, tip
from tests import gates


def equation_error(rtol=1e-10):
    """Largest miss of the tip, integrated from the root: theta'' = -P sin theta, no moment at the end."""
    missed = []
    for angle in np.radians(list(PUBLISHED)):
        load = EULER * load_ratio(angle)

        def along(_, y, load=load):
            return [y[1], -load * np.sin(y[0]), np.cos(y[0]), np.sin(y[0])]

        start = [0.0, np.sqrt(2.0 * load * (1.0 - np.cos(angle))), 0.0, 0.0]
        end = solve_ivp(along, (0.0, 1.0), start, rtol=rtol, atol=1e-2 * rtol).y[:, -1]
        missed.append(np.abs(end - [angle, 0.0, *tip(angle)]).max())
    return max(missed)


def test_tip_solves_the_elastica():
    """Requirement: angle, place and vanishing moment of the tip are those of the column's equation."""
    gates.hold("elastica_equation", equation_error)
