"""Loads at points, supports, springs and hinges of the elements, in statics and in motion."""

from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy.special import ellipk

import fe_reference as fe
from tests.fe.scenes import TIP, tipped
from tests.gates import check, hold
from tests.models import refused, scene
from tests.table_one import SECTION

SPRING: dict[str, Any] = {"body": "mass", "stiffness": (1000.0, 2000.0), "rotational_stiffness": 0.5}


def on_springs(**given: Any) -> fe.Model:
    """Return a strip with a body at its tip, and a body on springs alone."""
    mass = fe.BodyDesign(name="mass", centre=(0.3, 0.1), mass=0.2, moment_of_inertia=1e-3)
    return tipped(TIP, mass, elements=3, **given)


@pytest.mark.parametrize("how", [{}, {"integrator": "generalised-alpha", "step": 2e-5}])
@pytest.mark.parametrize("damping", [0.0, 2.0])
def test_a_mass_on_a_spring(how: dict[str, Any], damping: float) -> None:
    """A released mass on a spring and a damper moves as an oscillator, in either scheme."""
    led = {"body": "mass", "displacement": (3e-3, None)}
    model = on_springs(spring=SPRING | {"damping": (damping, 0.0)}, driven_displacement=led)
    motion = fe.solve_motion(model, duration=0.045, samples=9, check=False, **how)
    check("fe_drive_books", motion.energy_error)

    def error(stiffness: float = 1000.0) -> float:
        rate, time = damping / 0.4, motion.time
        swift = np.sqrt(stiffness / 0.2 - rate**2)
        exact = np.exp(-rate * time) * (np.cos(swift * time) + rate / swift * np.sin(swift * time))
        return float(np.abs((motion.bodies["mass"][:, 0] - 0.3) / 3e-3 - exact).max())

    hold("fe_oscillator", error)


def pulled(centre: tuple[float, float], **force: Any) -> fe.Model:
    """Return a strip with a body at its tip that a force pulls sideways and along."""
    body = fe.BodyDesign(centre=centre, mass=0.1, moment_of_inertia=1e-4)
    return tipped(body, elements=8, applied_force={"force": (-30.0, 20.0), **force})


@pytest.mark.parametrize("follower", [False, True])
def test_a_force_at_a_point(follower: bool) -> None:
    """A force at a point of a body acts as at the centre of a body that has it there, and does work."""
    point = (0.13, 0.04)
    off, there = pulled((0.1, 0.0), at=point, follower=follower), pulled(point, follower=follower)
    path, same = fe.solve_statics(off), fe.solve_statics(there)
    assert np.abs(path.shape - same.shape).max() < 1e-12 * np.ptp(path.shape)
    assert np.abs(path.shape - fe.solve_statics(pulled((0.1, 0.0))).shape).max() > 1e-4
    assert path.work[-1] == pytest.approx(path.strain_energy[-1], rel=1e-8)
    assert same.work[-1] == pytest.approx(path.work[-1], rel=1e-8)
    turns = [1.0 / np.linalg.inv(each.body_stiffness()[-1])[2, 2] for each in (path, same)]
    driven = fe.solve_statics(off, rotation=float(path.rotation[-1]), increments=5)
    assert turns[0] == pytest.approx(turns[1], rel=1e-9)
    assert turns[0] == pytest.approx(driven.stiffness[-1], rel=1e-8)
    assert abs(driven.torque[-1]) < 1e-9 * abs(driven.torque).max()
    for how in ({}, {"integrator": "generalised-alpha", "step": 2e-6}):
        motion = fe.solve_motion(off, duration=2e-5, check=False, **how)
        assert motion.starts_still and np.ptp(motion.rotation) < 1e-9


