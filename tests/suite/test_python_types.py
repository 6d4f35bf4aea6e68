"""Public names of both models, and wrong types at their functions: one line, as wrong values of a design."""

import ast
import math
import pickle
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fe_reference
import spline_model
from studies.answers.adapters import answer_release, answer_static
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.problem import named_case
from tests.table_one import SIX, TABLE_ONE

REFUSALS = (spline_model.InvalidParameter, fe_reference.InvalidParameter)
SPLINE = spline_model.cross_axis_pivot(**TABLE_ONE, control_points=4)
ELEMENTS = fe_reference.cross_axis_pivot(**TABLE_ONE, elements=2)


def pivot_of(package, **keywords):
    """Return the pivot of a package with these keywords."""
    return package.cross_axis_pivot(**keywords)


#: Function, what it is asked of, and keywords that it takes as they are.
CALLS = {
    "spline pivot": (pivot_of, spline_model, TABLE_ONE | {"control_points": 6, "gauss_points": 9}),
    "fe pivot": (pivot_of, fe_reference, TABLE_ONE | {"elements": 2}),
    "spline statics": (spline_model.solve_statics, SPLINE, {"rotation": 0.1, "increments": 1}),
    "spline mechanism": (spline_model.solve_statics, SPLINE, {"rotation": 0.1, "increments": 1}),
    "spline release": (spline_model.solve_motion, SPLINE, {"start": 0.1, "duration": 1e-4, "step": 1e-4}),
    "spline impulses": (spline_model.solve_impulses, SPLINE, {"start": 0.1, "duration": 1e-3, "step": 1e-4}),
    "spline modes": (spline_model.natural_frequencies, SPLINE, {"rotation": 0.1, "count": 1}),
    "fe statics": (fe_reference.solve_statics, ELEMENTS, {"rotation": 0.1, "increments": 1}),
    "fe mechanism": (fe_reference.solve_statics, ELEMENTS, {"rotation": 0.1, "increments": 1}),
    "fe release": (fe_reference.solve_motion, ELEMENTS, {"start": 0.1, "duration": 1e-4}),
    "fe modes": (fe_reference.natural_frequencies, ELEMENTS, {"rotation": 0.1, "count": 1}),
}
#: Calls that do not check the type of these parameters, or take NaN of them for none.
SECTION = ("area", "second_moment_of_area")
UNCHECKED = {"spline pivot": {*SECTION}}
#: Whole numbers, which may be of any size.
COUNTS = {"increments", "count", "control_points", "gauss_points", "elements"}
WRONG = {
    "infinite": math.inf,
    "text": "10",
    "texts": ["0.1"],
    "lists": [[0.1], [0.2, 0.3]],
    "nothing in it": [None],
    "empty": [],
    "truth": True,
    "complex": 1j,
    "table": {},
    "nan": math.nan,
    "too long": 10**400,
}


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", CALLS)
def test_wrong_types_are_one_line(name, wrong):
    """Whatever stands in place of a number is refused in one line that names the parameter."""
    solve, design, keywords = CALLS[name]
    for parameter in (
        keywords.keys() - UNCHECKED.get(name, set()) - (COUNTS if wrong == "too long" else set())
    ):
        with pytest.raises(REFUSALS) as refused:
            solve(design, **(keywords | {parameter: WRONG[wrong]}))
        line = str(refused.value)
        assert "\n" not in line
        assert line.startswith(f"{parameter}: got ")


#: Parameter -> what is beyond its range.
BEYOND = {
    "inclination": (0.0, 2.0),
    "crossing_ratio": (0.0, 1.0),
    "control_points": (3, 4.5),
    **dict.fromkeys(COUNTS - {"control_points"}, (0, 2.5)),
    **dict.fromkeys(("length", "area", "second_moment_of_area", "youngs_modulus", "density"), (0.0, -1.0)),
    **dict.fromkeys(("duration", "step", "accuracy"), (0.0, -1.0)),
    **dict.fromkeys(("body_mass", "body_moment_of_inertia"), (-1.0,)),
}


@pytest.mark.parametrize("name", CALLS)
def test_values_out_of_range_are_one_line(name):
    """A number beyond its range is refused in one line that names parameter, value and range."""
    solve, design, keywords = CALLS[name]
    for parameter in (set(keywords) | ({"accuracy"} if "increments" in keywords else set())) & BEYOND.keys():
        for value in BEYOND[parameter]:
            with pytest.raises(REFUSALS, match=rf"^{parameter}: got {value}, expected [^\n]*$"):
                solve(design, **(keywords | {parameter: value}))


#: Call -> its parameters that are one of several names.
CHOICES = {
    "spline pivot": ("measure", "stretch"),
    "fe pivot": ("element",),
    "spline statics": ("order", "method", "branch"),
    "spline mechanism": ("order", "control", "branch"),
    "spline release": ("integrator",),
    "spline impulses": ("form",),
    "fe release": ("integrator",),
    "fe modes": ("mass",),
}


