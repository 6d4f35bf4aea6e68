"""Mechanisms that move freely, and parts of one whose sizes differ by orders, in both models."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

import fe_reference
import spline_model
from fe_reference import control as fe_control
from fe_reference.mechanism import StripDesign as ElementStrip
from fe_reference.model import Body
from spline_model import newton as spline_newton
from spline_model.compile import compile_scene
from spline_model.mechanism import BodyDesign, StripDesign, compliant_mechanism
from spline_model.reduced.elements import Elements
from spline_model.statics import solve_mechanism
from studies.__main__ import main

FINDS = Path(__file__).parent / "finds"
MODELS = ("spline", "fe")
SECTION = {"width": 0.003, "thickness": 0.0008, "density": 1400.0, "poisson_ratio": 0.0}
SHORT = (0.1, 2e-4, 0.1)


def chain(model, lengths=SHORT, moduli=(3.5e9,) * 3, **how):
    """A chain of three strips and bodies, the last led aside by a twentieth of its length."""
    x = np.concatenate([[0.0], np.cumsum(lengths)])
    strip, body, make = {
        "spline": (StripDesign, BodyDesign, compliant_mechanism),
        "fe": (ElementStrip, Body, fe_reference.compliant_mechanism),
    }[model]
    ends = [("ground", "b1"), ("b1", "b2"), ("b2", "b3")]
    strips = [
        strip(
            name=f"s{i}",
            start=(x[i], 0.0),
            end=(x[i + 1], 0.0),
            root=root,
            tip=tip,
            youngs_modulus=moduli[i],
            **SECTION,
        )
        for i, (root, tip) in enumerate(ends)
    ]
    bodies = [body(name=f"b{i}", centre=(x[i], 0.0)) for i in (1, 2, 3)]
    led = {"body": "b3", "displacement": (0.0, -0.05 * x[-1])}
    effects = ("bending", "stretching", "driven_displacement")
    return make(strips=strips, bodies=bodies, effects=effects, parameters={"driven_displacement": led}, **how)


def torque(model, **design):
    """The torque that holds the last body of a chain straight: of elements the limit of two meshes."""
    if model == "spline":
        mechanism = chain(model, control_points=12, **design)
        return solve_mechanism(mechanism, body="b3", rotation=0.0, increments=10).torque[-1]
    coarse, fine = (
        fe_reference.solve_mechanism(
            chain(model, elements=n, **design), body="b3", rotation=0.0, increments=10
        ).torque[-1]
        for n in (20, 40)
    )
    return (4.0 * fine - coarse) / 3.0


@pytest.mark.parametrize(
    "design",
    [
        {},
        {"lengths": (0.1, 0.1, 0.1)},
        {"lengths": (0.1, 1e-2, 0.1), "moduli": (3.5e9, 3.5e13, 3.5e9)},
        {"lengths": (0.1, 1e-2, 0.1), "moduli": (3.5e5, 3.5e9, 3.5e9)},
    ],
)
def test_lengths_and_stiffnesses_that_differ_by_orders(design):
    """Requirement: both models solve a chain with a short, a stiff or a soft strip, and agree to 1e-3."""
    assert torque("spline", **design) == pytest.approx(torque("fe", **design), rel=1e-3)


def test_a_short_strip_between_long_ones_hardly_matters():
    """Requirement: 1e-5 m between strips of 0.1 m is solved and tends to the chain without it."""
    shorter = [torque("spline", lengths=(0.1, length, 0.1)) for length in (1e-4, 1e-5)]
    assert shorter[0] == pytest.approx(shorter[1], rel=2e-3)


@pytest.mark.parametrize("moduli", [(3.5e9,) * 3, (3.5e5, 3.5e9, 3.5e9)])
def test_newton_corrects_a_state_that_is_off_by_a_millionth(moduli):
    """Requirement: a state off by 1e-6 of a length, in a soft part too, is not taken for equilibrium."""
    system = compile_scene(chain("spline", moduli=moduli, control_points=6).driven(0.0, "b3"))
    work = Elements.of(system)
    exact = spline_newton.solve(work, work.state(system.rest), 0.0).z
    off = exact.copy()
    off[1] += 1e-6  # the first body aside, in lengths
    found = spline_newton.solve(work, off, 0.0)
    assert not found.reason
    assert abs(found.z[1] - exact[1]) < 1e-9

    structure = fe_reference.structure.structure_of(chain("fe", moduli=moduli))
    span = fe_control.spans(structure, body=2, rotations=[0.0], displacement=(0.0, 0.0))[0]
    start = np.zeros(structure.size)
    start[structure.body_slice(0).start + 1] = 1e-6 * structure.length
    outcome = fe_control.equilibrate(span, start, 0.0, fe_reference.path.Counter())
    assert not outcome.failure
    assert np.abs(structure.measure * outcome.y).max() < 1e-9


def told(arguments, capsys):
    """Exit code, JSON and the lines of a command."""
    code = main(arguments)
    out, err = capsys.readouterr()
    return code, out, err


SIZES = {"spline": ("--control-points", "20"), "fe": ("--elements", "10")}


def test_modes_of_lengths_stiffnesses_and_masses_far_apart(capsys):
    """Requirement: 1e4 between them leaves both models' modes within 2e-3 (1e-3 of either is round-off)."""
    case = str(FINDS / "sizes_apart.toml")
    found = [
        json.loads(told(["modes", case, "--model", model, *size, "--json", "-"], capsys)[1])["frequency_Hz"]
        for model, size in SIZES.items()
    ]
    assert found[0][:4] == pytest.approx(found[1][:4], rel=2e-3)
    code, _, err = told(["modes", case, "--model", "fe", "--elements", "20"], capsys)
    assert code == 2
    assert len(err.splitlines()) == 1
    assert "round-off decides a frequency" in err


