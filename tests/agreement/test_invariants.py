"""What holds in any form of either model: work, balance, symmetry, frame, the way back, increments."""

from functools import cache, partial

import numpy as np
import pytest

import fe_reference
import spline_model
from tests import gates
from tests.models import BOTH, rotation_matrix
from tests.table_one import LENGTH, SIDES, SIX, TABLE_ONE

QUARTER = np.pi / 2
#: Eighth-order central difference of a first derivative, offsets 1 to 4.
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)


def solved(rotation=QUARTER, increments=20, method=None, **settings):
    """Path of Table 1: of elements where they are named, else of splines by a method."""
    models = fe_reference if "element" in settings else spline_model
    how = {"method": method} if method else {}
    pivot = models.cross_axis_pivot(**(TABLE_ONE if models is fe_reference else SIX) | settings)
    return models.solve_statics(pivot, rotation=rotation, increments=increments, **how)


def off_slope(slope, values, step):
    """Largest difference of what should be the slope of values along a path, over its largest value."""
    count = len(values)
    found = sum(
        w / step * (values[4 + k : count - 4 + k] - values[4 - k : count - 4 - k])
        for k, w in enumerate(WEIGHTS, start=1)
    )
    return np.abs(found - slope[4:-4]).max() / np.abs(slope).max()


def torque_against_energy(increments=40, **settings):
    """Error of the torque against dU/d(theta)."""
    path = solved(increments=increments, **settings)
    energy = path.bending_energy + path.axial_energy + getattr(path, "shear_energy", 0.0)
    return off_slope(path.torque, energy, QUARTER / increments)


def stiffness_against_torque(increments=40, **settings):
    """Error of the stiffness against dT/d(theta)."""
    path = solved(increments=increments, **settings)
    return off_slope(path.stiffness, path.torque, QUARTER / increments)


def balance_of_reactions(end=1, **settings):
    """Imbalance of strips between clamp and body and of the body under the torque, over the torque.

    end: the clamp whose reactions are taken for the body's, 1 being right.
    """
    path = solved(**settings)
    force, couple = path.clamp_reactions[..., :2], path.clamp_reactions[..., 2]
    arms = path.shape[:, :, [0, -1]] - path.centre[:, None, None]
    moment = couple + arms[..., 0] * force[..., 1] - arms[..., 1] * force[..., 0]
    imbalance = (
        force.sum(axis=2) * LENGTH,
        moment.sum(axis=2),
        force[:, :, end].sum(axis=1) * LENGTH,
        moment[:, :, end].sum(axis=1) - path.torque,
    )
    return max(np.abs(each).max() for each in imbalance) / path.torque.max()


def apart(one, other, centre, sign=1.0):
    """Largest difference of torque, over its largest, and of a path of the centre, over L."""
    torque = np.abs(other.torque - sign * one.torque).max() / one.torque.max()
    return max(torque, np.abs(other.centre - centre).max() / LENGTH)


def mirror(**settings):
    """Difference of the path the other way from the image of the path in the axis of symmetry."""
    one, other = (solved(sign * QUARTER, **settings) for sign in (1, -1))
    across = 2 * one.centre[0, 0] - one.centre[:, 0]
    return apart(one, other, np.column_stack((across, one.centre[:, 1])), -1.0)


def frame(turned_by=0.7, **settings):
    """Difference of the pivot turned as a whole from the image of its path, turned by 0.7 rad."""
    one, other = solved(**settings), solved(orientation=turned_by, **settings)
    return apart(one, other, one.centre @ rotation_matrix(0.7).T)


def stiffness_apart(other=None, **settings):
    """Difference of the stiffness of the path the other way, and of the pivot turned as a whole."""
    one, changed = solved(**settings), settings | (other or {})
    images = solved(-QUARTER, **changed), solved(orientation=0.7, **changed)
    return max(np.abs(image.stiffness / one.stiffness - 1).max() for image in images)


def unloaded_return(back_to=0.0, **settings):
    """Torque left after 90 deg and back, over its peak; less than a unit in the last place is one."""
    path = solved([QUARTER, back_to], **settings)
    return max(np.abs(path.torque[-1]) / path.torque.max(), np.finfo(float).eps)


def increments_apart(other=None, **settings):
    """Relative change of torque and stiffness at 90 deg over numbers of increments, from twenty."""
    one = solved(**settings)
    ends = [solved(increments=count, **settings | (other or {})) for count in (1, 2, 5, 200)]
    return max(
        abs(getattr(end, name)[-1] / getattr(one, name)[-1] - 1)
        for end in ends
        for name in ("torque", "stiffness")
    )


