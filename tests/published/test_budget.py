"""The error budget: every bar is the largest difference of the two models that it names."""

import numpy as np
import pandas as pd
import pytest

from studies.published import solid_pivot
from studies.published.solids import limits_of

ROTATION = np.linspace(0.1, 1.0, 5)


def states(shift=0.0, **labels):
    """States of a model whose torque and place are further by a share that grows to `shift`."""
    share = 1.0 + shift * ROTATION
    values = {"torque_Nm": ROTATION * share, "com_x_m": ROTATION * share, "com_y_m": 0.0}
    return pd.DataFrame(labels | {"rotation_rad": ROTATION} | values)


def test_bars_are_the_largest_differences():
    """Torque is relative to the state, the trajectory to the chord of the solid's or beam's own path."""
    shifts = {name: 0.01 * k for k, name in enumerate(solid_pivot.VARIANTS)}
    wanted = {model for _, model, _ in solid_pivot.SOURCES.values() if not model.startswith("solid")}
    models = [states(model=name) for name in wanted - set(shifts)]
    variants = [states(shift, model=name) for name, shift in shifts.items()]
    laws = {"st-venant-kirchhoff": 0.0, "neo-hookean": -0.02}
    limits = [
        states(shift, law=law).assign(uncertainty=1e-4, uncertainty_m=9e-5) for law, shift in laws.items()
    ]
    tables = {"models": pd.concat(models), "variants": pd.concat(variants), "limits": pd.concat(limits)}
    rows = pd.DataFrame(solid_pivot.budget(tables, 5)).set_index("source")
    reference = 1.0 + shifts[solid_pivot.BEAM] * ROTATION
    for source, (_, model, against) in solid_pivot.SOURCES.items():
        if against == solid_pivot.BEAM:
            own = 1.0 + shifts.get(model, 0.0) * ROTATION
            apart = np.abs(own / reference - 1.0).max()
            assert rows.loc[source, "error_torque"] == pytest.approx(apart, abs=1e-14)
    law = rows.loc["material law of solids"]
    assert law["error_torque"] == pytest.approx(0.02) and law["error_trajectory"] == pytest.approx(0.02 / 0.9)
    solid = rows.loc["solids (refinement)"]
    assert (solid["error_torque"], solid["error_trajectory"]) == pytest.approx((1e-4, 1e-4))


def test_limits_have_the_uncertainty_of_mesh_and_order():
    """Of meshes of second order the limit is exact, and the order 1.5 makes its uncertainty."""
    meshes = pd.concat(
        states(fineness=n).assign(torque_Nm=lambda rows, n=n: rows["torque_Nm"] * (1.0 + 0.1 / n**2))
        for n in (2, 3, 4)
    )
    found = limits_of(meshes, (2.0, 1.5), design="x")
    assert found["torque_Nm"].to_numpy() == pytest.approx(ROTATION, rel=1e-12)
    fine = 0.1 / 9 - 0.1 / 16
    by_order = fine * abs(1.0 / ((4 / 3) ** 2 - 1.0) - 1.0 / ((4 / 3) ** 1.5 - 1.0))
    assert found["uncertainty"].to_numpy() == pytest.approx(np.full(5, by_order), rel=1e-9)
