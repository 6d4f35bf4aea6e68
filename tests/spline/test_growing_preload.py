"""Weight and pre-strain that grow on the elements: derivatives in their share."""

import numpy as np
import pytest

from spline_model import BodyDesign, compliant_mechanism
from spline_model.compile import compile_scene
from spline_model.newton import TOLERANCE
from spline_model.reduced.arrays import AXIAL, BENDING, DEAD, RATE
from spline_model.reduced.equilibrium import newton
from spline_model.reduced.model import at_rest, reduced
from spline_model.reduced.preload import Preload, act, apart, swell
from spline_model.strip.compiled import kernel
from tests.spline.test_reduced import FORMS, stretching, strip


def bridge(form):
    """A body between a curved and a straight strip, all of them heavy and pre-strained."""
    return compliant_mechanism(
        strips=[
            strip("a", (0, 0), (0.1, 0), tip="b", rise=0.02),
            strip("c", (0.12, 0.01), (0.2, 0.05), root="b", tip="ground"),
        ],
        bodies=[BodyDesign(name="b", centre=(0.11, 0.01), mass=0.01)],
        effects=("bending", stretching(form), "gravity", "pre_strain"),
        parameters={"pre_strain": {"curvature": 5.0, "strain": 3e-5}},
        **form,
    ).scene


@kernel()
def _solve(y, arrays, tolerance, counters):
    """A state at the held coordinates; its negative eigenvalues."""
    return newton(y, 0.0, False, arrays, tolerance, counters)[0]


@kernel()
def _swell(y, share, preload, arrays):
    """Both derivatives of its potential."""
    return swell(y, share, preload, arrays)


def states(model, shares):
    """y, potential, its two derivatives and the rate in the share at each of some shares, on one path."""
    (bodies, strips), preload, y = apart(model), Preload.of(model), at_rest(model)
    arrays = model.arrays()._replace(bodies=bodies, strips=strips)
    space = arrays.space
    for share in shares:
        act(share, preload, bodies, strips)
        counters = np.zeros(3, dtype=np.int64)
        assert _solve(y, arrays, TOLERANCE, counters) == 0
        energy = space.out[[BENDING, AXIAL, DEAD]].sum() + share * preload.hung[1]
        slope, bend = _swell(y, share, preload, arrays)
        yield y.copy(), energy, slope, bend, space.states[RATE].copy()


@pytest.mark.slow  # newton is compiled by itself for it
@pytest.mark.parametrize("form", [name for name in FORMS if name != "four points"])
def test_rates_in_the_share_are_differences(form):
    """Requirement: rate of the state and both derivatives of the potential are those of states next to it."""
    step, model = 1e-4, reduced(compile_scene(bridge(FORMS[form])))
    *_, before, here, after = states(model, (0.1, 0.2, 0.3, 0.4, 0.5 - step, 0.5, 0.5 + step))
    rate, slope, bend = ((b - a) / (2 * step) for a, b in zip(before[:3], after[:3], strict=True))
    np.testing.assert_allclose(here[4], rate, atol=1e-6 * np.abs(rate).max())
    assert abs(here[2] / slope - 1) < 1e-6
    assert abs(here[3] / bend - 1) < 1e-6
