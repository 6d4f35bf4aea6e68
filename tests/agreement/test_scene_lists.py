"""Lists of loads, supports and drives on one mechanism, joints, and what has to act on it from outside."""

import math

import numpy as np
import pytest

import fe_reference
import spline_model as spline
from tests import gates
from tests.closed_forms import followed
from tests.models import BOTH, held, refined, short

#: A strip of unit length and rigidity, which the elements stretch a little, and the splines not at all.
STRIP = {"start": (0.0, 0.0), "end": (1.0, 0.0), "area": 1e3, "second_moment_of_area": 1.0}
STRIP |= {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "density": 1e-3}
AXIAL = {spline: "inextensible", fe_reference: "stretching"}
#: The same, hardly stretched by elements either.
STIFF = {"area": 1e8, "density": 1e-8}


def beam(tip=None, models=spline, own=None, more=(), grid=None, **parameters):
    """A strip from the ground to a body, or to nothing, with these effects beside its elasticity."""
    names = ("bending", AXIAL[models], "strip_inertia", "body_inertia", *parameters)
    bodies = [models.BodyDesign(name=tip, centre=(1.0, 0.0), mass=1.0, moment_of_inertia=1.0)] if tip else []
    strip = models.StripDesign(name="beam", tip=tip, **STRIP | (own or {}))
    grid = ({"control_points": 8} if models is spline else {"elements": 8}) | (grid or {})
    return models.compliant_mechanism(
        strips=[strip], bodies=[*bodies, *more], effects=names, parameters=parameters, **grid
    )


@BOTH
def test_loads_superpose(models):
    """Requirement: loads on a tip and on a body add up, each with parameters of its own."""
    pull = [{"force": (0.3, 0.2)}, {"force": (-0.1, 1.8)}]
    turn = [{"moment": 0.2}, {"moment": 0.3}]

    def error(count=2):
        at_tip = [{"strip": "beam", **each, **more} for each, more in zip(pull, turn, strict=True)]
        several = beam("end", models, applied_force=pull[:count], applied_moment=turn)
        one = beam("end", models, applied_force={"force": (0.2, 2.0)}, applied_moment={"moment": 0.5})
        places = [models.solve_statics(each).bodies["end"] for each in (one, several)]
        places.append(models.solve_statics(beam(None, models, tip_force=at_tip)).tips["beam"])
        return max(np.abs(each - places[0]).max() for each in places)

    gates.hold(f"{short(models)}_lists", error)


def test_a_tip_moment_rolls_up_three_turns():
    """Requirement: the turn of a free end is counted beyond a full one."""

    def error(segments=8):
        moment = {"strip": "beam", "force": (0.0, 0.0), "moment": 6.0 * math.pi}
        path = spline.solve_statics(
            beam(grid={"segments": segments}, tip_force=moment), increments=30, check=False
        )
        return np.abs(path.tips["beam"][:, 2] - 6.0 * math.pi * path.load_factor).max()

    gates.hold("spline_turns", error)


@BOTH
def test_reactions_balance_the_loads(models):
    """Requirement: what drives and supports bear and the clamp bears is in balance with the loads."""
    given = {
        "driven_displacement": {"displacement": (None, 0.2)},
        "driven_rotation": {"angle": 0.4},
        "applied_force": [{"force": (1.0, 0.5)}, {"force": (0.3, -3.0)}],
    }

    def error(weigh=1.0):
        path = models.solve_statics(beam("end", models, **given))
        lift, twist = (path.reactions[-1, path.prescribed.index(("end", name))] for name in ("y", "rotation"))
        root, place = path.clamp_reactions[-1, 0, 0], path.bodies["end"][-1]
        force = root[:2] + np.array([1.3, lift - 2.5])
        moment = root[2] + weigh * twist + place[0] * (lift - 2.5) - place[1] * 1.3
        return max(abs(force).max(), abs(moment))

    gates.hold(f"{short(models)}_reactions", error)