def test_a_pinned_body_is_a_pendulum() -> None:
    """A force beside the centre of a pinned body swings it as a pendulum, of any amplitude and scheme."""
    pull = {"body": "mass", "force": (0.0, -50.0), "at": (0.3, 0.06)}
    pin, led = {"body": "mass", "fixed": ("x", "y")}, {"body": "mass", "angle": 2.0}
    small = on_springs(support=pin, applied_force=pull)
    rate = np.sqrt(50.0 * 0.04 / 1e-3)
    found = fe.natural_frequencies(small, rotation=None, count=1).frequency[0]
    assert 2.0 * np.pi * found == pytest.approx(rate, rel=1e-9)
    half = 2.0 * ellipk(np.sin(1.0) ** 2) / rate
    model = on_springs(support=pin, applied_force=pull, driven_rotation=led)
    for how in ({"step": 5e-6}, {"integrator": "generalised-alpha", "step": 5e-5}):

        def error(periods: float = 0.5, how: dict[str, Any] = how) -> float:
            motion = fe.solve_motion(model, duration=2.0 * periods * half, samples=5, check=False, **how)
            check("fe_drive_books", motion.energy_error)
            assert np.abs(motion.bodies["mass"][:, :2] - (0.3, 0.1)).max() == 0.0
            return float(abs(motion.bodies["mass"][-1, 2] / 2.0 + 1.0))

        hold("fe_pendulum", error)


def test_a_hinged_strip_is_a_pendulum() -> None:
    """A strip that hangs on a hinge swings as a rod, small and from the horizontal, in either scheme."""
    strip = fe.StripDesign(
        name="strip", start=(0.0, 0.0), end=(0.1, 0.0), tip=None, root_joint="hinge", **SECTION
    )

    def hung(*along: float) -> fe.Model:
        given = scene(("bending", "stretching", "strip_inertia"), gravity={"acceleration": along})
        return fe.compliant_mechanism(strips=[strip], elements=4, **given)

    rate = np.sqrt(1.5 * 9.81 / 0.1)
    found = fe.natural_frequencies(hung(9.81, 0.0), rotation=None, count=1).frequency[0]
    check("fe_hinges", abs(2.0 * np.pi * found / rate - 1.0))
    half = 2.0 * ellipk(0.5) / rate
    for how in ({}, {"integrator": "generalised-alpha", "step": 2e-4}):
        swing = fe.solve_motion(hung(0.0, -9.81), settled=False, duration=half, samples=4, check=False, **how)
        check("fe_pendulum", float(np.abs(swing.shape[-1, 0, -1] / 0.1 + (1.0, 0.0)).max()))
        check("fe_drive_books", swing.energy_error)


def test_hinges_leave_motions_free() -> None:
    """A motion that hinges leave free is held in statics and bears nothing; a load along it is refused."""
    ends = {"bar": ((0.0, 0.0), (0.0, 0.05)), "link": ((0.08, 0.0), (0.08, 0.05))}
    strips = [
        fe.StripDesign(
            name=name, start=a, end=b, tip="beam", root_joint="hinge", tip_joint="hinge", **SECTION
        )
        for name, (a, b) in ends.items()
    ]
    beam = fe.BodyDesign(name="beam", centre=(0.04, 0.05))

    def linkage(force: tuple[float, float]) -> fe.Model:
        given = scene(fe.DEFAULT_EFFECTS, applied_force={"force": force})
        return fe.compliant_mechanism(strips=strips, bodies=[beam], elements=2, **given)

    path = fe.solve_statics(linkage((0.0, 40.0)), increments=2)
    assert path.prescribed == () and path.axial_force[-1] == pytest.approx(20.0, rel=1e-9)
    refused(lambda: fe.solve_statics(linkage((1.0, 0.0))), "nothing holds body beam in the direction x")
    loose = partial(fe.StripDesign, name="loose", start=(0.0, 0.0), end=(0.1, 0.0), tip=None, **SECTION)
    refused(
        lambda: loose(tip_joint="hinge"), "tip_joint: got 'hinge', expected clamp at the free end of loose"
    )
    refused(lambda: loose(root_joint="weld"), "root_joint: got 'weld', expected one of clamp, hinge")
