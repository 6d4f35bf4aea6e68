"""Statics of strips and mechanisms: closed forms, balance, stiffness, watched paths; limits over meshes."""

import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_reference as fe
from studies.answers.models import put
from studies.answers.settings import FeSettings
from studies.commands.arguments import read_design
from tests.fe.scenes import GUIDE, PARAMETERS, SIDED, TIP, WIDE, four_bar, free_cantilever, pivot, tipped
from tests.frames import heavy
from tests.gates import hold
from tests.models import QUICK_ELEMENTS, extrapolated, scene
from tests.table_one import BARE, EI, MOMENT, THINNER

STATIC = {
    name: PARAMETERS[name] for name in ("gravity", "applied_force", "applied_moment", "pre_strain", "spring")
}


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_natural_curvature_gives_a_stress_free_arc(element: str) -> None:
    """A strip with natural curvature and strain lies on the arc of that radius, without energy."""
    curvature, strain = 0.75 * np.pi / GUIDE, 0.02
    given = {"pre_strain": {"curvature": curvature, "strain": strain}}
    radius = (1.0 + strain) / curvature
    angle = curvature * GUIDE

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        runs = [
            fe.solve_statics(free_cantilever(parameters=given, elements=n, element=element)) for n in elements
        ]
        exact = radius * np.array([np.sin(angle), 1.0 - np.cos(angle)])
        return float(np.abs(extrapolated([run.shape[-1, 0, -1] for run in runs]) - exact).max() / GUIDE)

    hold("fe_natural_arc", error)
    roots: dict[str, Any] = {"root_compliance": {"root": 3.0}}  # which nothing turns without a moment
    answer, soft = (
        fe.solve_statics(free_cantilever(parameters=given | more, element=element, section=WIDE))
        for more in ({}, roots)
    )
    assert np.abs(soft.shape[-1] - answer.shape[-1]).max() < 1e-12 * GUIDE
    assert abs(answer.strain_energy).max() < 1e-12 * EI * curvature * angle
    assert answer.counters["settling_increments"] == 20


def all_static(**discretisation: Any) -> Any:
    return four_bar(STATIC, rise=0.002, **discretisation)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_static_balance(element: str) -> None:
    """Work of drives and loads is the change of strain and gravity energy along the whole path."""

    def error(increments: int = 60) -> float:
        answer = fe.solve_statics(
            all_static(element=element, elements=8), body="crank", rotation=0.6, increments=increments
        )
        stored = answer.strain_energy + answer.spring_energy + answer.gravity_energy
        return float(np.abs(answer.work - (stored - stored[0])).max() / np.abs(answer.work).max())

    hold(f"fe_static_balance_{element}", error)


#: Few elements, and strips so heavy that the half of one that hangs beside the centre turns the body.
HEAVY = {"density": 2e6, "body_mass": 0.0, "centre_offset": (0.03, 0.05)}


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_stiffness_of_a_turn_has_the_weight_that_hangs_on_it(element: str) -> None:
    """Stiffness is the difference quotient of torques where half-elements of heavy strips hang on a body."""
    weight = scene(("bending", "stretching"), gravity={"acceleration": (0.0, -9.81)})
    model = pivot(**HEAVY, **weight, elements=2, element=element)
    stiffness = fe.solve_statics(model, rotation=0.5, increments=4).stiffness[-1]

    def error(step: float = 1e-3) -> float:
        ends = [
            fe.solve_statics(model, rotation=angle, increments=4).torque[-1]
            for angle in (0.5 + step, 0.5 - step)
        ]
        return abs(stiffness - (ends[0] - ends[1]) / (2.0 * step)) / MOMENT

    hold("fe_weight_stiffness", error)


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_stiffness_does_not_depend_on_the_order(element: str) -> None:
    """Whichever strip comes first, stiffness is the same: round-off of EA is not in it, however slender."""
    given = pivot(crossing_ratio=0.35, element=element)
    model = replace(given, strips=tuple(replace(strip, **THINNER) for strip in given.strips))
    turned = replace(model, strips=model.strips[::-1])
    one, other = (fe.solve_statics(each, rotation=0.5, increments=4).stiffness for each in (model, turned))
    assert one[1:] == pytest.approx(other[1:], rel=1e-12)


