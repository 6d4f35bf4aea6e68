"""Former names of commands, options, settings and keywords: accepted for one version, with a warning."""

import re

import pytest

import spline_model
from spline_model import cross_axis_pivot, solve_impulses
from studies.interactive.input import EVENTS, checked
from tests.table_one import TABLE_ONE

SOLVE = "solve silicon_pivot --control-points 5 --rotation-deg 5"
#: Arguments with a former name, and the same arguments with the present name.
COMMANDS = {
    "capacity silicon_pivot": "critical-load silicon_pivot",
    f"{SOLVE} --slide-stiffness 20": f"{SOLVE} --penalty-stiffness 20",
    f"{SOLVE} --slide-stiffness=20": f"{SOLVE} --penalty-stiffness=20",
    f"{SOLVE} --stretch=consistent --measure printed": f"{SOLVE} --stretch=consistent --measure published",
}


@pytest.mark.parametrize("former", COMMANDS)
def test_former_words_of_a_command_are_accepted(former, command):
    """Requirement: the former word gives the same output, and a warning with the present word."""
    old, new = command(*former.split()), command(*COMMANDS[former].split())
    assert (old.code, _untimed(old.out)) == (new.code, _untimed(new.out))
    assert (new.code, new.err) == (0, "")
    assert re.fullmatch(r"studies: warning: (\S+) is now called \S+; version 0.3 ends \1\n", old.err)


def _untimed(text):
    """Return the output without the time of the solver."""
    return re.sub(r"in [\d.e+]+ ms", "", text)


def test_former_keywords_of_python_are_accepted():
    """Requirement: the former keyword, value and function give the same model, with a FutureWarning."""
    new = cross_axis_pivot(**TABLE_ONE, control_points=5, penalty_stiffness=20.0, axial_modes=3)
    with pytest.warns(FutureWarning, match="penalty_stiffness"):
        old = cross_axis_pivot(**TABLE_ONE, control_points=5, slide_stiffness=20.0, axial_modes=3)
    assert old.design.discretisation == new.design.discretisation
    with pytest.warns(FutureWarning, match="published"):
        old = cross_axis_pivot(**TABLE_ONE, control_points=5, measure="printed", stretch="consistent")
    assert old.design.discretisation.measure == "published"
    with pytest.warns(FutureWarning, match="published"):
        run = solve_impulses(new, form="printed", duration=1e-6, step=1e-6)
    assert run.settings["integrator"] == "sequential impulses, published"
    with pytest.warns(FutureWarning, match="motion_penalty_stiffness"):
        assert spline_model.swinging_slide_stiffness is spline_model.motion_penalty_stiffness


def test_session_files_with_a_former_solver_are_read():
    """Requirement: an event of a former session file chooses the solver by its present name."""
    event = checked({"do": "solver", "name": "printed"}, EVENTS["solver"])
    assert event["name"] == "published"