#: Springs on the end of the beam, one of them to a body without strips on a spring to the ground.
SPRINGS = [
    {"body": "end", "rotational_stiffness": 0.7, "stiffness": (0.0, 2.0)},
    {"body": "end", "other": "hung", "stiffness": (5.0, 3.0), "rotational_stiffness": 0.4},
    {"body": "hung", "stiffness": (4.0, 6.0), "rotational_stiffness": 0.5},
]


def hung(models=spline):
    """The body without strips."""
    return models.BodyDesign(name="hung", centre=(1.0, -0.5), mass=0.5, moment_of_inertia=0.2)


@BOTH
def test_springs_bear_what_their_stiffness_says(models):
    """Requirement: an end turns by M / (EI/L + k); a body on springs alone swings by their stiffness."""

    def error(stiffness=0.7, **how):
        given = {"spring": {"rotational_stiffness": stiffness}, "applied_moment": {"moment": 2.0}}
        path = models.solve_statics(beam("end", models, **given), increments=4, **how)
        turn = path.rotation - path.load_factor * 2.0 / 1.7
        stored = 0.35 * path.rotation**2 - path.spring_energy
        alone = beam("end", models, more=[hung(models)], spring=SPRINGS[2])
        found = models.natural_frequencies(alone, rotation=None, body="hung", count=8).frequency
        rates = np.sqrt(np.array([4.0 / 0.5, 6.0 / 0.5, 0.5 / 0.2])) / (2.0 * math.pi)
        missed = np.abs(found[:, None] / rates - 1.0).min(axis=0)
        return max(np.abs(each).max() for each in (turn, stored, missed))

    gates.hold(f"{short(models)}_springs", error)
    if models is spline:
        gates.check("spline_springs", error(method="multipliers"))


#: Ends of the beam that turn freely, and a body that slides along it.
HINGED = {"root_joint": "hinge", "tip_joint": "hinge"}
SLIDING = {"fixed": ("y", "rotation")}


#: Joints of a column, roots of its Euler load and of its first frequency, and control points that it takes.
COLUMNS = [(HINGED, math.pi, math.pi, 10), ({"tip_joint": "hinge"}, 4.493409457909, 3.926602312048, 12)]


@BOTH
@pytest.mark.parametrize(("joints", "load", "root", "points"), COLUMNS, ids=["hinges", "clamp and hinge"])
def test_columns_on_hinges_buckle_as_euler_has_it(joints, load, root, points, models):
    """Requirement: a strip hinged at both ends buckles at pi^2 EI/L^2, and swings by pi^2 unloaded."""

    def found(method=None, **grid):
        given = {"models": models, "grid": grid, "own": joints | STIFF, "support": SLIDING}
        pressed = beam("end", **given, applied_force={"force": (-1.2 * load**2, 0.0)})
        how = {"increments": 6, "check": False} | ({"method": method} if method else {})
        (buckled,) = models.solve_statics(pressed, **how).critical_points
        swing = models.natural_frequencies(beam("end", **given), rotation=None, count=1).frequency[0]
        return np.array([1.2 * buckled.load_factor, 2.0 * math.pi * swing / root**2])

    def error(**grid):
        return np.abs(refined(found, **grid) - 1.0).sum()

    held(f"{short(models)}_hinges", models, error, points)
    if models is spline:
        gates.check("spline_hinges", error(method="multipliers", control_points=points))


def offset(history=((0.0, 1.0), (0.05, 1.0), (0.3, -0.5))):
    """A body on springs, hinged to the beam beside its centre, with a load beside its centre as well."""
    strip = spline.StripDesign(name="beam", tip="end", tip_joint="hinge", **STRIP)
    given = {
        "applied_force": [
            {"force": (0.5, -1.0), "at": (1.4, 0.3), "history": history},
            {"force": (0.1, 0.2)},
        ],
        "spring": {"stiffness": (1.0, 2.0), "rotational_stiffness": 0.5},
    }
    return spline.compliant_mechanism(
        strips=[strip],
        bodies=[spline.BodyDesign(name="end", centre=(1.2, 0.1), mass=1.0, moment_of_inertia=0.5)],
        effects=("bending", "stretching", "strip_inertia", "body_inertia", *given),
        parameters=given,
        control_points=8,
    )