LENGTH, DEPTH, WIDTH, YOUNGS_MODULUS, POISSON_RATIO, FORCE = 0.05, 0.01, 0.008, 2e9, 0.3, 1e-3


def test_shear_of_a_stubby_cantilever_is_timoshenkos() -> None:
    """F L^3 / 3 EI + F L / (5/6 G A): the factor of a rectangle, of which the shear is 3 % here.

    Timoshenko and Gere, Mechanics of Materials (1972), section 7.
    """
    bending = FORCE * LENGTH**3 / (YOUNGS_MODULUS * WIDTH * DEPTH**3 / 4.0)
    shear_modulus = YOUNGS_MODULUS / (2.0 * (1.0 + POISSON_RATIO))
    exact = bending + FORCE * LENGTH / (5.0 / 6.0 * shear_modulus * WIDTH * DEPTH)
    assert 0.02 < 1.0 - bending / exact < 0.05

    section = {"width": WIDTH, "thickness": DEPTH, "density": 1.0}
    section |= {"youngs_modulus": YOUNGS_MODULUS, "poisson_ratio": POISSON_RATIO}
    load = {"tip_force": {"strip": "strip", "force": (0.0, FORCE)}}  # so small that it is linear
    how: dict[str, Any] = {"length": LENGTH, "section": section, "parameters": load, "element": "reissner"}

    def error(elements: tuple[int, ...] = (4, 8, 16)) -> float:
        paths = [fe.solve_statics(free_cantilever(**how, elements=n), increments=1) for n in elements]
        return abs(float(extrapolated([path.shape[-1, 0, -1, 1] for path in paths])) / exact - 1.0)

    hold("fe_timoshenko_tip", error)


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_elements_that_turn_by_half_a_turn_are_refused(element: str) -> None:
    """Two elements rolled by 1.2 turns stop where each is bent by half a turn, and tell why; four go on."""
    coarse, fine = (
        tipped(TIP, elements=n, element=element, applied_moment={"moment": 2.4 * np.pi * EI / GUIDE})
        for n in (2, 4)
    )
    answer = fe.solve_statics(coarse, increments=12, check=False, raise_on_failure=False)
    assert answer.status is fe.Status.NOT_CONVERGED
    assert "an element is folded" in answer.message
    assert 0.9 < answer.rotation[-1] / (2.0 * np.pi) <= 1.0
    assert fe.solve_statics(fine, increments=12).rotation[-1] == pytest.approx(2.4 * np.pi)


EVERY: dict[str, dict[str, Any]] = {**SIDED, "root_compliance": {"root": "monolithic"}}


def wide_pivot() -> dict[str, Any]:
    """Return a pivot of thin strips a third as wide as long, with all effects of their sides."""
    sides = {"width": 0.03, "thickness": 5e-4, "effects": (*fe.DEFAULT_EFFECTS, *EVERY)}
    return BARE | sides | {"parameters": {"root_compliance": EVERY["root_compliance"]}}


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_curvature_is_the_slope_of_the_rotation(element: str) -> None:
    """With all effects of the sides the curvatures at the nodes add up to the turns between them."""

    def error(elements: int = 320) -> float:
        model = fe.cross_axis_pivot(**wide_pivot(), elements=elements, element=element)
        fields = fe.strip_fields(model, fe.solve_statics(model, rotation=1.0, increments=5).states[-1:])
        steps = np.diff(fields.arc_length)
        means = 0.5 * (fields.curvature[..., 1:] + fields.curvature[..., :-1])
        gaps = np.cumsum(means * steps, axis=-1) - (fields.rotation[..., 1:] - fields.rotation[..., :1])
        return float(np.abs(gaps).max())

    hold("fe_curvature_of_sides", error)


