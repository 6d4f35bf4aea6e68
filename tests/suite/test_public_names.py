"""What the packages of both models show of themselves, and answers as tables."""

import ast
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fe_reference
import spline_model
from tests.table_one import SIX, TABLE_ONE


def test_spline_shows_its_public_names_and_nothing_else():
    """Requirement: every name of the package resolves to what its module defines, and types know the same."""
    assert sorted(dir(spline_model)) == sorted(spline_model.__all__)
    assert len(spline_model.__all__) <= 30
    for name in spline_model.__all__:
        found = getattr(spline_model, name)
        assert getattr(found, "__name__", name) == name
    tree = ast.parse(Path(spline_model.__file__).read_text(encoding="utf-8"))
    typed = [alias.name for node in tree.body if isinstance(node, ast.If) for line in node.body
             if isinstance(line, ast.ImportFrom) for alias in line.names]  # fmt: skip
    assert sorted(typed) == sorted(spline_model.__all__)
    with pytest.raises(AttributeError, match="public are"):
        spline_model.solve_everything  # noqa: B018


def test_package_loads_nothing_before_a_name_is_used():
    """Requirement: the package itself is imported without numpy or the compiler."""
    script = "import sys, spline_model; print({'numpy', 'numba'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_both_models_name_their_columns_alike():
    """Requirement: answers are tables with the same names where they mean the same, and fit on a line."""
    spline = spline_model.solve_statics(spline_model.cross_axis_pivot(**SIX), rotation=0.1, increments=2)
    elements = fe_reference.solve_statics(
        fe_reference.cross_axis_pivot(**TABLE_ONE, elements=4), rotation=0.1, increments=2
    )
    assert set(spline.to_frame()) - set(elements.to_frame()) == {"moment_defect"}
    assert np.array_equal(spline.to_frame()["rotation_rad"], spline.rotation)
    assert repr(spline).startswith("<StaticSolution converged, 3 rows, the last one: load_factor = 1,")
    assert len(repr(spline)) < 400
    motion = spline_model.solve_release(spline_model.cross_axis_pivot(**SIX), start=0.1, duration=1e-3)
    swung = fe_reference.solve_release(
        fe_reference.cross_axis_pivot(**TABLE_ONE, elements=2), start=0.1, duration=1e-4
    )
    assert set(motion.to_frame()) <= set(swung.to_frame())
    assert len(repr(motion)) < 400