def test_hinges_and_loads_go_with_their_body():
    """Requirement: a load beside the centre acts where its point is, a hinge bears no moment, and the paper's
    system has the same states."""

    def error(lever=1.0):
        path, other = (spline.solve_statics(offset(), method=each) for each in ("condensed", "multipliers"))
        x, y, turn = path.bodies["end"][-1]
        (fx, fy, moment), spring = (
            path.clamp_reactions[-1, 0, 1],
            (1.0, 2.0, 0.5) * np.array([x - 1.2, y - 0.1, turn]),
        )
        cos, sin = math.cos(turn), math.sin(turn)
        load, hinge = (
            np.array([0.2 * cos - 0.2 * sin, 0.2 * sin + 0.2 * cos]) * lever,
            (-0.2 * cos + 0.1 * sin, -0.2 * sin - 0.1 * cos),
        )
        turning = -load[0] - 0.5 * load[1] - hinge[0] * fy + hinge[1] * fx - spring[2]
        apart = np.abs(path.bodies["end"] - other.bodies["end"]).max()
        return max(abs(turning), abs(moment), abs(0.6 - fx - spring[0]), abs(-0.8 - fy - spring[1]), apart)

    gates.hold("spline_offsets", error)


def carried(end=1.0, height=0.1, load=True, inertia=True, density=1e-3):
    """A body on a spring and two strips, each with a hinge, and a load beside the centre of the body."""
    section = STRIP | {"density": density}
    given = {"spring": {"stiffness": (1.0, 2.0), "rotational_stiffness": 0.5}}
    if load:
        given["applied_force"] = {"force": (0.5, -1.0), "at": (1.4, 0.3)}
    effects = ("bending", "stretching", "body_inertia", *given, *("strip_inertia",) * inertia)
    low = section | {"start": (0.0, -0.5), "end": (1.2, -0.4)}
    return spline.compliant_mechanism(
        strips=[
            spline.StripDesign(name="beam", tip="end", tip_joint="hinge", **section | {"end": (end, 0.0)}),
            spline.StripDesign(name="low", tip="end", root_joint="hinge", **low),
        ],
        bodies=[spline.BodyDesign(name="end", centre=(1.2, height), mass=1.0, moment_of_inertia=0.5)],
        effects=effects,
        parameters=given,
        control_points=7,
    )


def test_designs_with_hinges_have_derivatives_and_batches():
    """Requirement: derivatives by the places of hinges and centres are those of differences, and a batch
    gives what single solves give."""
    names = ("beam.end_x", "end.centre_y")

    def solved(end=1.0, height=0.1):
        return spline.solve_statics(carried(end, height), rotation=0.4, increments=4)

    found = spline.sensitivities(carried(), solved(), parameters=names)

    def error(step=1e-4):
        moved = [
            [solved(**{name: at + way * step}) for way in (1.0, -1.0)]
            for name, at in (("end", 1.0), ("height", 0.1))
        ]
        apart = [
            (getattr(a, name)[-1] - getattr(b, name)[-1]) / (2.0 * step)
            - getattr(found, name).derivative[-1, ..., k]
            for k, (a, b) in enumerate(moved)
            for name in ("torque", "stiffness", "centre")
        ]
        return max(np.abs(each).max() for each in apart)

    gates.hold("spline_carried_derivatives", error)
    batch = spline.solve_many(
        carried(), {"beam.end_x": [1.0, 1.05], "end.centre_y": [0.1, 0.15]}, rotation=0.4
    )
    for row, alone in enumerate((solved(), solved(1.05, 0.15))):
        np.testing.assert_allclose(batch.torque[row, -1], alone.torque[-1], rtol=1e-10)
        np.testing.assert_allclose(batch.stiffness[row, -1], alone.stiffness[-1], rtol=1e-9)


