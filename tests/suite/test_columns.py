"""Tables to read: a design of any size prints its digits, units that say what is printed, and no noise."""

import math
import re

import pytest

from studies.commands.columns import angle, fixed, plain, quantity, significant, table

#: A pivot 1 mm long of silicon strips 20 um by 50 um, written over Table 1.
SMALL = (
    ("length_m = 0.08485281374238571", "length_m = 1e-3"),
    ("width_m = 0.01000320153681966", "width_m = 5e-5"),
    ("thickness_m = 0.0049983997439180475", "thickness_m = 2e-5"),
    ("mass_kg = 0.2", "mass_kg = 1e-7"),
    ("moment_of_inertia_kg_m2 = 0.002", "moment_of_inertia_kg_m2 = 1e-14"),
)
WORDS = {
    "solve": ["--rotation-deg", 5, "--increments", 2],
    "release": ["--rotation-deg", 5, "--duration", 1e-3, "--step", 1e-5],
    "modes": ["--count", 3],
}


@pytest.mark.parametrize("name", WORDS)
def test_small_designs_print_digits(name, case, command):
    """In every table of a pivot a millimetre long no column is zeros, and no number is zero with a sign."""
    lines = command(name, case(*SMALL), "--model", "spline", *WORDS[name]).out.splitlines()
    first = next(place for place, line in enumerate(lines) if re.fullmatch(r"[\s\-\d.e+]+", line))
    rows = [line.split() for line in lines[first:] if re.fullmatch(r"[\s\-\d.e+]+", line)]
    assert len(rows) >= 3
    if name == "solve":  # a second table stands below
        assert all(len(row) == len(rows[-1]) for row in rows[3:])
        rows = rows[:3]
    for column in zip(*rows, strict=True):
        assert any(float(cell) != 0.0 for cell in column)
        assert not [cell for cell in column if re.fullmatch(r"-0(\.0*)?", cell)]
    if name == "solve":
        units = ["deg", "um", "um", "nm", "uN", "m", "uN", "m/rad", "nJ", "MPa"]
        assert lines[first - 1].split() == units
        assert all(len(cell.replace(".", "").strip("-0")) >= 5 for cell in rows[-1][1:-1])


def test_units_say_what_is_printed():
    """The number in the heading's unit is the quantity; columns that belong together share a prefix."""
    torque, energy = quantity("N m", torque=[0.0, -1.5e-5, 2.5e-3], energy=[1e-3, 2e-3, 3e-3])
    assert (torque.unit, energy.unit) == ("mN m", "mN m")
    assert torque.cells == ("0.000000", "-0.015000", "2.500000")
    (stress,) = quantity("Pa", highest=6, digits=6, stress=[14806.12e6, 1e3])
    assert (stress.unit, stress.cells) == ("MPa", ("14806.1", "0.0"))
    (large,) = quantity("N m", torque=[18219.25])
    assert (large.unit, large.cells) == ("N m", ("18219.25",))
    assert angle([math.pi / 2, -1e-17]).cells == ("90.000", "0.000")


def test_noise_is_zero():
    """What is below the floor of the design is zero in all digits, and NaN a dash."""
    (energy,) = quantity("J", floor=1e-20, energy=[1.6e-29, -3e-25])
    assert (energy.unit, energy.cells) == ("J", ("0.0", "0.0"))
    assert (fixed(-1e-9, 4), fixed(math.nan, 4), significant(-0.0)) == ("0.0000", "-", "0")


def test_columns_are_flush_and_groups_stand_over_theirs():
    """Headings, units and rows end at the same places, and a group's name over the last of its columns."""
    places = [*quantity("m", group="crank", x=[1.0, 2.0], y=[0.5, -12.0]), angle([0.1, 0.2], group="crank")]
    lines = list(table([plain("load", ["0.5", "1.0"]), *places]))
    assert len({len(line) for line in lines}) == 1
    assert lines[0].endswith("| " + " " * (len(lines[0]) - lines[0].index("|") - 7) + "crank")
    assert all(line[lines[0].index("|")] == "|" for line in lines)


def test_a_mechanism_at_rest_prints_no_noise(command):
    """The energy of a guide that nothing loads is zero in the table, in every state."""
    from studies.cases.problem import FOLDER

    guide = FOLDER / "parallel_strip_guide.toml"
    out = command("solve", guide, "--model", "fe", "--effects=bending,stretching", "--increments", 2).out
    rows = [line.replace("|", " ").split() for line in out.splitlines()[5:8]]
    assert {row[1] for row in rows} == {"0.0"}