def test_a_motion_of_lengths_stiffnesses_and_masses_far_apart(capsys):
    """Requirement: the led body has travelled alike in both models, though light nodes start in round-off."""
    case = str(FINDS / "sizes_apart.toml")
    sizes = {
        "spline": ("--control-points", "11"),
        "fe": ("--elements", "20", "--integrator", "generalised-alpha"),
    }
    travelled = []
    for model, size in sizes.items():
        words = ["release", case, "--model", model, *size, "--step", "2e-4", "--duration", "0.1"]
        code, out, _ = told([*words, "--no-check", "--json", "-"], capsys)
        y = json.loads(out)["bodies"]["last"]["y_m"]
        assert code == 0
        travelled.append(y[-1] - y[0])
    assert travelled[0] == pytest.approx(travelled[1], rel=0.02)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("name", "rigid", "first"), [("hub_with_cable", 1, 1.6876), ("free_flight", 3, 28.27)]
)
def test_rigid_motions_have_the_frequency_zero(name, rigid, first, model, capsys):
    """Requirement: rigid motions are printed as such; the first elastic one agrees between the models."""
    case = str(FINDS / f"{name}.toml")
    size = ["--control-points", "10"] if model == "spline" else []
    code, out, _ = told(["modes", case, "--model", model, "--json", "-", *size], capsys)
    frequency = json.loads(out)["frequency_Hz"]
    assert code == 0
    assert frequency[:rigid] == [0.0] * rigid
    assert frequency[rigid] == pytest.approx(first, rel=1e-3)
    assert "rigid motions that nothing holds" in told(["modes", case, "--model", model, *size], capsys)[1]


@pytest.mark.parametrize("model", MODELS)
def test_the_slow_mode_of_a_stiff_pendulum(model, capsys):
    """Requirement: sqrt(g / L) / (2 pi) = 0.28555 Hz of a point mass on a stiff bar with modes of 1e7 Hz."""
    size = ["--control-points", "8"] if model == "spline" else []
    arguments = ["modes", str(FINDS / "pinned_pendulum.toml"), "--model", model, "--json", "-", *size]
    code, out, _ = told(arguments, capsys)
    assert code == 0
    exact = math.sqrt(9.8 / 3.0443) / (2.0 * math.pi)
    assert json.loads(out)["frequency_Hz"][0] == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("command", ["solve", "compare"])
@pytest.mark.parametrize(("name", "body"), [("hub_with_cable", "hub"), ("free_flight", "A")])
def test_a_load_that_nothing_holds_is_told_in_a_line(name, body, command, model, capsys):
    """Requirement: no equilibrium, no traceback: the body and the direction in one line, exit code 2."""
    beside = ["cross_axis_pivot"] if command == "compare" else []
    code, _, err = told([command, str(FINDS / f"{name}.toml"), *beside, "--model", model], capsys)
    lines = [line for line in err.splitlines() if line]
    assert code == 2
    assert len(lines) == 1
    assert f"nothing holds body {body}" in lines[0]


