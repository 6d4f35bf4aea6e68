"""Random designs and command sequences: each is answered rightly, refused, or called bad input."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release
from studies.answers.models import put
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import flexural_scale
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_moments
from studies.engine import Answer, Claim, Part, Row, Tables
from studies.errors import BadInput
from studies.stability.verdict import DEFAULT, VARIED, Found, judged, study

EXAMPLES, SEED = 400, 20260101
#: Largest error of torque at the ends of the legs, over the largest of them, that is right [1]: the distance
#: of another branch from the default's own error; and of the books of energy of a motion.
TOLERANCE, BOOKS = 0.05, 1e-8
#: Torque and energy below this are those of an unloaded pivot [EI/L]: states are solved to 1e-11.
UNLOADED = 1e-6
#: Least control points and increments of the reference; control points of that of the default.
REFINED, REFINED_INCREMENTS, FINEST = 12, 24, 17
#: Paths that are held against elements as well, which share nothing with the splines, and elements a strip.
SAMPLE, ELEMENTS = 100, 80
#: Steps of a motion.
STEPS = 6


@dataclass(frozen=True, kw_only=True)
class _Example:
    """A pivot and what is asked of it.

    Attributes:
        length [m]; inclination [rad]; crossing_ratio, slenderness [1]; youngs_modulus [Pa]: of the design;
            the section is square to the eye, of depth L over slenderness.
        control_points: of the model with varied settings [1]; targets: rotations [rad] of a path's legs, in
            `increments` each; a motion is released at the first; step: of the motion, over the first period
            at rest [1]; None asks for a path.
    """

    length: float
    inclination: float
    crossing_ratio: float
    slenderness: float
    youngs_modulus: float
    control_points: int
    targets: tuple[float, ...]
    increments: int
    step: float | None

    @property
    def finer(self) -> int:
        """Increments of a leg of what the path is held against."""
        return max(REFINED_INCREMENTS, self.increments)

    def problem(self) -> Problem:
        """Return the design; CaseError for a value outside its range."""
        given = named_case()
        depth = self.length / self.slenderness
        return replace(
            given,
            length=self.length,
            inclination=self.inclination,
            crossing_ratio=self.crossing_ratio,
            youngs_modulus=self.youngs_modulus,
            **of_moments(2.0 * depth**2, 2.0 * depth**4 / 12.0),
            body_mass=given.body_mass * (self.length / given.length) ** 3,
            body_moment_of_inertia=given.body_moment_of_inertia * (self.length / given.length) ** 5,
            rotation=self.targets[0],
            increments=self.increments,
        )


def _examples() -> list[tuple[int, _Example]]:
    """Return the random examples with their numbers, the same every time."""
    generator = np.random.default_rng(SEED)
    return [(number, _drawn(generator)) for number in range(EXAMPLES)]


def _outcomes(number: int, example: _Example) -> Answer:
    """Return how one example ends with its own control points, and with the default settings."""
    kind = "path" if example.step is None else "motion"
    place: Row = {"case": f"example {number:03d}", "kind": kind}
    place |= {"x": math.degrees(max(example.targets, key=abs)), "y": example.slenderness}
    models = {VARIED: SplineSettings(control_points=example.control_points), DEFAULT: SplineSettings()}
    rows = [
        {**place, "model": model, "panel": f"{model}: {kind}"}
        | judged(partial(_path if example.step is None else _motion, example, settings), TOLERANCE)
        for model, settings in models.items()
    ]
    return {"outcomes": rows}


def _drawn(generator: np.random.Generator) -> _Example:
    """Return a random example, one in twenty with a value that no design can have."""
    uniform = generator.uniform
    legs = int(generator.integers(1, 4))
    example = _Example(
        length=10.0 ** uniform(-3.0, 0.5),
        inclination=math.radians(uniform(8.0, 82.0)),
        crossing_ratio=uniform(0.03, 0.97),
        slenderness=10.0 ** uniform(0.7, 4.0),
        youngs_modulus=10.0 ** uniform(6.0, 12.0),
        control_points=int(generator.integers(4, 10)),
        targets=tuple(float(turn) for turn in np.radians(uniform(-200.0, 200.0, legs))),
        increments=int(generator.integers(1, 25)),
        step=None if generator.random() < 0.7 else 10.0 ** uniform(-3.0, 0.0),
    )
    if generator.random() < 0.05:
        names = ("length", "crossing_ratio", "youngs_modulus")
        bad = (-1.0, 0.0, math.nan, math.inf)
        spoilt: dict[str, Any] = {str(generator.choice(names)): float(generator.choice(bad))}
        return replace(example, **spoilt)
    return example


def _path(example: _Example, settings: SplineSettings) -> Found:
    """Compare the torque at the ends of the legs with a refined path; the books of energy as well."""
    path = _legs(example, settings, example.increments)
    if not np.isfinite(path.torque).all():
        return Found(error=math.inf, fault="the torque is not a finite number")
    points = settings.control_points
    refined = replace(settings, control_points=FINEST if points is None else max(REFINED, points + 3))
    error, both = _apart(path, _legs(example, refined, example.finer), example)
    stored = path.bending_energy + path.axial_energy
    least = max(0.5 * np.abs(stored).max(), UNLOADED * flexural_scale(example.problem()))
    closed = np.abs(stored - path.work).max() <= least or example.increments < 5
    return Found.of(path, error if both else 0.0, fault="" if closed else "work and energy differ")


def _legs(example: _Example, settings: Settings, increments: int) -> Any:
    asked = put(example.problem(), settings)
    return asked.static_path(rotation=list(example.targets), increments=increments, raise_on_failure=False)


def _apart(path: Any, reference: Any, example: _Example) -> tuple[float, int]:
    """Return the largest difference of torque at the ends of legs that both reach, over the reference's
    largest [1], and how many these are; NaN for none."""
    ends, known = (_ends(each.rotation, example) for each in (path, reference))
    both = min(len(ends), len(known))
    scale = max(float(np.abs(reference.torque).max()), UNLOADED * flexural_scale(example.problem()))
    apart = np.abs(path.torque[ends[:both]] - reference.torque[known[:both]]).max(initial=0.0)
    return float(apart / scale) if both else math.nan, both


def _sample() -> Iterator[tuple[int, _Example]]:
    """Yield the first paths of designs that can be."""
    left = SAMPLE
    for number, example in _examples():
        if example.step is None and left:
            try:
                example.problem()
            except BadInput:
                continue
            left -= 1
            yield number, example


def _independent(number: int, example: _Example, count: int = ELEMENTS) -> Answer:
    """Return how far the default's path is from that of so many elements a strip."""
    path = _legs(example, SplineSettings(), example.increments)
    elements = _legs(example, FeSettings(elements=count), example.finer)
    error, both = _apart(path, elements, example)
    row = {"case": f"example {number:03d}", "legs": len(example.targets), "legs_compared": both}
    return {"elements": row | {"error": error, "reason": path.message or elements.message}}