def pressed(force: float = 20e3, elements: int = 20) -> fe.Model:
    """Return a pivot of steel strips, 300 x 50 x 3 mm at 60 deg, crossing in the middle, pressed down."""
    sides = {"length": 0.3, "inclination": np.pi / 3.0, "width": 50e-3, "thickness": 3e-3}
    loaded = scene(fe.DEFAULT_EFFECTS, applied_force={"force": (0.0, -force)})
    return fe.cross_axis_pivot(**BARE | sides | loaded, elements=elements)


#: Load at which the clamped strips of the pressed pivot buckle [N].
STRIPS_BUCKLE = 4.0 * np.pi**2 * 206e9 * 50e-3 * 3e-3**3 / 12.0 / 0.3**2 * 2.0 * np.sin(np.pi / 3.0)


def test_a_hanging_column_does_not_gain_whole_turns() -> None:
    """At twelve times Euler's load the body hangs in one place for any increments, turned by under pi."""
    hanging = heavy(fe, 30.0, elements=10)
    places = [fe.solve_statics(hanging, increments=k).bodies["tip"][-1] for k in (3, 10)]
    assert np.allclose(*places, rtol=1e-8, atol=1e-12)
    assert -np.pi < places[0][2] < -0.9 * np.pi


def test_strips_of_a_pressed_pivot_buckle_where_euler_says() -> None:
    """With its rotation held the pivot's strips buckle at 2 sin 60 deg times the load of one of them."""

    def error(elements: tuple[int, ...] = (10, 20, 40)) -> float:
        found = []
        for count in elements:
            path = fe.solve_statics(pressed(elements=count), rotation=0.0, increments=4, check=False)
            _, strips = path.critical_points
            found.append(20e3 * strips.load_factor)
        return float(abs(extrapolated(found) / STRIPS_BUCKLE - 1.0))

    hold("fe_pressed_pivot", error)


def test_a_bifurcation_is_where_it_is_for_any_increments() -> None:
    """It is placed by the eigenvalue that vanishes there, not by the increment that passes it."""
    paths = [
        fe.solve_statics(pressed(elements=8), rotation=0.0, increments=k, check=False).critical_points
        for k in (3, 4)
    ]
    assert [point.kind for point in paths[0]] == ["limit point", "bifurcation"]
    assert paths[0][1].load_factor == pytest.approx(paths[1][1].load_factor, rel=1e-9)


@pytest.mark.parametrize("aside", [1e-10, 1e-9])
def test_a_column_that_is_hardly_pushed_aside_bifurcates(aside: float) -> None:
    """Requirement: a path that cannot follow an imperfection around the Euler load ends in a bifurcation."""
    length, load = 0.1, 10.0
    column = {"start": (0.0, 0.0), "end": (length, 0.0), "tip": "body", "width": 0.01, "thickness": 5e-4}
    metal = {"youngs_modulus": 206e9, "poisson_ratio": 0.3, "density": 7850.0}
    strip, push = fe.StripDesign(name="column", **column, **metal), {"force": (-load, aside * load)}
    model = fe.compliant_mechanism(
        strips=[strip],
        bodies=[fe.BodyDesign(centre=(length, 0.0))],
        effects=("bending", "stretching", "applied_force"),
        parameters={"applied_force": push},
    )
    answer = fe.solve_statics(model, increments=10, raise_on_failure=False)
    (point,) = answer.critical_points
    euler = np.pi**2 * strip.flexural_rigidity / (4.0 * length**2)
    assert (point.kind, point.inertia) == ("bifurcation", 1)
    assert euler < point.load_factor * load < 1.01 * euler


