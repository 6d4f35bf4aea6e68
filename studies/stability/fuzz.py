"""Random designs and command sequences: each is answered rightly, refused, or called bad input."""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from studies.answers.adapters import answer_release
from studies.answers.models import built, model_of, refusals
from studies.answers.settings import Settings, SplineSettings
from studies.cases.problem import Problem, named_case
from studies.engine.study import Answer, Part
from studies.stability import maps
from studies.stability.family import CASE, DEFAULT, VARIED, Found, family, judged, said

EXAMPLES, SEED = 400, 20260101
#: Largest error of torque at the ends of the legs, over the largest of them, that is right [1]: the distance
#: of another branch from the default's own error; and of the books of energy of a motion.
TOLERANCE, BOOKS = 0.05, 1e-8
#: Torque and energy below this are those of an unloaded pivot [EI/L]: states are solved to 1e-11.
UNLOADED = 1e-6
#: Least control points and increments of the reference; control points of that of the default.
REFINED, REFINED_INCREMENTS, FINEST = 12, 24, 17
#: Steps of a motion.
STEPS = 6
STATIC, MOTION = "path", "motion"


@dataclass(frozen=True, kw_only=True)
class Example:
    """A pivot and what is asked of it.

    Attributes:
        length [m]; inclination [rad]; crossing_ratio, slenderness [1]; youngs_modulus [Pa]: of the design;
            the section is square to the eye, of depth L over slenderness.
        control_points: of the model with varied settings [1]; targets: rotations [rad] of a path's legs, in
            `increments` each; a motion is let go at the first; step: of the motion, over the first period at
            rest [1]; None asks for a path.
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
    def kind(self) -> str:
        """Whether a path or a motion is asked for."""
        return STATIC if self.step is None else MOTION

    def problem(self) -> Problem:
        """Return the design; CaseError for a value outside its range."""
        given = named_case(CASE)
        depth = self.length / self.slenderness
        return replace(
            given,
            length=self.length,
            inclination=self.inclination,
            crossing_ratio=self.crossing_ratio,
            youngs_modulus=self.youngs_modulus,
            area=2.0 * depth**2,
            second_moment_of_area=2.0 * depth**4 / 12.0,
            body_mass=given.body_mass * (self.length / given.length) ** 3,
            body_moment_of_inertia=given.body_moment_of_inertia * (self.length / given.length) ** 5,
            rotation=self.targets[0],
            increments=self.increments,
        )


def examples() -> list[tuple[int, Example]]:
    """Return the random examples with their numbers, the same every time."""
    generator = np.random.default_rng(SEED)
    return [(number, drawn(generator)) for number in range(EXAMPLES)]


def _outcomes(number: int, example: Example) -> Answer:
    """Return how one example ends with its own control points, and with the default settings."""
    place = {
        "case": f"example {number:03d}",
        "kind": example.kind,
        "x": math.degrees(max(example.targets, key=abs)),
        "y": example.slenderness,
    }
    models = {
        VARIED: SplineSettings(control_points=example.control_points),
        DEFAULT: SplineSettings(),
    }
    rows = [
        {**place, "model": model, "panel": f"{model}: {example.kind}", **found.row()}
        for model, settings in models.items()
        for found in [judged(partial(asked, example, settings), TOLERANCE)]
    ]
    return {"outcomes": rows}


def drawn(generator: np.random.Generator) -> Example:
    """Return a random example, one in twenty with a value that no design can have."""
    uniform = generator.uniform
    legs = int(generator.integers(1, 4))
    example = Example(
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


def asked(example: Example, settings: SplineSettings) -> Found:
    """Ask the spline for what the example says and compare it with what is known to be right."""
    return _path(example, settings) if example.step is None else _motion(example, settings)


def _path(example: Example, settings: SplineSettings) -> Found:
    """Compare the torque at the ends of the legs with a refined path; the books of energy as well."""
    problem = example.problem()
    unit = problem.youngs_modulus * problem.second_moment_of_area / problem.length
    path = _legs(example, settings, example.increments)
    ends = _ends(path.rotation, example)
    books = np.abs(path.bending_energy + path.axial_energy - path.work).max()
    stored = np.abs(path.bending_energy + path.axial_energy).max()
    if not np.isfinite(path.torque).all():
        return Found(error=math.inf, fault="the torque is not a finite number")
    points = settings.control_points
    refined = replace(settings, control_points=FINEST if points is None else max(REFINED, points + 3))
    reference = _legs(example, refined, max(REFINED_INCREMENTS, example.increments))
    known = _ends(reference.rotation, example)
    both = min(len(ends), len(known))
    scale = max(float(np.abs(reference.torque).max()), UNLOADED * unit)
    error = np.abs(path.torque[ends[:both]] - reference.torque[known[:both]]).max() if both else 0.0
    return Found(
        error=float(error / scale),
        reached=path.status.value == "converged",
        reason=path.message or path.resolution,
        states_limit=bool(path.resolution),
        warned=bool(path.resolution),
        fault=""
        if books <= max(0.5 * stored, UNLOADED * unit) or example.increments < 5
        else "work and energy differ",
        counters=path.counters,
    )


def _legs(example: Example, settings: Settings, increments: int) -> Any:
    model = model_of(settings)
    pivot, _ = built(model, example.problem(), settings, moving=False)
    with refusals(model, settings):
        return model.statics.solve_statics(
            pivot, rotation=list(example.targets), increments=increments, raise_on_failure=False
        )


def _ends(rotation: Any, example: Example) -> list[int]:
    """Return the states at which legs end, as far as the path goes, in order."""
    found, state = [], 0
    for target in example.targets:
        later = np.flatnonzero(np.abs(rotation[state + 1 :] - target) < 1e-12)
        if not later.size:
            break
        state += 1 + int(later[0])
        found.append(state)
    return found


def _motion(example: Example, settings: SplineSettings) -> Found:
    """Let the pivot go: whatever the step, the books of energy close and the clamps hold."""
    problem = example.problem()
    inertia = problem.body_moment_of_inertia + problem.body_mass * problem.length**2
    rigidity = problem.youngs_modulus * problem.second_moment_of_area
    period = 2.0 * math.pi * math.sqrt(inertia * problem.length / (2.0 * rigidity))
    step = period * float(example.step or 0.0)
    motion = answer_release(problem, settings, duration=STEPS * step, step=step)
    if not len(motion.time):
        return Found(error=0.0, reached=False, reason=motion.message, counters=motion.counters)
    stored = motion.kinetic_energy + motion.strain_energy
    scale = max(float(stored[0]), UNLOADED * rigidity / problem.length)
    gain, lost = float((stored - stored[0]).max()) / scale, float(np.abs(stored - stored[0]).max()) / scale
    gap = float(motion.constraint_residual.max()) / problem.length
    finite = all(np.isfinite(place).all() for place in motion.bodies.values())
    faults = {
        f"the energy grows by {gain:.2g} of itself": not gain <= BOOKS,
        f"the clamps part by {gap:.2g} of the length": not gap <= BOOKS,
        "the motion is not of finite numbers": not finite,
    }
    fault = next((fault for fault, holds in faults.items() if holds), "")
    return said(motion, max(lost, gap), fault=fault)


STUDY = family(
    Part(at=examples, ask=_outcomes),
    figures={
        "stability_fuzz": lambda tables: maps.outcome_map(
            tables["outcomes"],
            panels_by="panel",
            order=[f"{model}: {kind}" for kind in (STATIC, MOTION) for model in (DEFAULT, VARIED)],
            title="Random designs and commands, spline",
            xlabel="largest rotation [deg]",
            ylabel="slenderness L/h [1]",
            yscale="log",
            xlim=(-210.0, 210.0),
            ylim=(3.0, 2e4),
            xticks=[-180, -90, 0, 90, 180],
        )
    },
)