@pytest.mark.parametrize("name", CHOICES)
def test_unknown_names_are_one_line(name):
    """A name that is none of those known is refused with all of them."""
    solve, design, keywords = CALLS[name]
    for parameter in CHOICES[name]:
        with pytest.raises(REFUSALS, match=rf"^{parameter}: got 'other', expected one of [^\n]*$"):
            solve(design, **(keywords | {parameter: "other"}))


@pytest.mark.parametrize("name", ["spline statics", "fe statics"])
@pytest.mark.parametrize(
    "legs", [[0.1, 0.05], (0.1,), np.array([0.1, 0.05]), np.float64(0.1), np.float32(0.1), 1]
)
def test_numbers_of_all_kinds_are_angles(name, legs):
    """A sequence or array of angles is a path of several legs, and numpy's numbers are numbers."""
    solve, design, keywords = CALLS[name]
    answer = solve(design, **(keywords | {"rotation": legs, "increments": 6}))
    assert answer.rotation[-1] == pytest.approx(float(np.ravel(legs)[-1]), rel=1e-12)


@pytest.mark.parametrize("package", [spline_model, fe_reference], ids=["spline", "fe"])
def test_refusals_pass_from_one_process_to_another(package):
    """A worker's refusal, or its path that stopped, is the same where it is raised again."""
    refused = package.InvalidParameter("length", -1.0, "a finite number > 0 [m]")
    stopped = package.ConvergenceError("stopped", solution=(1, 2), load_factor=0.5, history=((1.0,),))
    for error in (refused, stopped):
        again = pickle.loads(pickle.dumps(error))
        assert (str(again), vars(again)) == (str(error), vars(error))


def _of(package):
    """Every function of a package that takes a design, as calls of one argument."""
    yield lambda each: package.solve_statics(each, rotation=0.1)
    yield lambda each: package.solve_statics(each, rotation=0.1)
    yield lambda each: package.solve_motion(each, start=0.1, duration=1e-4)
    yield lambda each: package.solve_motion(each, start=0.1, duration=1e-4)
    yield lambda each: package.natural_frequencies(each)
    if package is spline_model:
        yield lambda each: package.solve_impulses(each)
    yield lambda each: package.strip_fields(each, np.zeros((1, 1)))


def _arrays(answer):
    """Name and array of all stored or computed arrays of an answer, except those computed at each access."""
    for name in (each for each in dir(answer) if not each.startswith("_")):
        value = getattr(answer, name, None)
        for array in value.values() if isinstance(value, dict) else (value,):
            if isinstance(array, np.ndarray) and getattr(answer, name) is value:
                yield name, array


@pytest.mark.parametrize("settings", [SplineSettings(), FeSettings(elements=4)], ids=["spline", "fe"])
def test_answers_are_read_only(settings):
    """No array of a path or a motion can be overwritten, of a model's own answer or of the studies'."""
    design = replace(named_case(), rotation=0.1, increments=2)
    path = answer_static(design, settings)
    motion = answer_release(design, settings, start=0.1, duration=1e-4)
    for answer in (path, path.solution, motion, motion.solution):
        found = dict(_arrays(answer))
        assert len(found) > 7
        assert [name for name, array in found.items() if array.flags.writeable] == []


@pytest.mark.parametrize("other", [3, None, "pivot", {}, "the other model's"], ids=str)
@pytest.mark.parametrize("package", [spline_model, fe_reference], ids=["spline", "fe"])
def test_what_is_no_mechanism_is_one_line(package, other):
    """A number, nothing, words, a table or the other model's design in place of a mechanism is refused."""
    design = (ELEMENTS if package is spline_model else SPLINE) if other == "the other model's" else other
    for call in _of(package):
        with pytest.raises(REFUSALS, match=r"^mechanism: got .*, expected what cross_axis_pivot or "):
            call(design)


@pytest.mark.parametrize(
    "given", [{"drive": 3.0}, {"drive": {"held": (0, 1)}}, {"check": "no"}, {"check": 1}]
)
@pytest.mark.parametrize("package", [spline_model, fe_reference], ids=["spline", "fe"])
def test_options_of_a_motion_are_of_their_kind(package, given):
    """A drive that is none and a check that is no truth value are refused in one line."""
    ((name, _),) = given.items()
    with pytest.raises(REFUSALS, match=f"^{name}: got .*, expected "):
        package.solve_motion(
            SPLINE if package is spline_model else ELEMENTS, start=0.1, duration=1e-4, **given
        )


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
    motion = spline_model.solve_motion(spline_model.cross_axis_pivot(**SIX), start=0.1, duration=1e-3)
    swung = fe_reference.solve_motion(
        fe_reference.cross_axis_pivot(**TABLE_ONE, elements=2), start=0.1, duration=1e-4
    )
    assert set(motion.to_frame()) <= set(swung.to_frame())
    assert len(repr(motion)) < 400
