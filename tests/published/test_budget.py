"""The error budget: every bar is the largest difference of the two models that it names."""

import numpy as np
import pandas as pd
import pytest

from studies.published import solid_pivot
from studies.published.solids import COMPARED, STIFF, Design
from studies.record.store import Store
from tests.gates import hold

ROTATION = np.linspace(0.2, 1.0, 5)


def states(shift=0.0, **labels):
    """States of a model whose torque and place are further by a share that grows to `shift`."""
    share = 1.0 + shift * ROTATION
    values = {"torque_Nm": ROTATION * share, "com_x_m": ROTATION * share, "com_y_m": 0.0}
    return pd.DataFrame(labels | {"rotation_rad": ROTATION} | values)


def test_bars_are_the_largest_differences():
    """Torque is relative to the state, the trajectory to the chord of the solid's or beam's own path."""
    names = solid_pivot.DESIGNS["benchmark"].models
    shifts = {name: 0.01 * k for k, name in enumerate(names)} | {"beam": 0.0}
    models = [states(shift, model=name, design="benchmark") for name, shift in shifts.items()]
    laws = {"st-venant-kirchhoff": 0.0, "neo-hookean": -0.02}
    limits = [
        states(shift, law=law, design="benchmark").assign(uncertainty=1e-4, uncertainty_m=8e-5)
        for law, shift in laws.items()
    ]
    tables = {"models": pd.concat(models), "limits": pd.concat(limits)}
    rows = pd.DataFrame(solid_pivot.budget(tables)).set_index("source")
    reference = 1.0 + shifts[solid_pivot.BEAM] * ROTATION
    for source, (_, _, kind) in solid_pivot.SOURCES.items():
        apart = np.abs((1.0 + shifts[source] * ROTATION) / reference - 1.0).max()
        assert rows.loc[source, "error_torque"] == pytest.approx(apart, abs=1e-14)
        assert tuple(rows.loc[source, ["kind", "against"]]) == (kind, solid_pivot.BEAM)
    law = rows.loc["material law of solids"]
    assert law["error_torque"] == pytest.approx(0.02) and law["error_trajectory"] == pytest.approx(0.02 / 0.8)
    solid = rows.loc["solids (refinement)"]
    assert (solid["error_torque"], solid["error_trajectory"]) == pytest.approx((1e-4, 1e-4))


def test_limits_have_the_uncertainty_of_mesh_and_order():
    """Of meshes of second order the limit is exact, and the order 1.5 makes its uncertainty."""
    mesh = {"law": STIFF, "element": "serendipity"}
    meshes = pd.concat(
        states(fineness=n, **mesh).assign(torque_Nm=lambda rows, n=n: rows["torque_Nm"] * (1.0 + 0.1 / n**2))
        for n in (2, 3, 4)
    )
    (found,) = Design(orders=(2.0, 1.5)).limits(meshes)
    assert found["torque_Nm"].to_numpy() == pytest.approx(ROTATION, rel=1e-12)
    fine = 0.1 / 9 - 0.1 / 16
    by_order = fine * abs(1.0 / ((4 / 3) ** 2 - 1.0) - 1.0 / ((4 / 3) ** 1.5 - 1.0))
    assert found["uncertainty"].to_numpy() == pytest.approx(np.full(5, by_order), rel=1e-9)
    other = meshes.assign(element="lagrange", torque_Nm=1.01 * meshes["torque_Nm"])
    (found,) = Design(orders=(2.0, 1.5)).limits(pd.concat([meshes, other]))
    assert found["uncertainty"].to_numpy() == pytest.approx(np.full(5, max(0.01, by_order)), rel=1e-9)


def test_stored_solids_are_certain():
    """The committed torque of the benchmark pivot is certain from 9 degrees on, of both laws, from at least
    three meshes and both elements."""
    tables = Store().load_tables("model_form/solid_pivot")
    meshes, limits = tables["meshes"], tables["limits"]
    count = meshes[meshes["design"] == "benchmark"].groupby(["law", "element"])["fineness"].nunique()
    assert (count.xs("serendipity", level="element") >= 3).all() and count[STIFF, "lagrange"] >= 2

    def error(design="benchmark"):
        own = limits[(limits["design"] == design) & (limits["rotation_rad"] > COMPARED)]
        assert set(own["law"]) == {mesh[1] for mesh in solid_pivot.DESIGNS[design].meshes}
        return own["uncertainty"].max()

    hold("solid_uncertainty", error)