def test_a_pressed_pivot_says_what_buckles() -> None:
    """A free pivot tips first and its strips buckle later."""
    answer = fe.solve_statics(pressed(elements=8), increments=4, check=False)
    tips, strips = answer.critical_points
    assert tips.inertia == 1
    assert strips.inertia == answer.inertia[-1] > 1
    assert re.search(r"give way with the body at 2\.\d+ kN, load factor 0\.1", answer.message)
    assert re.search(r"the strips buckle at 1[78]\.\d+ kN, load factor 0\.9", answer.message)
    assert "the last state is unstable" in answer.message


def test_a_pressed_pivot_that_turns_stops_where_it_buckles() -> None:
    """Turned by a hundredth of a degree the pivot has no equilibrium beyond a load just below Euler's."""
    turned = {"rotation": np.radians(0.01), "order": "together", "increments": 4, "raise_on_failure": False}
    answer = fe.solve_statics(pressed(elements=8), **turned)
    assert answer.status.value == "not_converged"
    assert not answer.inertia.any()
    straight = (
        fe.solve_statics(pressed(elements=8), rotation=0.0, increments=4).critical_points[1].load_factor
    )
    (limit,) = (point for point in answer.critical_points if point.kind == "turning point")
    assert 0.99 * straight < limit.load_factor < straight
    assert limit.inertia == 1
    assert re.search(
        r"turning point: the strips buckle at 1\d\.\d+ kN, rotation 0\.009\d+ deg, ", answer.message
    )


def test_a_driven_body_without_stiffness_would_tip_over() -> None:
    """Where the stiffness of a driven turn at fixed loads vanishes is a limit point, and in words."""
    how = {"rotation": np.radians(1.0), "increments": 20, "order": "together"}
    answer = fe.solve_statics(pressed(force=8e3, elements=8), **how)
    (point,) = answer.critical_points
    assert (point.kind, point.inertia) == ("limit point", 0)

    def error(elements: int = 8) -> float:
        path = fe.solve_statics(pressed(force=8e3, elements=elements), **how)
        zero = np.interp(0.0, -path.stiffness, path.load_factor)
        return abs(point.load_factor - float(zero))

    hold("fe_tipping", error)
    assert point.rotation == pytest.approx(point.load_factor * np.radians(1.0))
    assert re.match(
        r"limit point: .* released, it tips over at 2\.08\d kN, rotation 0\.26\d+ deg", answer.message
    )


def test_a_stationary_torque_without_loads_is_nothing_to_warn_of() -> None:
    """The torque of Table 1 has a limit before 320 deg, and the message is empty."""
    answer = fe.solve_statics(pivot(elements=10), rotation=np.radians(320), increments=40)
    (point,) = answer.critical_points
    assert (point.kind, point.inertia, answer.message) == ("limit point", 0, "")
    most = int(np.abs(answer.torque).argmax())
    assert abs(point.rotation - answer.rotation[most]) < np.radians(320) / 40


def apart(found: Any, exact: Any, name: str) -> float:
    """Return the largest difference of a quantity, in parts of its largest value."""
    one, two = (np.asarray(getattr(each, name)) for each in (found, exact))
    return float(np.abs(one - two).max() / np.abs(two).max())


@pytest.mark.parametrize("element", fe.ELEMENTS)
def test_the_limit_of_a_path_is_within_its_estimate(element: str) -> None:
    """Torque, stiffness, energy and largest stress err by less than estimated, which is what was asked."""
    coarse, exact = (
        fe.solve_statics(pivot(elements=4, element=element), rotation=1.0, increments=5, accuracy=accuracy)
        for accuracy in (1e-3, 1e-7)
    )
    assert coarse.estimate is not None and exact.estimate is not None
    assert coarse.estimate.largest <= coarse.estimate.accuracy
    assert exact.estimate.meshes[: len(coarse.estimate.meshes)] == coarse.estimate.meshes
    for name in ("torque", "stiffness", "strain_energy", "largest_stress"):
        assert 0.0 < apart(coarse, exact, name) < coarse.estimate.errors[name]
    assert coarse.shape.shape == exact.shape.shape == (6, 2, 5, 2)
    assert apart(coarse, exact, "bending_moment") < coarse.estimate.largest
    assert coarse.stations == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0], rel=1e-14)