def _compared(tables: Tables) -> list[Row]:
    """Return how many paths elements were asked for, how many can be compared, and the largest difference."""
    errors = tables["elements"]["error"]
    return [{"asked": len(errors), "compared": int(errors.notna().sum()), "error": errors.max()}]


def _ends(rotation: Any, example: _Example) -> list[int]:
    """Return the states at which legs end, as far as the path goes, in order."""
    found, state = [], 0
    for target in example.targets:
        later = np.flatnonzero(np.abs(rotation[state + 1 :] - target) < 1e-12)
        if not later.size:
            break
        state += 1 + int(later[0])
        found.append(state)
    return found


def _motion(example: _Example, settings: SplineSettings) -> Found:
    """Release the pivot: for every step, the energy balance closes and the clamps hold."""
    problem, unit = example.problem(), flexural_scale(example.problem())
    inertia = problem.body_moment_of_inertia + problem.body_mass * problem.length**2
    step = 2.0 * math.pi * math.sqrt(inertia / (2.0 * unit)) * float(example.step or 0.0)
    motion = answer_release(problem, settings, duration=STEPS * step, step=step)
    if not len(motion.time):
        return Found.of(motion, 0.0)
    stored = motion.kinetic_energy + motion.strain_energy
    scale = max(float(stored[0]), UNLOADED * unit)
    gain, lost = float((stored - stored[0]).max()) / scale, float(np.abs(stored - stored[0]).max()) / scale
    gap = float(motion.constraint_residual.max()) / problem.length
    finite = all(np.isfinite(place).all() for place in motion.bodies.values())
    faults = {
        f"the energy grows by {gain:.2g} of itself": not gain <= BOOKS,
        f"the clamps part by {gap:.2g} of the length": not gap <= BOOKS,
        "the motion is not of finite numbers": not finite,
    }
    fault = next((fault for fault, holds in faults.items() if holds), "")
    return Found.of(motion, max(lost, gap), fault=fault)


STUDY = study(
    Part(at=_examples, ask=_outcomes),
    Part(at=_sample, ask=_independent),
    claims=(
        Claim(
            claim=f"Random paths are those of elements within {100 * TOLERANCE:g} % of the largest torque",
            formulation="{compared} of {asked} paths that both models follow",
            quantity="the largest difference of the torque at the ends of their legs",
            rows=_compared,
            value="error",
            most=TOLERANCE,
        ),
    ),
)
