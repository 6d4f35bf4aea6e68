"""What must hold on any mesh: energy, balance, symmetry, frame indifference, reversibility."""

from dataclasses import replace

import numpy as np
import pytest

from fe_reference import ELEMENTS, solve_statics
from tests.fe.cases import FORCE, LENGTH, MOMENT, QUICK_ELEMENTS, SECTION, pivot, rotated, rotation_matrix
from tests.gates import hold

QUARTER = np.pi / 2.0
#: Eighth-order central difference of a first derivative, offsets 1 to 4.
WEIGHTS = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)


@pytest.mark.parametrize("element", ELEMENTS)
def test_torque_is_the_slope_of_the_energy(element: str) -> None:
    """The torque is dU/dtheta: eighth-order differences of the energy over the path."""

    def error(increments: int = 40) -> float:
        answer = solve_statics(pivot(element=element), rotation=QUARTER, increments=increments)
        step, inner = QUARTER / increments, slice(4, -4)
        energy = answer.strain_energy
        count = len(energy)
        slope = sum(
            w / step * (energy[4 + k : count - 4 + k] - energy[4 - k : count - 4 - k])
            for k, w in enumerate(WEIGHTS, start=1)
        )
        return float(np.abs(slope - answer.torque[inner]).max() / answer.torque.max())

    hold(f"fe_energy_slope_{element}", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_stiffness_is_the_slope_of_the_torque(element: str) -> None:
    """The stiffness from the tangent is dT/dtheta, by the same differences of the torque."""

    def error(increments: int = 40) -> float:
        answer = solve_statics(pivot(element=element), rotation=QUARTER, increments=increments)
        step, torque, count = QUARTER / increments, answer.torque, increments + 1
        slope = sum(
            w / step * (torque[4 + k : count - 4 + k] - torque[4 - k : count - 4 - k])
            for k, w in enumerate(WEIGHTS, start=1)
        )
        return float(np.abs(slope - answer.stiffness[4:-4]).max() / answer.stiffness.max())

    hold(f"fe_torque_slope_{element}", error)


@pytest.mark.parametrize("element", ELEMENTS)
def test_stiffness_does_not_depend_on_the_order(element: str) -> None:
    """Whichever strip comes first, stiffness is the same: round-off of EA is not in it, however slender."""
    thinner = {"area": 0.1 * SECTION.area, "second_moment_of_area": 1e-3 * SECTION.second_moment_of_area}
    thin = replace(SECTION, **thinner)
    given = pivot(crossing_ratio=0.35, element=element)
    model = replace(given, strips=tuple(replace(strip, section=thin) for strip in given.strips))
    turned = replace(model, strips=model.strips[::-1])
    one, other = (solve_statics(each, rotation=0.5, increments=4).stiffness for each in (model, turned))
    assert one[1:] == pytest.approx(other[1:], rel=1e-12)


def test_reactions_balance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clamp and body hold every strip in balance; the body receives the driving torque alone."""

    def error(tolerance: float = 1e-10) -> float:
        for name, least in (("TOLERANCE", 1e-10), ("LAST", 1e-9)):
            monkeypatch.setattr(f"fe_reference.control.{name}", max(tolerance, least))
        answer = solve_statics(pivot(crossing_ratio=0.35), rotation=QUARTER)
        ends = answer.shape[:, :, [0, -1]] - answer.centre[:, None, None, :]
        force, couple = answer.clamp_reactions[..., :2], answer.clamp_reactions[..., 2]
        moment = couple + ends[..., 0] * force[..., 1] - ends[..., 1] * force[..., 0]
        strips = max(np.abs(force.sum(axis=2)).max() / FORCE, np.abs(moment.sum(axis=2)).max() / MOMENT)
        body = np.abs(force[:, :, 1].sum(axis=1)).max() / FORCE
        torque = np.abs(moment[:, :, 1].sum(axis=1) - answer.torque).max() / MOMENT
        return float(max(strips, body, torque))

    hold("fe_reactions_balance", error)


def test_section_forces_are_in_balance_along_the_strip() -> None:
    """The end values of M, N and V are the clamp reactions, and dM/ds = -(1 + eps) V between the nodes."""

    def error(elements: int = 80) -> float:
        answer = solve_statics(pivot(elements=elements, crossing_ratio=0.35), rotation=QUARTER, increments=5)
        moment = answer.bending_moment[1:]
        strain = answer.axial_force[1:] / SECTION.axial_rigidity
        load = (1.0 + strain) * answer.shear_force[1:]
        gain = np.diff(moment, axis=-1) + LENGTH / elements * 0.5 * (load[..., 1:] + load[..., :-1])
        assert np.allclose(moment[..., 0], -answer.clamp_reactions[1:, :, 0, 2], rtol=1e-12)
        assert np.allclose(moment[..., -1], answer.clamp_reactions[1:, :, 1, 2], rtol=1e-12)
        return float(np.abs(gain).max() * elements / np.abs(moment).max())

    hold("fe_section_force_balance", error)


def test_mirror() -> None:
    """Driven the other way the symmetric pivot gives the mirrored path, torque and stiffness."""

    def error(offset: float = 0.0) -> float:
        model = pivot(centre_offset=(offset, 0.0))
        one, other = (solve_statics(model, rotation=sign * QUARTER) for sign in (1.0, -1.0))
        across = 2.0 * one.centre[0, 0] - one.centre[:, 0]
        gaps = (
            (other.torque + one.torque) / one.torque.max(),
            (other.stiffness - one.stiffness) / one.stiffness.max(),
            (other.centre[:, 0] - across) / LENGTH,
            (other.centre[:, 1] - one.centre[:, 1]) / LENGTH,
        )
        return float(max(np.abs(gap).max() for gap in gaps))

    hold("fe_mirror", error)


@pytest.mark.parametrize("element", QUICK_ELEMENTS)
def test_frame_indifference(element: str) -> None:
    """The pivot turned as a whole by 2.5 rad gives the same torque and stiffness and the turned path."""

    def error(elements: int = 20) -> float:
        one = solve_statics(pivot(element=element), rotation=QUARTER)
        other = solve_statics(rotated(pivot(element=element, elements=elements), 2.5), rotation=QUARTER)
        gaps = (
            (other.torque - one.torque) / one.torque.max(),
            (other.stiffness - one.stiffness) / one.stiffness.max(),
            (other.centre - one.centre @ rotation_matrix(2.5).T) / LENGTH,
        )
        return float(max(np.abs(gap).max() for gap in gaps))

    hold(f"fe_rotated_{element}", error)


def test_unloaded_return() -> None:
    """Driven to 90 degrees and back the pivot is free of torque, relative to the peak."""

    def error(end: float = 0.0) -> float:
        answer = solve_statics(pivot(), rotation=(QUARTER, end))
        # what is left is far below one unit in the last place of the peak, which stands for it
        return max(float(abs(answer.torque[-1]) / answer.torque.max()), float(np.finfo(float).eps))

    hold("fe_unloaded_return", error)


def test_path_does_not_depend_on_the_increments() -> None:
    """One increment of 90 degrees is refused, halved, and ends in the state that twenty increments reach."""

    def error(elements: int = 20) -> float:
        fine = solve_statics(pivot(), rotation=QUARTER)
        coarse = solve_statics(pivot(elements=elements), rotation=QUARTER, increments=1)
        assert coarse.counters["halvings"] > 0
        assert fine.counters["halvings"] == 0
        gaps = [
            getattr(coarse, name)[-1] / getattr(fine, name)[-1] - 1.0
            for name in ("torque", "stiffness", "centre")
        ]
        return float(max(np.abs(gap).max() for gap in gaps))

    hold("fe_increment_independence", error)
