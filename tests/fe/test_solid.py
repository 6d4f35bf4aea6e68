"""Solids of strips: derivatives, rigid motions, agreement of both elements, and the beam within them."""

import math

import numpy as np
import pytest

import fe_reference
from fe_reference import ConvergenceError, InvalidParameter, SolidStrip, solve_solids
from tests.gates import hold

LENGTH, WIDTH, THICKNESS, CROSSED = 0.08, 0.01, 2e-3, math.pi / 4
MATERIAL = {"youngs_modulus": 200e9, "poisson_ratio": 0.3}
ELEMENTS, LAWS = ("serendipity", "lagrange"), ("st-venant-kirchhoff", "neo-hookean")


def strip(**changed):
    """A strip of a coarse mesh."""
    sides = {"length": LENGTH, "width": WIDTH, "thickness": THICKNESS, "fineness": 1}
    return SolidStrip(**sides | MATERIAL | changed)


def pivot(rotations, **changed):
    """The path of a pivot whose strips cross in the middle."""
    x, y = LENGTH * math.cos(CROSSED), LENGTH * math.sin(CROSSED)
    ends = [((0.0, 0.0), (x, y)), ((x, 0.0), (0.0, y))]
    return solve_solids(strip(**changed), ends, np.radians(rotations), centre=(0.5 * x, y))


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", LAWS)
def test_stiffness_is_the_derivative_of_the_force(law, element):
    """The product with the stiffness is the central difference of the forces, far from rest."""
    made, random = strip(law=law, element=element), np.random.default_rng(1)
    u = 0.1 * THICKNESS * random.standard_normal(made.nodes.shape)
    way = THICKNESS * random.standard_normal((u.size, 1))
    step = 1e-5
    forces = [made.assembled(u + sign * step * way.reshape(-1, 3), way)[0] for sign in (1.0, -1.0)]
    product = made.assembled(u, way)[2][:, 0]
    assert (forces[0] - forces[1]) / (2.0 * step) == pytest.approx(product, abs=1e-6 * np.abs(product).max())


@pytest.mark.parametrize("law", LAWS)
def test_a_rigid_turn_needs_no_force(law):
    """Green's strain of a rigid turn is zero: forces are round-off of E A."""
    made = strip(law=law)
    x, y, _ = made.nodes.T
    u = np.column_stack([-x - y, x - y, 0.0 * x])
    force = made.assembled(u, np.zeros((u.size, 1)))[0]
    assert np.abs(force).max() < 1e-12 * made.youngs_modulus * WIDTH * THICKNESS


def test_both_elements_agree():
    """20 and 27 nodes find the same torque and place at 20 degrees; a gate has how far they are apart."""

    def error(fineness=2):
        paths = [pivot([2.0, 5.0, 12.0, 20.0], fineness=fineness, element=element) for element in ELEMENTS]
        apart = np.hypot(*(paths[0].centre - paths[1].centre)[-1]) / LENGTH
        return max(apart, abs(paths[0].torque[-1] / paths[1].torque[-1] - 1.0))

    hold("solid_elements", error)


def test_without_lateral_contraction_a_solid_is_a_beam_that_shears():
    """With Poisson's ratio 0 the torque is that of the shear-deformable beam: no clamp stiffens a strip."""
    section = {"width": WIDTH, "thickness": THICKNESS, **MATERIAL, "poisson_ratio": 0.0, "density": 1.0}
    body = {"body_mass": 1.0, "body_moment_of_inertia": 1.0}
    shape = {"length": LENGTH, "inclination": CROSSED, "crossing_ratio": 0.5}
    beams = fe_reference.cross_axis_pivot(**shape, **section, **body, element="reissner", elements=160)
    expected = fe_reference.solve_statics(beams, rotation=math.radians(9.0), increments=4).torque[-1]

    def error(poisson_ratio=0.0):
        path = pivot([2.0, 5.0, 9.0], poisson_ratio=poisson_ratio, fineness=2)
        return abs(path.torque[-1] / expected - 1.0)

    hold("solid_beam", error)


def test_supports_of_one_block_make_the_strip_longer():
    """Blocks of the material act as 0.416 t more length at each end (O'Donnell 1960), Poisson's ratio 0."""

    def error(fineness=2):
        rigid, blocks = (
            pivot([2.0], poisson_ratio=0.0, fineness=fineness, support=support).torque[-1]
            for support in (0.0, 2.0 * THICKNESS)
        )
        return abs(rigid / blocks - 1.0 - 2.0 * 0.416 * THICKNESS / LENGTH)

    hold("solid_support", error)


def test_a_rotation_may_occur_twice():
    """A repeated rotation has the same state again, and the states that follow are predicted without it."""
    torque = pivot([2.0, 2.0, 5.0, 5.0, 2.0]).torque
    assert torque[[1, 3, 4]] == pytest.approx(torque[[0, 2, 0]], rel=1e-9)
    with pytest.raises(InvalidParameter, match=r"^rotations: got nan, expected a finite number"):
        pivot([2.0, math.nan])


def test_a_step_that_is_too_long_is_an_error():
    """A quarter turn at once is no equilibrium, and the message names the rotation and the remedy."""
    with pytest.raises(ConvergenceError, match=r"^solids at 170 deg: .*; use smaller steps$"):
        pivot([170.0])
    with pytest.raises(InvalidParameter, match=r"^ends: got .*, expected strips of the length of the mesh"):
        solve_solids(strip(), [((0.0, 0.0), (1.0, 0.0))], [0.01], centre=(1.0, 0.0))
