"""Sweeps of a case whose section is given by its sides, its material by name, its place by an orientation."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.sweep import batch
from studies.sweep.read import plan_of


@pytest.mark.slow
@pytest.mark.parametrize(
    ("vary", "together"),
    [
        ({"strip": {"thickness_m": [2e-4, 3e-4], "width_m": [0.008, 0.004]}}, True),
        ({"strip": {"slenderness": [80.0, 120.0]}}, True),
        ({"strip": {"orientation_deg": [0, 40]}}, True),
        ({"material": {"name": ["peek", "pla"]}}, False),
    ],
)
def test_sides_names_and_orientations_can_be_varied(vary, together):
    """Designs of varied sides, materials and orientations answer all at once as they do one by one."""
    content = {"case": "titanium_pivot", "vary": vary, "sample": {"method": "list"}}
    content["settings"] = {"control_points": 8}
    task = plan_of("sweep", content, Path()).task
    assert task.batch == together
    columns = {f"{section}.{key}": each for section, keys in vary.items() for key, each in keys.items()}
    found = [batch.solve_chunk(replace(task, batch=way), 0, columns).to_pandas() for way in {together, False}]
    assert all((each["status"] == "converged").all() for each in found)
    # kernels and single paths begin from other guesses: how often they iterate is no answer
    numbers = found[0].drop(columns="iterations").select_dtypes("number")
    assert np.allclose(found[-1][numbers.columns], numbers, rtol=1e-9, equal_nan=True)