def test_frequencies_have_a_limit() -> None:
    """The first frequencies about a bent state err by less than estimated."""
    coarse, exact = (
        fe.natural_frequencies(pivot(elements=6), rotation=0.5, count=3, accuracy=accuracy)
        for accuracy in (1e-3, 1e-7)
    )
    assert coarse.estimate is not None
    errors = np.abs(coarse.frequency / exact.frequency - 1.0)
    assert np.all(errors < list(coarse.estimate.errors.values()))
    with pytest.raises(fe.ConvergenceError, match=r"accuracy 1e-14 is not reached with up to \d+ elements"):
        fe.natural_frequencies(pivot(elements=6), rotation=0.5, count=3, accuracy=1e-14)


def test_an_accuracy_out_of_reach_is_told() -> None:
    """What round-off does not let reach is the best answer with its estimate, and not converged."""
    asked = {"rotation": 0.5, "increments": 2, "accuracy": 1e-13}
    best = fe.solve_statics(pivot(elements=4), raise_on_failure=False, **asked)
    assert best.status.value == "not_converged"
    assert "ask for no less" in best.message
    assert best.estimate is not None and best.estimate.largest > best.estimate.accuracy
    with pytest.raises(fe.ConvergenceError, match="is not reached"):
        fe.solve_statics(pivot(elements=4), **asked)
    pressed = pivot(elements=2, **scene(fe.DEFAULT_EFFECTS, applied_force={"force": (0.0, -1e6)}))
    stopped = fe.solve_statics(pressed, accuracy=1e-3, raise_on_failure=False)
    assert stopped.status.value == "not_converged" and stopped.estimate is None


@pytest.mark.slow
def test_a_mesh_that_round_off_stops_leaves_the_coarser_ones_their_answer() -> None:
    """A chain of strips of 100, 0.2 and 100 mm: 160 elements stop at rest, with 41 bifurcations that are
    round-off, and were the answer. 20, 40 and 80 elements agree within 1.2e-4."""
    design = read_design(str(Path(__file__).parents[1] / "suite" / "finds" / "mixed_lengths.toml"))
    asked = put(design, FeSettings(elements=20))
    path = asked.static_path(raise_on_failure=False, accuracy=1e-5)
    assert path.estimate is not None and path.estimate.meshes == (20, 40, 80)
    assert not path.critical_points and path.load_factor[-1] == 1.0
    assert path.status.value == "not_converged"
    assert "round-off stops 160 elements; ask for no less" in path.message
    assert path.estimate.largest > 1e-5


QUANTITIES = {"torque": "torque", "trajectory": "centre", "stiffness": "stiffness"}


@cache
def path(element: str, elements: int) -> fe.StaticSolution:
    return fe.solve_statics(pivot(element=element, elements=elements), rotation=np.pi / 2.0, increments=10)


def deviation(value: np.ndarray, exact: np.ndarray) -> float:
    """Return the largest deviation over the path, over the largest change of the quantity on it."""
    moved = exact - exact[0] if exact.ndim > 1 else exact
    gap, size = (np.linalg.norm(each.reshape(len(exact), -1), axis=1) for each in (value - exact, moved))
    return float(gap.max() / size.max())


@pytest.mark.parametrize("element", fe.ELEMENTS)
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_level_of_twenty_elements(element: str, quantity: str) -> None:
    """Twenty elements are as near to the extrapolated value as stated."""

    def pick(elements: int) -> np.ndarray:
        return np.asarray(getattr(path(element, elements), QUANTITIES[quantity]))

    def error(elements: int = 20) -> float:
        return deviation(pick(elements), extrapolated([pick(n) for n in (40, 80, 160)]))

    hold(f"fe_level_{quantity}_{element}", error)
