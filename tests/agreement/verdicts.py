"""The judge of what both models say of a random scene.

A scene is silent when the models differ by more than their own estimates, or do not know within a tenth, and
neither of them says why.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import Design
from tests.agreement.random_scenes import described, scene

#: Differences below are those of Newton's tolerances, over the scales of `_scales` [1].
FLOOR = 1e-6
#: An estimate above says that a model does not know [1].
UNKNOWN = 0.1
#: Refinements whose difference estimates the error: control points of the spline, elements. Increments differ
#: as well, since an answer must not depend on them.
CONTROL_POINTS, ELEMENTS = (10, 12), (20, 40)


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What one run says, over the states of its path: numbers by quantity, and what it says of itself."""

    values: dict[str, np.ndarray]
    said: str


def answer(asked: Design, settings: Settings, times: int = 1) -> Answer:
    """Return the answer with `times` as many increments, at those of the scene."""
    increments = times * asked.increments
    found = put(asked, settings).static_path(increments=increments, raise_on_failure=False)
    place = np.hstack([found.bodies[body.name] for body in asked.bodies])
    energy = found.bending_energy + found.axial_energy + getattr(found, "shear_energy", 0.0)
    values = {"path": place, "energy": energy + found.gravity_energy}
    if asked.rotation is not None:
        values |= {"torque": found.torque, "stiffness": found.stiffness}
    said = [str(found.status.value)] if found.status.value != "converged" else []
    said += [text for text in (found.message, getattr(found, "resolution", "")) if text]
    return Answer(values={name: value[::times] for name, value in values.items()}, said="; ".join(said))


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """How the models compare: by quantity the difference over the estimate, and the estimate over its scale.

    said: what either says of its answer; empty where both are sure.
    """

    seed: int
    ratio: dict[str, float]
    estimate: dict[str, float]
    said: str

    @property
    def worst(self) -> float:
        """The largest ratio; infinite where an estimate says that a model does not know."""
        if max(self.estimate.values()) > UNKNOWN:
            return float("inf")
        return max(self.ratio.values())

    def __str__(self) -> str:
        parts = ", ".join(f"{k} {v:.3g} x {self.estimate[k]:.1e}" for k, v in self.ratio.items())
        return f"{parts}\n    {described(self.seed)}"


def judged(seed: int, control_points: int = CONTROL_POINTS[1]) -> Verdict:
    """Return the verdict on a scene; `control_points` are those of the spline that is judged."""
    asked = scene(seed)
    spline = [
        answer(asked, SplineSettings(control_points=n), times)
        for n, times in zip((CONTROL_POINTS[0], control_points), (2, 1), strict=True)
    ]
    elements = [
        answer(asked, FeSettings(elements=n), times) for n, times in zip(ELEMENTS, (1, 2), strict=True)
    ]
    said = "; ".join(dict.fromkeys(each.said for each in (*spline, *elements) if each.said))
    if said:
        return Verdict(seed=seed, ratio={"all": 0.0}, estimate={"all": 0.0}, said=said)
    reference = spline if control_points == CONTROL_POINTS[1] else [spline[0], spline[0]]
    ratio, estimate = {}, {}
    for name, scale in _scales(asked, elements[1].values).items():
        coarse, fine = (each.values[name] / scale for each in elements)
        rough, sure = (each.values[name] / scale for each in reference)
        errors = np.abs(fine - coarse).max() / 3.0, np.abs(sure - rough).max()
        apart = np.abs(spline[1].values[name] / scale - (4.0 * fine - coarse) / 3.0).max()
        estimate[name] = float(sum(errors))
        ratio[name] = float(apart / (estimate[name] + FLOOR))
    return Verdict(seed=seed, ratio=ratio, estimate=estimate, said="")


def _scales(asked: Design, values: dict[str, np.ndarray]) -> dict[str, Any]:
    """Return what each quantity is related to: lengths of strips, 1 rad, and the largest of the path."""
    first = asked.strips[0]
    length = first.length
    moment = first.youngs_modulus * first.second_moment_of_area / length
    bodies = values["path"].shape[1] // 3
    scales: dict[str, Any] = {"path": np.tile([length, length, 1.0], bodies)}
    least = {"energy": 0.01 * moment, "torque": 0.1 * moment, "stiffness": moment}
    return scales | {
        name: max(float(np.abs(values[name]).max()), least[name]) for name in least if name in values
    }