WORK = {
    torque_against_energy: ("spline_torque_is_energy_derivative", "fe_torque_is_energy_derivative"),
    stiffness_against_torque: ("spline_stiffness_is_torque_derivative", "fe_stiffness_is_torque_derivative"),
    balance_of_reactions: ("spline_balance_of_reactions", "fe_balance_of_reactions"),
}
SYMMETRIES = {
    mirror: ("spline_mirror", "fe_mirror"),
    frame: ("spline_rigid_rotation", "fe_rigid_rotation"),
    stiffness_apart: ("spline_stiffness_symmetry", "fe_stiffness_symmetry"),
    unloaded_return: ("spline_unloaded_return", "fe_unloaded_return"),
}
INCREMENTS = {increments_apart: ("spline_increment_independence", "fe_increment_independence")}
ELEMENTS = [{"element": element} for element in fe_reference.ELEMENTS]
FORMS = [
    {},
    {"control_points": 4},
    {"control_points": 6, "segments": 2},
    {"stretch": "inextensible"},
    {"stretch": "consistent", "measure": "spatial", "control_points": 4},
    {"crossing_ratio": 0.2, "inclination": np.radians(30), "centre_offset": (0.01, 0.02)},
]
NUMBERS = [
    {"control_points": n, "method": m} for n in (6, 4, 8, 10, 12) for m in ("condensed", "multipliers")
]
CASES = [
    (check, gate[forms is ELEMENTS], settings, number)
    for checks, splines in ((WORK, FORMS), (SYMMETRIES, NUMBERS), (INCREMENTS, [{}]))
    for forms in (splines, ELEMENTS)
    for check, gate in checks.items()
    for number, settings in enumerate(forms)
]


@pytest.mark.parametrize(
    ("check", "gate", "settings", "number"), CASES, ids=[f"{gate}-{k}" for _, gate, _, k in CASES]
)
def test_invariants(check, gate, settings, number):
    """Requirement: torque = dU/d(theta), K = dT/d(theta), reactions balance, the mirror image, the pivot
    turned as a whole, the way back and other increments give the same answer, in every form of the models."""
    error = partial(check, **settings)
    gates.check(gate, error())
    if number == 0:
        gates.refuse(gate, error)


def test_body_offset_only_moves_the_reported_point():
    """Requirement: a centre of mass off the plate changes its path, not the torque."""
    plain, moved = solved(), solved(centre_offset=(0.01, -0.02))
    turned = [rotation_matrix(angle) @ (0.01, -0.02) for angle in plain.rotation]
    gates.check("spline_rigid_rotation", apart(plain, moved, plain.centre + turned))


#: Effects with nothing in them: legal, and the same answer as without them.
ZERO = {
    "gravity": {"acceleration": (0.0, 0.0)},
    "strip_damping": {"relaxation_time": 0.0},
    "strip_drag": {"rate": 0.0},
    "body_damping": {},
    "applied_force": {"force": (0.0, 0.0)},
    "applied_moment": {"moment": 0.0},
    "pre_strain": {"curvature": 0.0, "strain": 0.0},
    "root_compliance": {"root": 0.0},
}
#: Effects of the curl, which are nothing without a Poisson effect. Impulses have none.
CURLS = {"clamped_width": {}, "anticlastic": {}}
#: Grid of each model, and its motions.
BRIEF, ALPHA = {"duration": 2e-3, "step": 1e-4}, {"integrator": "generalised-alpha", "step": 1e-5}
MOTIONS = {
    spline_model: ({"control_points": 6}, (("solve_motion", BRIEF), ("solve_impulses", BRIEF))),
    fe_reference: (
        {"elements": 4},
        (
            ("solve_motion", {"duration": 1e-4, "step": 1e-7}),
            ("solve_motion", {"duration": 1e-4, **ALPHA}),
        ),
    ),
}


@cache
def found(models, names, curls):
    """Torques of a path and rotations of the motions of a scene with effects that have nothing in them."""
    grid, motions = MOTIONS[models]
    model = models.cross_axis_pivot(
        **TABLE_ONE | SIDES | ({"poisson_ratio": 0.0} if curls else {}) | grid,
        effects=(*spline_model.DEFAULT_EFFECTS, *names),
        parameters={each: (ZERO | CURLS)[each] for each in names},
    )
    moved = [
        getattr(models, solve)(model, start=1.0, **steps).rotation
        for solve, steps in motions
        if not (curls and solve == "solve_impulses")
    ]
    path = models.solve_statics(model, rotation=1.0, increments=8, order="together")
    return [path.torque, *moved]


@BOTH
@pytest.mark.parametrize("name", [*ZERO, *CURLS])
def test_zero_equals_absent(name, models):
    """Requirement: an effect with nothing in it gives the path and the motions of a scene without it."""
    bare, named = (found(models, names, name in CURLS) for names in ((), (name,)))
    for one, other in zip(bare, named, strict=True):
        assert np.ptp(one) > 1e-6
        assert np.abs(one - other).max() <= 1e-14 * np.abs(one).max()
