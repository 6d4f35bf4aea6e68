"""Both models in one test: which of them, on what grids, and the limit over meshes of the elements."""

import pytest

import fe_reference
import spline_model
from tests import gates
from tests.fe.cases import extrapolated

BOTH = pytest.mark.parametrize("models", [spline_model, fe_reference], ids=lambda each: each.__name__)


def short(models):
    """Name of a model in its gates."""
    return models.__name__.partition("_")[0]


def refined(ask, elements=None, **grid):
    """Return what `ask` finds, of finite elements the limit over meshes."""
    return ask(**grid) if elements is None else extrapolated([ask(elements=n, **grid) for n in elements])


def held(gate, models, error, control_points=10, elements=(10, 20, 40)):
    """Hold an error of both models' discretisations against the model's gate."""
    grid = {"elements": elements} if models is fe_reference else {"control_points": control_points}
    gates.hold(gate, lambda **coarse: float(error(**grid | coarse)))
