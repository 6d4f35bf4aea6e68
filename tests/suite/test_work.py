"""The formulas of counted work are those of the code that is counted."""

import numpy as np
import pytest

from fe_reference.pivot import cross_axis_pivot as element_pivot
from spline_model.compile import compile_scene
from spline_model.fast.condense import condense, recover
from spline_model.fast.solve import grid_of, mode_count
from spline_model.fast.strip import Grid, Local, assemble_points, local_arrays
from spline_model.newton import Workspace
from spline_model.path import follow
from spline_model.pivot import cross_axis_pivot
from spline_model.sparse import LEAST_SIZE
from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from studies.work_precision import work
from tests.suite.counted import Counted
from tests.table_one import TABLE_ONE

counting = np.vectorize(Counted, otypes=[object])


def operations(call, *arguments):
    """Operations that a call does with counted numbers."""
    Counted.operations = 0
    call(*arguments)
    return Counted.operations


@pytest.mark.parametrize("n", [4, 5, 6, 9])
def test_operations_of_the_condensed_spline(n):
    """Assembly, condensation and recovery of a strip do as many operations as the formulas say."""
    design = cross_axis_pivot(**TABLE_ONE, control_points=n).mechanism.design
    grid, modes, own = grid_of(design), mode_count(design), 2 * n - 6
    local = Local(*(counting(array) for array in local_arrays(n, modes)))
    points = counting(np.column_stack((np.linspace(0.0, 1.0, n), 0.01 * np.sin(np.arange(n)))))
    compliance = counting(np.ones(modes))
    table = Grid(*(counting(array) for array in grid))
    done = operations(assemble_points.py_func, points, compliance, compliance, table, local)
    assert done == work.assembly_flops(len(grid.weight), n - 1, modes)

    local.h[:] = counting(10.0 * np.eye(own + 3) + 1.0)
    assert operations(condense.py_func, local, compliance, own) == work.condensation_flops(own, modes)
    change = (counting(np.zeros(k)) for k in (3, own, modes))
    assert operations(recover.py_func, local, compliance, own, *change) == work.recovery_flops(own, modes)


@pytest.mark.parametrize("elements", [1, 3])
def test_operations_of_an_element(elements):
    """Forces and tangent of an element do as many operations as the constants say."""
    law = element_pivot(**TABLE_ONE, elements=elements).structure.law
    moved = counting(1e-3 * np.random.default_rng(3).normal(size=(6, 2 * elements)))
    assert operations(law.forces, moved) == 2 * elements * work.ELEMENT_FORCES
    assert operations(law.tangents, moved) == 2 * elements * work.ELEMENT_TANGENT


@pytest.mark.parametrize(
    "settings",
    [
        SplineSettings(control_points=7),
        SplineSettings(control_points=7, basis="bspline"),
        FeSettings(elements=6),
    ],
    ids=str,
)
def test_sizes_are_those_of_the_models(settings):
    """Unknowns and points are those of the systems that the models solve."""
    found = work.work_of(settings, answer_static(named_case("cross_axis_pivot"), settings).counters)
    if isinstance(settings, FeSettings):
        structure = element_pivot(**TABLE_ONE, **settings.keywords()).structure
        assert (found.unknowns, found.points) == (structure.size - 1, 2 * settings.elements)
        return
    pivot = cross_axis_pivot(**TABLE_ONE, **settings.keywords())
    if settings.basis == "bezier":
        own, modes = 2 * 7 - 6, mode_count(pivot.mechanism.design)
        assert found.unknowns == 2 + 2 * (own + modes)
    else:
        system = compile_scene(pivot.driven(1.0))
        assert found.unknowns == system.layout.size
        assert found.points == len(system.tables.bending.weight)


@pytest.mark.parametrize("n", [24, 64])
def test_operations_of_the_sparse_factorisation(n):
    """The factors of a long B-spline hold what the constants say, within 3 %."""
    system = compile_scene(cross_axis_pivot(**TABLE_ONE, control_points=n, basis="bspline").driven(1.0))
    workspace, size = Workspace.of(system), system.layout.size
    workspace.evaluate(follow(system, [0.2]).states[-1], 0.2)
    factors = workspace.pattern.factorise(workspace.hessian)
    below, right = (np.diff(part.indptr) - 1 for part in (factors.L.tocsc(), factors.U.tocsr()))
    assert (below + 2 * below * right).sum() / size == pytest.approx(work.SPARSE_FLOPS, rel=0.03)
    assert (factors.L.nnz + factors.U.nnz) / size == pytest.approx(work.SPARSE_ENTRIES, rel=0.03)
    assert size >= work.SPARSE_FROM == LEAST_SIZE