@pytest.mark.parametrize("model", MODELS)
def test_free_flight_keeps_its_momentum(model, capsys):
    """Requirement: the centre of mass moves by the impulse of the force, (1, 2) N as a triangle of 20 ms."""
    arguments = ["release", str(FINDS / "free_flight.toml"), "--model", model, "--duration", "0.03"]
    code, out, _ = told([*arguments, "--no-check", "--json", "-"], capsys)
    answer = json.loads(out)
    assert code == 0
    masses, rest = {"A": 0.02, "B": 0.05}, {"A": (-0.01, 0.003), "B": (0.11, 0.0)}
    strip = 4430.0 * 0.01 * 0.0005 * 0.1027  # titanium, an arc; it moves about as the mean of its ends
    total = sum(masses.values()) + strip
    weight = {name: mass + 0.5 * strip for name, mass in masses.items()}
    for axis, force in ((0, 1.0), (1, 2.0)):
        key = ("x_m", "y_m")[axis]
        moved = sum(weight[name] * (answer["bodies"][name][key][-1] - rest[name][axis]) for name in masses)
        # int of the velocity: impulse 0.01 F reached at 0.02 s, 0.01 s at full speed after it
        exact = force * (0.01 * 0.01 + 0.01 * 0.01) / total
        assert moved / total == pytest.approx(exact, rel=0.03)


def test_pendulum_period():
    """Requirement: a point mass on a stiff bar from the horizontal swings in 4.1335 s, 1.18034 times 2 pi
    sqrt(L / g) (elliptic integral)."""
    side = 0.31622776601683794
    mechanism = compliant_mechanism(
        strips=[
            StripDesign(
                name="bar",
                start=(0.0, 0.0),
                end=(0.0, -3.0443),
                root="pin",
                tip="mass",
                width=side,
                thickness=side,
                youngs_modulus=1e9,
                density=1e-2,
            )
        ],
        bodies=[
            BodyDesign(name="pin", centre=(0, 0)),
            BodyDesign(name="mass", centre=(0, -3.0443), mass=10.0),
        ],
        effects=("bending", "stretching", "strip_inertia", "body_inertia", "gravity", "driven_displacement"),
        parameters={
            "gravity": {"acceleration": (0.0, -9.8)},
            "driven_displacement": {"body": "pin", "displacement": (0, 0), "history": ((0, 1), (1, 1))},
        },
        control_points=6,
    )
    motion = spline_model.dynamics.solve_motion(
        mechanism, start=math.pi / 2, body="mass", duration=1.1, step=2e-3, check=False
    )
    x = motion.bodies["mass"][:, 0]
    at = int(np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))[0])
    quarter = motion.time[at] + (motion.time[at + 1] - motion.time[at]) * x[at] / (x[at] - x[at + 1])
    assert 4.0 * quarter == pytest.approx(4.1335, rel=1e-3)


@pytest.mark.parametrize("model", MODELS)
def test_what_nothing_holds_falls(model, tmp_path, capsys):
    """Requirement: two bodies on a strip, held until their release, fall by g t^2 / 2 in the mean."""
    case = tmp_path / "falling.toml"
    text = (FINDS / "free_flight.toml").read_text().split("[scene]")[0]
    case.write_text(text + '[scene]\neffects = ["+gravity"]\n')
    arguments = ["release", str(case), "--model", model, "--duration", "0.1", "--no-check", "--json", "-"]
    code, out, _ = told(arguments, capsys)
    answer = json.loads(out)
    assert code == 0
    assert answer["bodies"]["A"]["y_m"][0] == pytest.approx(0.003, abs=1e-12)
    gained = np.array(answer["kinetic_J"]) + np.array(answer["strain_J"]) + np.array(answer["gravity_J"])
    assert np.ptp(gained) < 1e-4 * max(answer["kinetic_J"])
    strip = 4430.0 * 0.01 * 0.0005 * 0.1027
    masses = {"A": 0.02 + 0.5 * strip, "B": 0.05 + 0.5 * strip}
    fallen = sum(
        mass * (answer["bodies"][name]["y_m"][-1] - answer["bodies"][name]["y_m"][0])
        for name, mass in masses.items()
    ) / sum(masses.values())
    assert fallen == pytest.approx(-0.5 * 9.80665 * 0.01, rel=0.01)