def test_all_motions_know_hinges():
    """Requirement: the leapfrog and massless strips move a body on hinges as the energy scheme does."""
    run = {"start": 0.4, "duration": 0.2, "check": False}

    def error(step=1e-3):
        motion = spline.solve_motion(carried(load=False), step=step, **run)
        explicit = spline.solve_motion(carried(load=False), integrator="leapfrog", records=50, **run)
        light = spline.solve_motion(carried(load=False, density=1e-12), step=step, **run)
        massless = spline.solve_motion(carried(load=False, inertia=False), step=step, **run)
        pairs = ((motion, explicit), (light, massless))
        return max(np.abs(a.bodies["end"][-1] - b.bodies["end"][-1]).max() for a, b in pairs)

    gates.hold("spline_carried_motion", error)


@BOTH
def test_followers_bend_strips_as_the_elastica_has_it(models):
    """Requirement: a force that turns with the tip bends a strip as its elastica, in both systems; one along
    it buckles nothing below flutter at 20.05 EI/L^2, and beside it a dead load still does."""

    def bent(method=None, **grid):
        tip = {"strip": "beam", "force": (0.0, 10.0), "follower": True}
        how = {"increments": 10, "check": False} | ({"method": method} if method else {})
        return models.solve_statics(beam(None, models, STIFF, grid=grid, tip_force=tip), **how).tips["beam"][
            -1
        ]

    def error(**grid):
        return np.abs(refined(bent, **grid) - followed(10.0)).max()

    gate = f"{short(models)}_followers"
    held(gate, models, error, 14, (20, 40, 80))
    along = {"strip": "beam", "force": (-19.9, 0.0), "follower": True}
    path = models.solve_statics(beam(None, models, tip_force=along))
    assert path.critical_points == () and path.message == ""
    if models is spline:
        gates.check(gate, error(method="multipliers", control_points=14))
        both = [along | {"force": (-1e-9, 0.0)}, {"strip": "beam", "force": (-3.0, 0.0)}]
        (found,) = spline.solve_statics(beam(tip_force=both), check=False).critical_points
        gates.check(gate, abs(12.0 * found.load_factor / math.pi**2 - 1.0))


def sprung():
    """The beam on springs with dampers, one of which holds a body on a rail."""
    springs = [each | {"damping": (0.05, 0.1), "rotational_damping": 0.02} for each in SPRINGS]
    rail = {"body": "hung", "fixed": ("x",)}
    return beam("end", more=[hung()], spring=springs, support=rail)


def pushed():
    """The beam under a force that turns with its body."""
    force = {"force": (-0.3, 1.0), "at": (1.1, -0.2), "follower": True, "history": ((0.0, 0.0), (0.2, 1.0))}
    return beam("end", applied_force=force)


@pytest.mark.parametrize(
    ("gate", "made", "how"),
    [
        ("spline_spring_motion", sprung, {"start": 1.0, "body": "end", "duration": 1.0}),
        ("spline_hinged_motion", offset, {"duration": 0.6}),
        ("spline_follower_motion", pushed, {"duration": 0.5}),
    ],
)
def test_motions_keep_their_energy(gate, made, how):
    """Requirement: what springs, dampers, hinges, loads beside centres and forces that turn with a body do in
    a motion is in the balance of energies over any step, and supports stay."""

    def error(booked=1.0):
        run = spline.solve_motion(made(), step=0.02, check=False, **how)
        assert run.status.value == "converged" and (made is not sprung or run.dissipated[-1] > 1e-2)
        energy = run.kinetic_energy + run.strain_energy - booked * (run.work - run.dissipated)
        moved = run.bodies["hung"][:, 0] - 1.0 if made is sprung else 0.0
        return max(np.abs(energy - energy[0]).max(), np.abs(moved).max())

    gates.hold(gate, error)


def test_a_drive_that_begins_at_speed_carries_the_points_of_its_body():
    """Requirement: a jump of a driven rotation moves the body alike, wherever on it a load acts."""

    def moved(angle, **at):
        drive = {"angle": angle, "history": ((0.0, 0.0), (0.5, 1.0))}
        pulled = beam("end", applied_force={"force": (0.0, 0.2), **at}, driven_rotation=drive)
        return spline.solve_motion(pulled, start=None, duration=1.0, step=0.01, check=False).bodies["end"]

    def error(angle=0.5):
        return np.abs(moved(0.5) - moved(angle, at=(1.5, 0.3))).max()

    gates.hold("spline_drive_at_speed", error)
