"""Public functions and inputs have docstrings in the style of numpydoc, whose examples run."""

import doctest
import inspect
import re

import pytest

import fe_reference
import spline_model
import studies

FACADES = (spline_model, fe_reference, studies)
#: Classes that a user makes, beside those that functions return.
INPUTS = ("BodyDesign", "DrivenDisplacement", "DrivenRotation", "HeldPivot", "SolidStrip", "StripDesign")
FUNCTIONS = {
    f"{package.__name__}.{name}": getattr(package, name)
    for package in FACADES
    for name in sorted(package.__all__, key=lambda name: (name not in ("cross_axis_pivot", "plot"), name))
    if inspect.isfunction(getattr(package, name)) or name in INPUTS
}
#: Sections that each of them has.
SECTIONS = ("Parameters", "Examples")
#: Those without a refusal of their own, and those that rest on no publication.
NO_RAISES = ("spline_model.plate_factors", "spline_model.motion_penalty_stiffness")
NO_SOURCE = ("plot", "overlay", "BodyDesign", "StripDesign")


@pytest.mark.parametrize("name", FUNCTIONS)
def test_docstring_has_every_section_and_parameter(name):
    """Requirement: parameters, all of them, return value, errors, source and an example."""
    function = FUNCTIONS[name]
    text = inspect.getdoc(function)
    wanted = {*SECTIONS, *(["Raises"] if name not in NO_RAISES else [])}
    wanted |= {"References"} if name.partition(".")[2] not in NO_SOURCE else set()
    wanted |= {"Returns"} if inspect.isfunction(function) else set()
    assert wanted - set(re.findall(r"^(\w+)\n-+$", text, re.MULTILINE)) == set()
    listed = re.split(r"\n(?:Returns|Raises)\n", text.partition("Parameters\n----------\n")[2])[0]
    entries = ", ".join(re.findall(r"^([\w, ]+?)(?: : .*)?$", listed, re.MULTILINE)).split(", ")
    assert set(inspect.signature(function).parameters) - set(entries) == set()


@pytest.mark.parametrize("package", FACADES, ids=lambda package: package.__name__)
def test_examples_run(package):
    """Requirement: the examples of a package run in one session, that of the pivot first."""
    names = {name: getattr(package, name) for name in package.__all__}
    finder, runner = doctest.DocTestFinder(recurse=False), doctest.DocTestRunner()
    for name, function in FUNCTIONS.items():
        if name.startswith(f"{package.__name__}."):
            (example,) = finder.find(function, name, globs=names)
            example.globs = names
            assert runner.run(example, clear_globs=False).failed == 0, name
    assert runner.summarize(verbose=False).attempted >= 3
